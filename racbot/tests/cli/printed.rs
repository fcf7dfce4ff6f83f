//! Every command that README and book print, in the order printed, from one folder as a newcomer would run them.

use super::racbot;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use tempfile::tempdir;

/// Printed commands that are not ours: how they begin, and what runs them.
const ELSEWHERE: [(&str, &str); 10] = [
    ("cargo run --release -p testbench --bin blind", "testbench/tests/blind.rs runs the series, shorter"),
    ("cargo run --release", "the demo: racbot/tests/cli/good_data.rs"),
    ("cargo install --path racbot", "builds what this test runs; `the robot's binary` of test.sh without features"),
    ("pip install", "the Python stage of test.sh"),
    ("cargo build --release", "made the command that this test runs"),
    ("./test.sh", "runs this test"),
    ("fusesoc", "testbench/tests/hardware_tools.rs"),
    ("RAC4I65_GENERATED=$PWD/generated fusesoc", "testbench/tests/hardware_tools.rs"),
    ("export PATH", "the command's path is the test's matter"),
    ("python3 testbench/engine/score.py", "testbench/tests/physics_engine.rs runs the engine and the scorer"),
];
/// Placing takes a minute: racbot/tests/bitstream_build.rs runs it as printed.
const PLACES: &str = "bitstream build ";
/// Commands that need a device which is not here: what they say without it, and what is run instead.
const WITHOUT_DEVICE: [(&str, &str, &str); 11] = [
    ("load rac4i65.bit", "rac4i65.bit: No such file", "load --card virtual"),
    ("info --list", "", "info --list"),
    ("info", "no Mesa 4I65", "info --card virtual"),
    ("drive --setpoints points.csv", "no Mesa 4I65", "--card virtual"),
    ("monitor", "no Mesa 4I65", "monitor --card virtual --once"),
    ("kick", "no Mesa 4I65", "--card virtual"),
    ("radio --number 3 --velocity", "/dev/ttyUSB0: ", ""),
    ("latency --seconds 60", "", "latency --seconds 1"),
    ("serve --vision-to", "", "serve --ports 0,0,0 --vision none --seconds 0.2"),
    ("serve --card", "0000:02:00.0", ""),
    ("vision detect frames/", "frames", ""),
];

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap()
}

/// README, then the book's pages in the order of its summary.
fn pages() -> Vec<PathBuf> {
    let book = repository().join("docs/book/src");
    let summary = fs::read_to_string(book.join("SUMMARY.md")).unwrap();
    let links = summary.split("](").skip(1).map(|rest| book.join(rest.split(')').next().unwrap()));
    std::iter::once(repository().join("README.md")).chain(links).collect()
}

