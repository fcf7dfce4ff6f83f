//! Recall and precision of the ball on labelled photographs:
//!
//! ```sh
//! cargo run --release -p vision --example photographs -- FOLDER ...
//! ```
//!
//! Labels are as `labelled` says. With `--list` every miss and every mistake is named.

mod labelled;

use labelled::Photograph;
use std::path::Path;
use vision::ball::{Ball, DEFAULT_SCORE};
use vision::detect;
use vision::render::Label;

/// Smallest ball that counts, pixels of a picture 224 wide.
const SMALLEST: f64 = 8.0;
/// Overlap, as intersection over union, from which on a ball is found.
const FOUND: f64 = 0.5;
/// Scores at which the whole is given.
const SCORES: [f64; 7] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7];

/// Balls that count, those found, and what was found besides.
#[derive(Default)]
struct Count {
    balls: usize,
    found: usize,
    wrong: usize,
}

fn judge(photograph: &Photograph, balls: &[Ball], least: f64, list: bool, count: &mut Count) {
    let size = |label: &Label| label.region.width.max(label.region.height);
    let smallest = SMALLEST * photograph.picture.width() as f64 / 224.0;
    let mut free: Vec<&Ball> = balls.iter().filter(|ball| ball.score >= least).collect();
    for label in &photograph.labels {
        let hit = free.iter().position(|ball| ball.region.overlap(&label.region) > FOUND).map(|at| free.remove(at));
        if label.visible > 0.0 && size(label) > smallest {
            count.balls += 1;
            count.found += usize::from(hit.is_some());
            if hit.is_none() && list {
                let r = label.region;
                let near = balls.iter().map(|b| (b.region.overlap(&r), b.score)).max_by(|a, b| a.0.total_cmp(&b.0));
                println!(
                    "missed  {} {:.0} {:.0} size {:.1} nearest {near:.2?}",
                    photograph.file.display(),
                    r.x,
                    r.y,
                    size(label)
                );
            }
        } else {
            // Too small to count or to be ignored: a loose match is no mistake either.
            free.retain(|ball| ball.region.overlap(&label.region) < 0.1);
        }
    }
    count.wrong += free.len();
    for ball in free.iter().filter(|_| list) {
        let r = ball.region;
        println!(
            "mistake {} {:.0} {:.0} size {:.1} score {:.2}",
            photograph.file.display(),
            r.x,
            r.y,
            r.width.max(r.height),
            ball.score
        );
    }
}

fn main() {
    let list = std::env::args().any(|argument| argument == "--list");
    for folder in std::env::args().skip(1).filter(|argument| argument != "--list") {
        let photographs = match labelled::folder(Path::new(&folder)) {
            Ok(photographs) => photographs,
            Err(what) => {
                eprintln!("{what}");
                std::process::exit(1);
            }
        };
        let seen: Vec<Vec<Ball>> =
            photographs.iter().map(|photograph| detect(&photograph.picture, 0.02).balls).collect();
        println!("{folder}: {} pictures", photographs.len());
        for least in SCORES {
            let mut count = Count::default();
            for (photograph, balls) in photographs.iter().zip(&seen) {
                judge(photograph, balls, least, list && least == DEFAULT_SCORE, &mut count);
            }
            let share = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
            let Count { balls, found, wrong } = count;
            println!(
                "  score {least}: {found} of {balls} balls, {wrong} wrong: recall {:.1} %, precision {:.1} %",
                share(found, balls),
                share(found, found + wrong)
            );
        }
    }
}
