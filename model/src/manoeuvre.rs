//! Drives that show particular effects, for simulations and as advice for real ones.

use std::f64::consts::{FRAC_PI_3, TAU};

use crate::effects::Applied;
use crate::simulation::VirtualRobot;
use runs::Run;
use runs::frames::{Pose, Twist};
use runs::geometry::{Geometry, GeometryError};
use runs::robot::{Robot, Support};

/// A drive with a purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manoeuvre {
    /// Turns on the spot, both ways: body radius, marker offset, yaw inertia.
    Spin,
    /// Out and back in six directions: skews, radii, what lies in the world.
    Star,
    /// A square of 0.8 m without turning.
    Square,
    /// To and fro and around, faster and faster: delays, inertias.
    Chirp,
    /// Hard starts and stops: grip, play, mass.
    StopAndGo,
    /// Slow reversals of every wheel: dry friction, dead band, play.
    Creep,
    /// Full duty, straight and turning: motor constants, battery.
    FullDuty,
    /// Wheels off the floor, one axis after the other: motor, gear and friction without the body.
    Blocks,
}

/// Speed of the paper's robot without load, m/s at the rim of a wheel: slower robots drive slower.
const NO_LOAD: f64 = 7.7;
/// Acceleration of a ramp, m/s², and its shortest time, s.
const RAMP: [f64; 2] = [0.8, 0.2];
/// Rest after a drive, s.
const REST_S: f64 = 0.15;
/// The angle that spreads any number of directions evenly, rad.
const GOLDEN: f64 = 2.399_963;

impl Manoeuvre {
    /// In the order in which the command line lists them.
    pub const ALL: [Self; 8] =
        [Self::Spin, Self::Star, Self::Square, Self::Chirp, Self::StopAndGo, Self::Creep, Self::FullDuty, Self::Blocks];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spin => "spin",
            Self::Star => "star",
            Self::Square => "square",
            Self::Chirp => "chirp",
            Self::StopAndGo => "stop-and-go",
            Self::Creep => "creep",
            Self::FullDuty => "full-duty",
            Self::Blocks => "blocks",
        }
    }

    /// What is driven, in a few words.
    pub fn purpose(self) -> &'static str {
        match self {
            Self::Spin => "turns on the spot, both ways",
            Self::Star => "out and back in six directions, turning on the way back",
            Self::Square => "a square without turning",
            Self::Chirp => "to and fro and around, faster and faster",
            Self::StopAndGo => "hard starts and stops",
            Self::Creep => "slow reversals of every wheel",
            Self::FullDuty => "full duty, straight and turning",
            Self::Blocks => "wheels off the floor, one axis after the other",
        }
    }

    /// By its name on the command line; `None` where none has it.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|m| m.name() == name)
    }

    /// What carries the robot meanwhile.
    pub fn support(self) -> Support {
        if self == Self::Blocks { Support::Blocks } else { Support::Floor }
    }

    /// Body twists to command, one a control tick, for a robot whose controller believes in `robot`.
    ///
    /// # Errors
    /// [`GeometryError`] if its wheels cannot drive it.
    pub fn commands(self, robot: &Robot) -> Result<Vec<Twist>, GeometryError> {
        let geometry = robot.geometry()?;
        let fastest = robot.no_load_wheel_speed(robot.supply_v) * robot.wheel_radius_m;
        let pace = (fastest / NO_LOAD).min(1.0);
        let rim = robot.layout.wheels().iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.02, f64::max);
        let mut script = Script { tick: robot.tick_s(), pace, turning: pace * 0.085 / rim, twists: Vec::new() };
        self.write(&mut script, &geometry, robot);
        Ok(script.twists)
    }

    fn write(self, script: &mut Script, geometry: &Geometry, robot: &Robot) {
        match self {
            Self::Spin => {
                for omega in [3.0, -3.0, 6.0, -6.0] {
                    script.ramped(Twist::new(0.0, 0.0, omega), 2.0);
                }
            }
            Self::Star => {
                for k in 0..6 {
                    let angle = f64::from(k) * FRAC_PI_3 + 0.2;
                    let out = Twist::new(0.7 * angle.cos(), 0.7 * angle.sin(), 0.0);
                    script.ramped(out, 1.0);
                    script.ramped(Twist { omega: 1.0, ..out.scaled(-1.0) }, 1.0);
                }
            }
            Self::Square => {
                for [x, y] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
                    script.ramped(Twist::new(0.6 * x, 0.6 * y, 0.0), 1.3);
                }
            }
            Self::Chirp => script.along(12.0, |t| {
                let phase = TAU * (0.3 * t + 0.08 * t * t);
                Twist::new(0.5 * phase.sin(), 0.3 * (0.7 * phase).cos(), 1.5 * (0.6 * phase).sin())
            }),
            Self::StopAndGo => {
                for k in 0..6 {
                    let angle = GOLDEN * f64::from(k);
                    script.held(Twist::new(1.5 * angle.cos(), 1.5 * angle.sin(), 0.0), 0.5);
                    script.held(Twist::default(), 0.5);
                }
            }
            Self::Creep => {
                for k in 0..6 {
                    let angle = f64::from(k) * FRAC_PI_3 + 0.1;
                    let slow = Twist::new(0.06 * angle.cos(), 0.06 * angle.sin(), 0.2);
                    script.ramped(slow, 1.5);
                    script.ramped(slow.scaled(-1.0), 1.5);
                }
            }
            Self::FullDuty => {
                // More than the motors can: they are at full duty until the sign changes.
                for [x, y] in [[0.0, 3.0], [3.0, 0.0]] {
                    for seconds in [0.5_f64, -0.8, 0.8, -0.8, 0.5] {
                        script.held(Twist::new(x, y, 0.0).scaled(seconds.signum()), seconds.abs());
                    }
                    script.held(Twist::default(), 0.4);
                }
                for omega in [35.0, -35.0] {
                    script.held(Twist::new(0.0, 0.0, omega), 0.8);
                    script.held(Twist::default(), 0.4);
                }
            }
            Self::Blocks => {
                let fastest = robot.no_load_wheel_speed(robot.supply_v);
                for wheel in 0..geometry.wheel_count() {
                    for share in [0.03, -0.03, 0.15, -0.15, 0.5, -0.5, 0.9, -0.9] {
                        let mut speeds = vec![0.0; geometry.wheel_count()];
                        speeds[wheel] = share * fastest;
                        script.exactly(geometry.twist(&speeds), 0.35);
                    }
                    script.exactly(Twist::default(), 0.2);
                }
            }
        }
    }
}