/// Commands in the `sh` blocks of a page: comments off, continued lines joined, one a line.
fn commands(text: &str) -> Vec<String> {
    let blocks = text.split("```sh\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    let without_comments = |line: &str| line.split(" #").next().unwrap().trim_end().to_owned();
    let mut found = Vec::new();
    for block in blocks {
        let lines: Vec<_> = block.lines().map(without_comments).collect();
        let joined = lines.join("\n").replace("\\\n", " ");
        let parts = joined.lines().flat_map(|line| line.split("&&"));
        found.extend(parts.map(|part| part.split_whitespace().collect::<Vec<_>>().join(" ")).filter(|c| !c.is_empty()));
    }
    found
}

/// A recording of the four-wheel robot that README and book describe with `racbot init`, wheel 3 smaller than said.
fn recording(folder: &Path) -> String {
    let work = folder.join("recording");
    fs::create_dir(&work).unwrap();
    let frame = "--wheels 60,135,225,300 --x forward --radius-mm 27 --body-radius-mm 80 --gear 3.6";
    let drive = "--counts-per-motor-rev 4096 --rate-hz 1000 --camera-hz 75 --mass-kg 2.6 --supply-v 22.2 \
                 --resistance-ohm 1.03 --torque-constant 0.0335 --rotor-inertia 1.35e-5";
    run(&work, &format!("init robot.toml {frame} {drive}"));
    let gains = "\n[pi]\nkp = 0.05\nki = 0.3\n";
    let robot = fs::read_to_string(work.join("robot.toml")).unwrap();
    let robot = robot.replace("friction_torque = 0 ", "friction_torque = 0.0008 ") + gains;
    fs::write(work.join("robot.toml"), &robot).unwrap();
    fs::write(
        work.join("true.toml"),
        robot + "\n[[effect]]\nname = \"wheel-radius\"\n[effect.parameters]\nscale_3 = -0.03\n",
    )
    .unwrap();
    run(&work, "simulate --robot robot.toml --hidden true.toml --out drive");
    fs::read_to_string(work.join("drive/run.csv")).unwrap()
}

fn run(folder: &Path, command: &str) -> String {
    let outcome = racbot(folder, &command.split_whitespace().collect::<Vec<_>>());
    assert_eq!(outcome.code, Some(0), "racbot {command}: {}{}", outcome.stdout, outcome.stderr);
    outcome.stdout
}

/// What the reader has of his own: a log in our columns, and one in others' with its map.
fn belongings(folder: &Path, log: &str) {
    for name in ["data", "generated", "dist"] {
        symlink(repository().join(name), folder.join(name)).unwrap();
    }
    fs::create_dir(folder.join("my")).unwrap();
    fs::write(folder.join("my/run_01.csv"), log).unwrap();
    fs::write(folder.join("run_01.csv"), log).unwrap();
    let (header, rest) = log.split_once('\n').unwrap();
    fs::write(folder.join("theirs.csv"), header.replacen('t', "seconds", 1).replace("enc_", "ticks ") + "\n" + rest)
        .unwrap();
    let columns: String = (1..=4).map(|n| format!("enc_{n} = \"ticks {n}\"\n")).collect();
    let same = ["cam_x", "cam_y", "cam_theta"].map(|name| format!("{name} = \"{name}\"\n")).concat();
    let map = format!("[time]\ncolumn = \"seconds\"\nunit = \"s\"\n[columns]\n{columns}{same}");
    fs::write(folder.join("map.toml"), map).unwrap();
    fs::copy(repository().join("data/set-points/fig-6.csv"), folder.join("points.csv")).unwrap();
    fs::copy(repository().join("data/robot.toml"), folder.join("robot.toml")).unwrap();
}

/// Runs what is printed after `racbot`, its output not redirected and home a folder here; where it needs a device, sees that this is said, and runs the rest without.
fn as_printed(folder: &Path, command: &str) -> String {
    let command = command.split(" > ").next().unwrap().replace("~/", "home/");
    let command = command.as_str();
    let Some((_, said, instead)) = WITHOUT_DEVICE.iter().find(|(begin, ..)| command.starts_with(begin)) else {
        return run(folder, command);
    };
    if !said.is_empty() && !command.contains("--card virtual") {
        let refused = racbot(folder, &command.split_whitespace().collect::<Vec<_>>());
        assert!(refused.code == Some(1) && refused.stderr.contains(said), "{command}: {}", refused.stderr);
    }
    match *instead {
        "" => String::new(),
        more if more.starts_with("--") => run(folder, &format!("{command} {more}")),
        other => run(folder, other),
    }
}

#[test]
fn every_printed_command_does_what_is_said() {
    let scratch = tempdir().unwrap();
    let log = recording(scratch.path());
    let folder = scratch.path().join("newcomer");
    fs::create_dir(&folder).unwrap();
    belongings(&folder, &log);
    let mut ours = 0;
    for page in pages() {
        for command in commands(&fs::read_to_string(&page).unwrap()) {
            if let Some(arguments) = command.strip_prefix("racbot ") {
                ours += 1;
                if arguments.starts_with(PLACES) {
                    continue;
                }
                let text = as_printed(&folder, arguments);
                // The reader's own question, in README: which wheel?
                if ["gap my --out out/my", "gap set"].contains(&arguments) {
                    assert!(text.contains("wheel-radius") && text.contains("wheel 3"), "{text}");
                }
            } else {
                let known = ELSEWHERE.iter().any(|(begin, _)| command.starts_with(begin));
                assert!(known, "{}: nothing runs {command:?}", page.display());
            }
        }
    }
    assert!(ours > 20, "{ours} commands found");
}

#[test]
fn the_printed_map_converts_a_file_with_its_columns() {
    let page = fs::read_to_string(repository().join("docs/book/src/log-format.md")).unwrap();
    let map = page.split("```toml\nformat").nth(1).unwrap().split("```").next().unwrap();
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("map.toml"), format!("format{map}")).unwrap();
    let rows: String = (0..50).map(|k| format!("{},{k},{},{},0,90\n", 5000 + 10 * k, -k, 10 * k)).collect();
    let header = "time_ms,left/ticks,right/ticks,pose.x,pose.y,pose.yaw\n";
    fs::write(folder.path().join("theirs.csv"), header.to_owned() + &rows).unwrap();
    run(folder.path(), "convert map.toml theirs.csv ours.csv");
    let ours = fs::read_to_string(folder.path().join("ours.csv")).unwrap();
    let last: Vec<f64> = ours.lines().last().unwrap().split(',').map(|field| field.parse().unwrap()).collect();
    let names: Vec<_> = ours.lines().next().unwrap().split(',').collect();
    let column = |name: &str| last[names.iter().position(|n| *n == name).unwrap()];
    assert!((column("t") - 0.49).abs() < 1e-9 && column("enc_1") == 49.0 && column("enc_2") == 49.0, "{ours}");
    // Their robot faces 90 degrees; our x axis is to its right. The field stays as it is.
    assert!((column("cam_x") - 0.49).abs() < 1e-9 && column("cam_theta").abs() < 1e-9, "{ours}");
}
