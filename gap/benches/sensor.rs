//! What an inertial sensor lets the workflow see: detection limits with and without it, controls, and hidden effects
//! with their intervals. Writes `docs/measured/gap-sensor-limits.md`, `gap-sensor-named.md`, `gap-sensor-drive.md`,
//! `gap-sensor-ties.md` and `gap-sensor-slip.md`; with the last part of one of these names as argument that one alone.

#[allow(dead_code, reason = "shared with the tests")]
#[path = "../tests/sensor/felt.rs"]
mod felt;

use felt::{Hidden, blind, done, estimate, names, numb, sensor, set, truth};
use gap::Analysis;
use measured::Table;
use model::manoeuvre::Manoeuvre::{self, Chirp, Spin, StopAndGo};
use model::plant::{Contact, Creep};
use runs::DataSet;

const DRIVES: [Manoeuvre; 2] = [Spin, Chirp];
/// Seeds of the limits, of the controls, and of each hidden effect.
const LIMITS: u64 = 2;
const CONTROLS: u64 = 10;
const EACH: u64 = 3;
const COMMAND: &str = "cargo bench -p gap --bench sensor";

/// Name, parameter, factor to the unit of the table, and that unit.
type Row = (&'static str, &'static str, f64, &'static str);
/// Drives that push the wheels to what they hold.
const HARD: [Manoeuvre; 3] = [Spin, Chirp, StopAndGo];

/// Effects of the drive whose limits a sensor may change.
const DRIVE_ROWS: [Row; 10] = [
    ("floor-tilt", "x_rad", 57.295_78, "°"),
    ("floor-tilt", "y_rad", 57.295_78, "°"),
    ("robot-mass", "scale", 100.0, "%"),
    ("yaw-inertia", "scale", 100.0, "%"),
    ("centre-of-mass", "x_m", 1e3, "mm"),
    ("centre-of-mass", "y_m", 1e3, "mm"),
    ("torque-constant", "scale", 100.0, "%"),
    ("rotor-inertia", "scale", 100.0, "%"),
    ("coulomb-friction", "torque_nm", 1e3, "mNm"),
    ("viscous-friction", "coefficient_nms", 1e3, "mNm s"),
];

/// Effects whose limits a sensor may change.
const ROWS: [Row; 15] = [
    ("body-radius", "scale", 100.0, "%"),
    ("wheel-radius", "scale_1", 100.0, "%"),
    ("wheel-radius-common", "scale", 100.0, "%"),
    ("wheel-skew", "skew_1_rad", 57.295_78, "°"),
    ("sideways-creep", "scale", 100.0, "%"),
    ("encoder-loss", "loss_1", 100.0, "%"),
    ("encoder-lag", "latency_s", 1e3, "ms"),
    ("camera-latency", "latency_s", 1e3, "ms"),
    ("gyro-scale", "scale", 100.0, "%"),
    ("gyro-bias", "z_rad_s", 57.295_78, "°/s"),
    ("imu-latency", "latency_s", 1e3, "ms"),
    ("imu-mount", "x_rad", 57.295_78, "°"),
    ("imu-mount", "z_rad", 57.295_78, "°"),
    ("imu-mount", "x_m", 1e3, "mm"),
    ("imu-mount", "y_m", 1e3, "mm"),
];

/// A row of limits: the worst of the seeds, or a dash.
fn row((name, parameter, factor, unit): &Row, columns: &[Vec<Analysis>]) -> Vec<String> {
    let cell = |all: &Vec<Analysis>| {
        let of = |a: &Analysis| a.limits.iter().find(|l| l.name == *name && l.parameter == *parameter).map(|l| l.limit);
        let known: Vec<f64> = all.iter().filter_map(of).collect();
        let worst = known.iter().copied().fold(0.0, f64::max);
        if known.len() < all.len() { "–".to_owned() } else { format!("{:.2}", factor * worst) }
    };
    std::iter::once(format!("{name} `{parameter}`, {unit}")).chain(columns.iter().map(cell)).collect()
}

fn limits() -> Vec<Vec<String>> {
    let analysed = |of: &dyn Fn(DataSet) -> DataSet| -> Vec<Analysis> {
        (0..LIMITS).map(|k| done(&of(set(&truth(&[], 20 + k), &DRIVES, 20 + k)))).collect()
    };
    let columns = [analysed(&numb), analysed(&|set| set), analysed(&blind)];
    ROWS.iter().map(|of| row(of, &columns)).collect()
}

/// A hall that holds wheels well, and one on which hard starts make them slip.
const FLOORS: [f64; 2] = [0.9, 0.3];

fn drive_limits() -> Vec<Vec<String>> {
    let analysed = |friction: f64, of: &dyn Fn(DataSet) -> DataSet| -> Vec<Analysis> {
        let hall = |k: u64| {
            let contact = Contact::Friction { friction_coefficient: friction, creep: Creep::at_rest(3e-4) };
            model::effects::Applied { contact, ..truth(&[], 20 + k) }
        };
        (0..LIMITS).map(|k| done(&of(set(&hall(k), &HARD, 20 + k)))).collect()
    };
    let columns: Vec<Vec<Analysis>> =
        FLOORS.iter().flat_map(|friction| [analysed(*friction, &numb), analysed(*friction, &|set| set)]).collect();
    for (k, a) in columns.iter().enumerate() {
        println!("{k}: {:?}", a.iter().map(names).collect::<Vec<_>>());
    }
    DRIVE_ROWS.iter().map(|of| row(of, &columns)).collect()
}

const SLIPPERY: Hidden = ("wheel-slip", &[("friction_coefficient", 0.3)]);

/// What is hidden in the drive, and what the logs have: with the duties, and the camera or not.
const TIES: [(&str, &[Hidden], bool); 10] = [
    ("floor-tilt 1.1° and -0.8°", &[("floor-tilt", &[("x_rad", 0.02), ("y_rad", -0.014)])], true),
    ("floor-tilt 1.1° and -0.8°, no camera", &[("floor-tilt", &[("x_rad", 0.02), ("y_rad", -0.014)])], false),
    ("centre-of-mass 12 and -9 mm", &[("centre-of-mass", &[("x_m", 0.012), ("y_m", -0.009)])], true),
    ("robot-mass +20 %", &[("robot-mass", &[("scale", 0.2)])], true),
    ("torque-constant -12 %", &[("torque-constant", &[("scale", -0.12)])], true),
    ("coulomb-friction 10 mNm", &[("coulomb-friction", &[("torque_nm", 0.01)])], true),
    ("wheel-slip 0.25", &[("wheel-slip", &[("friction_coefficient", 0.25)])], true),
    ("wheel-slip 0.3 and robot-mass +20 %", &[SLIPPERY, ("robot-mass", &[("scale", 0.2)])], true),
    ("wheel-slip 0.3 and torque-constant -12 %", &[SLIPPERY, ("torque-constant", &[("scale", -0.12)])], true),
    ("wheel-slip 0.25, no camera", &[("wheel-slip", &[("friction_coefficient", 0.25)])], false),
];

fn ties() -> Vec<Vec<String>> {
    let said = |a: &Analysis| {
        let ties: Vec<String> = a.alternatives.iter().map(|set| set.join(" + ")).collect();
        let named = if names(a).is_empty() { "nothing".to_owned() } else { names(a).join(", ") };
        if ties.is_empty() { named } else { format!("{named} ({})", ties.join("; ")) }
    };
    let case = |(what, hidden, seen): &(&str, &[Hidden], bool)| {
        let of = |k: u64| {
            let data = set(&truth(hidden, 80 + k), &HARD, 80 + k);
            if *seen { data } else { blind(data) }
        };
        let cell = |felt: bool| {
            let mut all: Vec<String> =
                (0..LIMITS).map(|k| said(&done(&if felt { of(k) } else { numb(of(k)) }))).collect();
            all.dedup();
            all.join(" / ")
        };
        vec![(*what).to_owned(), cell(false), cell(true)]
    };
    TIES.iter().map(case).collect()
}

/// Of how many sets with an effect of one and a half times its limit it is named.
const SLIP_SETS: u64 = 10;
const BEYOND: f64 = 1.5;

/// Effect, parameter, sign of what is hidden, and whether the log has the sensor's columns.
const SLIP_ROWS: [(&str, &str, f64, bool); 3] =
    [("robot-mass", "scale", 1.0, true), ("robot-mass", "scale", 1.0, false), ("torque-constant", "scale", -1.0, true)];

fn slip() -> Vec<Vec<String>> {
    let of = |hidden: &[Hidden], k: u64, felt: bool| {
        let data = set(&truth(hidden, k), &HARD, k);
        done(&if felt { data } else { numb(data) })
    };
    let row = |&(effect, parameter, sign, felt): &(&str, &str, f64, bool)| {
        let limit = |a: &Analysis| a.limits.iter().find(|l| l.name == effect).map_or(f64::NAN, |l| l.limit);
        let limit = (0..LIMITS).map(|k| limit(&of(&[SLIPPERY], 20 + k, felt))).fold(0.0, f64::max);
        let size = BEYOND * limit;
        let hidden = [(parameter, sign * size)];
        let found = |k: &u64| names(&of(&[SLIPPERY, (effect, &hidden)], 80 + k, felt)).contains(&effect);
        let named = (0..SLIP_SETS).filter(found).count();
        let logs = if felt { "camera and inertial sensor" } else { "camera" };
        vec![
            effect.to_owned(),
            logs.to_owned(),
            format!("{:.1}", 100.0 * limit),
            format!("{:+.1}", 100.0 * sign * size),
            format!("{named} of {SLIP_SETS}"),
        ]
    };
    SLIP_ROWS.iter().map(row).collect()
}

/// Parameters, and their true values for a part.
type Truths = Vec<(&'static str, f64)>;

/// A hidden effect, the parameters whose intervals are to hold the truth, and that truth with the part's tolerances.
struct Case {
    what: &'static str,
    hidden: &'static [Hidden<'static>],
    /// Whether the log has the sensor's columns.
    felt: bool,
    truths: fn(u64, &'static [Hidden<'static>]) -> Truths,
}

