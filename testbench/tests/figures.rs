//! No figure is copied into a document by hand: what was measured is included from `docs/measured/`, what is set says where
//! the code sets it, and README's table is written from the measured ones.
//!
//! `RACBOT_MEASURED=write cargo test --release -p testbench --test figures` rewrites README's table.

use std::fs;
use testbench::repository;

/// Units that make a number a figure.
const UNITS: [&str; 39] = [
    "%", "×", "°", "°/m", "ns", "µs", "us", "ms", "s", "minutes", "hours", "mm", "cm", "m", "km", "Hz", "kHz", "MHz",
    "GHz", "V", "A", "Nm", "mNm", "N", "kg", "g", "m/s", "m/s²", "rad", "mrad", "kB", "MB", "GB", "clocks", "ticks",
    "LUTs", "slices", "LSB", "seconds",
];

/// Figures that are set, not measured: page, figure, the file that sets it, and how it stands there.
const SET: [(&str, &str, &str, &str); 69] = [
    ("bitstream.md", "100 MHz", "bitstream/src/flow/timing/delays.rs", "the 100 MHz domains of 19 files"),
    ("bitstream.md", "33.3 MHz", "fixed-kin/src/registers/map.rs", "NOMINAL_CLOCK_HZ: u32 = 33_333_333"),
    ("bitstream.md", "500,000 clocks", "testbench/tests/bitstream_circuit.rs", "const CLOCKS: usize = 500_000"),
    ("gap.md", "0.2 ms", "testbench/engine/mechanics.py", "STEP_S = 0.0002"),
    ("gap.md", "20 ms", "testbench/truth/src/axis/draw.rs", "[0.001, 0.002, 0.005, 0.01, 0.02]"),
    ("gap.md", "0.8 %", "gap/src/thresholds.rs", "warmth: f64 = 0.008"),
    ("gap.md", "2 %", "gap/src/thresholds.rs", "rolling_loses: f64 = 0.02"),
    ("gap.md", "30 %", "gap/src/thresholds.rs", "undecided: f64 = 0.3"),
    ("gap.md", "95 %", "gap/src/evidence.rs", "95 % confidence interval"),
    ("introduction.md", "210°", "runs/src/geometry.rs", "[90.0_f64, 210.0, 330.0]"),
    ("introduction.md", "330°", "runs/src/geometry.rs", "[90.0_f64, 210.0, 330.0]"),
    ("introduction.md", "90°", "runs/src/geometry.rs", "[90.0_f64, 210.0, 330.0]"),
    ("serve.md", "0.26 m/s²", "ssl/src/ball.rs", "ROLLING: f64 = 0.26"),
    ("serve.md", "1 ms", "ssl/src/trigger.rs", "SPEED_PER_PULSE: f64 = 1000.0"),
    ("serve.md", "1 s", "ssl/src/robot.rs", "const CHARGE_S: f64 = 1.0"),
    ("serve.md", "10 m/s", "ssl/src/trigger.rs", "SPEED_PER_PULSE: f64 = 1000.0"),
    ("serve.md", "100 ms", "ssl/src/pilot.rs", "SILENCE_S: f64 = 0.1"),
    ("serve.md", "3 m/s²", "ssl/src/ball.rs", "SLIDING: f64 = 3.0"),
    ("serve.md", "4 m/s²", "ssl/src/contact.rs", "and 4 m/s² are more than"),
    ("serve.md", "46 g", "ssl/src/ball.rs", "MASS: f64 = 0.046"),
    ("serve.md", "75°", "ssl/src/front.rs", "STEEPEST: f32 = 75.0"),
    ("serve.md", "80 %", "model/src/trajectory/limits.rs", "SPEED_SHARE: f64 = 0.8"),
    ("course.md", "10.2 ms", "fixed-kin/src/kicker.rs", "MAXIMUM_PULSE_US as u32 * MICROSECOND_CLOCKS[1]"),
    ("driving.md", "100 ms", "driver/src/recording/writer.rs", "FLUSH_EVERY: Duration = Duration::from_millis(100)"),
    ("driving.md", "50 ms", "driver/src/board/state.rs", "watchdog_s: 0.05"),
    ("driving.md", "30 ms", "driver/src/board/state.rs", "set_point_s: 0.03"),
    ("driving.md", "0.2 s", "driver/src/board/state.rs", "stall_s: 0.2"),
    ("driving.md", "50 MHz", "hdl/src/board.rs", "Crystal oscillator, 50 MHz"),
    ("driving.md", "340,000 clocks", "fixed-kin/src/kicker.rs", "MAXIMUM_PULSE_US as u32 * MICROSECOND_CLOCKS[1]"),
    ("driving.md", "10.2 ms", "fixed-kin/src/kicker.rs", "MAXIMUM_PULSE_US: u16 = 10_000"),
    ("evidence.md", "4,000,000 clocks", "testbench/tests/cosim_local_bus.rs", "4_000_000"),
    ("evidence.md", "1,500,000 clocks", "hdl/tests/blocks_radio.rs", "1_500_000"),
    ("evidence.md", "2,500 ticks", "hdl/tests/sequencer.rs", "scenario(8, ticks / 4)"),
    ("evidence.md", "120 ticks", "testbench/tests/core_backends.rs", "{ 5 } else { 60 }"),
    ("evidence.md", "40 ticks", "testbench/tests/open_board.rs", "const TICKS: usize = 40"),
    ("evidence.md", "20,000,000 clocks", "testbench/tests/core_short_tick.rs", "CLOCKS: u64 = 20_000_000"),
    ("evidence.md", "3,300 ticks", "testbench/tests/core_backends.rs", "compare(Kind::Verilog, 8_000.0, 1_500)"),
    ("evidence.md", "400 ticks", "testbench/tests/netlist.rs", "const TICKS: usize = 400"),
    ("evidence.md", "8 kHz", "testbench/tests/core_backends.rs", "Kind::RustHdl, 8_000.0"),
    ("evidence.md", "34 clocks", "fixed-kin/src/kicker.rs", "MICROSECOND_CLOCKS: [u32; 2] = [25, 34]"),
    ("evidence.md", "30 mm", "testbench/src/faults/judge.rs", "OFF_TRACK_M: f64 = 0.03"),
    ("evidence.md", "52 ms", "testbench/src/faults/judge.rs", "WATCHDOG: Duration = Duration::from_millis(52)"),
    ("evidence.md", "1.5 s", "testbench/src/faults/judge.rs", "SLOW: Duration = Duration::from_millis(1_500)"),
    ("evidence.md", "10 minutes", "model/tests/fuzz.rs", "RACBOT_FUZZ_S=600"),
    ("gateware.md", "33.33 MHz", "fixed-kin/src/registers/map.rs", "NOMINAL_CLOCK_HZ: u32 = 33_333_333"),
    ("open-board.md", "40 ticks", "testbench/tests/open_board.rs", "const TICKS: usize = 40"),
    ("open-board.md", "33.33 MHz", "fixed-kin/src/registers/map.rs", "NOMINAL_CLOCK_HZ: u32 = 33_333_333"),
    ("open-board.md", "33 MHz", "fixed-kin/src/registers/map.rs", "clock_hz: 33_000_000"),
    ("open-board.md", "12 MHz", "hdl/src/emit/open_board.rs", "12 MHz · 88 / 32 = 33 MHz"),
    ("radio.md", "33.33 MHz", "fixed-kin/src/registers/map.rs", "NOMINAL_CLOCK_HZ: u32 = 33_333_333"),
    ("radio.md", "50 ms", "driver/src/board/state.rs", "watchdog_s: 0.05"),
    ("radio.md", "10 ms", "driver/src/radio/base_station.rs", "PERIOD: Duration = Duration::from_millis(10)"),
    ("log-format.md", "30 s", "model/src/manoeuvre.rs", "run.duration_s() < 30.0"),
    ("log-format.md", "90°", "runs/src/geometry.rs", "[90.0_f64, 210.0, 330.0]"),
    ("log-format.md", "210°", "runs/src/geometry.rs", "[90.0_f64, 210.0, 330.0]"),
    ("log-format.md", "330°", "runs/src/geometry.rs", "[90.0_f64, 210.0, 330.0]"),
    ("smartbot.md", "16.7 MHz", "fixed-kin/src/registers/map.rs", "16.7, 8.3, 5.6, 4.2 MHz at the nominal clock"),
    ("smartbot.md", "970 clocks", "docs/measured/proofs.md", "over 970 clocks after the tick"),
    ("smartbot.md", "0.2 s", "driver/src/imu/mod.rs", "REST_TIME: Duration = Duration::from_millis(200)"),
    ("smartbot.md", "0.4 m", "simulator/src/blackout.rs", "STAND_OFF: f64 = 0.4"),
    ("smartbot.md", "10 ms", "simulator/src/eye.rs", "EXPOSURE_S: f64 = 0.01"),
    ("smartbot.md", "50 ms", "simulator/src/eye.rs", "latency_s: 0.05"),
    ("smartbot.md", "50 mm", "simulator/src/blackout.rs", "REACHED: f64 = 0.05"),
    ("smartbot.md", "14 mm", "simulator/src/blackout.rs", "NEEDED: f64 = (REACHED - CLOSE) / 2.45"),
    ("smartbot.md", "0.8 m", "vision/src/localise/outlook.rs", "WAY: f64 = 0.8"),
    ("smartbot.md", "7 %", "driver/src/drive/sure.rs", "ASTRAY: f64 = 0.07"),
    ("smartbot.md", "4°", "driver/src/drive/sure.rs", "wheels that are all skewed by 4°"),
    ("smartbot.md", "80 mm", "vision/src/onboard.rs", "SURE: [f64; 2] = [0.08, 0.08]"),
    ("smartbot.md", "4.6°", "vision/src/onboard.rs", "SURE: [f64; 2] = [0.08, 0.08]"),
];

