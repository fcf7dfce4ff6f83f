//! Wheels that slip now and then: where they hold, camera and counts agree, and the file is right.

use runs::frames::Twist;
use runs::geometry::Geometry;

use super::samples::Sample;

/// Difference of a stretch's motion by the counts and by the camera, in the larger of both, up to which they agree.
const AGREES: f64 = 0.2;
/// Share of the stretches that must agree: the file of another robot agrees where it drives straight at most, and of the
/// wheels and the camera of different drives a few agree by chance.
const HOLDS: f64 = 0.25;
/// Share of what wheels turn beside what the camera saw, in all other stretches, that one of them alone makes where it is
/// the one that slips: of three that slip alike each has a third.
const ALONE: f64 = 0.6;

/// Where wheels hold, and which of them does not elsewhere.
pub(super) struct Slips {
    /// Share of the stretches in which they hold.
    holds: f64,
    /// The wheel that slips, from 0, if it is one.
    wheel: Option<usize>,
}

impl Slips {
    /// Of stretches, each with its motion by the camera; `None` where hardly any agrees.
    pub(super) fn of(geometry: &Geometry, rim: f64, samples: &[Sample], seen: &[([f64; 2], f64)]) -> Option<Self> {
        let size = |t: &Twist| t.vx.hypot(t.vy).hypot(rim * t.omega);
        let mut held = 0_usize;
        let mut beside = vec![0.0; geometry.wheels().len()];
        for (sample, ([x, y], turn)) in samples.iter().zip(seen) {
            let (counted, seen) = (geometry.twist(&sample.turned), Twist::new(*x, *y, *turn));
            let off = Twist::new(counted.vx - seen.vx, counted.vy - seen.vy, counted.omega - seen.omega);
            if size(&off) < AGREES * size(&counted).max(size(&seen)) {
                held += 1;
                continue;
            }
            for ((beside, turned), needed) in beside.iter_mut().zip(&sample.turned).zip(geometry.wheel_speeds(seen)) {
                *beside += (turned - needed).abs();
            }
        }
        let holds = held as f64 / samples.len().max(1) as f64;
        let all: f64 = beside.iter().sum();
        let wheel = (0..beside.len()).find(|i| beside[*i] > ALONE * all);
        (holds >= HOLDS).then_some(Self { holds, wheel })
    }

    /// What is wrong, and what to do about it.
    pub(super) fn said(&self, left: f64) -> (String, String) {
        let which = self.wheel.map_or_else(|| "wheels slip".to_owned(), |i| format!("wheel {} slips", i + 1));
        let turns = match self.wheel {
            Some(_) => "its encoder loses or gains counts",
            None => "encoders lose or gain counts",
        };
        let what = format!(
            "{:.0} % of what the camera saw does not follow from the counts, but in {:.0} % of the time they agree as they \
             are read, so that the file fits the robot: {which} in the rest of it, or {turns}, or the camera lost the robot",
            100.0 * left,
            100.0 * self.holds
        );
        let remedy = "look at tyre, grub screw and cable, drive with less acceleration on a floor that holds, and leave out \
                      what was driven so; `racbot gap` says where most is off";
        (what, remedy.to_owned())
    }
}
