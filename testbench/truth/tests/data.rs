//! The data sets as a workflow meets them.

use std::collections::BTreeMap;
use std::path::Path;

use truth::{Ablation, Conditions, Kind, Log, Robot, draw, draw_with, simulate};

/// Largest difference between the logged duties and those that the law in `robot.toml` gives.
fn replay_error(robot: &Robot, log: &Log) -> f64 {
    let axes = log.rows[0].counts.len();
    let (mut worst, mut integrals, mut before) = (0.0_f64, vec![0.0; axes], vec![0_i64; axes]);
    for row in &log.rows {
        for i in 0..axes {
            let speed = (row.counts[i] - before[i]) as f64 * robot.speed_quantum();
            let error = (row.refs[i] * 100.0).round() / 100.0 - speed;
            let next = integrals[i] + robot.ki * error / robot.control_rate_hz;
            let wanted = robot.kp * error + next;
            if !(wanted.abs() > 1.0 && error * wanted > 0.0) {
                integrals[i] = next;
            }
            let duty = (robot.kp * error + integrals[i]).clamp(-1.0, 1.0);
            worst = worst.max((duty - row.duties[i]).abs());
        }
        before.clone_from(&row.counts);
    }
    worst
}

fn conditions() -> Vec<Conditions> {
    let usual = Conditions::default();
    vec![
        usual.clone(),
        Conditions { rate_hz: 100.0, ..usual.clone() },
        Conditions { rate_hz: 2000.0, ..usual.clone() },
        Conditions { wheels: 4, ..usual.clone() },
        Conditions { blocks: true, ..usual.clone() },
        Conditions { translations_only: true, ..usual },
    ]
}

#[test]
fn the_stated_law_replays_every_duty() {
    for conditions in conditions() {
        let case = draw_with(11, &Kind::EffectFree, &conditions).unwrap();
        for log in simulate(&case) {
            let worst = replay_error(&case.robot, &log);
            assert!(worst <= 0.0005 + 1e-9, "{worst} under {conditions:?}");
        }
    }
}

#[test]
fn effects_in_the_controller_break_the_replay_and_others_do_not() {
    for (kind, breaks) in [
        ("single:pi-gain:3", true),
        ("single:quantisation:4", true),
        ("single:sample-order:3", true),
        ("single:wheel-skew:4", false),
        ("single:encoder-lag:4", false),
        ("single:actuation-latency:4", false),
    ] {
        let case = draw(5, &kind.parse().unwrap()).unwrap();
        let worst = simulate(&case).iter().map(|log| replay_error(&case.robot, log)).fold(0.0, f64::max);
        assert_eq!(worst > 0.0006, breaks, "{kind}: {worst}");
    }
}

