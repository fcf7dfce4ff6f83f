//! Runs recorded over the card, by a host that wakes up late now and then: the gap workflow replays set points
//! and duties to the last bit, and finds the one word that is wrong.

use driver::Board;
use driver::drive::{Ending, Plan};
use driver::realtime::Clock;
use driver::recording::{Recording, logged_robot};
use fixed_kin::speed::SpeedMode;
use gap::{Analysis, Options, Verdict};
use links::effect::Link;
use model::effects::Applied;
use model::trajectory::SetPoint;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::output::Existing;
use runs::robot::{Effect, EffectParameter, Robot};
use runs::{DataSet, Layout};
use simulator::fpga::BitTrue;
use simulator::replay::{Part, replay};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;
use testbench::faults::Rig;

/// A host that oversleeps by some milliseconds now and then.
struct Sleepy {
    rig: Rig,
    /// Of a hundred wake-ups.
    late: u32,
    random: ChaCha8Rng,
}

impl Clock for Sleepy {
    fn now(&mut self) -> Duration {
        self.rig.now()
    }

    fn sleep_until(&mut self, at: Duration) {
        let over =
            if self.random.random_range(0..100) < self.late { self.random.random_range(1_500..20_000) } else { 0 };
        self.rig.sleep_until(at + Duration::from_micros(over));
    }
}

/// Drives a square and records it, with a camera where nobody is late: a pose is logged when the host wakes up,
/// and the jitter of its stamps would rightly be found. Gives the ticks that the host missed.
fn record(robot: &Robot, speed_mode: SpeedMode, late: u32, file: &Path) -> u64 {
    let point = |x, y, stop| SetPoint { x, y, v: 1.0, omega: 1.0, stop, heading: None };
    let points = [point(1.0, 0.0, false), point(1.0, 1.0, false), point(0.0, 1.0, true), point(0.0, 0.0, true)];
    let actual = Applied::of(robot).robot;
    let rig = Rig::new(&actual, Rig::nominal_clock_hz(), None).unwrap();
    let mut plan = Plan::new(robot, &points);
    plan.settings.speed_mode = speed_mode;
    let mut recording = Recording::start(file, Layout::of_robot(3, late == 0), Existing::Refuse).unwrap();
    recording.wait_where_full();
    let (mut clock, mut camera) =
        (Sleepy { rig: rig.clone(), late, random: ChaCha8Rng::seed_from_u64(1) }, rig.clone());
    let clock_hz = Rig::nominal_clock_hz();
    let never = AtomicBool::new(false);
    let driven = plan.drive(Board::new(rig), &mut clock, clock_hz, &mut camera, Some(&mut recording), &never).unwrap();
    assert!(matches!(driven.ending, Ending::Finished), "{:?}", driven.ending);
    recording.finish().unwrap();
    let scale = plan.scale(clock_hz).unwrap();
    logged_robot(&plan.believed(), &scale, &plan.settings).save(file.with_file_name("robot.toml")).unwrap();
    driven.unseen
}

fn analyse(folder: &Path) -> (DataSet, Analysis) {
    let set = DataSet::open(folder).unwrap();
    let analysis = gap::analyse(&set, &Options::default()).unwrap();
    (set, analysis)
}

/// Words compared and different, and ticks missing, of a link.
fn replayed(analysis: &Analysis, link: Link) -> (usize, usize, u64) {
    let found = analysis.exact.iter().find(|l| l.link == link).and_then(|l| l.replay.as_ref());
    let r = found.unwrap_or_else(|| panic!("{link:?} was not replayed: {:?}", analysis.remarks));
    (r.compared, r.different, r.missing)
}