const CASES: [Case; 6] = [
    Case {
        what: "gyro-scale +4 %",
        hidden: &[("gyro-scale", &[("scale", 0.04)])],
        felt: true,
        truths: |part, hidden| vec![("scale", sensor(&truth(hidden, part)).gyro_errors()[0][2])],
    },
    Case {
        what: "gyro-bias 3.4 °/s about z",
        hidden: &[("gyro-bias", &[("z_rad_s", 0.06)])],
        felt: true,
        truths: |part, hidden| vec![("z_rad_s", sensor(&truth(hidden, part)).gyro_errors()[1][2])],
    },
    Case {
        what: "imu-latency 10 ms",
        hidden: &[("imu-latency", &[("latency_s", 0.01)])],
        felt: true,
        truths: |_, _| vec![("latency_s", 0.01)],
    },
    Case {
        what: "imu-mount 25 and -20 mm",
        hidden: &[("imu-mount", &[("x_m", 0.025), ("y_m", -0.02)])],
        felt: true,
        truths: |_, _| vec![("x_m", 0.025), ("y_m", -0.02)],
    },
    Case {
        what: "encoder-lag 20 ms, without the sensor's columns",
        hidden: &[("encoder-lag", &[("latency_s", 0.02)])],
        felt: false,
        truths: |_, _| vec![("latency_s", 0.02)],
    },
    Case {
        what: "encoder-lag 20 ms",
        hidden: &[("encoder-lag", &[("latency_s", 0.02)])],
        felt: true,
        truths: |_, _| vec![("latency_s", 0.02)],
    },
];

