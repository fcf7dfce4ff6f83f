//! Who sees the robot from outside.

use runs::frames::Pose;

/// A source of poses in the field frame, such as an overhead camera.
pub trait PoseSource {
    /// The pose that arrived since the last call, for the tick at `t` seconds of the drive. Must neither wait
    /// nor allocate.
    fn arrived(&mut self, t: f64) -> Option<Pose>;
}

impl<S: PoseSource + ?Sized> PoseSource for Box<S> {
    fn arrived(&mut self, t: f64) -> Option<Pose> {
        (**self).arrived(t)
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
