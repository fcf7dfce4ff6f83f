//! Motors on a bench, as others log them: speeds in place of counts, a limit of the firmware, an encoder that is decoded
//! otherwise than the file says, a circuit with more resistance.

use gap::thresholds::Thresholds;
use gap::{Analysis, Options, Verdict};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::Run;

use super::common::{names, of_files_by, value, with_dry_friction};
use links::effect::Link;

const VOLT: f64 = 12.0;
const OHM: f64 = 2.2;
const KT: f64 = 0.03;
const INERTIA: f64 = 4e-5;
const DRY_NM: f64 = 0.006;
const COUNTS: f64 = 2000.0;
const KP: f64 = 0.012;
const KI: f64 = 0.08;
/// Seconds a row, and steps of the simulation in one.
const ROW_S: f64 = 0.005;
const STEPS: u32 = 50;

/// A motor as it is, where that is not what the file says, and how it is logged.
#[derive(Clone, Copy)]
struct Bench {
    ohm: f64,
    /// Counts of a turn that come.
    counts: f64,
    /// Largest duty that the firmware gives.
    most: f64,
    /// Gains of the loop; none for duties that are set.
    gains: Option<[f64; 2]>,
    /// Gain of a position loop that makes the set points, 1/s.
    position: Option<f64>,
    /// Inertia of the file, in that of the motor, and dry friction, Nm.
    told: f64,
    dry_nm: f64,
    /// Whether duties are logged with the row after theirs.
    late: bool,
    /// Torque of pushes that come and go, RMS, Nm.
    pushed_nm: f64,
    /// Torque of a weight beside the shaft, Nm.
    weight_nm: f64,
    /// Torque of a fan at 1 rad/s, Nm s²/rad².
    fan_nms2: f64,
    /// Voltage that the bridge takes off against the current, V.
    drop_v: f64,
    /// Speeds of differences, through a filter that takes this share of the new one, in place of counts.
    filtered: Option<f64>,
}

const PLAIN: Bench = Bench {
    ohm: OHM,
    counts: COUNTS,
    most: 1.0,
    gains: Some([KP, KI]),
    position: None,
    told: 1.0,
    dry_nm: DRY_NM,
    late: false,
    pushed_nm: 0.0,
    weight_nm: 0.0,
    fan_nms2: 0.0,
    drop_v: 0.0,
    filtered: None,
};

impl Bench {
    fn run(self, seed: u64) -> Run {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut run = Run { name: format!("run_{seed}"), ..Run::default() };
        let (mut angle, mut speed, mut integral, mut seen) = (0.0, 0.0_f64, 0.0, 0.0);
        let (mut asked, mut set, mut last) = (0.0, 0.0_f64, 0_i64);
        // Eight waves of 0.2 to 2 Hz have four times the square of one's amplitude.
        let waves: Vec<[f64; 2]> = if self.pushed_nm > 0.0 {
            (0..8).map(|_| [rng.random_range(1.2..12.6), rng.random_range(0.0..6.3)]).collect()
        } else {
            Vec::new()
        };
        let (mut counts, mut speeds, mut duties, mut references) = (vec![], vec![], vec![], vec![]);
        for row in 0..2400_u32 {
            if row % 110 == 0 {
                asked = if row < 2200 { rng.random_range(-0.6..0.6) * VOLT / KT } else { 0.0 };
            }
            let count = (angle * self.counts / std::f64::consts::TAU).floor() as i64;
            set = match self.position {
                // Speeds that are asked for in turn stand for angles: a fifth of a second of each.
                Some(gain) => {
                    let to = 0.2 * asked;
                    (1e4 * gain * (to - count as f64 * std::f64::consts::TAU / COUNTS)).round() / 1e4
                }
                None => set + (asked - set).clamp(-8.0, 8.0),
            };
            let measured = (count - last) as f64 / ROW_S * std::f64::consts::TAU / COUNTS;
            last = count;
            seen += self.filtered.unwrap_or(1.0) * (measured - seen);
            let duty: f64 = match self.gains {
                Some([kp, ki]) => {
                    let error = set - measured;
                    let more = integral + ki * ROW_S * error;
                    if (kp * error + more).abs() <= 1.0 || error * (kp * error + more) < 0.0 {
                        integral = more;
                    }
                    kp * error + integral
                }
                None => set * KT / VOLT,
            };
            let duty = (duty.clamp(-self.most, self.most) * 1e5).round() / 1e5;
            run.t.push(f64::from(row) * ROW_S);
            counts.push(count);
            speeds.push((seen * 1e4).round() / 1e4);
            duties.push(duty);
            references.push(set);
            let at = f64::from(row) * ROW_S;
            let pushed = 0.5 * self.pushed_nm * waves.iter().map(|[rate, from]| (rate * at + from).sin()).sum::<f64>();
            for _ in 0..STEPS {
                let load = self.weight_nm * angle.sin() - self.fan_nms2 * speed * speed.abs();
                let volts = VOLT * duty - KT * speed;
                let torque = KT * (volts - volts.clamp(-self.drop_v, self.drop_v)) / self.ohm + pushed + load;
                speed = with_dry_friction(speed, torque, self.dry_nm, INERTIA, ROW_S / f64::from(STEPS));
                angle += speed * ROW_S / f64::from(STEPS);
            }
        }
        if self.late {
            duties.rotate_right(1);
            duties[0] = 0.0;
        }
        run.duty = vec![duties];
        if self.gains.is_some() {
            run.reference = vec![references];
        }
        if self.filtered.is_some() {
            run.speed = vec![speeds];
        } else {
            (run.counts, run.count_gaps) = (vec![counts], vec![Vec::new()]);
        }
        run
    }

