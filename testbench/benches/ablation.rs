//! Every threshold of the gap workflow off, halved and doubled in turn, on blind sets and on recordings of real machines:
//! writes `docs/measured/ablation.md`.
//!
//! ```sh
//! cargo bench -p testbench --bench ablation -- [--minutes M] [--sets N] [--seed S] [--state FILE]
//! ```
//!
//! Set after set, each with all thresholds; no set is begun after `--minutes`. Every answer stands in the state file as
//! soon as it is known, and an interrupted run goes on from there; after a change of the workflow the file must go.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use gap::options::Options;
use gap::thresholds::Thresholds;
use serde::{Deserialize, Serialize};
use testbench::blind::{Answer, Grade, Group, Plan, Task};
use truth::Conditions;

/// Log rate of the sets, Hz: an analysis takes a quarter of the time it takes at 1 kHz.
const RATE_HZ: f64 = 250.0;
/// Effects of the single sets: of every link that is fitted, and of what passes for another.
const SINGLE: [&str; 14] = [
    "wheel-skew",
    "wheel-radius",
    "encoder-loss",
    "camera-latency",
    "coulomb-friction",
    "viscous-friction",
    "stribeck-friction",
    "torque-constant",
    "robot-mass",
    "battery-sag",
    "dead-band",
    "actuation-latency",
    "gear-backlash",
    "wheel-slip",
];

type Change = fn(&mut Thresholds);

