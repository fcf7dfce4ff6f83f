//! What all detections in a 640 x 480 frame cost on one core: time, time on the processor without what other programs
//! took, and instructions, which no load changes. Writes `docs/measured/vision-time.md`.
//!
//! Instructions are counted by callgrind, of the Debian package valgrind.

use measured::Table;
use rayon::prelude::*;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;
use vision::ball::DEFAULT_SCORE;
use vision::detect;
use vision::picture::{Picture, read};
use vision::render::sample;

/// Frames; their seeds are nobody else's.
const FRAMES: u64 = 24;
const FIRST_SEED: u64 = 5000;
/// Times that every frame is timed.
const ROUNDS: usize = 10;
/// Quality of the JPEG that callgrind's process reads.
const QUALITY: u8 = 97;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    match &arguments[1..] {
        [flag, ..] if flag == "--test" => {}
        [flag, file, ..] if flag == "--frame" => {
            let picture = read(Path::new(file)).expect("the frame just written can be read");
            black_box(counted(&picture));
        }
        _ => measure(),
    }
}

/// What callgrind counts.
#[inline(never)]
fn counted(picture: &Picture) -> usize {
    let scene = detect(picture, DEFAULT_SCORE);
    scene.balls.len() + scene.lines.len()
}

fn measure() {
    let frames: Vec<Picture> =
        (0..FRAMES).into_par_iter().map(|k| sample(FIRST_SEED + k, 640, 480).rendered.picture).collect();
    let (mut whole, mut alone) = (Vec::new(), Vec::new());
    for frame in (0..ROUNDS).flat_map(|_| &frames) {
        let (start, ran) = (Instant::now(), on_processor());
        black_box(counted(frame));
        alone.push(on_processor() - ran);
        whole.push(start.elapsed().as_secs_f64() * 1e3);
    }
    let instructions: Vec<f64> = frames.par_iter().filter_map(instructions).collect();
    let row = |what: &str, mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let place = (values.len().max(1) - 1) as f64 * share;
            values.get(place as usize).map_or_else(|| "not measured".to_owned(), |value| format!("{value:.1}"))
        };
        vec![what.to_owned(), values.len().to_string(), at(0.0), at(0.5), at(1.0)]
    };
    Table {
        name: "vision-time",
        title: "What all detections in a 640 x 480 frame cost on one core",
        command: "cargo bench -p vision --bench time",
        columns: &["of a frame", "measurements", "least", "median", "largest"],
    }
    .write(&[
        row("time, ms", whole),
        row("time on the processor, ms", alone),
        row("instructions, millions", instructions),
    ]);
}

/// Processor time of this thread so far, ms.
fn on_processor() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    1e3 * time.tv_sec as f64 + time.tv_nsec as f64 / 1e6
}

/// Millions of instructions of [`counted`]; `None` without valgrind.
fn instructions(frame: &Picture) -> Option<f64> {
    let folder = tempfile::tempdir().ok()?;
    let file = folder.path().join("frame.jpg");
    std::fs::write(&file, frame.to_jpeg(QUALITY, false)).ok()?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--toggle-collect=*counted*"])
        .arg(std::env::current_exe().ok()?)
        .arg("--frame")
        .arg(file)
        .output()
        .ok()?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let count = said.lines().find_map(|line| line.split("Collected :").nth(1))?;
    count.trim().parse::<f64>().ok().map(|count| count / 1e6)
}
