//! Counts of speeds or dead reckoning, duties of currents.

use super::{CountSource, DutySource, Source, VIRTUAL_ARM_M, VIRTUAL_COUNTS_PER_RAD};
use crate::Run;
use crate::frames::{Pose, displacement_to, wrap_angle};
use crate::robot::Robot;

/// What is carried from part to part.
pub(super) struct Derive {
    source: Source,
    /// What a winding current counts as, 1/A.
    duty_per_ampere: f64,
    /// Time and value of each wheel's last speed, and its angle since the start, rad.
    speeds: Vec<(Option<(f64, f64)>, f64)>,
    /// Last pose by dead reckoning, and the way since the start in units of the virtual wheels, rad.
    pose: Option<Pose>,
    way: [f64; 3],
    unused: Vec<&'static str>,
    said: bool,
}

impl Derive {
    pub(super) fn new(source: Source, as_logged: &Robot, robot: &Robot, first: &Run) -> Self {
        let wheels = if first.speed.is_empty() { first.measured.len() } else { first.speed.len() };
        let resistance = if as_logged.supply_v == robot.supply_v { robot.motor.resistance_ohm } else { 1.0 };
        let mut unused = Vec::new();
        if source.counts == CountSource::Odometry {
            let logged = [("ref", !first.reference.is_empty()), ("duty", !first.duty.is_empty())];
            unused.extend(logged.iter().filter(|(_, there)| *there).map(|(name, _)| *name));
        }
        Self {
            source,
            duty_per_ampere: resistance / as_logged.supply_v,
            speeds: vec![(None, 0.0); wheels],
            pose: None,
            way: [0.0; 3],
            unused,
            said: false,
        }
    }

    pub(super) fn apply(&mut self, run: &mut Run) {
        match self.source.counts {
            CountSource::Encoders => {}
            CountSource::Speeds => self.integrate(run),
            CountSource::Odometry => self.reckon(run),
        }
        if self.source.duties == DutySource::Currents && self.source.counts != CountSource::Odometry {
            let duty = |current: &Vec<f64>| current.iter().map(|i| i * self.duty_per_ampere).collect();
            run.duty = run.current.iter().map(duty).collect();
            // What drives is the current, whatever the supply does.
            run.supply_v = None;
        }
    }

    fn integrate(&mut self, run: &mut Run) {
        let speeds = if run.speed.is_empty() { &run.measured } else { &run.speed };
        run.counts = vec![Vec::with_capacity(run.t.len()); speeds.len()];
        run.count_gaps = vec![Vec::new(); speeds.len()];
        for (wheel, (speeds, (last, angle))) in speeds.iter().zip(&mut self.speeds).enumerate() {
            for (tick, (t, speed)) in run.t.iter().zip(speeds).enumerate() {
                if speed.is_finite() {
                    if let Some((before, old)) = last.replace((*t, *speed)) {
                        *angle += 0.5 * (old + speed) * (t - before);
                    }
                } else {
                    run.count_gaps[wheel].push(tick);
                }
                run.counts[wheel].push(count(*angle));
            }
        }
    }

    fn reckon(&mut self, run: &mut Run) {
        let Some([x, y, theta]) = &run.odometry else { return };
        run.counts = vec![Vec::new(); 3];
        run.count_gaps = vec![Vec::new(); 3];
        for tick in 0..run.t.len() {
            let pose = Pose::new(x[tick], y[tick], theta[tick]);
            if [pose.x, pose.y, pose.theta].iter().all(|v| v.is_finite()) {
                if let Some(before) = self.pose.replace(pose) {
                    let mut relative = before.relative(pose);
                    relative.theta = wrap_angle(relative.theta);
                    let d = displacement_to(relative);
                    let turned = [d.vx, d.vy, d.vx + VIRTUAL_ARM_M * d.omega];
                    self.way.iter_mut().zip(turned).for_each(|(way, d)| *way += d);
                }
            } else {
                run.count_gaps.iter_mut().for_each(|gaps| gaps.push(tick));
            }
            for (counts, way) in run.counts.iter_mut().zip(self.way) {
                counts.push(count(way));
            }
        }
        // They belong to wheels that nobody described.
        run.reference.clear();
        run.duty.clear();
        run.measured.clear();
    }

    pub(super) fn note(&mut self) -> Vec<String> {
        let mut notes = Vec::new();
        if std::mem::replace(&mut self.said, true) {
            return notes;
        }
        match self.source.counts {
            CountSource::Encoders => {}
            CountSource::Speeds => notes.push("wheel speeds are integrated in place of encoder counts".to_owned()),
            CountSource::Odometry => {
                let mut note =
                    "the robot's own odometry stands in place of its wheels: what differs from the camera is \
                                told of the whole robot"
                        .to_owned();
                if !self.unused.is_empty() {
                    note += &format!(" ({} not used)", self.unused.join(", "));
                }
                notes.push(note);
            }
        }
        if self.source.duties == DutySource::Currents {
            notes.push("currents drive the motors: resistance, supply and back-EMF do not matter".to_owned());
        }
        notes
    }
}

fn count(angle: f64) -> i64 {
    (angle * VIRTUAL_COUNTS_PER_RAD).round() as i64
}
