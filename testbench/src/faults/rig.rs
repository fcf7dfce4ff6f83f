//! A configured card, a robot and a camera in simulated time, with things that can break.

use driver::drive::PoseSource;
use driver::realtime::Clock;
use driver::{BusError, Registers};
use fixed_kin::registers::{NOMINAL_CLOCK_HZ, STATUS, STATUS_ARMED};
use model::camera::{Camera, CameraModel};
use model::measurement::Measurement;
use runs::frames::Pose;
use runs::geometry::GeometryError;
use runs::robot::Robot;
use simulator::virtual_card::{BitTrueLive, Live, Machine, Wiring};
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

/// What a read and a write take, as on a 33 MHz PCI bus.
const READ_TIME: Duration = Duration::from_nanos(900);
const WRITE_TIME: Duration = Duration::from_nanos(300);
/// Steps in which time passes, so that it is known when the outputs went off.
const STEP: Duration = Duration::from_millis(1);

/// What breaks outside of the bus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigFault {
    /// The cable of an encoder.
    Cable(usize, Cable),
    /// The camera sends nothing from now on.
    CameraGone,
    /// The card's clock runs at this share of what it was.
    Clock(f64),
    /// The host sleeps for so long.
    Stall(Duration),
    /// Somebody presses the emergency stop.
    EmergencyStop,
}

/// What breaks of a cable; positions are those of the moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cable {
    /// One line cut.
    Cut,
    /// Lines swapped.
    Swapped,
    /// Lines shorted.
    Shorted,
    /// Both lines cut; so does a blocked wheel look.
    Silent,
    /// Exchanged with the next axis.
    Crossed,
}

#[derive(Debug)]
struct Inside {
    live: BitTrueLive,
    machine: Machine,
    camera: Option<Camera>,
    clock_hz: f64,
    /// The clock before anything broke.
    right_hz: f64,
    /// Clocks of the card, and the time up to which they were counted.
    clocks: f64,
    counted: Duration,
    now: Duration,
    fault: Option<(Duration, RigFault)>,
    armed_at: Option<Duration>,
    track: Vec<Pose>,
    failure: Option<String>,
}

/// Registers, clock and camera of one rig; clones are the same one.
#[derive(Clone, Debug)]
pub struct Rig(Rc<RefCell<Inside>>);

impl Rig {
    /// A robot at rest behind a card of this clock.
    ///
    /// # Errors
    /// A robot whose wheels cannot drive it.
    pub fn new(robot: &Robot, clock_hz: f64, fault: Option<(Duration, RigFault)>) -> Result<Self, GeometryError> {
        Ok(Self(Rc::new(RefCell::new(Inside {
            live: BitTrueLive::new(),
            machine: Machine::new(robot)?,
            camera: Some(Camera::new(CameraModel::of(robot), 1)),
            clock_hz,
            right_hz: clock_hz,
            clocks: 0.0,
            counted: Duration::ZERO,
            now: Duration::ZERO,
            fault,
            armed_at: None,
            track: Vec::new(),
            failure: None,
        }))))
    }

    /// Clock of the simulated card, Hz.
    #[must_use]
    pub fn nominal_clock_hz() -> f64 {
        f64::from(NOMINAL_CLOCK_HZ)
    }

    /// Takes away the cause of whatever broke, or would have; what the card keeps of it stays.
    pub fn mend(&self) {
        let mut inside = self.0.borrow_mut();
        inside.fault = None;
        inside.clock_hz = inside.right_hz;
        inside.machine.mend();
        inside.live.pins().emergency_stop = false;
    }

    /// Lets time pass without a host.
    pub fn pass(&self, time: Duration) {
        let until = self.0.borrow().now + time;
        self.0.borrow_mut().run_to(until);
    }

    /// Whether the outputs may be on.
    #[must_use]
    pub fn armed(&self) -> bool {
        self.0.borrow_mut().armed()
    }

    /// When the outputs were last seen on, to a millisecond.
    #[must_use]
    pub fn last_armed(&self) -> Option<Duration> {
        self.0.borrow().armed_at
    }

    /// The rig's time.
    #[must_use]
    pub fn time(&self) -> Duration {
        self.0.borrow().now
    }

    /// Where the robot was, every millisecond.
    #[must_use]
    pub fn track(&self) -> Vec<Pose> {
        self.0.borrow().track.clone()
    }

    /// Why the simulation failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        self.0.borrow().failure.clone()
    }
}

impl Inside {
    fn armed(&mut self) -> bool {
        self.live.read(STATUS.offset).is_ok_and(|word| STATUS_ARMED.is_set(word))
    }

    fn run_to(&mut self, until: Duration) {
        while self.now < until {
            if let Some((at, fault)) = self.fault
                && self.now >= at
            {
                self.fault = None;
                self.breaks(fault);
            }
            // A stall above may have gone past it.
            self.now = self.now.max(until.min(self.now + STEP));
            self.settle();
            if self.armed() {
                self.armed_at = Some(self.now);
            }
        }
    }

    /// Brings the card up to now.
    fn settle(&mut self) {
        self.clocks += (self.now - self.counted).as_secs_f64() * self.clock_hz;
        self.counted = self.now;
        if let Err(error) = self.live.run_to(self.clocks as u64, self.clock_hz, &mut self.machine) {
            self.failure.get_or_insert(error.to_string());
        }
        while self.track.len() as u128 <= self.now.as_millis() {
            self.track.push(self.machine.plant().pose());
        }
    }

    fn breaks(&mut self, fault: RigFault) {
        match fault {
            RigFault::Cable(axis, cable) => {
                let positions = self.machine.encoders();
                let other = (axis + 1) % 3;
                let wiring = &mut self.machine.wiring;
                match cable {
                    Cable::Cut => wiring[axis] = Wiring::Cut(positions[axis]),
                    Cable::Swapped => wiring[axis] = Wiring::Swapped(positions[axis]),
                    Cable::Shorted => wiring[axis] = Wiring::Shorted(positions[axis]),
                    Cable::Silent => wiring[axis] = Wiring::Silent(positions[axis]),
                    Cable::Crossed => {
                        let offset = positions[other] - positions[axis];
                        wiring[axis] = Wiring::Crossed(other, offset);
                        wiring[other] = Wiring::Crossed(axis, -offset);
                    }
                }
            }
            RigFault::CameraGone => self.camera = None,
            RigFault::Clock(ratio) => self.clock_hz *= ratio,
            RigFault::Stall(time) => self.run_to(self.now + time),
            RigFault::EmergencyStop => self.live.pins().emergency_stop = true,
        }
    }
}

impl Registers for Rig {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        let mut inside = self.0.borrow_mut();
        inside.now += READ_TIME;
        inside.settle();
        inside.live.read(offset).map_err(|error| BusError::read(offset, error))
    }

    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        let mut inside = self.0.borrow_mut();
        inside.now += WRITE_TIME;
        inside.settle();
        inside.live.write(offset, data).map_err(|error| BusError::write(offset, error))
    }
}

impl Clock for Rig {
    fn now(&mut self) -> Duration {
        self.0.borrow().now
    }

    fn sleep_until(&mut self, at: Duration) {
        self.0.borrow_mut().run_to(at);
    }
}

impl PoseSource for Rig {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        let mut inside = self.0.borrow_mut();
        let pose = inside.machine.plant().pose();
        inside.camera.as_mut()?.observe(t, pose).map(Into::into)
    }
}