/// README's four figures: what is said of them, the table, its row (by the first cell), and the columns.
const README: [(&str, &str, &str, &[&str]); 4] = [
    (
        "whole chip, emitted Verilog, against its fixed-point twin: clocks, differences",
        "campaign",
        "",
        &["clocks", "differences"],
    ),
    ("slices of the XC2S200 that the gateware takes, of", "bitstream-resources", "slices", &["used", "of"]),
    ("drives with one fault each, violations of what is promised", "fault-campaign", "all", &["cases", "violations"]),
    (
        "the control loop on a simulated robot, with controller, odometry, camera and log",
        "speeds",
        "the same with controller, odometry, camera and log",
        &["ratio"],
    ),
];

fn read(path: &str) -> String {
    fs::read_to_string(repository().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// A document without code, links' targets and included tables.
fn prose(text: &str) -> String {
    let blocks: String = text.split("```").step_by(2).collect();
    let lines = blocks.lines().filter(|line| !line.starts_with("{{#include"));
    let text = lines.collect::<Vec<_>>().join("\n");
    let text: String = text.split('`').step_by(2).collect::<Vec<_>>().join(" ");
    text.split("](")
        .enumerate()
        .map(|(n, part)| if n == 0 { part } else { part.split_once(')').map_or("", |p| p.1) })
        .collect()
}

/// Numbers with a unit after them, as written, but on one line.
fn figures(text: &str) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let trim = |word: &str| -> String {
        word.trim_matches(|c: char| !c.is_alphanumeric() && !"%°²×/".contains(c)).to_owned()
    };
    let is_number = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_digit()) && word.chars().all(|c| c.is_ascii_digit() || ".,".contains(c))
    };
    let mut found = Vec::new();
    for (n, word) in words.iter().enumerate() {
        // "3 ms", "3 million clocks", and "3°" or "3%" in one.
        let word = trim(word);
        let next = |k: usize| words.get(n + k).map(|w| trim(w)).unwrap_or_default();
        let is_unit = |word: &str| UNITS.contains(&word);
        if is_number(&word) {
            let (one, two) = (next(1), next(2));
            if is_unit(&one) {
                found.push(format!("{word} {one}"));
            } else if is_unit(&two) && ["million", "thousand"].contains(&one.as_str()) {
                found.push(format!("{word} {one} {two}"));
            }
        } else if let Some(split) = word.find(|c: char| !c.is_ascii_digit() && !".,".contains(c))
            && split > 0
            && is_unit(&word[split..])
        {
            found.push(word);
        }
    }
    found
}

