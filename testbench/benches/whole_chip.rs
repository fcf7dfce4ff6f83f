//! The whole chip, compiled, against the bit-true card for a thousand million clocks: writes `docs/measured/campaign.md`.
//!
//! ```sh
//! cargo bench -p testbench --bench whole_chip -- [--clocks N] [--state FILE] [--jobs N]
//! ```
//!
//! Seed after seed from power-up on. What is done stands in the state file, one seed a line, so that an interrupted
//! campaign goes on where it was; a state of another Verilog counts for nothing. It takes processes of low priority well:
//! `nice -n 19`.

use hdl::design::content_hash;
use std::fs::{File, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use testbench::whole_chip::{Seen, compare, compiled};

/// Clocks of all seeds together.
const CLOCKS: u64 = 1_000_000_000;
/// Pairs of ticks of a seed: 20 million clocks, some ten seconds, which an interruption may cost.
const PAIRS: u64 = 10_000;

const TABLE: measured::Table<'_> = measured::Table {
    name: "campaign",
    title: "The whole chip, compiled from the emitted Verilog, against the bit-true card",
    command: "cargo bench -p testbench --bench whole_chip",
    columns: &[
        "Verilog",
        "seeds",
        "clocks",
        "control ticks compared",
        "with a duty",
        "captured indices",
        "differences",
    ],
};

/// What the state file says: seeds that are done with the present Verilog.
struct State {
    done: Vec<(u64, Seen)>,
    file: File,
}

impl State {
    fn open(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        let done = text.lines().filter_map(line).collect();
        let file = OpenOptions::new().create(true).append(true).open(path);
        Self { done, file: file.unwrap_or_else(|error| panic!("{}: {error}", path.display())) }
    }

    fn add(&mut self, seed: u64, seen: Seen) {
        let Seen { ticks, clocks, driven, captured } = seen;
        let line = format!("{:08x} {PAIRS} {seed} {ticks} {clocks} {driven} {captured}\n", content_hash());
        self.file.write_all(line.as_bytes()).and_then(|()| self.file.flush()).expect("the state can be kept");
        self.done.push((seed, seen));
        println!("seed {seed}: {clocks} clocks; {} in all", self.clocks());
    }

    fn clocks(&self) -> u64 {
        self.done.iter().map(|(_, seen)| seen.clocks).sum()
    }
}

/// Seed and result of a line that the present Verilog and length of a seed made.
fn line(text: &str) -> Option<(u64, Seen)> {
    let (hash, rest) = text.split_once(' ')?;
    let numbers: Vec<u64> = rest.split(' ').map(str::parse).collect::<Result<_, _>>().ok()?;
    let &[pairs, seed, ticks, clocks, driven, captured] = &numbers[..] else { return None };
    let ours = hash == format!("{:08x}", content_hash()) && pairs == PAIRS;
    ours.then_some((seed, Seen { ticks, clocks, driven, captured }))
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let value = |name: &str| arguments.iter().position(|a| a == name).map(|at| arguments[at + 1].as_str());
    let clocks: u64 = value("--clocks").map_or(CLOCKS, |text| text.parse().expect("--clocks takes a number"));
    let jobs: u64 = value("--jobs").map_or(1, |text| text.parse().expect("--jobs takes a number"));
    let path = value("--state").map_or_else(|| std::env::temp_dir().join("racbot-whole-chip.state"), PathBuf::from);
    println!("state in {}", path.display());
    let built = compiled().unwrap_or_else(|error| panic!("{error}"));
    let state = Mutex::new(State::open(&path));
    let next = AtomicU64::new(1);
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    {
                        let state = state.lock().expect("no thread panicked");
                        if state.clocks() >= clocks {
                            return;
                        }
                        if state.done.iter().any(|(done, _)| *done == seed) {
                            continue;
                        }
                    }
                    let seen = compare(&built, seed, PAIRS).unwrap_or_else(|error| panic!("{error}"));
                    state.lock().expect("no thread panicked").add(seed, seen);
                }
            });
        }
    });
    let state = state.into_inner().expect("no thread panicked");
    let sum = |part: fn(&Seen) -> u64| state.done.iter().map(|(_, seen)| part(seen)).sum::<u64>().to_string();
    let row = vec![
        format!("{:08x}", content_hash()),
        state.done.len().to_string(),
        sum(|seen| seen.clocks),
        sum(|seen| seen.ticks),
        sum(|seen| seen.driven),
        sum(|seen| seen.captured),
        "0".to_owned(),
    ];
    println!("{}", row.join(" | "));
    TABLE.write(&[row]);
}