#[test]
fn both_speed_modes_are_replayed_to_the_last_bit_behind_missed_ticks() {
    for (mode, name) in [(SpeedMode::Difference, "a.csv"), (SpeedMode::CountAndTime, "b.mcap")] {
        let folder = tempfile::tempdir().unwrap();
        let unseen = record(&Robot::racbot(), mode, 1, &folder.path().join(name));
        assert!(unseen > 200, "{unseen}");
        let (set, analysis) = analyse(folder.path());
        let rows = set.runs[0].len();
        let summary = analysis.terminal_summary();
        println!("{}", analysis.remarks.join("\n"));
        let (words, different, missing) = replayed(&analysis, Link::Controller);
        // Of every gap, a row tells the integrators; all others are compared.
        assert!(words > 3 * (rows - unseen as usize) && different == 0, "{words} words of {rows} rows\n{summary}");
        assert!(missing <= unseen && missing + 5 > unseen, "{missing} of {unseen}");
        let (words, different, _) = replayed(&analysis, Link::Command);
        assert_eq!((words, different), (3 * rows, 0), "{summary}");
        assert_eq!(analysis.verdict, Verdict::Agrees, "{summary}");

        // Through the FPGA itself, whose integrators are told by the duties after every gap.
        let through = replay(BitTrue::new(), &set.robot, &set.runs[0], Part::default(), |_| {}).unwrap();
        if mode == SpeedMode::Difference {
            assert!(through.gaps.pauses > 20 && through.gaps.missing == missing, "{:?}", through.gaps);
            for wheel in &through.wheels {
                // The decimals of the log, a hundredth of a word.
                assert!(wheel.fpga.max < 1e-9, "{wheel:?}");
                assert!(wheel.fpga.ticks + 3 * through.gaps.pauses > rows, "{wheel:?} of {rows}");
            }
        } else {
            assert!(through.skipped.is_some());
        }

        // Without the measured speeds, counts will do where the loop had nothing else.
        let mut bare = set.clone();
        bare.runs[0].measured.clear();
        let analysis = gap::analyse(&bare, &Options::default()).unwrap();
        if mode == SpeedMode::Difference {
            let (words, different, _) = replayed(&analysis, Link::Controller);
            assert!(words > 3 * (rows - 2 * unseen as usize) && different == 0, "{words}");
        } else {
            assert!(analysis.exact.iter().all(|l| l.link != Link::Controller));
            assert!(analysis.remarks.iter().any(|r| r.contains("meas_1..")), "{:?}", analysis.remarks);
        }
    }
}

#[test]
fn one_word_with_one_bit_changed_is_found_with_its_time() {
    let folder = tempfile::tempdir().unwrap();
    record(&Robot::racbot(), SpeedMode::Difference, 1, &folder.path().join("run.csv"));
    let (set, _) = analyse(folder.path());
    let row = (1_500..).find(|k| set.runs[0].duty[1][*k].abs() > 0.05).unwrap();
    let changed = |signal: &mut f64, lsb: f64| *signal += lsb;
    let check = |set: &DataSet, link: Link, name: &str| {
        let analysis = gap::analyse(set, &Options::default()).unwrap();
        let (_, different, _) = replayed(&analysis, link);
        assert_eq!((different, analysis.verdict), (1, Verdict::Unexplained), "{}", analysis.terminal_summary());
        let structure = &analysis.unexplained.iter().find(|u| u.link == link).unwrap().structure;
        let place = format!("{name}: 1 of ");
        assert!(
            structure.contains(&place) && structure.contains(&format!("at {:.4} s", set.runs[0].t[row])),
            "{structure}"
        );
        assert!(analysis.located.iter().any(|l| l.link == link && l.signal == name), "{:?}", analysis.located);
    };
    let mut duty = set.clone();
    changed(&mut duty.runs[0].duty[1][row], 2_f64.powi(-24));
    check(&duty, Link::Controller, "duty_2");
    // The integrator ran on another set point than is logged: set point and duty disagree with the log, once.
    let mut reference = set.clone();
    changed(&mut reference.runs[0].reference[2][row], set.robot.ref_quantum.unwrap());
    check(&reference, Link::Command, "ref_3");
}

#[test]
fn effects_that_the_card_was_told_are_in_its_words_and_not_found_again() {
    let skew = EffectParameter { value: 0.07, ..EffectParameter::default() };
    let effect = Effect {
        name: "wheel-skew".to_owned(),
        parameters: vec![("skew_1_rad".to_owned(), skew)],
        ..Effect::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let robot = Robot { effects: vec![effect], ..Robot::racbot() };
    record(&robot, SpeedMode::CountAndTime, 0, &folder.path().join("run.csv"));
    let (set, analysis) = analyse(folder.path());
    assert!(set.robot.effects.is_empty());
    assert_eq!(analysis.verdict, Verdict::Agrees, "{}", analysis.terminal_summary());
    assert_eq!(replayed(&analysis, Link::Command).1, 0);
}

/// As the drive under QEMU, whose card is compiled Verilog in frozen time.
#[test]
fn a_slow_loop_is_replayed_as_well() {
    let folder = tempfile::tempdir().unwrap();
    let mut robot = Robot { control_rate_hz: 40.0, ..Robot::racbot() };
    robot.pi.ki = 0.4;
    record(&robot, SpeedMode::Difference, 1, &folder.path().join("run.csv"));
    let (_, analysis) = analyse(folder.path());
    let (words, different, _) = replayed(&analysis, Link::Controller);
    assert!(words > 500 && different == 0, "{words} {different}: {}", analysis.terminal_summary());
    assert_eq!(replayed(&analysis, Link::Command).1, 0);
}