/// Rows of a measured table as cells, the head first.
fn table(name: &str) -> Vec<Vec<String>> {
    let text = read(&format!("docs/measured/{name}.md"));
    let rows = text.lines().filter(|line| line.starts_with('|') && !line.starts_with("|---"));
    rows.map(|row| row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()).collect()
}

fn cells(name: &str, row: &str, columns: &[&str]) -> String {
    let rows = table(name);
    let found = if row.is_empty() { rows.get(1) } else { rows.iter().find(|cells| cells[0] == row) };
    let found = found.unwrap_or_else(|| panic!("docs/measured/{name}.md has no row {row:?}"));
    let cell = |column: &&str| {
        let at = rows[0].iter().position(|head| head == *column);
        found[at.unwrap_or_else(|| panic!("docs/measured/{name}.md has no column {column:?}"))].clone()
    };
    columns.iter().map(cell).collect::<Vec<_>>().join(", ")
}

#[test]
fn the_readme_shows_what_was_measured() {
    let rows = README.iter().map(|(what, name, row, columns)| {
        format!("| {what} | {} | [table](docs/measured/{name}.md) |\n", cells(name, row, columns))
    });
    let (begin, end) = ("<!-- from docs/measured, by testbench/tests/figures.rs -->\n", "<!-- to here -->");
    let expected = format!("{begin}| measured | | |\n|---|---|---|\n{}{end}", rows.collect::<String>());
    let text = read("README.md");
    let (before, rest) = text.split_once(begin).expect("README has the mark where its figures begin");
    let (_, after) = rest.split_once(end).expect("README has the mark where its figures end");
    let right = format!("{before}{expected}{after}");
    if std::env::var_os("RACBOT_MEASURED").is_some_and(|value| value == "write") {
        fs::write(repository().join("README.md"), right).unwrap();
        return;
    }
    assert!(
        text == right,
        "README's figures are old: RACBOT_MEASURED=write cargo test --release -p testbench --test figures"
    );
}

