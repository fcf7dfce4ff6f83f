//! Speeds that a firmware filters before it logs them.

use gap::{Analysis, Verdict};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;

use super::common::{names, of_files};

const VOLT: f64 = 12.0;
const OHM: f64 = 3.8;
const KT: f64 = 0.0083;
const GEAR: f64 = 9.68;
/// At the motor shaft, kg m².
const ROTOR: f64 = 4e-7;

/// A lifted motor under steps of its duty, its speed filtered by so many seconds.
fn steps(seed: u64, filter_s: f64) -> Analysis {
    let text = format!(
        "encoder_counts_per_motor_rev = 2048\ngear_ratio = {GEAR}\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
         wheel_radius_m = 0.03\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\nrotor_inertia = {ROTOR}\n\
         friction_torque = 0\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n"
    );
    let run = |n| {
        let mut rng = ChaCha8Rng::seed_from_u64(10 * seed + n);
        let mut run = Run { name: format!("{n}"), ..Run::default() };
        let (mut speed, mut seen, mut duty) = (0.0_f64, 0.0, 0.0);
        let (mut duties, mut speeds) = (Vec::new(), Vec::new());
        for row in 0..8000 {
            if row % 250 == 0 {
                duty = rng.random_range(-0.8..0.8);
            }
            run.t.push(f64::from(row) * 1e-3);
            duties.push(duty);
            speeds.push(seen + rng.random_range(-0.3..0.3));
            for _ in 0..10 {
                let torque = KT * (VOLT * duty - KT * GEAR * speed) / OHM;
                speed += 1e-4 * torque / ROTOR / GEAR;
                seen += if filter_s > 0.0 { 1e-4 * (speed - seen) / filter_s } else { speed - seen };
            }
        }
        (run.duty, run.speed) = (vec![duties], vec![speeds]);
        run
    };
    of_files(&text, (0..4).map(run))
}

/// A filter of 20 ms makes nearly twice the inertia of a motor whose own time constant is 22 ms.
#[test]
fn a_filter_on_speeds_is_not_called_inertia_for_sure() {
    let a = steps(1, 0.02);
    // Inertia and delay together are as late as the filter; neither is sure.
    assert_eq!(a.verdict, Verdict::Ambiguous, "{}", a.terminal_summary());
    let said = |r: &&String| r.starts_with("Found from speeds that the log has in place of counts: rotor-inertia");
    let said = a.remarks.iter().find(said).unwrap_or_else(|| panic!("{}", a.terminal_summary()));
    assert!((18..=23).any(|ms| said.contains(&format!("filters them by {ms} ms"))), "{said}");
    let a = steps(1, 0.0);
    assert_eq!((a.verdict, &names(&a)[..]), (Verdict::Agrees, &[][..]), "{}", a.terminal_summary());
    assert!(!a.remarks.iter().any(|r| r.contains("firmware filters")), "{:?}", a.remarks);
}
