//! What an inertial sensor lets the workflow see: detection limits with and without it, controls, and hidden effects
//! with their intervals. Writes `docs/measured/gap-sensor-limits.md` and `gap-sensor-named.md`.

#[allow(dead_code, reason = "shared with the tests")]
#[path = "../tests/sensor/felt.rs"]
mod felt;

use felt::{Hidden, blind, done, estimate, names, numb, sensor, set, truth};
use gap::Analysis;
use measured::Table;
use model::manoeuvre::Manoeuvre::{self, Chirp, Spin};
use runs::DataSet;

const DRIVES: [Manoeuvre; 2] = [Spin, Chirp];
/// Seeds of the limits, of the controls, and of each hidden effect.
const LIMITS: u64 = 2;
const CONTROLS: u64 = 10;
const EACH: u64 = 3;
const COMMAND: &str = "cargo bench -p gap --bench sensor";

/// Effects whose limits a sensor may change: name, parameter, factor to the unit of the table, and that unit.
const ROWS: [(&str, &str, f64, &str); 15] = [
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

fn limits() -> Vec<Vec<String>> {
    let analysed = |of: &dyn Fn(DataSet) -> DataSet| -> Vec<Analysis> {
        (0..LIMITS).map(|k| done(&of(set(&truth(&[], 20 + k), &DRIVES, 20 + k)))).collect()
    };
    let columns = [analysed(&numb), analysed(&|set| set), analysed(&blind)];
    let row = |(name, parameter, factor, unit): &(&str, &str, f64, &str)| {
        let cell = |all: &Vec<Analysis>| {
            let of =
                |a: &Analysis| a.limits.iter().find(|l| l.name == *name && l.parameter == *parameter).map(|l| l.limit);
            let known: Vec<f64> = all.iter().filter_map(of).collect();
            // The worst of the seeds.
            let worst = known.iter().copied().fold(0.0, f64::max);
            if known.len() < all.len() { "–".to_owned() } else { format!("{:.2}", factor * worst) }
        };
        let mut row = vec![format!("{name} `{parameter}`, {unit}")];
        row.extend(columns.iter().map(cell));
        row
    };
    ROWS.iter().map(row).collect()
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
    Table {
        name: "gap-sensor-limits",
        title: "Size named in nine of ten such data sets (a spin and a chirp, worst of 2 seeds), by what the log has",
        command: COMMAND,
        columns: &["effect", "camera", "camera and inertial sensor", "inertial sensor alone"],
    }
    .write(&limits());
    Table {
        name: "gap-sensor-named",
        title: "Hidden in robots with camera and inertial sensor, each with another part of its type: named, and nothing else or in its place",
        command: COMMAND,
        columns: &["hidden", "data sets", "right", "intervals that hold the truth"],
    }
    .write(&named());
}
