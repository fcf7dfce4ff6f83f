//! Speeds of the moment in rows as long as a motor takes to follow its duty.

use gap::{Analysis, Interval, Verdict};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;

use super::common::{names, of_files, with_dry_friction};

const VOLT: f64 = 12.0;
const OHM: f64 = 3.8;
const KT: f64 = 0.0083;
const GEAR: f64 = 9.68;
/// At the motor shaft, kg m²: a time constant of 22 ms.
const ROTOR: f64 = 4e-7;

/// A lifted motor's file, whose logs have rows of that length.
fn file(row_s: f64) -> String {
    format!(
        "encoder_counts_per_motor_rev = 2048\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         wheel_radius_m = 0.03\ncontrol_rate_hz = {}\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\n\
         rotor_inertia = {ROTOR}\nfriction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n",
        1.0 / row_s
    )
}

/// A lifted motor that is so much heavier than its file, under a duty that wanders and jumps, its speed read at the rows or
/// behind a low-pass.
fn logged(seed: u64, row_s: f64, heavier: f64, filter_s: f64) -> Analysis {
    logged_by(&file(row_s), seed, row_s, [heavier, filter_s, 0.0])
}

/// The same by that file, of duties that act `late_s` later than logged.
fn logged_by(file: &str, seed: u64, row_s: f64, [heavier, filter_s, late_s]: [f64; 3]) -> Analysis {
    let run = |n| {
        let mut rng = ChaCha8Rng::seed_from_u64(100 * seed + n);
        let mut run = Run { name: format!("{n}"), ..Run::default() };
        let (mut speed, mut seen, mut level, mut duty) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let (mut duties, mut speeds) = (Vec::new(), Vec::new());
        let step = 1e-4;
        for row in 0..700_usize {
            if row % 40 == 0 {
                level = rng.random_range(-0.8..0.8);
            }
            // A ramp of the set point, as users drive.
            duty += (level - duty).clamp(-0.08, 0.08);
            run.t.push(row as f64 * row_s);
            duties.push(duty);
            speeds.push(seen + rng.random_range(-0.05..0.05));
            for k in 0..(row_s / step).round() as usize {
                let at = row as f64 + (step * (k as f64 + 0.5) - late_s) / row_s;
                let acting = if at < 0.0 { 0.0 } else { duties[at as usize] };
                let torque = KT * (VOLT * acting - KT * GEAR * speed) / OHM;
                speed += step * torque / ROTOR / (1.0 + heavier) / GEAR;
                seen += if filter_s > 0.0 { step * (speed - seen) / filter_s } else { speed - seen };
            }
        }
        (run.duty, run.speed) = (vec![duties], vec![speeds]);
        run
    };
    of_files(file, (0..5).map(run))
}

/// A straight line from row to row made it 13 % heavier, at five noise floors.
#[test]
fn a_motor_that_follows_within_a_row_agrees() {
    for (seed, row_s) in [(1, 0.02), (2, 0.03), (3, 0.04)] {
        let a = logged(seed, row_s, 0.0, 0.0);
        assert_eq!((a.verdict, &names(&a)[..]), (Verdict::Agrees, &[][..]), "{row_s}: {}", a.terminal_summary());
    }
    let a = logged(4, 0.02, 0.5, 0.0);
    let size = a.effects.first().map(|e| e.parameters[0].2);
    let holds = matches!(size, Some(Interval::Ci95([low, high])) if low < 0.5 && 0.5 < high);
    assert!(names(&a) == ["rotor-inertia"] && holds, "{}", a.terminal_summary());
}

/// What the file states is not looked for in the age of the rows as well: one row of it was "not in these logs", and of two rows
/// the rest was an inertia that is not there.
#[test]
fn a_latency_that_the_file_states_is_no_age_of_the_rows() {
    for (seed, row_s, rows) in [(22, 0.02, 1.0), (23, 0.02, 2.0), (24, 0.03, 1.0)] {
        let late_s = rows * row_s;
        let effect = "[[effect]]\nname = \"actuation-latency\"\n[effect.parameters]\nlatency_s";
        let stated = format!("{}{effect} = {late_s}\n", file(row_s));
        let a = logged_by(&stated, seed, row_s, [0.0, 0.0, late_s]);
        assert_eq!((a.verdict, &names(&a)[..]), (Verdict::Agrees, &[][..]), "{rows}: {}", a.terminal_summary());
    }
}