#[test]
fn set_points_follow_the_commands_to_half_a_quantum() {
    let case = draw(3, &Kind::EffectFree).unwrap();
    let mounts = case.robot.mounts();
    for log in simulate(&case) {
        for row in &log.rows {
            for (mount, &set_point) in mounts.iter().zip(&row.refs) {
                let ideal = mount.rim_speed(row.command) / case.robot.wheel_radius_m;
                assert!((ideal - set_point).abs() <= 0.005 + 1e-9);
            }
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_data_and_another_seed_others() {
    let text = |seed: u64| {
        let case = draw(seed, &Kind::Single { effect: None, size: None }).unwrap();
        let logs: Vec<String> = simulate(&case).iter().map(|log| log.to_csv(case.columns)).collect();
        (case.robot.to_toml(), truth::truth(&case), logs)
    };
    assert_eq!(text(21), text(21));
    assert_ne!(text(21).2, text(22).2);
}

#[test]
fn every_effect_can_be_hidden_at_every_size_and_its_data_stay_finite() {
    let names: Vec<String> = truth::catalogue()
        .map(|entry| format!("single:{}", entry.name))
        .chain(truth::outside().map(|entry| format!("outside:{}", entry.name)))
        .collect();
    assert!(names.len() > 45);
    for (k, name) in names.iter().enumerate() {
        let size = 1 + k % 5;
        for size in [size, 5] {
            let case = draw(k as u64, &format!("{name}:{size}").parse().unwrap()).unwrap();
            let truth = truth::truth(&case);
            assert_eq!(truth.effects.len() + truth.outside.len(), 1);
            assert!(truth.effects.iter().chain(&truth.outside).all(|e| !e.parameters.is_empty()));
        }
        let mut case = draw(k as u64, &format!("{name}:5").parse().unwrap()).unwrap();
        case.drives.truncate(1);
        for log in simulate(&case) {
            let last = log.rows.last().unwrap();
            assert!(last.counts.iter().all(|c| c.abs() < 10_000_000), "{name} runs away");
            assert!(log.frames.iter().all(|f| f.pose.iter().all(|v| v.is_finite() && v.abs() < 50.0)), "{name}");
        }
    }
}

#[test]
fn ablated_sets_claim_an_effect_and_are_marked() {
    for ablation in Ablation::ALL {
        let case = draw(9, &Kind::Ablation(Some(ablation))).unwrap();
        assert_eq!(truth::truth(&case).ablation, Some(ablation));
        assert_eq!(case.effects.len(), 1);
        let plain = truth::Case { ablation: None, ..case.clone() };
        let (spoiled, plain) = (simulate(&case), simulate(&plain));
        assert_eq!(spoiled == plain, ablation == Ablation::AbsentTruth, "{ablation}");
    }
    let absent = draw(9, &Kind::Ablation(Some(Ablation::AbsentTruth))).unwrap();
    assert_eq!(absent.machine, draw(9, &Kind::EffectFree).unwrap().machine);
}

#[test]
fn missing_groups_of_columns_are_missing_and_nothing_else() {
    let conditions = Conditions { camera: false, duty: false, ..Conditions::default() };
    assert!(draw_with(1, &Kind::EffectFree, &conditions).is_err());
    let conditions = Conditions { camera: false, commands: false, ..Conditions::default() };
    let case = draw_with(1, &Kind::EffectFree, &conditions).unwrap();
    let csv = simulate(&case)[0].to_csv(case.columns);
    let header = csv.lines().next().unwrap();
    assert_eq!(header, "t,ref_1,ref_2,ref_3,enc_1,enc_2,enc_3,duty_1,duty_2,duty_3,supply_v");
    let single = draw_with(1, &Kind::Single { effect: None, size: None }, &conditions).unwrap();
    assert!(truth::truth(&single).observable);
}

/// Figures by which logs of the same robot are alike.
struct Figures {
    /// Standard deviation of duty within 20 ms, typical.
    dither: f64,
    /// Duty within 20 ms, root mean square.
    level: f64,
    /// Fastest wheel over 50 ms, rad/s.
    fastest: f64,
}

fn figures(duties: &[Vec<f64>], counts: &[Vec<i64>], quantum: f64) -> Figures {
    let (mut dither, mut level, mut fastest) = (Vec::new(), Vec::new(), 0.0_f64);
    for (duty, count) in duties.iter().zip(counts) {
        for window in duty.chunks_exact(20) {
            let mean = window.iter().sum::<f64>() / 20.0;
            dither.push((window.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 20.0).sqrt());
            level.push(mean * mean);
        }
        for window in count.windows(51).step_by(10) {
            fastest = fastest.max(((window[50] - window[0]) as f64 / 50.0 * quantum).abs());
        }
    }
    dither.sort_unstable_by(f64::total_cmp);
    Figures {
        dither: dither[dither.len() / 2],
        level: (level.iter().sum::<f64>() / level.len() as f64).sqrt(),
        fastest,
    }
}

/// The same figures of a published log.
fn published(path: &Path, quantum: f64) -> Figures {
    let text = std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut lines = text.lines();
    let columns: BTreeMap<&str, usize> =
        lines.next().unwrap().split(',').enumerate().map(|(k, name)| (name, k)).collect();
    let (mut duties, mut counts) = (vec![Vec::new(); 3], vec![Vec::new(); 3]);
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        for axis in 0..3 {
            duties[axis].push(fields[columns[format!("duty_{}", axis + 1).as_str()]].parse().unwrap());
            counts[axis].push(fields[columns[format!("enc_{}", axis + 1).as_str()]].parse().unwrap());
        }
    }
    figures(&duties, &counts, quantum)
}

#[test]
fn logs_look_like_those_of_the_published_example() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/runs/wheel-skew");
    let quantum = Robot::standard().speed_quantum();
    // Lines, rotation, sweep, stop and go.
    let example: Vec<Figures> = (1..=4).map(|n| published(&folder.join(format!("run_{n:02}.csv")), quantum)).collect();
    let conditions = Conditions { standard_robot: true, ..Conditions::default() };
    let mut ours: BTreeMap<String, Vec<Figures>> = BTreeMap::new();
    for seed in 0..12 {
        let case = draw_with(seed, &Kind::EffectFree, &conditions).unwrap();
        for (drive, log) in case.drives.iter().zip(simulate(&case)) {
            let duties: Vec<Vec<f64>> = (0..3).map(|i| log.rows.iter().map(|row| row.duties[i]).collect()).collect();
            let counts: Vec<Vec<i64>> = (0..3).map(|i| log.rows.iter().map(|row| row.counts[i]).collect()).collect();
            ours.entry(drive.name.clone()).or_default().push(figures(&duties, &counts, quantum));
        }
    }
    for (pattern, theirs) in ["lines", "rot", "sweep", "stopgo"].into_iter().zip(&example) {
        let ours = &ours[pattern];
        let mean = |of: fn(&Figures) -> f64| ours.iter().map(of).sum::<f64>() / ours.len() as f64;
        let alike = |name: &str, ours: f64, theirs: f64, factor: f64| {
            println!("{pattern} {name}: ours {ours:.3}, theirs {theirs:.3}");
            assert!(ours < factor * theirs && theirs < factor * ours, "{pattern} {name}: ours {ours}, theirs {theirs}");
        };
        alike("dither", mean(|f| f.dither), theirs.dither, 1.5);
        alike("level", mean(|f| f.level), theirs.level, 1.8);
        alike("fastest wheel", mean(|f| f.fastest), theirs.fastest, 1.6);
    }
}