    fn told(self, seed: u64) -> Analysis {
        self.told_by(seed, Thresholds::default())
    }

    fn told_by(self, seed: u64, thresholds: Thresholds) -> Analysis {
        let text = format!(
            "encoder_counts_per_motor_rev = {COUNTS}\ngear_ratio = 1\nsupply_v = {VOLT}\nsupport = \"blocks\"\n\
             wheel_radius_m = 1\n[motor]\nresistance_ohm = {OHM}\ntorque_constant = {KT}\nrotor_inertia = {}\n\
             friction_torque = {DRY_NM}\n[pi]\nkp = {KP}\nki = {KI}\n[[wheel]]\nx_m = 0\ny_m = 0\ndrive_deg = 0\n",
            self.told * INERTIA
        );
        of_files_by(&text, (0..4).map(|n| self.run(10 * seed + n)), &Options { thresholds, ..Options::default() })
    }
}

#[test]
fn a_bench_as_its_file_has_it_agrees() {
    for bench in [PLAIN, Bench { gains: None, ..PLAIN }, Bench { filtered: Some(1.0), ..PLAIN }] {
        let a = bench.told(1);
        assert_eq!((a.verdict, &names(&a)[..]), (Verdict::Agrees, &[][..]), "{}", a.terminal_summary());
    }
}

/// A resistance does what an inertia and a friction that are both as much larger do, with one figure in place of two.
#[test]
fn more_resistance_in_the_circuit_is_told() {
    for (seed, scale) in [(2, 0.2), (3, 0.35), (4, -0.2)] {
        let a = Bench { ohm: OHM * (1.0 + scale), gains: None, ..PLAIN }.told(seed);
        let own = names(&a) == ["winding-resistance"];
        assert!(own && (value(&a, "scale") / scale - 1.0).abs() < 0.15, "{scale}: {}", a.terminal_summary());
    }
}

/// The duties follow from the speeds that the log has, or it is not said that no law replays them.
#[test]
fn speeds_in_place_of_counts_stand_for_those_of_the_loop() {
    let compared = |a: &Analysis| a.links.iter().any(|l| l.link == Link::Controller);
    let as_measured = Bench { filtered: Some(1.0), ..PLAIN }.told(5);
    assert!(compared(&as_measured), "{}", as_measured.terminal_summary());
    let filtered = Bench { filtered: Some(0.3), ..PLAIN }.told(5);
    assert!(!compared(&filtered), "{}", filtered.terminal_summary());
    assert!(filtered.unexplained.iter().all(|u| u.link != Link::Controller), "{:?}", filtered.unexplained);
    assert!(filtered.remarks.iter().any(|r| r.starts_with("Controller: not compared")), "{:?}", filtered.remarks);
}

#[test]
fn a_limit_of_the_output_is_said() {
    let a = Bench { most: 0.35, ..PLAIN }.told(6);
    assert_eq!(a.verdict, Verdict::Unexplained, "{}", a.terminal_summary());
    let said = a.unexplained.iter().any(|u| u.structure.contains("duties are limited to 0.350"));
    assert!(said, "{:?}", a.unexplained);
    assert!(names(&a).is_empty(), "{}", a.terminal_summary());
}

