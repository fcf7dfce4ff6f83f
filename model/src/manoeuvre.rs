//! Drives that show particular effects, for simulations and as advice for real ones.

use crate::frames::Twist;
use crate::geometry::Geometry;
use crate::simulation::VirtualRobot;

/// A drive with a purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manoeuvre {
    /// Turns on the spot, both ways: body radius, marker offset, yaw inertia.
    Spin,
    /// Out and back in six directions: skews, radii, what lies in the world.
    Star,
    /// A square of 0.8 m without turning.
    Square,
    /// Sideways to and fro, faster and faster: delays, inertias.
    Chirp,
    /// Hard starts and stops: grip, play, mass.
    StopAndGo,
    /// Slow reversals of every wheel: dry friction, dead band, play.
    Creep,
    /// Full speed, straight and turning: motor constants, battery.
    FullDuty,
}

impl Manoeuvre {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Spin, Self::Star, Self::Square, Self::Chirp, Self::StopAndGo, Self::Creep, Self::FullDuty];

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
        }
    }

    /// The manoeuvre of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|m| m.name() == name)
    }

    /// Drives it with a robot whose controller believes in `believed`.
    pub fn drive(self, robot: &mut VirtualRobot, believed: &Geometry) {
        match self {
            Self::Spin => {
                for omega in [3.0, -3.0, 6.0, -6.0] {
                    robot.drive(Twist::new(0.0, 0.0, omega), 2.0, believed);
                }
            }
            Self::Star => {
                for k in 0..6 {
                    let angle = f64::from(k) * std::f64::consts::FRAC_PI_3 + 0.2;
                    let out = Twist::new(0.7 * angle.cos(), 0.7 * angle.sin(), 0.0);
                    robot.drive(out, 1.0, believed);
                    robot.drive(Twist { omega: 1.0, ..out.scaled(-1.0) }, 1.0, believed);
                }
            }
            Self::Square => {
                for [x, y] in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]] {
                    robot.drive(Twist::new(0.6 * x, 0.6 * y, 0.0), 1.3, believed);
                }
            }
            Self::Chirp => {
                let start = robot.time();
                loop {
                    let t = robot.time() - start;
                    if t > 12.0 {
                        break;
                    }
                    let phase = std::f64::consts::TAU * (0.3 * t + 0.08 * t * t);
                    robot.look();
                    robot.tick(
                        Twist::new(0.5 * phase.sin(), 0.3 * (0.7 * phase).cos(), 1.5 * (0.6 * phase).sin()),
                        believed,
                    );
                }
            }
            Self::StopAndGo => {
                for k in 0..6 {
                    let angle = 2.399_963 * f64::from(k);
                    let go = Twist::new(1.5 * angle.cos(), 1.5 * angle.sin(), 0.0);
                    for _ in 0..(0.5 / robot.tick_s()) as usize {
                        robot.look();
                        robot.tick(go, believed);
                    }
                    for _ in 0..(0.5 / robot.tick_s()) as usize {
                        robot.look();
                        robot.tick(Twist::default(), believed);
                    }
                }
            }
            Self::Creep => {
                for k in 0..6 {
                    let angle = f64::from(k) * std::f64::consts::FRAC_PI_3 + 0.1;
                    robot.drive(Twist::new(0.06 * angle.cos(), 0.06 * angle.sin(), 0.2), 1.5, believed);
                    robot.drive(Twist::new(-0.06 * angle.cos(), -0.06 * angle.sin(), -0.2), 1.5, believed);
                }
            }
            Self::FullDuty => {
                for twist in [Twist::new(0.0, 3.0, 0.0), Twist::new(0.0, -3.0, 0.0), Twist::new(0.0, 0.0, 25.0)] {
                    robot.drive(twist, 1.6, believed);
                }
            }
        }
    }
}
