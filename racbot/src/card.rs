//! Which card a command works on.

use crate::terminal::Failure;
use clap::Args;
use driver::RegisterWindow;
use driver::drive::PoseSource;
use driver::load::{Options as LoadOptions, inspect, measure_clock};
use driver::pci::{FindError, PciCard, SYSFS_DEVICES, SysfsCard, Use, find};
use driver::realtime::{Clock, MonotonicClock};
use runs::robot::Robot;
use std::path::Path;

/// Name that stands for the built-in card.
#[cfg(feature = "simulation")]
const VIRTUAL: &str = "virtual";

/// Options that choose the card and its clock.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct CardOptions {
    /// PCI slot of the card, as lspci names it; without it the only Mesa 4I65 there is
    #[cfg_attr(feature = "simulation", doc = "(`virtual` is the built-in one, bit-true, with a robot behind it)")]
    #[arg(long, value_name = "SLOT")]
    pub(crate) card: Option<String>,
}

/// Whose time passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// Everybody's.
    Real,
    /// The built-in card's own, as fast as it can be computed.
    #[cfg(feature = "simulation")]
    Simulated,
}

/// An open card, with the time and the camera that belong to it.
pub(crate) struct OpenCard {
    /// Its name: the slot.
    pub(crate) name: String,
    /// What reads and writes its PCI windows.
    pub(crate) card: Box<dyn PciCard>,
    /// Whether it is the simulated one in this program.
    #[cfg(feature = "simulation")]
    pub(crate) built_in: bool,
    /// The time in which it lives.
    pub(crate) clock: Box<dyn Clock>,
    /// The camera above its robot, if there is one.
    pub(crate) source: Option<Box<dyn PoseSource>>,
    /// The built-in card, for who moves its robot or rides on it.
    #[cfg(feature = "simulation")]
    pub(crate) shared: Option<simulator::virtual_card::SharedCard>,
}

/// A card that runs our design.
pub(crate) struct ReadyCard {
    /// Its name: the slot.
    pub(crate) name: String,
    /// Window through which the FPGA is read and written.
    pub(crate) registers: RegisterWindow<Box<dyn PciCard>>,
    /// Measured clock, Hz.
    pub(crate) clock_hz: f64,
    /// The time in which it lives.
    pub(crate) clock: Box<dyn Clock>,
    /// The camera above its robot, if there is one.
    pub(crate) source: Option<Box<dyn PoseSource>>,
    /// The built-in card, for who moves its robot or rides on it.
    #[cfg(feature = "simulation")]
    pub(crate) shared: Option<simulator::virtual_card::SharedCard>,
}

impl ReadyCard {
    /// Sets the robot of a built-in card down where a real one stands.
    pub(crate) fn stand(&self, pose: runs::frames::Pose) {
        #[cfg(feature = "simulation")]
        if let Some(card) = &self.shared {
            card.stand(pose);
        }
        let _ = pose;
    }
}

impl CardOptions {
    /// Opens the card, loaded or not. The built-in one is new, and not loaded.
    pub(crate) fn open(&self, purpose: Use) -> Result<OpenCard, Failure> {
        self.open_with(purpose, &Robot::racbot(), self.pace())
    }

    /// The card's own time where nobody looks on meanwhile: what comes out does not depend on this machine.
    pub(crate) fn pace(&self) -> Pace {
        #[cfg(feature = "simulation")]
        if self.is_built_in() {
            return Pace::Simulated;
        }
        Pace::Real
    }

    /// The same, where behind a built-in card there is this robot in this time.
    pub(crate) fn open_with(&self, purpose: Use, robot: &Robot, pace: Pace) -> Result<OpenCard, Failure> {
        #[cfg(feature = "simulation")]
        if self.is_built_in() {
            return built_in(robot, pace);
        }
        let _ = (robot, pace);
        let slot = find(Path::new(SYSFS_DEVICES), self.card.as_deref()).map_err(no_card)?;
        let card = SysfsCard::open(&slot, purpose).map_err(Failure::data)?;
        Ok(OpenCard {
            name: slot.name,
            card: Box::new(card),
            #[cfg(feature = "simulation")]
            built_in: false,
            clock: Box::new(MonotonicClock),
            source: None,
            #[cfg(feature = "simulation")]
            shared: None,
        })
    }

    /// Whether the simulated card of this program is asked for.
    #[cfg(feature = "simulation")]
    pub(crate) fn is_built_in(&self) -> bool {
        self.card.as_deref() == Some(VIRTUAL)
    }

    /// Opens a card on which our design runs, and measures its clock. The built-in one is loaded first.
    pub(crate) fn ready(&self, purpose: Use, robot: &Robot, pace: Pace) -> Result<ReadyCard, Failure> {
        let mut open = self.open_with(purpose, robot, pace)?;
        let about = |what: String| Failure::data(format!("{}: {what}", open.name));
        #[cfg(feature = "simulation")]
        if open.built_in {
            driver::load::load(&mut open.card, &simulator::circuit::committed(), &LoadOptions::default(), |_| {})
                .map_err(|error| about(error.to_string()))?;
        }
        let state = inspect(&mut open.card).map_err(|error| about(error.to_string()))?;
        if state.identity.is_none() {
            let why = state.other.unwrap_or_else(|| "its FPGA is not configured".to_owned());
            return Err(about(format!("{why}; run racbot load first")));
        }
        let clock_hz = measure_clock(&mut open.card, LoadOptions::default().clock_time)
            .map_err(|error| about(error.to_string()))?;
        Ok(ReadyCard {
            name: open.name,
            registers: RegisterWindow::new(open.card),
            clock_hz,
            clock: open.clock,
            source: open.source,
            #[cfg(feature = "simulation")]
            shared: open.shared,
        })
    }
}

/// What to say of a card that is not there.
fn no_card(error: FindError) -> Failure {
    #[cfg(feature = "simulation")]
    if matches!(error, FindError::Sysfs { .. } | FindError::None { .. } | FindError::NoSuchSlot { .. }) {
        return Failure::data(format!("{error}; the built-in one is --card {VIRTUAL}"));
    }
    Failure::data(error)
}

/// The built-in card, new and not loaded.
#[cfg(feature = "simulation")]
fn built_in(robot: &Robot, pace: Pace) -> Result<OpenCard, Failure> {
    use model::camera::CameraModel;
    use simulator::virtual_card::{SharedCard, VirtualCard};
    /// Seed of the camera's noise.
    const SEED: u64 = 1;
    let card = VirtualCard::new(robot).map_err(Failure::data)?;
    let card = SharedCard::new(if pace == Pace::Real { card.in_host_time() } else { card });
    let clock: Box<dyn Clock> = if pace == Pace::Real { Box::new(MonotonicClock) } else { Box::new(card.clone()) };
    let source = Box::new(card.camera(CameraModel::of(robot), SEED));
    Ok(OpenCard {
        name: VIRTUAL.to_owned(),
        shared: Some(card.clone()),
        card: Box::new(card),
        built_in: true,
        clock,
        source: Some(source),
    })
}
