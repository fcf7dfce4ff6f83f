//! Who sees where the robot is.

use model::measurement::Measurement;
use model::odometry::Estimate;

/// A source of poses in the field frame: a camera above the robot, or on it.
pub trait PoseSource {
    /// What arrived since the last call, for the tick at `t` seconds of the drive. Must neither wait nor allocate.
    fn arrived(&mut self, t: f64) -> Option<Measurement>;

    /// Hears what the controller believes of the pose at `t` seconds of the drive, which a source on the robot needs as
    /// its prediction. Must neither wait nor allocate.
    fn believed(&mut self, t: f64, belief: &Estimate) {
        let _ = (t, belief);
    }

    /// Whether what it sees contradicts what it last heard of the controller's belief. Must neither wait nor allocate.
    fn contradicts(&self) -> bool {
        false
    }
}

impl<S: PoseSource + ?Sized> PoseSource for Box<S> {
    fn arrived(&mut self, t: f64) -> Option<Measurement> {
        (**self).arrived(t)
    }
    fn believed(&mut self, t: f64, belief: &Estimate) {
        (**self).believed(t, belief);
    }
    fn contradicts(&self) -> bool {
        (**self).contradicts()
    }
}

/// A source without measurements: the robot drives by its wheels alone.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoSource;

impl PoseSource for NoSource {
    fn arrived(&mut self, _: f64) -> Option<Measurement> {
        None
    }
}
