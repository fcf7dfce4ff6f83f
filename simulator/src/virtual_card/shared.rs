//! One virtual card in several hands: the driver's registers, its clock, and the camera above the robot.

use super::VirtualCard;
use driver::drive::PoseSource;
use driver::pci::{Bar, PciCard, PciError};
use driver::realtime::Clock;
use model::camera::{Camera, CameraModel};
use model::measurement::Measurement;
use runs::frames::{Pose, Twist};
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

/// A card; clones are the same one.
#[derive(Clone, Debug)]
pub struct SharedCard(Rc<RefCell<VirtualCard>>);

impl SharedCard {
    /// Takes a card, which all clones of this then reach.
    #[must_use]
    pub fn new(card: VirtualCard) -> Self {
        Self(Rc::new(RefCell::new(card)))
    }

    /// Where the robot really is.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.motion().0
    }

    /// Lifts its robot, and sets it down elsewhere.
    pub fn stand(&self, pose: Pose) {
        self.0.borrow_mut().stand(pose);
    }

    /// Where its robot is, and how it moves.
    #[must_use]
    pub fn motion(&self) -> (Pose, Twist) {
        let mut card = self.0.borrow_mut();
        let plant = card.machine().plant();
        (plant.pose(), plant.twist())
    }

    /// An overhead camera that sees this card's robot.
    #[must_use]
    pub fn camera(&self, model: CameraModel, seed: u64) -> CameraAbove {
        CameraAbove { card: self.clone(), camera: Camera::new(model, seed) }
    }
}

impl PciCard for SharedCard {
    fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError> {
        self.0.borrow_mut().read32(bar, offset)
    }
    fn write32(&mut self, bar: Bar, offset: u32, data: u32) -> Result<(), PciError> {
        self.0.borrow_mut().write32(bar, offset, data)
    }
    fn write8(&mut self, bar: Bar, offset: u32, data: u8) -> Result<(), PciError> {
        self.0.borrow_mut().write8(bar, offset, data)
    }
    fn has(&self, bar: Bar) -> bool {
        self.0.borrow().has(bar)
    }
    fn now(&mut self) -> Duration {
        self.0.borrow_mut().now()
    }
    fn sleep(&mut self, time: Duration) {
        self.0.borrow_mut().sleep(time);
    }
    fn remark(&self) -> Option<String> {
        self.0.borrow().remark()
    }
}

impl Clock for SharedCard {
    fn now(&mut self) -> Duration {
        PciCard::now(self)
    }
    fn sleep_until(&mut self, at: Duration) {
        let wait = at.saturating_sub(PciCard::now(self));
        if !wait.is_zero() {
            self.sleep(wait);
        }
    }
}

/// Sees the robot of a virtual card, with noise and latency.
#[derive(Debug)]
pub struct CameraAbove {
    card: SharedCard,
    camera: Camera,
}

impl PoseSource for CameraAbove {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        self.camera.observe(t, self.card.pose()).map(Into::into)
    }
}
