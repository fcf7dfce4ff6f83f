use super::*;
use crate::frames::{Pose, displacement, wrap_angle};
use crate::{CameraSample, DataSet, Logs};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn read(run: Run) -> Run {
    let mut reading = Reading::new(&Robot::racbot(), &run, Path::new("run.csv")).unwrap();
    reading.apply(run)
}

fn times(ticks: usize) -> Vec<f64> {
    (0..ticks).map(|k| k as f64 * 1e-3).collect()
}

/// A wheel that swings, rad.
fn angle(t: f64) -> f64 {
    4.0 * (3.0 * t).sin()
}

#[test]
fn counts_that_repeat_are_no_samples_and_slow_wheels_are() {
    let robot = Robot::racbot();
    let counts = |every: usize, size: f64| -> Vec<i64> {
        (0..4000)
            .map(|k| (size * angle((k / every * every) as f64 * 1e-3) * robot.counts_per_wheel_rad()) as i64)
            .collect()
    };
    let run = |every: usize, size: f64| {
        let counts = vec![counts(every, size)];
        read(Run { t: times(4000), counts, count_gaps: vec![Vec::new()], ..Run::default() })
    };
    let slow = run(10, 1.0);
    let gaps = &slow.count_gaps[0];
    assert!((3500..=3610).contains(&gaps.len()), "nine of ten: {}", gaps.len());
    // Late only where the wheel turns round and a reading is the same as the one before.
    assert!(gaps.iter().filter(|g| **g % 10 == 0).count() < 20);
    assert!(slow.notes[0].contains("every 10.0 ticks (100 Hz)"), "{:?}", slow.notes);
    for (every, size) in [(1, 1.0), (1, 0.001), (1, 1e-5)] {
        let run = run(every, size);
        assert!(run.count_gaps[0].is_empty() && run.notes.is_empty(), "{every} {size}: {:?}", run.notes);
    }
}

/// Rows of a loop at 90 Hz: in milliseconds, and in 32 bits half a day after the clock began.
#[test]
fn rows_with_coarse_stamps_are_read_by_their_number() {
    let mut rng = ChaCha8Rng::seed_from_u64(20);
    let lost: Vec<bool> = (0..900).map(|k| k > 3 && rng.random::<f64>() < 0.02).collect();
    let made = |stamp: &dyn Fn(f64) -> f64, truth: &dyn Fn(usize) -> f64| {
        let robot = Robot::racbot();
        let kept = || (0..900).filter(|k| !lost[*k]);
        let count = |k: usize| (angle(truth(k)) * robot.counts_per_wheel_rad()).floor() as i64;
        let counts = vec![kept().map(count).collect()];
        let t: Vec<f64> = kept().map(|k| stamp(truth(k))).collect();
        let run = read(Run { t, counts, count_gaps: vec![Vec::new()], ..Run::default() });
        let apart: Vec<f64> = run.t.iter().zip(kept()).map(|(t, k)| t - truth(k)).collect();
        let middle = apart.iter().sum::<f64>() / apart.len() as f64;
        (apart.iter().map(|d| (d - middle).abs()).fold(0.0, f64::max), run.notes)
    };
    let beat = |k: usize| k as f64 / 90.0;
    let (off, notes) = made(&|t| (t * 1e3).round() * 1e-3, &beat);
    assert!(off < 1e-4 && notes.len() == 1 && notes[0].contains("steps of 1.000 ms"), "{off} {notes:?}");
    let (off, notes) = made(&|t| f64::from((t + 40_000.0) as f32), &beat);
    assert!(off < 3e-4 && notes[0].contains("by their number, at 90.0 Hz"), "{off} {notes:?}");
    // Whole rows that are missing, a loop that is woken in whole milliseconds, and one that comes when it comes.
    let (off, notes) = made(&|t| t, &|k| k as f64 * 0.01);
    assert!(off < 1e-12 && notes.is_empty(), "{off} {notes:?}");
    let woken = |k: usize| (beat(k) * 1e3).round() * 1e-3;
    let (off, notes) = made(&|t| t, &woken);
    assert!(off < 1e-12 && notes.is_empty(), "{off} {notes:?}");
    let late = |k: usize| beat(k) + 2e-3 * (1.7 * k as f64).sin().abs();
    let (off, notes) = made(&|t| (t * 1e3).round() * 1e-3, &late);
    assert!(off < 2e-3 && notes.is_empty(), "{off} {notes:?}");
}

