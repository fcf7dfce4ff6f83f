//! What the simulator remembers of a run between ticks.

/// Poses and shaft angles at equal intervals.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    interval: f64,
    poses: Vec<[f64; 3]>,
    angles: Vec<Vec<f64>>,
}

impl Track {
    /// An empty track with a sample every `interval` seconds, from time 0.
    pub(crate) fn new(interval: f64) -> Self {
        Self { interval, poses: Vec::new(), angles: Vec::new() }
    }

    /// Appends a sample: pose and every shaft's angle.
    pub(crate) fn push(&mut self, pose: [f64; 3], angles: &[f64]) {
        self.poses.push(pose);
        self.angles.push(angles.to_vec());
    }

    /// Index before `time` and the part of an interval after it; times outside the track are those of its ends.
    fn place(&self, time: f64) -> Option<(usize, f64)> {
        let last = self.poses.len().checked_sub(1)?;
        let place = (time / self.interval).clamp(0.0, last as f64);
        let index = (place as usize).min(last.saturating_sub(1));
        Some((index, place - index as f64))
    }

    /// Pose at `time`, interpolated; the heading is not wrapped.
    pub(crate) fn pose(&self, time: f64) -> [f64; 3] {
        let Some((index, part)) = self.place(time) else { return [0.0; 3] };
        let (from, to) = (self.poses[index], self.poses[(index + 1).min(self.poses.len() - 1)]);
        [0, 1, 2].map(|k| from[k] + part * (to[k] - from[k]))
    }

    /// Angle of shaft `i` at `time`, interpolated, rad.
    pub(crate) fn angle(&self, i: usize, time: f64) -> f64 {
        let Some((index, part)) = self.place(time) else { return 0.0 };
        let (from, to) = (self.angles[index][i], self.angles[(index + 1).min(self.angles.len() - 1)][i]);
        from + part * (to - from)
    }

    /// Speed of the chassis centre at `time`, m/s, over two milliseconds.
    pub(crate) fn speed(&self, time: f64) -> f64 {
        let (from, to) = (self.pose(time - 0.001), self.pose(time + 0.001));
        (to[0] - from[0]).hypot(to[1] - from[1]) / 0.002
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_interpolated_and_ends_are_held() {
        let mut track = Track::new(0.5);
        assert_eq!(track.pose(1.0), [0.0; 3]);
        track.push([0.0, 1.0, 0.0], &[0.0]);
        track.push([1.0, 1.0, 4.0], &[2.0]);
        assert_eq!(track.pose(0.25), [0.5, 1.0, 2.0]);
        assert_eq!(track.angle(0, 0.125), 0.5);
        assert_eq!(track.pose(-1.0), [0.0, 1.0, 0.0]);
        assert_eq!(track.pose(9.0), [1.0, 1.0, 4.0]);
    }
}
