//! Files that were good once: whatever became of them is read, or refused with file and reason.
//!
//! `RACBOT_FUZZ_S=600 cargo test --release -p model --test fuzz -- --nocapture` goes on for ten minutes each.

use std::path::Path;
use std::time::Instant;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::robot::Robot;
use runs::{DataSet, Run};

const TOKENS: [&str; 22] = [
    "nan",
    "inf",
    "-inf",
    "1e999",
    "-0",
    "1e-400",
    "0x1F",
    "9223372036854775808",
    ",",
    ",,",
    "\n",
    "\r\n",
    "\r",
    "\"",
    "\u{feff}",
    "é",
    "\0",
    "=",
    "[[effect]]\n",
    "[[wheel]]\n",
    "[",
    "t",
];

/// Calls `case` some thousand times, or for as long as somebody asks; gives the number of calls.
fn repeat(mut case: impl FnMut()) -> u64 {
    let seconds = std::env::var("RACBOT_FUZZ_S").ok().and_then(|s| s.parse::<u64>().ok());
    let (begun, mut cases) = (Instant::now(), 0);
    while seconds.map_or(cases < 4_000, |s| begun.elapsed().as_secs() < s) {
        case();
        cases += 1;
    }
    cases
}

/// One to four things that happen to files.
fn damaged(good: &[u8], rng: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..rng.random_range(1..=4) {
        let n = bytes.len();
        let at = rng.random_range(0..=n);
        let end = (at + rng.random_range(0..40)).min(n);
        match rng.random_range(0..7) {
            0 if at < n => bytes[at] ^= 1 << rng.random_range(0..8),
            1 => bytes.truncate(at),
            2 => {
                bytes.drain(at..end);
            }
            3 => {
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            4 => {
                let token = TOKENS[rng.random_range(0..TOKENS.len())];
                bytes.splice(at..end, token.bytes());
            }
            5 => {
                // A line twice, or two lines swapped.
                let mut lines: Vec<Vec<u8>> = bytes.split(|b| *b == b'\n').map(<[u8]>::to_vec).collect();
                let (a, b) = (rng.random_range(0..lines.len()), rng.random_range(0..lines.len()));
                if rng.random::<bool>() {
                    lines.swap(a, b);
                } else {
                    lines.insert(a, lines[b].clone());
                }
                bytes = lines.join(&b'\n');
            }
            _ => {
                let token = TOKENS[rng.random_range(0..TOKENS.len())];
                bytes.splice(at..at, token.bytes());
            }
        }
    }
    bytes
}

fn data(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name)).unwrap()
}

#[test]
fn damaged_logs_are_read_or_refused() {
    let whole = data("runs/wheel-skew/run_01.csv");
    let lines: Vec<&[u8]> = whole.split(|b| *b == b'\n').take(25).collect();
    let plain = lines.join(&b'\n');
    // As our own recorder writes it, with measured speeds.
    let columns = |k: usize| if k == 0 { ",meas_1,meas_2,meas_3".to_owned() } else { format!(",{k}.25,,-{k}e-3") };
    let ours: Vec<Vec<u8>> = lines.iter().enumerate().map(|(k, l)| [*l, columns(k).as_bytes()].concat()).collect();
    let seeds = [plain, ours.join(&b'\n')];
    let (robot, path) = (Robot::racbot(), Path::new("run.csv"));
    let (mut read, mut rng) = (0, ChaCha8Rng::seed_from_u64(4));
    let cases = repeat(|| {
        let bytes = damaged(&seeds[rng.random_range(0..2)], &mut rng);
        match Run::from_reader(&bytes[..], path).and_then(|run| run.check(&robot, path).map(|()| run)) {
            Ok(run) => {
                read += 1;
                assert!(!run.is_empty() && run.t.iter().all(|t| t.is_finite()));
                assert!(run.duty.iter().flatten().all(|d| !d.is_infinite()));
                assert!(run.counts.iter().all(|c| c.len() == run.len()));
                assert!(run.measured.iter().all(|m| m.len() == run.len()));
            }
            Err(e) => assert!(e.to_string().starts_with("run.csv") && !e.what.is_empty() && !e.hint.is_empty(), "{e}"),
        }
    });
    println!("{cases} damaged logs, {read} read");
    assert!(read > 0);
}