/// A threshold, what becomes of it, and how.
const VARIANTS: &[(&str, &str, Change)] = &[
    ("as shipped", "", |_| ()),
    ("held_share", "halved", |t| t.held_share *= 0.5),
    ("held_share", "doubled", |t| t.held_share *= 2.0),
    ("held_switch", "halved", |t| t.held_switch *= 0.5),
    ("law_share", "off", |t| t.law_share = 0.0),
    ("law_share", "doubled", |t| t.law_share *= 2.0),
    ("law_sigmas", "off", |t| t.law_sigmas = 0.0),
    ("law_sigmas", "doubled", |t| t.law_sigmas *= 2.0),
    ("one", "off", |t| t.one = f64::INFINITY),
    ("alike", "0.9", |t| t.alike = 0.9),
    ("alike", "0.998", |t| t.alike = 0.998),
    ("twin", "off", |t| t.twin = f64::INFINITY),
    ("twin", "doubled", |t| t.twin *= 2.0),
    ("gain", "off", |t| t.gain = 0.0),
    ("gain", "doubled", |t| t.gain *= 2.0),
    ("costs", "halved", |t| t.costs = t.costs.map(|c| 0.5 * c)),
    ("costs", "doubled", |t| t.costs = t.costs.map(|c| 2.0 * c)),
    ("shares", "off", |t| t.shares = [0.0; 2]),
    ("share_of_excess", "off", |t| t.share_of_excess = 0.0),
    ("share_of_excess", "doubled", |t| t.share_of_excess *= 2.0),
    ("held_out_t", "off", |t| t.held_out_t = 0.0),
    ("held_out_t", "doubled", |t| t.held_out_t *= 2.0),
    ("strong", "off", |t| t.strong = f64::INFINITY),
    ("harms", "off", |t| t.harms = f64::INFINITY),
    ("drive_correlation", "1", |t| t.drive_correlation = 1.0),
    ("ties", "off", |t| t.ties = [0.0; 2]),
    ("tied", "off", |t| t.tied = 0.0),
    ("tied", "doubled", |t| t.tied *= 2.0),
    ("doubtful", "off", |t| t.doubtful = 0.0),
    ("near", "halved", |t| t.near = t.near.map(|n| 0.5 * n)),
    ("first", "off", |t| t.first = 0.0),
    ("does_both", "off", |t| t.does_both = 0.0),
    ("hides", "off", |t| t.hides = f64::INFINITY),
    ("open", "off", |t| t.open = f64::INFINITY),
    ("price", "off", |t| t.price = 0.0),
    ("price", "doubled", |t| t.price *= 2.0),
    ("as_good", "1", |t| t.as_good = 1.0),
    ("closes", "off", |t| t.closes = 0.0),
    ("better", "off", |t| t.better = 0.0),
    ("worse", "off", |t| t.worse = f64::INFINITY),
    ("adjusted", "off", |t| t.adjusted = 0.0),
    ("far_left", "off", |t| t.far_left = f64::INFINITY),
    ("far_left", "halved", |t| t.far_left *= 0.5),
    ("as_well", "off", |t| t.as_well = f64::INFINITY),
    ("as_well", "1", |t| t.as_well = 1.0),
    ("undecided", "off", |t| t.undecided = 0.0),
    ("undecided", "doubled", |t| t.undecided *= 2.0),
    ("dwarfs", "off", |t| t.dwarfs = f64::INFINITY),
    ("dwarfs", "halved", |t| t.dwarfs *= 0.5),
    ("from_noise", "off", |t| t.from_noise = f64::INFINITY),
    ("told", "off", |t| t.told = f64::INFINITY),
    ("least_together", "off", |t| t.least_together = 0.0),
    ("least_together", "1", |t| t.least_together = 1.0),
    ("runaway", "off", |t| t.runaway = f64::INFINITY),
    ("cancels", "off", |t| t.cancels = f64::INFINITY),
    ("cancels", "halved", |t| t.cancels *= 0.5),
    ("falls", "off", |t| t.falls = f64::INFINITY),
    ("runs_differ", "off", |t| t.runs_differ = 0.0),
    ("rolling_loses", "off", |t| t.rolling_loses = 0.0),
    ("rolling_loses", "doubled", |t| t.rolling_loses *= 2.0),
    ("warmth", "off", |t| t.warmth = 0.0),
    ("warmth", "doubled", |t| t.warmth *= 2.0),
    ("sticks", "off", |t| t.sticks = f64::INFINITY),
    ("sticks", "halved", |t| t.sticks *= 0.5),
    ("sticks_often", "off", |t| t.sticks_often = f64::INFINITY),
    ("hidden", "off", |t| t.hidden = 1.0),
    ("far", "off", |t| t.far = f64::INFINITY),
    ("matters", "off", |t| t.matters = [0.0; 2]),
    ("explained", "off", |t| t.explained = 0.0),
    ("law_leaves", "off", |t| t.law_leaves = 0.0),
    ("missed", "off", |t| t.missed = [f64::INFINITY; 2]),
    ("blind", "off", |t| t.blind = f64::INFINITY),
    ("seen", "off", |t| t.seen = 0.0),
    ("false_alarm", "off", |t| t.false_alarm = f64::INFINITY),
    ("burst", "off", |t| t.burst = [0.0; 3]),
    ("pushed", "off", |t| t.pushed = [0.0; 2]),
    ("stretch", "off", |t| t.stretch = [0.0; 2]),
    ("line", "off", |t| t.line = [0.0; 3]),
    ("ripple", "off", |t| t.ripple = [0.0; 2]),
    ("ripple", "doubled", |t| t.ripple = t.ripple.map(|r| 2.0 * r)),
    ("bobs", "off", |t| t.bobs = [0.0; 2]),
    ("phases", "off", |t| t.phases = f64::INFINITY),
    ("rattles", "halved", |t| t.rattles = t.rattles.map(|r| 0.5 * r)),
    ("shakes", "off", |t| t.shakes = 0.0),
    ("frozen", "off", |t| t.frozen = 0.0),
    ("torn", "halved", |t| t.torn = t.torn.map(|s| 0.5 * s)),
    ("limited", "off", |t| t.limited[0] = 0.0),
    ("differs", "doubled", |t| t.differs = t.differs.map(|d| 2.0 * d)),
    ("digits", "off", |t| t.digits = 0.0),
    ("removes", "off", |t| t.removes = [0.0; 2]),
    ("left_wrong", "off", |t| t.left_wrong = f64::INFINITY),
    ("no_noise", "off", |t| t.no_noise = f64::INFINITY),
    ("far_open", "off", |t| t.far_open = f64::INFINITY),
    ("far_open", "halved", |t| t.far_open *= 0.5),
    ("stamps", "off", |t| t.stamps = [0.0, f64::NEG_INFINITY]),
    ("rate", "off", |t| t.rate = f64::INFINITY),
    ("foreign", "off", |t| t.foreign = 0.0),
];

/// Data that all variants look at.
enum Set {
    Simulated(Box<Task>),
    Recorded(PathBuf),
}

impl Set {
    fn is_axis(&self) -> bool {
        let groups = [Group::AxisFree, Group::Axis, Group::AxisPair];
        matches!(self, Self::Simulated(task) if groups.contains(&task.group))
    }