#[test]
fn speeds_become_counts() {
    let speed = |k: usize| 12.0 * (3.0 * k as f64 * 1e-3).cos();
    let mut column: Vec<f64> = (0..2000).map(speed).collect();
    column[700] = f64::NAN;
    let run = read(Run { t: times(2000), speed: vec![column], ..Run::default() });
    let robot = as_logged(&Robot::racbot(), run.source, None);
    for k in [1, 699, 701, 1999] {
        let turned = run.counts[0][k] as f64 / robot.counts_per_wheel_rad();
        assert!((turned - angle(k as f64 * 1e-3)).abs() < 1e-5, "{k}: {turned}");
    }
    assert_eq!(run.count_gaps[0], [700]);
    assert_eq!(run.source.counts, CountSource::Speeds);
}

#[test]
fn dead_reckoning_becomes_wheels_that_retrace_it() {
    let pose = |k: usize| {
        let t = k as f64 * 1e-2;
        Pose::new(t.sin(), 0.3 * t, wrap_angle(2.0 * t))
    };
    let column = |f: fn(Pose) -> f64| (0..500).map(|k| f(pose(k))).collect::<Vec<f64>>();
    let run = read(Run {
        t: (0..500).map(|k| f64::from(k) * 1e-2).collect(),
        odometry: Some([column(|p| p.x), column(|p| p.y), column(|p| p.theta)]),
        duty: vec![vec![0.1; 500]; 2],
        ..Run::default()
    });
    let robot = as_logged(&Robot::racbot(), run.source, None);
    let geometry = robot.geometry().unwrap();
    let mut at = pose(0);
    for k in 1..500 {
        let turned: Vec<f64> =
            run.counts.iter().map(|c| (c[k] - c[k - 1]) as f64 / robot.counts_per_wheel_rad()).collect();
        at = at.compose(displacement(geometry.twist(&turned)));
        assert!(at.distance(pose(k)) < 1e-3 && wrap_angle(at.theta - pose(k).theta).abs() < 1e-3, "{k}: {at:?}");
    }
    assert!(run.duty.is_empty() && run.notes[0].contains("duty not used"), "{:?}", run.notes);
}

#[test]
fn currents_become_duties_of_a_motor_without_back_emf() {
    let run = read(Run { t: times(3), current: vec![vec![1.0, -0.5, 0.0]; 3], ..Run::default() });
    let robot = as_logged(&Robot::racbot(), run.source, None);
    assert_eq!(robot.motor.back_emf(), 0.0);
    let ampere = run.duty[0][0] * robot.supply_v / robot.motor.resistance_ohm;
    assert!((ampere - 1.0).abs() < 1e-12);
    let little = Robot::parse_partial("[motor]\ntorque_constant = 0.02", Path::new("r")).unwrap();
    let robot = as_logged(&little, run.source, Some(0.01));
    assert!(robot.lacks(&["supply_v", "motor.resistance_ohm", "control_rate_hz"]).is_empty());
    assert!((robot.control_rate_hz - 100.0).abs() < 1e-9);
    let again = Run { duty: Vec::new(), ..run };
    let mut reading = Reading::new(&little, &again, Path::new("r")).unwrap();
    assert_eq!(reading.apply(again).duty[0][0], 1.0);
}

#[test]
fn currents_that_repeat_their_readings_are_samples_now_and_then() {
    let run = |every: usize| {
        let current = vec![(0..800).map(|k| 3.0 * (k / every * every) as f64).collect()];
        read(Run { t: times(800), current, ..Run::default() })
    };
    let held = run(8);
    assert!((0..800).all(|k| held.duty[0][k].is_finite() == (k % 8 == 0)), "{:?}", &held.duty[0][..20]);
    assert!(
        held.notes[0].starts_with("current_1 repeat their readings: a new one comes every 8.0 ticks"),
        "{:?}",
        held.notes
    );
    assert!(run(1).duty[0].iter().all(|d| d.is_finite()));
    // Read by a clock of its own.
    for ticks in [3.0, 1.7] {
        let current = vec![(0..800).map(|k| 3.0 * (f64::from(k) / ticks).floor()).collect()];
        let read = read(Run { t: times(800), current, ..Run::default() });
        let fresh = read.duty[0].iter().filter(|d| d.is_finite()).count() as f64;
        assert!((fresh * ticks / 800.0 - 1.0).abs() < 0.02, "{ticks}: {fresh}");
    }
}

/// Currents to 0.1 A with little noise: what repeats by chance was no sample, and the rows between were taken for it.
#[test]
fn currents_that_repeat_for_their_rounding_are_samples() {
    let mut random = ChaCha8Rng::seed_from_u64(18);
    for noise in [0.04, 0.06, 0.1] {
        let amps = |k: i32| 2.0 * (0.004 * f64::from(k)).sin() + random.random_range(-noise..noise);
        let current = vec![(0..4000).map(amps).map(|i: f64| (10.0 * i).round() / 10.0).collect()];
        let read = read(Run { t: times(4000), current, ..Run::default() });
        let said = read.notes.iter().any(|note| note.contains("repeat"));
        assert!(read.duty[0].iter().all(|d| d.is_finite()) && !said, "{noise}: {:?}", read.notes);
    }
}