#[test]
fn damaged_robots_are_read_or_refused() {
    let path = Path::new("robot.toml");
    let effect = b"\n[[effect]]\nname = \"wheel-radius\"\nwheels = [2]\n[effect.parameters]\nscale_2 = { value = 0.1, ci95 = [0.05, 0.15] }\n";
    let words = "arithmetic = \"fixed-kin\"\nregisters = { kp = 1042300, ki = -1, tick_period = 33333 }\n";
    let ours = String::from_utf8(data("robot.toml")).unwrap().replace("[pi]\n", &format!("[pi]\n{words}"));
    assert!(Robot::parse(&ours, path).unwrap().pi.registers.len() == 3);
    let seeds = [[ours.as_bytes(), effect].concat(), data("robot-four-wheels.toml")];
    let (mut read, mut rng) = ([0; 2], ChaCha8Rng::seed_from_u64(5));
    let cases = repeat(|| {
        for (good, read) in seeds.iter().zip(&mut read) {
            let Ok(text) = String::from_utf8(damaged(good, &mut rng)) else { continue };
            match Robot::parse(&text, path) {
                Ok(robot) => {
                    *read += 1;
                    assert_eq!(Robot::parse(&robot.to_toml(), path).as_ref(), Ok(&robot), "{text}");
                    if let Ok(edited) = Robot::edited(&text, &[], path) {
                        assert!(Robot::parse(&edited, path).is_ok_and(|r| r.effects.is_empty()), "{text}");
                    }
                    let _ = model::effects::Applied::of(&robot).plant();
                }
                Err(e) => assert!(e.to_string().starts_with("robot.toml") && !e.what.is_empty(), "{e}"),
            }
        }
    });
    println!("{} damaged robots, {} read", 2 * cases, read[0] + read[1]);
    assert!(read.iter().all(|r| *r > 0));
}

/// What the issue of a damaged recording comes down to, one by one.
#[test]
fn every_known_corruption_is_read_rightly_or_refused_with_its_place() {
    let whole = String::from_utf8(data("runs/wheel-skew/run_01.csv")).unwrap();
    let good: String = whole.lines().take(200).map(|l| format!("{l}\n")).collect();
    let header = good.lines().next().unwrap().to_owned();
    let columns: Vec<&str> = header.split(',').collect();
    let column = |name: &str| columns.iter().position(|c| *c == name).unwrap();
    let edit = |line: usize, name: &str, value: &str| -> String {
        let rows = good.lines().enumerate().map(|(k, row)| {
            let mut fields: Vec<&str> = row.split(',').collect();
            if k + 1 == line {
                fields[column(name)] = value;
            }
            fields.join(",") + "\n"
        });
        rows.collect()
    };
    let without = |name: &str| -> String {
        let drop = column(name);
        let keep = |row: &str| {
            let fields: Vec<&str> = row.split(',').enumerate().filter(|(i, _)| *i != drop).map(|f| f.1).collect();
            fields.join(",") + "\n"
        };
        good.lines().map(keep).collect()
    };
    let robot = Robot::racbot();
    let folder = tempfile::tempdir().unwrap();
    robot.save(folder.path().join("robot.toml")).unwrap();
    let open = |text: &[u8]| {
        std::fs::write(folder.path().join("run.csv"), text).unwrap();
        DataSet::open(folder.path()).map(|set| set.runs[0].clone()).map_err(|e| e.to_string())
    };
    let plain = open(good.as_bytes()).unwrap();
    // Read rightly.
    assert_eq!(open(good.replace('\n', "\r\n").as_bytes()).unwrap(), plain);
    assert_eq!(open(format!("\u{feff}{good}").as_bytes()).unwrap(), plain);
    assert_eq!(open(good.trim_end().as_bytes()).unwrap(), plain);
    // Refused, with line and column where there is one.
    let refused: [(Vec<u8>, &str); 13] = [
        (without("t").into_bytes(), "run.csv:1:1: t: no such column"),
        (without("enc_2").into_bytes(), "run.csv:1:1: enc_2: no such column"),
        (without("cam_y").into_bytes(), "run.csv:1:1: cam_y: no such column"),
        (edit(50, "duty_2", "much").into_bytes(), "duty_2: \"much\" is no number"),
        (edit(50, "duty_2", "NaN").into_bytes(), "duty_2: NaN is not a finite number"),
        (edit(50, "enc_1", "12.5").into_bytes(), "enc_1: \"12.5\" is no whole number"),
        (good.as_bytes()[..good.len() - 30].to_vec(), "the file ends too early"),
        (edit(50, "t", plain.t[47].to_string().as_str()).into_bytes(), "stands twice"),
        (edit(50, "t", "0").into_bytes(), "time runs backwards"),
        (edit(50, "enc_3", "-2147483648").into_bytes(), "enc_3: jumps by"),
        (edit(50, "enc_3", "65535000").into_bytes(), "enc_3: jumps by"),
        (Vec::new(), "run.csv: is empty"),
        (b"\0\0\0\0".to_vec(), "run.csv:1:1: t: no such column"),
    ];
    for (bytes, part) in refused {
        let shown = open(&bytes).unwrap_err();
        assert!(shown.contains(part), "no {part:?} in {shown}");
        assert!(shown.contains("; "), "what to do? {shown}");
        if part.contains("duty_2") || part.contains("enc_1") {
            assert!(shown.contains("run.csv:50:"), "{shown}");
        }
    }
    std::fs::remove_file(folder.path().join("run.csv")).unwrap();
    assert!(DataSet::open(folder.path()).unwrap_err().to_string().contains("holds no runs"));
}
