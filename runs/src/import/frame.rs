//! The frame of a file, and the way from it into ours.

use std::f64::consts::FRAC_PI_2;

use serde::Deserialize;

use crate::Run;
use crate::frames::wrap_angle;

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Frame {
    #[serde(default)]
    pub(super) x: Axis,
    #[serde(default)]
    pub(super) y: Up,
    #[serde(default)]
    pub(super) headings: Sense,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Axis {
    #[default]
    Right,
    Forward,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Up {
    #[default]
    Up,
    Down,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Sense {
    #[default]
    CounterClockwise,
    Clockwise,
}

impl Frame {
    /// Into our frame: x to the right, y forward, headings of x, counter-clockwise.
    pub(super) fn turn(&self, run: &mut Run, camera: &mut [[f64; 3]]) {
        let f = self;
        let sign = if f.headings == Sense::Clockwise { -1.0 } else { 1.0 };
        let quarter = if f.x == Axis::Forward { FRAC_PI_2 } else { 0.0 };
        let heading = |theta: f64| wrap_angle(sign * theta - quarter);
        for pose in camera {
            pose[1] *= if f.y == Up::Down { -1.0 } else { 1.0 };
            pose[2] = heading(pose[2]);
        }
        if let Some([_, _, theta]) = &mut run.odometry {
            theta.iter_mut().for_each(|t| *t = heading(*t));
        }
        for rates in
            [run.command.as_mut().map(|c| &mut c[2]), run.gyro.as_mut().map(|g| &mut g[2])].into_iter().flatten()
        {
            rates.iter_mut().for_each(|w| *w *= sign);
        }
        if f.x == Axis::Forward {
            for [x, y, _] in [&mut run.command, &mut run.gyro, &mut run.acceleration].into_iter().flatten() {
                for (x, y) in x.iter_mut().zip(y) {
                    (*x, *y) = (-*y, *x);
                }
            }
        }
    }
}