    fn name(&self) -> String {
        match self {
            Self::Simulated(task) => format!("{} {}", task.group.name(), task.seed),
            Self::Recorded(path) => path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned()),
        }
    }
}

/// What one variant said of one set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Outcome {
    set: String,
    variant: String,
    /// None for a recording, whose truth nobody knows.
    grade: Option<Grade>,
    said: String,
}

fn options((_, _, change): &(&str, &str, Change)) -> Options {
    let mut options = Options::default();
    change(&mut options.thresholds);
    options
}

fn key((name, how, _): &(&str, &str, Change)) -> String {
    format!("{name} {how}")
}

/// Verdict, names and wheels: what a user acts on.
fn said(answer: &Answer) -> String {
    let mut names: Vec<String> = answer.effects.iter().map(|e| format!("{} {:?}", e.name, e.wheels)).collect();
    names.sort();
    format!("{}: {}", answer.verdict, names.join(", "))
}

/// The answers of all variants to one set, those that are known already left out.
fn answers(set: &Set, known: &BTreeMap<(String, String), Outcome>, keep: &(dyn Fn(Outcome) + Sync)) {
    let open = VARIANTS.iter().filter(|v| !known.contains_key(&(set.name(), key(v)))).collect::<Vec<_>>();
    if open.is_empty() {
        return;
    }
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let outcome =
        |variant: &&(&str, &str, Change), grade, said| Outcome { set: set.name(), variant: key(variant), grade, said };
    match set {
        Set::Simulated(task) => {
            // A robot that cannot be simulated makes no set.
            let Ok(sealed) = task.make(scratch.path()) else { return };
            for variant in open {
                let scored = task.score(&sealed, scratch.path(), &options(variant));
                let said = scored.answer.as_ref().map_or_else(Clone::clone, said);
                keep(outcome(&variant, Some(scored.grade), said));
            }
        }
        Set::Recorded(path) => {
            let data = runs::DataSet::open(path).expect("the recordings of data/real are sound");
            for variant in open {
                let answer = gap::analyse(&data, &options(variant)).map_err(|e| e.to_string());
                let said = match answer.map(|a| Answer::from_json(&a.to_json())) {
                    Ok(answer) => answer.as_ref().map_or_else(String::new, said),
                    Err(why) => why,
                };
                keep(outcome(&variant, None, said));
            }
        }
    }
}

fn read(path: &Path) -> BTreeMap<(String, String), Outcome> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let lines = text.lines().filter_map(|line| serde_json::from_str::<Outcome>(line).ok());
    lines.map(|o| ((o.set.clone(), o.variant.clone()), o)).collect()
}

