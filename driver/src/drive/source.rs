//! Who sees the robot from outside.

use runs::frames::Pose;

/// A source of poses in the field frame, such as an overhead camera.
pub trait PoseSource {
    /// The pose that arrived since the last call, for the tick at `t` seconds of the drive. Must neither wait
    /// nor allocate.
    fn arrived(&mut self, t: f64) -> Option<Pose>;

    /// Hears what the controller believes of the pose at `t` seconds of the drive, which a source on the robot needs as
    /// its prediction. Must neither wait nor allocate.
    fn believed(&mut self, t: f64, pose: Pose) {
        let _ = (t, pose);
    }
}

impl<S: PoseSource + ?Sized> PoseSource for Box<S> {
    fn arrived(&mut self, t: f64) -> Option<Pose> {
        (**self).arrived(t)
    }
    fn believed(&mut self, t: f64, pose: Pose) {
        (**self).believed(t, pose);
    }
}

/// Nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoSource;

impl PoseSource for NoSource {
    fn arrived(&mut self, _: f64) -> Option<Pose> {
        None
    }
}
