//! Logs that are longer than what is kept in memory: what they need of it, and that they say the same.

use std::fmt::Write as _;
use std::path::Path;

use gap::{Options, analyse, analyse_logs};
use links::drive::{DriveLink, DriveModel};
use links::motion::{MotionLink, MotionModel};
use links::pieces::segments;
use model::effects::Applied;
use model::manoeuvre::{Manoeuvre, simulate};
use runs::frames::Pose;
use runs::robot::{Effect, EffectParameter, Robot};
use runs::{DataSet, Logs};

/// Bytes that a tick of a longer log may add; the log alone has 136.
const MOST_BYTES: f64 = 60.0;

/// A log of manoeuvres one after the other, of a robot with dry friction that its file does not know.
fn write(folder: &Path, times: usize) -> usize {
    let torque = EffectParameter { value: 0.015, ..EffectParameter::default() };
    let parameters = vec![("torque_nm".to_owned(), torque)];
    let effect = Effect { name: "coulomb-friction".to_owned(), parameters, ..Effect::default() };
    let robot = Robot::racbot();
    let applied = Applied::of(&Robot { effects: vec![effect], ..robot.clone() });
    let mut text =
        "t,cmd_vx,cmd_vy,cmd_w,ref_1,ref_2,ref_3,enc_1,enc_2,enc_3,duty_1,duty_2,duty_3,cam_x,cam_y,cam_theta\n"
            .to_owned();
    let (mut ticks, mut begin, mut counted) = (0, 0.0, [0; 3]);
    for k in 0..times {
        let drive = [Manoeuvre::Chirp, Manoeuvre::StopAndGo][k % 2];
        let run = simulate(drive, &applied, &robot, Pose::new(0.2, -0.3, 0.7 * k as f64), k as u64).unwrap();
        let mut frames = run.camera.iter().peekable();
        let command = run.command.as_ref().unwrap();
        for row in 0..run.len() {
            let _ = write!(text, "{:.6}", begin + run.t[row]);
            command.iter().chain(&run.reference).for_each(|c| write!(text, ",{}", c[row]).unwrap());
            (0..3).for_each(|i| write!(text, ",{}", counted[i] + run.counts[i][row]).unwrap());
            run.duty.iter().for_each(|c| write!(text, ",{}", c[row]).unwrap());
            match frames.next_if(|f| f.tick == row) {
                Some(f) => writeln!(text, ",{},{},{}", f.pose.x, f.pose.y, f.pose.theta).unwrap(),
                None => text.push_str(",,,\n"),
            }
        }
        ticks += run.len();
        // A pause: the robot is carried to the next start.
        begin += run.t[run.len() - 1] + 0.05;
        counted = [0, 1, 2].map(|i| counted[i] + run.counts[i][run.len() - 1]);
    }
    std::fs::write(folder.join("long.csv"), text).unwrap();
    std::fs::write(folder.join("robot.toml"), robot.to_toml()).unwrap();
    ticks
}

/// Most bytes at a time of reading a log and comparing every tick of it on both links.
fn peak(folder: &Path) -> u64 {
    let robot = Robot::racbot();
    let counted = allocation_counter::measure(|| {
        let set = Logs::open_within(folder, robot.clone(), 0).unwrap();
        let pieces = segments(&robot, &robot.geometry().unwrap(), &set.logs, 1 << 12);
        let motion = MotionLink::new(&pieces, [0.0015, 0.0015, 0.009], 1.0);
        assert!(motion.residuals(&MotionModel::new(&robot)).len() > 10);
        let model = DriveModel::new(&robot);
        assert!(DriveLink::new(&pieces, &model).unwrap().residuals(&model).unwrap().torque.len() > 100);
    });
    counted.bytes_max
}

#[test]
fn memory_hardly_grows_with_the_log() {
    let (short, long) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let ticks = [write(short.path(), 12), write(long.path(), 36)];
    // One thread, this one, so that all is counted.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().unwrap();
    let bytes = pool.install(|| [peak(short.path()), peak(long.path())]);
    let a_tick = (bytes[1] as f64 - bytes[0] as f64) / (ticks[1] - ticks[0]) as f64;
    assert!(a_tick < MOST_BYTES, "{a_tick:.1} bytes a tick: {bytes:?} bytes for {ticks:?} ticks");
}

#[test]
fn a_log_in_a_file_says_what_it_says_in_memory() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), 4);
    let robot = Robot::racbot();
    let set = Logs::open_within(folder.path(), robot, 1000).unwrap();
    let there = analyse_logs(&set, &Options::default()).unwrap();
    let here = analyse(&DataSet::open(folder.path()).unwrap(), &Options::default()).unwrap();
    assert_eq!(there.to_json(), here.to_json());
    assert_eq!(there.effects.iter().map(|e| e.name.as_str()).collect::<Vec<_>>(), ["coulomb-friction"]);
    assert!((there.effects[0].parameters[0].1 - 0.015).abs() < 0.002, "{:?}", there.effects[0].parameters);
}

/// Drives of some 7 s, of which there are enough for a sample.
const DRIVES: usize = 90;

#[test]
fn a_cause_looked_for_in_a_part_is_estimated_on_all() {
    let folder = tempfile::tempdir().unwrap();
    let minutes = write(folder.path(), DRIVES) as f64 / 60e3;
    let set = Logs::open_within(folder.path(), Robot::racbot(), 1000).unwrap();
    let found = analyse_logs(&set, &Options::default()).unwrap();
    let remark = found.remarks.iter().find(|r| r.starts_with("Causes were looked for in")).expect("a sample");
    assert!(remark.contains(&format!(" of {minutes:.1} minutes")), "{minutes} {remark}");
    assert_eq!(found.effects.iter().map(|e| e.name.as_str()).collect::<Vec<_>>(), ["coulomb-friction"]);
    let (_, torque, interval) = &found.effects[0].parameters[0];
    let [low, high] = interval.ends().unwrap();
    assert!((low..high).contains(&0.015) && (torque - 0.015).abs() < 0.002, "{torque} {low} {high}");
}
