//! Recall and precision of the ball on labelled photographs:
//!
//! ```sh
//! cargo run --release -p vision --example photographs -- FOLDER ...
//! ```
//!
//! Labels are as `labelled` says. With `--list` every miss and every mistake is named. With `RACBOT_MEASURED=write` the
//! folders are the rows of `docs/measured/ball-photographs.md`, by their names.

mod labelled;

use labelled::Photograph;
use measured::Table;
use std::path::Path;
use vision::ball::{Ball, DEFAULT_SCORE};
use vision::detect;
use vision::render::Label;

/// Smallest ball that counts, pixels of a picture 224 wide.
const SMALLEST: f64 = 8.0;
/// Overlap, as intersection over union, from which on a ball is found.
const FOUND: f64 = 0.5;
/// The second operating point of the tables.
const STRICT: f64 = 0.5;
/// Scores at which the whole is given.
const SCORES: [f64; 7] = [0.1, 0.2, 0.25, DEFAULT_SCORE, 0.4, STRICT, 0.7];

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

/// A row of the table: counts at the default score and, with fewer mistakes, at the second one.
fn row(folder: &Path, pictures: usize, counts: [&Count; 2]) -> Vec<String> {
    let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy().into_owned();
    let share = |part: usize, whole: usize| {
        if whole == 0 { "-".to_owned() } else { format!("{:.1}", 100.0 * part as f64 / whole as f64) }
    };
    let mut row = vec![name, pictures.to_string(), counts[0].balls.to_string()];
    for Count { balls, found, wrong } in counts {
        let precision = if *balls == 0 { "-".to_owned() } else { share(*found, found + wrong) };
        row.extend([share(*found, *balls), precision, wrong.to_string()]);
    }
    row
}

fn main() {
    let mut rows = Vec::new();
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
        let counted = |least: f64, list: bool| {
            let mut count = Count::default();
            for (photograph, balls) in photographs.iter().zip(&seen) {
                judge(photograph, balls, least, list, &mut count);
            }
            count
        };
        for least in SCORES {
            let count = counted(least, list && least == DEFAULT_SCORE);
            let share = |part: usize, whole: usize| 100.0 * part as f64 / whole.max(1) as f64;
            let Count { balls, found, wrong } = count;
            println!(
                "  score {least}: {found} of {balls} balls, {wrong} wrong: recall {:.1} %, precision {:.1} %",
                share(found, balls),
                share(found, found + wrong)
            );
        }
        let [usual, strict] = [DEFAULT_SCORE, STRICT].map(|least| counted(least, false));
        rows.push(row(Path::new(&folder), photographs.len(), [&usual, &strict]));
    }
    if std::env::var_os("RACBOT_MEASURED").is_some_and(|value| value == "write") {
        Table {
            name: "ball-photographs",
            title: &format!(
                "The ball on photographs of 224 x 224 pixels that nothing was trained on, at score {DEFAULT_SCORE} and at {STRICT}"
            ),
            command: "cargo run --release -p vision --example photographs -- FOLDER ...",
            columns: &[
                "photographs",
                "pictures",
                "balls over 8 pixels",
                "recall, %",
                "precision, %",
                "mistakes",
                "recall at 0.5, %",
                "precision at 0.5, %",
                "mistakes at 0.5",
            ],
        }
        .write(&rows);
    }
}