#[test]
fn held_poses_are_dropped_and_frozen_ones_left_to_the_links() {
    let camera = |every: usize, frozen: std::ops::Range<usize>| -> Vec<CameraSample> {
        let at = |k: usize| if frozen.contains(&k) { frozen.start } else { k / every * every };
        (0..3000).map(|k| CameraSample { tick: k, pose: Pose::new(at(k) as f64, 0.0, 0.0) }).collect()
    };
    let run = |camera| read(Run { t: times(3000), camera, has_camera: true, ..Run::default() });
    let held = run(camera(16, 0..0));
    assert_eq!(held.camera.len(), 3000_usize.div_ceil(16));
    assert!(held.notes[0].contains("63 new poses a second") || held.notes[0].contains("62 new"), "{:?}", held.notes);
    assert_eq!(run(camera(1, 0..0)).camera.len(), 3000);
    assert_eq!(run(camera(1, 1000..2500)).camera.len(), 3000, "one long freeze is a lost track, which is reported");
}

#[test]
fn a_robot_that_says_too_little_for_its_log_is_told_all_at_once() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("run.csv"), "t,enc_1,enc_2\n0,0,0\n1,1,1\n").unwrap();
    std::fs::write(folder.path().join("robot.toml"), "control_rate_hz = 1\n").unwrap();
    let e = DataSet::open(folder.path()).unwrap_err().to_string();
    for part in ["run.csv", "[[wheel]]", "wheel_radius_m", "gear_ratio", "encoder_counts_per_motor_rev", "racbot init"]
    {
        assert!(e.contains(part), "{e}");
    }
    assert_eq!(Logs::open(folder.path()).unwrap_err().to_string(), e);
    std::fs::write(folder.path().join("run.csv"), "t,odom_x,odom_y,odom_theta\n0,0,0,0\n1,1,1,0\n").unwrap();
    assert_eq!(DataSet::open(folder.path()).unwrap().runs[0].counts.len(), 3);
}

/// Ten frames of a robot that drives on arrive at once, ten times a second.
#[test]
fn frames_that_a_network_delivers_in_bunches_are_told() {
    let notes = |bunch: usize| {
        let t: Vec<f64> = (0..3000).map(|k| 0.01 * (k / bunch * bunch) as f64 + 1e-4 * (k % bunch) as f64).collect();
        let pose = |tick| CameraSample { tick, pose: Pose::new(0.003 * tick as f64, 0.0, 0.0) };
        let camera = (0..3000).map(pose).collect();
        let run = Run { t, camera, has_camera: true, ..Run::default() };
        super::camera::Repeats::of(&run).note(&run)
    };
    assert!(notes(10).is_some_and(|note| note.starts_with("the camera's frames come in bunches")));
    assert_eq!(notes(1), None);
}