fn named() -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    let quiet = (0..CONTROLS).filter(|k| names(&done(&set(&truth(&[], 40 + k), &DRIVES, 40 + k))).is_empty()).count();
    rows.push(vec!["nothing".to_owned(), CONTROLS.to_string(), quiet.to_string(), "–".to_owned()]);
    for case in &CASES {
        let name = case.hidden[0].0;
        let (mut alone, mut held, mut all) = (0, 0, 0);
        for k in 0..EACH {
            let part = 60 + k;
            let data = set(&truth(case.hidden, part), &DRIVES, part);
            let a = done(&if case.felt { data } else { numb(data) });
            alone += usize::from(names(&a) == [name] && a.alternatives.is_empty());
            for (parameter, truth) in (case.truths)(part, case.hidden) {
                let (_, [low, high]) = estimate(&a, parameter);
                held += usize::from((low..=high).contains(&truth));
                all += 1;
            }
        }
        rows.push(vec![case.what.to_owned(), EACH.to_string(), alone.to_string(), format!("{held} of {all}")]);
    }
    rows
}

fn main() {
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let asked: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let wanted = |name: &str| asked.is_empty() || asked.iter().any(|a| a == name);
    if wanted("drive") {
        Table {
            name: "gap-sensor-drive",
            title: "Size of the drive's effects named in nine of ten such data sets (a spin, a chirp, hard starts; worst of 2 seeds), by what the log has and what the floor holds",
            command: COMMAND,
            columns: &[
                "effect",
                "friction 0.9, camera",
                "camera and inertial sensor",
                "friction 0.3, camera",
                "camera and inertial sensor",
            ],
        }
        .write(&drive_limits());
    }
    if wanted("ties") {
        Table {
            name: "gap-sensor-ties",
            title: "What is said of effects of the drive with and without the sensor's columns, 2 seeds; ties in brackets",
            command: COMMAND,
            columns: &["hidden", "without sensor", "with sensor"],
        }
        .write(&ties());
    }
    if wanted("slip") {
        Table {
            name: "gap-sensor-slip",
            title: "Effects of the drive beside wheels that slip at friction 0.3, hidden at one and a half times their limit",
            command: COMMAND,
            columns: &["effect", "log", "limit (worst of 2 seeds), %", "hidden, %", "named"],
        }
        .write(&slip());
    }
    if wanted("limits") {
        Table {
        name: "gap-sensor-limits",
        title: "Size named in nine of ten such data sets (a spin and a chirp, worst of 2 seeds), by what the log has",
        command: COMMAND,
        columns: &["effect", "camera", "camera and inertial sensor", "inertial sensor alone"],
    }
    .write(&limits());
    }
    if wanted("named") {
        Table {
        name: "gap-sensor-named",
        title: "Hidden in robots with camera and inertial sensor, each with another part of its type: named, and nothing else or in its place",
        command: COMMAND,
        columns: &["hidden", "data sets", "right", "intervals that hold the truth"],
    }
    .write(&named());
    }
}