#[test]
fn no_document_has_a_figure_of_its_own() {
    let mut pages: Vec<String> = fs::read_dir(repository().join("docs/book/src"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".md"))
        .collect();
    pages.sort();
    let mut own = Vec::new();
    for page in pages.iter().map(|page| format!("docs/book/src/{page}")).chain(["README.md".to_owned()]) {
        let text = read(&page);
        let name = page.rsplit('/').next().unwrap();
        // README's own table comes from docs/measured.
        let text =
            text.split("<!-- from").next().unwrap().to_owned() + text.split("<!-- to here -->").nth(1).unwrap_or("");
        for figure in figures(&prose(&text)) {
            if !SET.iter().any(|(page, set, ..)| *page == name && *set == figure) {
                own.push(format!("{page}: {figure}"));
            }
        }
    }
    assert!(
        own.is_empty(),
        "figures by hand; include a table of docs/measured, link to it, or say in SET where the code sets them:\n{}",
        own.join("\n")
    );
}

#[test]
fn what_is_set_stands_where_it_is_said_to() {
    for (page, figure, file, text) in SET {
        assert!(read(file).contains(text), "{page}: {figure}: {file} no longer says {text:?}");
        let page = format!("docs/book/src/{page}");
        assert!(figures(&prose(&read(&page))).iter().any(|f| f == figure), "{page} no longer says {figure}");
    }
}

#[test]
fn figures_are_found_in_prose_only() {
    let text = "It takes 3.5 ms, `5 ms` not, 2 to 3 million clocks; [4 s](x.md) 14.5°/m, 1 % and (7°).\n```\n9 ms\n```\n8 apples";
    assert_eq!(figures(&prose(text)), ["3.5 ms", "3 million clocks", "4 s", "14.5°/m", "1 %", "7°"]);
}
