//! Logs that lack some of their rows.

use gap::{Analysis, Interval, Verdict};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;

use super::common::{names, of_files};

const VOLT: f64 = 12.0;
const OHM: f64 = 3.8;
const KT: f64 = 0.0083;
const GEAR: f64 = 9.68;
/// At the motor shaft, kg m²: a time constant of 88 ms.
const ROTOR: f64 = 1.6e-6;
const COUNTS: f64 = 2048.0;
const ROW_S: f64 = 0.01;

/// A lifted motor that is so much heavier than its file, under a duty that wanders. A row begins so many that are lost with
/// some chance.
fn logged(seed: u64, heavier: f64, (chance, most): (f64, usize)) -> Analysis {
    let text = format!(
        "encoder_counts_per_motor_rev = {COUNTS}\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         wheel_radius_m = 0.03\ncontrol_rate_hz = {}\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\n\
         rotor_inertia = {ROTOR}\nfriction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n",
        1.0 / ROW_S
    );
    let run = |n| {
        let mut rng = ChaCha8Rng::seed_from_u64(100 * seed + n);
        let mut run = Run { name: format!("{n}"), ..Run::default() };
        let (mut angle, mut speed, mut level, mut duty, mut lost) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64, 0);
        let (mut duties, mut counts) = (Vec::new(), Vec::new());
        let step = 1e-4;
        for row in 0..1200_usize {
            if row % 30 == 0 {
                level = rng.random_range(-0.8..0.8);
            }
            duty += (level - duty).clamp(-0.04, 0.04);
            if lost == 0 && rng.random_range(0.0..1.0) < chance {
                lost = rng.random_range(1..=most);
            }
            if lost == 0 {
                run.t.push(row as f64 * ROW_S);
                duties.push(duty);
                counts.push((angle / std::f64::consts::TAU * GEAR * COUNTS).floor() as i64);
            }
            lost = lost.saturating_sub(1);
            for _ in 0..(ROW_S / step).round() as usize {
                let torque = KT * (VOLT * duty - KT * GEAR * speed) / OHM;
                speed += step * torque / ROTOR / (1.0 + heavier) / GEAR;
                angle += step * speed;
            }
        }
        (run.duty, run.counts, run.count_gaps) = (vec![duties], vec![counts], vec![Vec::new()]);
        run
    };
    of_files(&text, (0..5).map(run))
}

/// Held over the rows that are lost, every duty was late by a part of a row: it acted before, by 0.8 rows, and the motor was
/// heavier.
#[test]
fn duties_in_rows_that_are_lost_are_not_those_before() {
    for (seed, lost) in [(1, (0.2, 1)), (2, (0.15, 2)), (3, (0.02, 12))] {
        let a = logged(seed, 0.0, lost);
        assert_eq!((a.verdict, &names(&a)[..]), (Verdict::Agrees, &[][..]), "{lost:?}: {}", a.terminal_summary());
        let a = logged(seed + 10, 0.4, lost);
        let size = a.effects.first().map(|e| e.parameters[0].2);
        let holds = matches!(size, Some(Interval::Ci95([low, high])) if low < 0.4 && 0.4 < high);
        assert!(names(&a) == ["rotor-inertia"] && holds, "{lost:?}: {}", a.terminal_summary());
    }
}
