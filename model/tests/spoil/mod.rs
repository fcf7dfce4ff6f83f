//! Mistakes that people make when they set a data set up, each made on purpose.

use std::f64::consts::{FRAC_PI_2, TAU};

use model::setup::{Mistake, mistakes};
use runs::frames::wrap_angle;
use runs::robot::{Layout, Robot};
use runs::{DataSet, Logs, Run};

/// One mistake: name, kinds that are right answers, what it needs of the set, and how it is made.
pub(crate) struct Spoil {
    /// What was done.
    pub(crate) name: &'static str,
    /// Kinds of [`Mistake`] that name it.
    pub(crate) kinds: &'static [&'static str],
    /// Whether a set can show it.
    pub(crate) shows: fn(&DataSet) -> bool,
    make: fn(&mut Robot, &mut [Run]),
}

fn camera(set: &DataSet) -> bool {
    set.runs.iter().any(|run| run.camera.len() > 30)
}

fn references(set: &DataSet) -> bool {
    set.runs.iter().all(|run| !run.reference.is_empty())
}

fn commands(set: &DataSet) -> bool {
    set.runs.iter().all(|run| run.command.is_some())
}

fn duties(set: &DataSet) -> bool {
    set.runs.iter().all(|run| !run.duty.is_empty()) && references(set)
}

/// Whether the motors are described.
fn motors(set: &DataSet) -> bool {
    runs::drive_lacks(&set.robot).is_empty() && !set.runs.iter().all(|run| run.counts.is_empty())
}

/// Whether a thousand times the mass is too much for the motors at a fiftieth of what a floor passes on.
fn weak(set: &DataSet) -> bool {
    let motor = &set.robot.motor;
    let stall = motor.torque_constant * set.robot.supply_v / motor.resistance_ohm;
    let force = set.robot.wheel_count() as f64 * set.robot.gear_ratio * stall / set.robot.wheel_radius_m;
    1e3 * set.robot.mass_kg * 0.02 * 9.81 > 3.0 * force
}

fn every_pose(runs: &mut [Run], change: impl Fn(&mut runs::frames::Pose)) {
    runs.iter_mut().flat_map(|run| &mut run.camera).for_each(|sample| change(&mut sample.pose));
}