/// Ten and twenty times the inertia: the file's motor hardly moves by what the logs give it, whatever its friction, and a
/// weight beside the shaft that bends its speeds a little was named, or nothing.
#[test]
fn a_file_with_far_too_much_inertia_hides_no_friction() {
    for (seed, told) in [(8, 10.0), (9, 20.0)] {
        let a = Bench { told, dry_nm: 0.014, gains: None, ..PLAIN }.told(seed);
        let mut named = names(&a);
        named.sort_unstable();
        assert_eq!(named, ["coulomb-friction", "rotor-inertia"], "{told}: {}", a.terminal_summary());
        for (parameter, truth) in [("scale", 1.0 / told - 1.0), ("torque_nm", 0.014 - DRY_NM)] {
            let mut all = a.effects.iter().flat_map(|e| &e.parameters);
            let within = all.find(|p| p.0 == parameter).and_then(|p| p.2.ends());
            let right = within.is_some_and(|[low, high]| low < truth && truth < high && high - low < 0.5 * truth.abs());
            assert!(right, "{told}: {truth} {}", a.terminal_summary());
        }
    }
}

/// A logger that writes down the duty before the loop has worked out the next one is a row late, and no motor is lighter.
#[test]
fn duties_that_are_logged_a_row_late_are_said_to_be() {
    let a = Bench { gains: None, late: true, ..PLAIN }.told(10);
    assert_eq!(names(&a), ["actuation-latency"], "{}", a.terminal_summary());
    assert!((value(&a, "latency_s") + ROW_S).abs() < 0.1 * ROW_S, "{}", a.terminal_summary());
    assert!(a.remarks.iter().any(|r| r.contains("the log has them 1.0 rows late")), "{:?}", a.remarks);
    let a = Bench { late: true, ..PLAIN }.told(11);
    let order = a.effects.iter().find(|e| e.name == "sample-order").map(|e| e.parameters.clone());
    let of = |name: &str| order.iter().flatten().find(|p| p.0 == name).map(|p| p.1);
    assert_eq!((of("signal"), of("shift_ticks")), (Some(2.0), Some(1.0)), "{}", a.terminal_summary());
}

/// Half the counts: the back-EMF brakes twice as much for what is seen, and twice as much seems to turn.
#[test]
fn an_encoder_that_gives_half_of_its_counts_is_named() {
    let a = Bench { counts: COUNTS / 2.0, gains: None, ..PLAIN }.told(7);
    assert_eq!((names(&a), a.verdict), (vec!["encoder-scale"], Verdict::Ambiguous), "{}", a.terminal_summary());
    assert!((value(&a, "scale") + 0.5).abs() < 0.02, "{}", a.terminal_summary());
    assert!(a.remarks.iter().any(|r| r.contains("Turn the shaft by hand and count")), "{:?}", a.remarks);
}

/// A loop answers pushes of 4 % of what the motor has. Fitted to its duties, a resistance of 30 % more seems 40 % more;
/// by what the set points made of them it is what it is. Without it pushes are left, 15 % of what the motor gave.
#[test]
fn pushes_that_a_loop_answers_are_no_motor() {
    let more = 0.3;
    let bench = Bench { ohm: OHM * (1.0 + more), pushed_nm: 0.04 * KT * VOLT / OHM, ..PLAIN };
    let (by_set_points, by_duties) =
        (bench.told(12), bench.told_by(12, Thresholds { answered: 2.0, ..Thresholds::default() }));
    for a in [&by_set_points, &by_duties] {
        assert_eq!(names(a), ["winding-resistance"], "{}", a.terminal_summary());
    }
    let off = |a: &Analysis| (value(a, "scale") / more - 1.0).abs();
    assert!(off(&by_set_points) < 0.1, "{}", by_set_points.terminal_summary());
    assert!(off(&by_duties) > 0.2, "{}", by_duties.terminal_summary());
    let as_filed = Bench { ohm: OHM, ..bench }.told(13);
    assert_eq!(
        (as_filed.verdict, &names(&as_filed)[..]),
        (Verdict::Unexplained, &[][..]),
        "{}",
        as_filed.terminal_summary()
    );
    for (a, said) in [(&by_set_points, true), (&by_duties, false), (&as_filed, true), (&PLAIN.told(1), false)] {
        let answers = a.remarks.iter().any(|r| r.starts_with("The speed loop answers torques"));
        assert_eq!(answers, said, "{:?}", a.remarks);
    }
}