fn row(variant: &(&str, &str, Change), sets: &[Set], known: &BTreeMap<(String, String), Outcome>) -> Vec<String> {
    let shipped = key(&VARIANTS[0]);
    let of = |set: &Set, variant: &str| known.get(&(set.name(), variant.to_owned()));
    // Only sets that every variant has seen are compared.
    let whole: Vec<&Set> = sets.iter().filter(|s| VARIANTS.iter().all(|v| of(s, &key(v)).is_some())).collect();
    let (simulated, recorded): (Vec<&Set>, Vec<&Set>) = whole.iter().partition(|s| matches!(s, Set::Simulated(_)));
    let (axes, robots): (Vec<&Set>, Vec<&Set>) = simulated.iter().partition(|s| s.is_axis());
    let graded = |wanted: &[Grade]| {
        let own = simulated.iter().filter_map(|s| of(s, &key(variant))?.grade);
        own.filter(|g| wanted.contains(g)).count().to_string()
    };
    let differ = |sets: &[&Set]| {
        let other = |s: &&&Set| of(s, &key(variant)).map(|o| &o.said) != of(s, &shipped).map(|o| &o.said);
        format!("{} of {}", sets.iter().filter(other).count(), sets.len())
    };
    vec![
        if variant.1.is_empty() { variant.0.to_owned() } else { format!("`{}` {}", variant.0, variant.1) },
        graded(&[Grade::Right, Grade::Within]),
        graded(&[Grade::Extra]),
        graded(&[Grade::Partial]),
        graded(&[Grade::Nothing, Grade::Failed]),
        graded(&[Grade::Wrong]),
        differ(&robots),
        differ(&axes),
        differ(&recorded),
    ]
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let value = |name: &str| arguments.iter().position(|a| a == name).map(|at| arguments[at + 1].as_str());
    let number = |name: &str| value(name).map(|text| text.parse::<f64>().unwrap_or_else(|e| panic!("{name}: {e}")));
    let budget = number("--minutes").map(|m| Duration::from_secs_f64(60.0 * m));
    let most = number("--sets").map_or(usize::MAX, |n| n as usize);
    let path = value("--state").map_or_else(|| std::env::temp_dir().join("racbot-ablation.jsonl"), PathBuf::from);
    let seed = number("--seed").map_or(1, |s| s as u64);
    let robots = Plan {
        effect_free: 6,
        single: 1,
        sizes: vec![3, 5],
        only: SINGLE.iter().map(|n| (*n).to_owned()).collect(),
        pairs: 8,
        outside: 6,
        conditions: Conditions { rate_hz: RATE_HZ, ..Conditions::default() },
        ..Plan::new(seed)
    };
    let axes =
        Plan { axes_free: 30, axes: 1, sizes: vec![3, 5], axis_pairs: 24, pair_sizes: vec![4], ..Plan::new(seed) };
    let mut tasks = [robots.tasks(), axes.tasks()].concat();
    // Every kind of set comes early: a run that is cut short says something of each.
    tasks.sort_by_key(|t| t.seed);
    let mut sets: Vec<Set> = tasks.into_iter().take(most).map(|t| Set::Simulated(Box::new(t))).collect();
    let real = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/real");
    let mut folders: Vec<PathBuf> = std::fs::read_dir(&real)
        .expect("data/real is part of the repository")
        .filter_map(|entry| entry.ok().map(|e| e.path()).filter(|p| p.is_dir()))
        .collect();
    // A recording of minutes takes as long as all simulated sets: the shortest early, the others at the end.
    folders.sort_by_key(|folder| bytes(folder));
    let mut recorded = folders.into_iter().map(Set::Recorded);
    let at = sets.len().min(4);
    sets.splice(at..at, recorded.next());
    sets.extend(recorded);
    let known = Mutex::new(read(&path));
    let before = known.lock().expect("no thread has panicked").clone();
    let file = OpenOptions::new().create(true).append(true).open(&path);
    let file: Mutex<File> = Mutex::new(file.unwrap_or_else(|error| panic!("{}: {error}", path.display())));
    let keep = |outcome: Outcome| {
        let line = serde_json::to_string(&outcome).expect("an outcome is plain text");
        writeln!(file.lock().expect("no thread has panicked"), "{line}").expect("the state can be kept");
        let key = (outcome.set.clone(), outcome.variant.clone());
        known.lock().expect("no thread has panicked").insert(key, outcome);
    };
    let (began, next) = (Instant::now(), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(set) = sets.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if budget.is_none_or(|budget| began.elapsed() < budget) {
                        answers(set, &before, &keep);
                        println!("{}: {:.0} s", set.name(), began.elapsed().as_secs_f64());
                    }
                }
            });
        }
    });
    let known = known.into_inner().expect("no thread has panicked");
    let rows: Vec<Vec<String>> = VARIANTS.iter().map(|v| row(v, &sets, &known)).collect();
    rows.iter().for_each(|row| println!("{}", row.join(" | ")));
    let given: Vec<&str> = arguments[1..].iter().map(String::as_str).filter(|a| *a != "--bench").collect();
    measured::Table {
        name: "ablation",
        title: "What the gap workflow says with each of its thresholds off, halved or doubled",
        command: &format!("cargo bench -p testbench --bench ablation -- {}", repeatable(&given).join(" ")),
        columns: &[
            "threshold",
            "right or within",
            "extra",
            "partial",
            "nothing",
            "wrong",
            "robots answered otherwise",
            "axes answered otherwise",
            "recordings answered otherwise",
        ],
    }
    .write(&rows);
}

/// Size of the files of a folder.
fn bytes(folder: &Path) -> u64 {
    let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
    files.filter_map(|file| file.metadata().ok()).map(|m| m.len()).sum()
}

/// Where the state is kept, and how long each of the runs took that filled it, is no part of what was measured.
fn repeatable<'a>(given: &[&'a str]) -> Vec<&'a str> {
    let pairs = given.chunks(2).filter(|pair| !["--state", "--minutes"].contains(&pair[0]));
    pairs.flatten().copied().collect()
}
