//! What the host writes down: a run in the log format, and the `robot.toml` beside it.

use driver::{Scale, Snapshot};
use fixed_kin::format::Format;
use fixed_kin::speed::SpeedMode;
use model::frames::{Pose, Twist, wrap_angle};
use model::robot::Robot;
use model::run::{CameraSample, Run};

/// Decimals of a logged number: finer than any LSB of the card, so that words survive the log.
const DECIMALS: f64 = 1e9;
/// Decimals of a camera pose: the noise is a thousand times larger.
const CAMERA_DECIMALS: f64 = 1e6;

fn rounded(value: f64, decimals: f64) -> f64 {
    (value * decimals).round() / decimals
}

/// A run that grows by a row a tick.
#[derive(Debug)]
pub(super) struct Recording {
    run: Run,
    wheels: usize,
}

impl Recording {
    pub(super) fn new(wheels: usize, camera: bool) -> Self {
        let run = Run {
            name: "run".to_owned(),
            command: Some(Default::default()),
            reference: vec![Vec::new(); wheels],
            counts: vec![Vec::new(); wheels],
            count_gaps: vec![Vec::new(); wheels],
            duty: vec![Vec::new(); wheels],
            supply_v: Some(Vec::new()),
            has_camera: camera,
            ..Run::default()
        };
        Self { run, wheels }
    }

    pub(super) fn row(&mut self, t: f64, command: Twist, seen: &Snapshot, scale: &Scale, supply_v: f64) {
        let run = &mut self.run;
        run.t.push(rounded(t, DECIMALS));
        // What the card got, to the last bit.
        let command = scale.twist(scale.twist_words(command));
        if let Some([vx, vy, w]) = &mut run.command {
            vx.push(rounded(command.vx, DECIMALS));
            vy.push(rounded(command.vy, DECIMALS));
            w.push(rounded(command.omega, DECIMALS));
        }
        for wheel in 0..self.wheels {
            run.reference[wheel].push(rounded(scale.speed(seen.references[wheel]), DECIMALS));
            run.counts[wheel].push(i64::from(seen.counts[wheel]));
            run.duty[wheel].push(rounded(f64::from(seen.duties[wheel]), DECIMALS));
        }
        if let Some(supply) = &mut run.supply_v {
            supply.push(supply_v);
        }
    }

    /// A camera pose at the coming row.
    pub(super) fn camera(&mut self, pose: Pose) {
        let pose = Pose::new(
            rounded(pose.x, CAMERA_DECIMALS),
            rounded(pose.y, CAMERA_DECIMALS),
            rounded(wrap_angle(pose.theta), CAMERA_DECIMALS),
        );
        self.run.camera.push(CameraSample { tick: self.run.t.len(), pose });
    }

    pub(super) fn finish(mut self) -> Run {
        let ticks = self.run.t.len();
        self.run.camera.retain(|sample| sample.tick < ticks);
        self.run
    }
}

/// The robot as the log's `robot.toml` describes it: what the controller believes, and the words in
/// which its speed loops computed.
pub(super) fn logged_robot(believed: &Robot, scale: &Scale, speed_mode: SpeedMode) -> Robot {
    let gains = &scale.configuration().gains[0];
    let mut robot = believed.clone();
    robot.pi.arithmetic = Some("fixed-kin".to_owned());
    let words = [
        ("kp", gains.kp.to_bits()),
        ("ki", gains.ki.to_bits()),
        ("lower", gains.lower.to_bits()),
        ("upper", gains.upper.to_bits()),
        ("tick_period", scale.tick_period as i32),
        ("count_and_time", i32::from(speed_mode == SpeedMode::CountAndTime)),
    ];
    robot.pi.registers = words.map(|(name, word)| (name.to_owned(), i64::from(word))).to_vec();
    robot.duty_quantum = Some(Format::DUTY.lsb());
    robot.ref_quantum = Some(scale.speed(fixed_kin::format::Speed::from_bits(1)));
    robot
}