/// Simulates a manoeuvre with a robot that is what `applied` says, and whose controller believes in
/// the nominal `believed`. Nothing but the seed is random.
///
/// # Errors
/// [`GeometryError`] if the wheels of either cannot drive it.
pub fn simulate(
    manoeuvre: Manoeuvre,
    applied: &Applied,
    believed: &Robot,
    start: Pose,
    seed: u64,
) -> Result<Run, GeometryError> {
    let mut applied = applied.clone();
    applied.robot.support = manoeuvre.support();
    let geometry = believed.geometry()?;
    let commands = manoeuvre.commands(believed)?;
    let mut robot = VirtualRobot::of(&applied, start, seed)?;
    for command in commands {
        robot.look();
        robot.tick(command, &geometry);
    }
    let mut run = robot.into_log();
    applied.finish(&mut run, seed);
    Ok(run)
}

/// Twists to command, tick by tick.
struct Script {
    tick: f64,
    /// Share of the paper's robot's speeds, forward and turning.
    pace: f64,
    turning: f64,
    twists: Vec<Twist>,
}

impl Script {
    fn paced(&self, t: Twist) -> Twist {
        Twist::new(self.pace * t.vx, self.pace * t.vy, self.turning * t.omega)
    }

    /// Commands for `seconds` by the time since their start.
    fn along(&mut self, seconds: f64, at: impl Fn(f64) -> Twist) {
        let ticks = (seconds / self.tick).ceil().max(1.0) as usize;
        let part: Vec<Twist> = (0..ticks).map(|k| self.paced(at(k as f64 * self.tick))).collect();
        self.twists.extend(part);
    }

    /// `twist` at once.
    fn held(&mut self, twist: Twist, seconds: f64) {
        self.along(seconds, |_| twist);
    }

    /// `twist` at once, whatever the pace.
    fn exactly(&mut self, twist: Twist, seconds: f64) {
        let ticks = (seconds / self.tick).ceil().max(1.0) as usize;
        self.twists.extend(std::iter::repeat_n(twist, ticks));
    }

    /// `twist` reached and left with limited acceleration: covers `twist` × `seconds`, ends at rest.
    fn ramped(&mut self, twist: Twist, seconds: f64) {
        let ramp = (twist.speed() / RAMP[0]).max(RAMP[1]);
        self.along(seconds + ramp, |t| twist.scaled((t / ramp).min((seconds + ramp - t) / ramp).clamp(0.0, 1.0)));
        self.held(Twist::default(), REST_S);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_manoeuvre_is_driven_and_stays_on_the_field() {
        for m in Manoeuvre::ALL {
            assert_eq!(Manoeuvre::from_name(m.name()), Some(m));
            let robot = Robot { support: m.support(), ..Robot::racbot() };
            let run = simulate(m, &Applied::of(&robot), &robot, Pose::new(0.0, 0.0, 0.3), 1).unwrap();
            assert_eq!(run.check(&robot, std::path::Path::new(m.name())), Ok(()));
            assert!(run.duration_s() > 4.0 && run.duration_s() < 30.0, "{}: {} s", m.name(), run.duration_s());
            let farthest = run.camera.iter().map(|c| c.pose.x.hypot(c.pose.y)).fold(0.0, f64::max);
            assert!(farthest < 2.5, "{}: {farthest} m from the start", m.name());
            let moved = (0..3).map(|i| run.counts[i].iter().map(|c| c.abs()).max().unwrap()).min().unwrap();
            assert!(moved > 300, "{}: a wheel moved {moved} counts only", m.name());
        }
    }

    #[test]
    fn on_blocks_every_axis_turns_alone() {
        let robot = Robot { support: Support::Blocks, ..Robot::racbot() };
        let geometry = robot.geometry().unwrap();
        for twist in Manoeuvre::Blocks.commands(&robot).unwrap() {
            let turning = geometry.wheel_speeds(twist).iter().filter(|w| w.abs() > 1e-6).count();
            assert!(turning <= 1);
        }
    }

    #[test]
    fn full_duty_is_full_duty() {
        let robot = Robot::racbot();
        let run = simulate(Manoeuvre::FullDuty, &Applied::of(&robot), &robot, Pose::default(), 1).unwrap();
        let full = run.duty.iter().flatten().filter(|d| d.abs() > 0.999).count();
        assert!(full as f64 > 0.3 * (3 * run.len()) as f64, "{full} of {}", 3 * run.len());
    }
}