/// A loop answers a weight as well as pushes, but a weight explains what no answer does.
#[test]
fn a_weight_that_a_loop_answers_has_its_name() {
    let weight_nm = 0.2 * KT * VOLT / OHM;
    let a = Bench { weight_nm, ..PLAIN }.told(14);
    assert_eq!(names(&a), ["gravity-load"], "{}", a.terminal_summary());
    assert!((value(&a, "sin_1_nm") / weight_nm - 1.0).abs() < 0.1, "{}", a.terminal_summary());
}

/// A loop answers small pushes as it does a weight. Beside its answers a weight would be as large as undoes the pushes best: a
/// size that set points say nothing of is judged by the duties.
#[test]
fn a_weight_beside_small_pushes_has_its_size() {
    let stall = KT * VOLT / OHM;
    let weight_nm = 0.2 * stall;
    for (seed, pushed) in [(22, 0.02), (23, 0.02), (24, 0.01)] {
        let a = Bench { weight_nm, pushed_nm: pushed * stall, ..PLAIN }.told(seed);
        let text = a.terminal_summary();
        assert_eq!(names(&a), ["gravity-load"], "{text}");
        let found = value(&a, "sin_1_nm");
        assert!((found / weight_nm - 1.0).abs() < 0.05, "{found} instead of {weight_nm}: {text}");
    }
}

/// Pushes beyond what is noise of a drive, and no name: that is no agreement.
#[test]
fn pushes_beyond_noise_are_no_agreement() {
    let a = Bench { pushed_nm: 0.15 * KT * VOLT / OHM, ..PLAIN }.told(15);
    assert_eq!((a.verdict, names(&a)), (Verdict::Unexplained, Vec::new()), "{}", a.terminal_summary());
    assert!(a.unexplained.iter().any(|u| u.structure.contains("which the speed loops answer")), "{:?}", a.unexplained);
}

/// Viscous friction and a bridge that coasts bend speeds as a fan does, but not as well.
#[test]
fn a_fan_is_no_friction_beside_a_bridge() {
    let fastest = VOLT / KT;
    let stall = KT * VOLT / OHM;
    let fan_nms2 = 0.3 * stall / (fastest * fastest);
    let a = Bench { fan_nms2, ..PLAIN }.told(16);
    assert_eq!(names(&a), ["quadratic-drag"], "{}", a.terminal_summary());
    let found = value(&a, "coefficient_1_nms2");
    assert!((found / fan_nms2 - 1.0).abs() < 0.1, "{found} instead of {fan_nms2}");
}

/// A loop that lets friction stop its axis never brakes: through it, a bridge that swallows small duties does the same.
#[test]
fn duties_that_never_brake_show_friction_or_a_dead_band() {
    let stall = KT * VOLT / OHM;
    let more = 0.08 * stall;
    for (seed, gain, pushed) in [(17, 12.0, 0.01), (18, 12.0, 0.0), (20, 6.0, 0.01)] {
        let bench = Bench { position: Some(gain), dry_nm: DRY_NM + more, pushed_nm: pushed * stall, ..PLAIN };
        let a = bench.told(seed);
        let text = a.terminal_summary();
        assert_eq!((a.verdict, names(&a)), (Verdict::Ambiguous, vec!["coulomb-friction"]), "{text}");
        assert!(a.alternatives.iter().any(|set| set == &["coulomb-friction", "dead-band"]), "{text}");
        let ends = a.effects[0].parameters[0].2.ends().unwrap();
        assert!(ends[0] <= more && more <= ends[1], "{more}: {text}");
    }
}

/// A bridge of transistors that saturate takes volts off while it brakes, too: no dead band of duties, and no friction.
#[test]
fn volts_that_a_bridge_drops_are_named() {
    for (seed, drop_v) in [(21, 1.0), (22, 2.0)] {
        let a = Bench { drop_v, ..PLAIN }.told(seed);
        assert_eq!(names(&a), ["bridge-drop"], "{}", a.terminal_summary());
        let found = value(&a, "drop_v");
        assert!((found / drop_v - 1.0).abs() < 0.1, "{found} instead of {drop_v}");
    }
}