/// The mistakes of the list, some in two forms.
pub(crate) const SPOILS: &[Spoil] = &[
    Spoil {
        name: "time in milliseconds",
        kinds: &["time-unit"],
        shows: |_| true,
        make: |_, runs| runs.iter_mut().flat_map(|run| &mut run.t).for_each(|t| *t *= 1e3),
    },
    Spoil {
        name: "time in microseconds",
        kinds: &["time-unit"],
        shows: |_| true,
        make: |_, runs| runs.iter_mut().flat_map(|run| &mut run.t).for_each(|t| *t *= 1e6),
    },
    Spoil {
        name: "control_rate_hz a quarter",
        kinds: &["control-rate"],
        shows: |_| true,
        make: |robot, _| robot.control_rate_hz *= 0.25,
    },
    Spoil {
        name: "headings in degrees",
        kinds: &["heading-degrees"],
        shows: camera,
        make: |_, runs| every_pose(runs, |p| p.theta = p.theta.to_degrees()),
    },
    Spoil {
        name: "headings clockwise",
        kinds: &["heading-clockwise"],
        shows: camera,
        make: |_, runs| every_pose(runs, |p| p.theta = -p.theta),
    },
    Spoil {
        name: "headings of the forward axis",
        kinds: &["heading-axis"],
        shows: camera,
        make: |_, runs| every_pose(runs, |p| p.theta = wrap_angle(p.theta + FRAC_PI_2)),
    },
    Spoil {
        name: "camera in millimetres",
        kinds: &["camera-unit"],
        shows: camera,
        make: |_, runs| {
            every_pose(runs, |p| {
                p.x *= 1e3;
                p.y *= 1e3;
            });
        },
    },
    Spoil {
        name: "metres taken for centimetres",
        kinds: &["camera-unit"],
        shows: camera,
        make: |_, runs| {
            every_pose(runs, |p| {
                p.x *= 1e-2;
                p.y *= 1e-2;
            });
        },
    },
    Spoil {
        name: "image y down",
        kinds: &["camera-y-down"],
        shows: camera,
        make: |_, runs| every_pose(runs, |p| p.y = -p.y),
    },
    Spoil {
        name: "commands x forward",
        kinds: &["command-frame"],
        shows: commands,
        make: |_, runs| {
            for [vx, vy, _] in runs.iter_mut().filter_map(|run| run.command.as_mut()) {
                for (x, y) in vx.iter_mut().zip(vy) {
                    (*x, *y) = (*y, -*x);
                }
            }
        },
    },
    Spoil {
        name: "diameter for radius",
        kinds: &["wheel-diameter"],
        shows: camera,
        make: |robot, _| robot.wheel_radius_m *= 2.0,
    },
    Spoil {
        name: "gear ratio upside down",
        kinds: &["gear-ratio"],
        shows: |set| (camera(set) || references(set)) && set.robot.gear_ratio > 1.5,
        make: |robot, _| robot.gear_ratio = 1.0 / robot.gear_ratio,
    },
    Spoil {
        name: "counts without x4",
        kinds: &["encoder-counts", "gear-ratio"],
        shows: |set| camera(set) || references(set),
        make: |robot, _| robot.encoder_counts_per_motor_rev /= 4.0,
    },
    Spoil {
        name: "encoder 1 reversed",
        kinds: &["encoder-order"],
        shows: camera,
        make: |_, runs| runs.iter_mut().flat_map(|run| &mut run.counts[0]).for_each(|c| *c = -*c),
    },
    Spoil {
        name: "encoder 1 of two at half its counts",
        kinds: &["wheel-counts"],
        shows: |set| camera(set) && set.robot.wheel_count() == 2,
        make: |_, runs| runs.iter_mut().flat_map(|run| &mut run.counts[0]).for_each(|c| *c /= 2),
    },
    Spoil {
        name: "encoder 2 at four times its counts",
        kinds: &["wheel-counts"],
        shows: camera,
        make: |_, runs| runs.iter_mut().flat_map(|run| &mut run.counts[1]).for_each(|c| *c *= 4),
    },
    Spoil {
        name: "encoders 1 and 2 swapped",
        kinds: &["encoder-order"],
        shows: camera,
        make: |_, runs| runs.iter_mut().for_each(|run| run.counts.swap(0, 1)),
    },
    Spoil {
        name: "set points in rpm",
        kinds: &["reference-unit"],
        shows: references,
        make: |_, runs| runs.iter_mut().flat_map(|run| &mut run.reference).flatten().for_each(|r| *r *= 60.0 / TAU),
    },
    Spoil {
        name: "robot.toml of another robot",
        kinds: &["robot-file"],
        shows: camera,
        make: |robot, _| {
            // The same number of wheels, bigger, other encoders, on a plate three times as wide.
            robot.wheel_radius_m *= 1.9;
            robot.encoder_counts_per_motor_rev *= 0.6;
            let mut wheels = robot.layout.wheels();
            for wheel in &mut wheels {
                (wheel.x_m, wheel.y_m) = (3.0 * wheel.x_m, 3.0 * wheel.y_m);
            }
            robot.layout = Layout::Wheels(wheels);
        },
    },
    Spoil {
        name: "wheels of another size",
        kinds: &["robot-file"],
        shows: camera,
        make: |robot, _| robot.wheel_radius_m *= 0.55,
    },
    Spoil {
        name: "duties without their sign",
        kinds: &["drive-unsigned"],
        shows: duties,
        make: |_, runs| runs.iter_mut().flat_map(|run| &mut run.duty).flatten().for_each(|d| *d = d.abs()),
    },
    Spoil {
        name: "duties taken for percent",
        kinds: &["supply", "duty-unit"],
        shows: duties,
        make: |_, runs| runs.iter_mut().flat_map(|run| &mut run.duty).flatten().for_each(|d| *d *= 0.01),
    },
    Spoil {
        name: "supply of another battery",
        kinds: &["supply"],
        shows: duties,
        make: |robot, _| robot.supply_v *= 3.3,
    },
    Spoil {
        name: "rotor inertia in g cm²",
        kinds: &["motor-unit"],
        shows: motors,
        make: |robot, _| robot.motor.rotor_inertia *= 1e7,
    },
    Spoil {
        name: "mass in grams",
        kinds: &["motor-unit"],
        shows: |set| motors(set) && weak(set),
        make: |robot, _| robot.mass_kg *= 1e3,
    },
    Spoil {
        name: "yaw inertia in kg cm²",
        kinds: &["motor-unit"],
        shows: motors,
        make: |robot, _| robot.yaw_inertia_kg_m2 *= 1e4,
    },
    Spoil {
        name: "resistance in milliohm",
        kinds: &["motor-unit"],
        shows: motors,
        make: |robot, _| robot.motor.resistance_ohm *= 1e3,
    },
    Spoil {
        name: "torque constant in mNm/A",
        kinds: &["motor-unit", "supply"],
        shows: motors,
        make: |robot, _| robot.motor.torque_constant *= 1e3,
    },
    Spoil {
        name: "friction in mNm",
        kinds: &["motor-unit"],
        shows: |set| motors(set) && set.robot.motor.friction_torque > 0.0,
        make: |robot, _| robot.motor.friction_torque *= 1e3,
    },
];

/// Mistakes found in a set as it is.
pub(crate) fn found(robot: Robot, runs: &[Run]) -> Vec<Mistake> {
    let set = DataSet { folder: "set".into(), robot, runs: runs.to_vec() };
    mistakes(&Logs::from(&set))
}

impl Spoil {
    /// Mistakes found once this one is made.
    pub(crate) fn found(&self, set: &DataSet) -> Vec<Mistake> {
        let (mut robot, mut runs) = (set.robot.clone(), set.runs.clone());
        (self.make)(&mut robot, &mut runs);
        found(robot, &runs)
    }
}
