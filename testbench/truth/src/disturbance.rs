//! Effects that are in no catalogue: what a workflow must call "none of these".

/// A disturbance of the robot or of its measurement.
#[derive(Clone, Debug, PartialEq)]
pub enum Disturbance {
    /// Dry friction on one wheel that comes and goes with the heading: `torque·(1 + cos(harmonic·θ − phase))/2`.
    HeadingRub {
        /// Index of the wheel, from 0.
        wheel: usize,
        /// Peak torque at the wheel shaft, Nm.
        torque_nm: f64,
        /// Maxima per turn of the robot.
        harmonic: f64,
        /// Heading of a maximum × harmonic, rad.
        phase_rad: f64,
    },
    /// A wheel starts to stick late in every run.
    Sticking {
        /// Index of the wheel, from 0.
        wheel: usize,
        /// Dry friction at the wheel shaft, Nm.
        torque_nm: f64,
        /// Time of the onset, s.
        onset_s: f64,
    },
    /// A cable pulls towards an anchor once it is stretched.
    CablePull {
        /// Anchor, world frame, m.
        anchor_m: [f64; 2],
        /// Slack length, m.
        slack_m: f64,
        /// Stiffness beyond, N/m.
        stiffness_n_m: f64,
    },
    /// A torque at one wheel shaft that oscillates in time.
    PeriodicTorque {
        /// Index of the wheel, from 0.
        wheel: usize,
        /// Amplitude, Nm.
        torque_nm: f64,
        /// Cycles a second, Hz.
        frequency_hz: f64,
        /// At t = 0, rad.
        phase_rad: f64,
    },
    /// Somebody runs into the robot: a short push at drawn times.
    Collisions {
        /// Force while it lasts, N.
        force_n: f64,
        /// Duration of a push, s.
        duration_s: f64,
        /// Pushes per run.
        count: usize,
    },
    /// Dry friction between robot and floor inside a strip of the field (a wet or worn patch), N.
    RoughPatch {
        /// Edge of the half plane, world x, m: the drag acts where x is beyond it.
        edge_m: f64,
        /// Drag against the motion, N.
        force_n: f64,
    },
}

/// A push on the robot during a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Beginning, in time of the run, s.
    pub start_s: f64,
    /// First moment without it, s.
    pub end_s: f64,
    /// Force, world frame, N.
    pub force_n: [f64; 2],
    /// Moment about the vertical axis, counter-clockwise, Nm.
    pub moment_nm: f64,
}

impl Disturbance {
    /// Dry friction added to the shaft of `wheel`, Nm.
    #[must_use]
    pub fn dry_torque(&self, wheel: usize, time_s: f64, heading_rad: f64) -> f64 {
        match *self {
            Self::HeadingRub { wheel: at, torque_nm, harmonic, phase_rad } if at == wheel => {
                0.5 * torque_nm * (1.0 + (harmonic * heading_rad - phase_rad).cos())
            }
            Self::Sticking { wheel: at, torque_nm, onset_s } if at == wheel && time_s >= onset_s => torque_nm,
            _ => 0.0,
        }
    }

    /// Torque on the shaft of `wheel`, Nm.
    #[must_use]
    pub fn shaft_torque(&self, wheel: usize, time_s: f64) -> f64 {
        match *self {
            Self::PeriodicTorque { wheel: at, torque_nm, frequency_hz, phase_rad } if at == wheel => {
                torque_nm * (std::f64::consts::TAU * frequency_hz * time_s + phase_rad).sin()
            }
            _ => 0.0,
        }
    }

    /// Force on the chassis, world frame, N, at position and velocity (m, m/s).
    #[must_use]
    pub fn force(&self, position: [f64; 2], velocity: [f64; 2]) -> [f64; 2] {
        match *self {
            Self::CablePull { anchor_m, slack_m, stiffness_n_m } => {
                let away = [position[0] - anchor_m[0], position[1] - anchor_m[1]];
                let length = away[0].hypot(away[1]);
                let pull = stiffness_n_m * (length - slack_m).max(0.0) / length.max(1e-9);
                [-pull * away[0], -pull * away[1]]
            }
            Self::RoughPatch { edge_m, force_n } if position[0] > edge_m => {
                let speed = velocity[0].hypot(velocity[1]);
                let drag = force_n / speed.max(0.02);
                [-drag * velocity[0], -drag * velocity[1]]
            }
            _ => [0.0; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slack_cable_does_not_pull_and_a_tight_one_pulls_back() {
        let cable = Disturbance::CablePull { anchor_m: [0.0, 0.0], slack_m: 0.5, stiffness_n_m: 4.0 };
        assert_eq!(cable.force([0.3, 0.0], [0.0; 2]), [0.0, 0.0]);
        let [x, y] = cable.force([0.0, 1.0], [0.0; 2]);
        assert!(x.abs() < 1e-12 && (y + 2.0).abs() < 1e-12);
    }

    #[test]
    fn sticking_starts_at_its_onset_on_its_wheel_only() {
        let sticking = Disturbance::Sticking { wheel: 2, torque_nm: 0.02, onset_s: 3.0 };
        assert_eq!(sticking.dry_torque(2, 2.9, 0.0), 0.0);
        assert_eq!(sticking.dry_torque(2, 3.1, 0.0), 0.02);
        assert_eq!(sticking.dry_torque(1, 3.1, 0.0), 0.0);
    }
}
