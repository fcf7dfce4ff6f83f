//! A brushless motor without a gear that a position loop turns slowly: the cogs of its stator, and nothing where it has none.

use std::f64::consts::TAU;

use super::common::{names, of_files, simulate, with, with_dry_friction};

use gap::{Analysis, Options, Verdict, analyse};
use model::manoeuvre::Manoeuvre;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;
use runs::robot::Robot;

const KT: f64 = 0.12;
const INERTIA: f64 = 2.5e-4;
const DRY_NM: f64 = 0.02;
const MOST_A: f64 = 4.0;
const COUNTS: f64 = 16384.0;
const ROW_S: f64 = 0.002;
const STEPS: u32 = 20;
/// Cogs a turn of twelve teeth before fourteen poles.
const COGS: f64 = 84.0;

fn run(cogs_nm: f64, seed: u64) -> Run {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut run = Run { name: format!("run_{seed}"), ..Run::default() };
    let (mut angle, mut speed, mut set, mut rate) = (rng.random_range(0.0..TAU), 0.0_f64, 0.0, 0.0);
    let start = angle;
    let (mut counts, mut currents) = (vec![], vec![]);
    for row in 0..12_000_u32 {
        if row % 750 == 0 {
            rate = rng.random_range(2.0..8.0) * if rng.random::<bool>() { 1.0 } else { -1.0 };
        }
        set += rate * ROW_S;
        let error = set - (angle - start);
        let asked = (60.0 * INERTIA / KT) * (60.0 * error + 1.4 * (rate - speed));
        let current = (asked.clamp(-MOST_A, MOST_A) * 1e3).round() / 1e3;
        run.t.push(f64::from(row) * ROW_S);
        counts.push((angle * COUNTS / TAU).floor() as i64);
        currents.push(current);
        let step = ROW_S / f64::from(STEPS);
        for _ in 0..STEPS {
            let torque = KT * current + cogs_nm * (COGS * angle).sin();
            speed = with_dry_friction(speed, torque, DRY_NM, INERTIA, step);
            angle += step * speed;
        }
    }
    run.counts = vec![counts];
    run.current = vec![currents];
    run
}

fn done(cogs_nm: f64, seed: u64) -> Analysis {
    let text = format!(
        "encoder_counts_per_wheel_rev = {COUNTS}\ngear_ratio = 1\nsupport = \"blocks\"\nwheel_radius_m = 1\nwheel_inertia_kg_m2 = 0\n[motor]\n\
         torque_constant = {KT}\nrotor_inertia = {INERTIA}\nfriction_torque = {DRY_NM}\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n"
    );
    of_files(&text, (0..2).map(|k| run(cogs_nm, 10 * seed + k)))
}

#[test]
fn cogs_of_a_motor_without_a_gear_are_said_by_their_number() {
    for (seed, cogs_nm) in [(1, 0.012), (2, 0.018)] {
        let a = done(cogs_nm, seed);
        let said = a.unexplained.iter().any(|left| left.structure.contains(" 84 times a turn"));
        assert!(said && a.verdict == Verdict::Unexplained, "{}", a.terminal_summary());
        let a = done(0.0, seed);
        assert_eq!(a.verdict, Verdict::Agrees, "{}", a.terminal_summary());
    }
}

/// Rollers show in thousands of blocks, and by the tail of their law's distribution no chance would be left; none is told that
/// is less than what flips of signs resolve.
#[test]
fn a_ripple_of_rollers_has_a_chance_that_a_test_can_resolve() {
    let ripple = [("cos_1", 0.05), ("cos_2", 0.05), ("cos_3", 0.05), ("order", 15.0)];
    let truth = with(&Robot::racbot(), "roller-ripple", &ripple);
    let a = analyse(&simulate(&truth, &[Manoeuvre::Chirp, Manoeuvre::Chirp], 71), &Options::default()).unwrap();
    assert_eq!(names(&a), ["roller-ripple"], "{}", a.terminal_summary());
    let p = a.effects[0].evidence.p_value().unwrap();
    assert!((estimation::sign_flips::LEAST..1e-3).contains(&p), "{p}");
    let folder = tempfile::tempdir().unwrap();
    a.write(folder.path()).unwrap();
    let written = std::fs::read_to_string(folder.path().join("robot.toml")).unwrap();
    assert!(written.contains(&format!("p_value = {p:?}\n")), "{written}");
}