/// Poses of frames 30 times a second, to rows 500 times a second: between the frames they are lines.
#[test]
fn interpolated_poses_are_samples_where_frames_were() {
    let mut state = 7_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1_u32 << 23) - 1.0
    };
    let pose = |t: f64| [0.8 * (1.1 * t).sin(), 0.5 * (0.7 * t).cos(), 0.9 * t];
    let mut seen = |t: f64, noise: f64| pose(t).map(|v| v + noise * random());
    let period = 1.0 / 30.0;
    let rows = |frames: &[[f64; 3]], step: f64| {
        let sample = |tick: usize| {
            let place = 0.002 * tick as f64 / period;
            let (frame, share) = (place as usize, place.fract());
            let at = |i: usize| frames[frame][i] + share * (frames[frame + 1][i] - frames[frame][i]);
            let [x, y, theta] = [0, 1, 2].map(|i| (at(i) / step).round() * step);
            CameraSample { tick, pose: Pose::new(x, y, wrap_angle(theta)) }
        };
        (0..3000).map(sample).collect::<Vec<_>>()
    };
    let run = |camera| {
        let t = (0..3000).map(|k| 0.002 * k as f64).collect();
        read(Run { t, camera, has_camera: true, ..Run::default() })
    };
    for (noise, step) in [(1e-3, 1e-5), (3e-3, 1e-5), (2e-3, 1e-6)] {
        let frames: Vec<[f64; 3]> = (0..200).map(|k| seen(period * f64::from(k), noise)).collect();
        let kept = run(rows(&frames, step));
        let number = kept.camera.len();
        assert!((150..=185).contains(&number), "{noise} {step}: {number} of 180 frames");
        assert!(kept.notes.iter().any(|n| n.contains("interpolated")), "{:?}", kept.notes);
        // Next to a frame: no more than half a row from it.
        let off = |s: &CameraSample| {
            let place = 0.002 * s.tick as f64 / period;
            (place - place.round()).abs() * period
        };
        let near = kept.camera.iter().filter(|s| off(s) <= 0.0021).count();
        assert!(near as f64 > 0.97 * number as f64, "{near} of {number}");
    }
    // A camera of every row, noisy or smooth, finely or coarsely written, keeps all of it.
    for (noise, step) in [(1e-3, 1e-5), (1e-5, 1e-5), (2e-5, 1e-5), (0.0, 1e-7), (0.0, 1e-5), (0.0, 1e-3), (5e-4, 1e-3)]
    {
        let written = |tick: usize| {
            let [x, y, theta] = seen(0.002 * tick as f64, noise).map(|v| (v / step).round() * step);
            CameraSample { tick, pose: Pose::new(x, y, wrap_angle(theta)) }
        };
        let camera: Vec<CameraSample> = (0..3000).map(written).collect();
        let kept = run(camera);
        assert_eq!(kept.camera.len(), 3000, "{noise} {step}: {:?}", kept.notes);
    }
    // A camera of every row that loses the robot for 0.3 s now and then, bridged by lines.
    let mut camera: Vec<CameraSample> = (0..3000)
        .map(|tick| {
            let [x, y, theta] = seen(0.002 * tick as f64, 1e-3).map(|v| (v / 1e-5).round() * 1e-5);
            CameraSample { tick, pose: Pose::new(x, y, theta) }
        })
        .collect();
    for lost in [400, 1200, 2500] {
        let [a, b] = [camera[lost].pose, camera[lost + 150].pose];
        for k in 0..=150 {
            let share = k as f64 / 150.0;
            let [x, y, theta] = [(a.x, b.x), (a.y, b.y), (a.theta, b.theta)]
                .map(|(a, b)| ((a + share * (b - a)) / 1e-5).round() * 1e-5);
            camera[lost + k].pose = Pose::new(x, y, theta);
        }
    }
    let kept = run(camera);
    assert!((2550..=2560).contains(&kept.camera.len()), "{}", kept.camera.len());
    assert!(kept.notes.iter().any(|n| n.contains("bridged by lines")), "{:?}", kept.notes);
}

/// A map's poses, some every two seconds, put on lines at 5 a second in a file of their own: each is a row of its own.
#[test]
fn poses_interpolated_at_times_of_their_own_are_samples_where_frames_were() {
    let pose = |t: f64| Pose::new(3.0 * (0.11 * t).sin(), 2.0 * (0.07 * t).cos(), 0.4 * (0.2 * t).sin());
    let between = |t: f64, every: f64| {
        let frame = (t / every).floor();
        let (share, [a, b]) = (t / every - frame, [frame, frame + 1.0].map(|frame| pose(frame * every)));
        let at = |a: f64, b: f64| a + share * (b - a);
        Pose::new(at(a.x, b.x), at(a.y, b.y), at(a.theta, b.theta))
    };
    // Rows of wheels at 10 a second, and one of a pose after every second one.
    let run = |of: &dyn Fn(f64) -> Pose| {
        let t: Vec<f64> = (0..3000).map(|k| 0.2 * f64::from(k / 3) + [0.0, 0.02, 0.1][k as usize % 3]).collect();
        let camera = (0..1000).map(|k| CameraSample { tick: 3 * k + 1, pose: of(t[3 * k + 1]) }).collect();
        let mut run = Run { t, camera, has_camera: true, ..Run::default() };
        let mut interpolated = interpolated::Interpolated::of(&run);
        interpolated.apply(&mut run);
        (run.camera.len(), interpolated.note(&run))
    };
    let (kept, note) = run(&|t| between(t, 2.07));
    assert!((85..=105).contains(&kept), "{kept} of 97 frames");
    assert!(note.is_some_and(|note| note.contains("(0.5 frames a second)")));
    let positions = run(&|t| Pose::new(between(t, 2.07).x, between(t, 2.07).y, f64::NAN));
    assert_eq!(positions.0, kept);
    // As the camera gave them, finely or in millimetres, all stay.
    for step in [1e-7, 1e-3] {
        let written = |t: f64| {
            let p = pose(t);
            let [x, y, theta] = [p.x, p.y, p.theta].map(|v| (v / step).round() * step);
            Pose::new(x, y, theta)
        };
        assert_eq!(run(&written), (1000, None), "{step}");
    }
    // A robot that drives straight from corner to corner, in millimetres.
    let square = |t: f64| {
        let p = between(t, 8.0);
        Pose::new((p.x / 1e-3).round() * 1e-3, (p.y / 1e-3).round() * 1e-3, (p.theta / 1e-3).round() * 1e-3)
    };
    assert_eq!(run(&square), (1000, None));
}