/// The motor's own lag is over in a row, or half a row more, and what comes of a filter is that of an inertia.
#[test]
fn a_filter_beside_a_motor_that_follows_within_a_row_may_be_an_inertia() {
    for (seed, row_s, filter_s) in [(5, 0.025, 0.06), (6, 0.025, 0.09), (25, 0.018, 0.06), (26, 0.016, 0.05)] {
        let a = logged(seed, row_s, 0.0, filter_s);
        let own = names(&a).contains(&"speed-filter");
        let tied = a
            .alternatives
            .iter()
            .any(|set| ["rotor-inertia", "speed-filter"].iter().all(|n| set.iter().any(|s| s == n)));
        let told = a.remarks.iter().find_map(|r| {
            let (ms, _) = r.split_once("a speed-filter of ")?.1.split_once(" ms with the inertia of the file")?;
            ms.parse::<f64>().ok()
        });
        let true_told = told.is_some_and(|ms| (1e-3 * ms / filter_s - 1.0).abs() < 0.1);
        assert!(own || tied && true_told, "{filter_s}: {told:?} {}", a.terminal_summary());
        assert_eq!(a.verdict, Verdict::Ambiguous, "{}", a.terminal_summary());
    }
    // A motor that takes longer than a row shows beside a filter.
    let a = logged(7, 0.01, 1.0, 0.0);
    assert!(names(&a) == ["rotor-inertia"] && a.verdict != Verdict::Ambiguous, "{}", a.terminal_summary());
}

/// A motor with a dry friction (Nm at the wheel) under a duty of two levels, its counts differenced in the middle between two
/// duties, as of tasks that take turns.
fn differenced_between_duties(seed: u64, row_s: f64, heavier: f64, dry: f64) -> Analysis {
    let run = |n| {
        let mut rng = ChaCha8Rng::seed_from_u64(100 * seed + n);
        let mut run = Run { name: format!("{n}"), ..Run::default() };
        let (mut speed, mut angle, mut read) = (0.0_f64, 0.0_f64, 0.0_f64);
        let (mut duties, mut speeds) = (vec![0.5], Vec::new());
        let (step, inertia) = (1e-4, ROTOR * (1.0 + heavier) * GEAR * GEAR);
        let halves = (0.5 * row_s / step).round() as usize;
        for row in 0..1000_usize {
            run.t.push(row as f64 * row_s);
            let count = (angle / 0.002).floor() * 0.002;
            speeds.push((count - read) / row_s);
            read = count;
            let before = duties[row];
            let now = if rng.random_range(0.0..1.0) < 0.2 { 0.75 - before } else { before };
            duties.push(now);
            for i in 0..2 * halves {
                let duty = if i < halves { before } else { now };
                let torque = KT * GEAR * (VOLT * duty - KT * GEAR * speed) / OHM;
                speed = with_dry_friction(speed, torque, dry, inertia, step);
                angle += step * speed;
            }
        }
        (run.duty, run.speed) = (vec![duties.split_off(1)], vec![speeds]);
        run
    };
    of_files(&file(row_s), (0..3).map(run))
}

/// Read as means up to their duty they were a curve of the bridge that is not there, and half as much friction again.
#[test]
fn speeds_differenced_between_two_duties_are_late_by_the_log() {
    const DRY: f64 = 0.02;
    for (seed, row_s, heavier) in [(11, 0.02, 0.0), (12, 0.01, -0.4), (13, 0.03, 0.0), (14, 0.02, 0.8)] {
        let a = differenced_between_duties(seed, row_s, heavier, DRY);
        let holds = |name: &str, value: f64| {
            let found = a.effects.iter().find(|e| e.name == name).map(|e| e.parameters[0].2);
            matches!(found, Some(Interval::Ci95([low, high])) if low <= value && value <= high)
        };
        let wanted = if heavier == 0.0 { vec!["coulomb-friction"] } else { vec!["coulomb-friction", "rotor-inertia"] };
        let mut found = names(&a);
        found.sort_unstable();
        let sized = holds("coulomb-friction", DRY) && (heavier == 0.0 || holds("rotor-inertia", heavier));
        assert!(found == wanted && sized, "{row_s} {heavier}: {}", a.terminal_summary());
    }
}
