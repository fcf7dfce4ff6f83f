//! Recall and precision of the ball by its size on rendered pictures that nothing was trained on, and under changes of
//! light and colour that nothing was trained on either. Writes `docs/measured/ball-detection.md`.

mod effects;

use measured::Table;
use rayon::prelude::*;
use vision::ball::{Ball, DEFAULT_SCORE};
use vision::detect;
use vision::picture::Picture;
use vision::render::{Label, sample};

/// Pictures; their seeds start at 0, those of training at 10 000.
const PICTURES: u64 = 400;
/// Least share of a ball that must be seen to count.
const VISIBLE: f64 = 0.4;
/// Edges of the classes of size, pixels of a picture 224 wide.
const SIZES: [f64; 6] = [5.0, 8.0, 12.0, 20.0, 40.0, 300.0];
/// Two operating points: the one that is the default, and one of fewer mistakes.
const OPERATING: [f64; 2] = [DEFAULT_SCORE, 0.5];
/// Scores at which the whole is given.
const SCORES: [f64; 7] = [0.1, 0.2, 0.25, DEFAULT_SCORE, 0.4, 0.5, 0.7];

struct Seen {
    labels: Vec<Label>,
    balls: Vec<Ball>,
}

fn size(label: &Label) -> f64 {
    label.region.width.max(label.region.height)
}

/// Balls of a class of size: all, found; and what was found besides that is no ball.
fn count(seen: &[Seen], from: f64, to: f64, least: f64) -> [usize; 3] {
    let mut sums = [0; 3];
    for picture in seen {
        let mut free: Vec<&Ball> = picture.balls.iter().filter(|ball| ball.score >= least).collect();
        for label in &picture.labels {
            let hit = free.iter().position(|ball| ball.region.overlap(&label.region) > 0.5);
            let hit = hit.map(|place| free.remove(place));
            if label.visible >= VISIBLE && size(label) > from && size(label) <= to {
                sums[0] += 1;
                sums[1] += usize::from(hit.is_some());
            } else if hit.is_none() {
                // Too small or too hidden to count: a loose match is no mistake either.
                free.retain(|ball| ball.region.overlap(&label.region) < 0.1);
            }
        }
        let large = |ball: &&Ball| {
            let size = ball.region.width.max(ball.region.height);
            size > from && size <= to
        };
        sums[2] += free.into_iter().filter(large).count();
    }
    sums
}

fn share(part: usize, whole: usize) -> String {
    if whole == 0 { "-".to_owned() } else { format!("{:.1}", 100.0 * part as f64 / whole as f64) }
}

fn row(name: String, [balls, found, wrong]: [usize; 3]) -> Vec<String> {
    vec![name, balls.to_string(), share(found, balls), share(found, found + wrong)]
}

fn main() {
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let rendered: Vec<(Picture, Vec<Label>)> = (0..PICTURES)
        .into_par_iter()
        .map(|seed| {
            let rendered = sample(seed, 224, 224).rendered;
            (rendered.picture, rendered.balls)
        })
        .collect();
    let changed = |change: fn(&mut Picture, u64)| -> Vec<Seen> {
        let seen = rendered.par_iter().enumerate().map(|(seed, (picture, labels))| {
            let mut picture = picture.clone();
            change(&mut picture, seed as u64);
            Seen { balls: detect(&picture, SCORES[0]).balls, labels: labels.clone() }
        });
        seen.collect()
    };
    let seen = changed(|_, _| {});
    let mut rows: Vec<Vec<String>> = SIZES
        .windows(2)
        .map(|w| {
            row(format!("{} to {} pixels, score {DEFAULT_SCORE}", w[0], w[1]), count(&seen, w[0], w[1], DEFAULT_SCORE))
        })
        .collect();
    rows.extend(SCORES.map(|least| row(format!("over 8 pixels, score {least}"), count(&seen, 8.0, 1e9, least))));
    Table {
        name: "ball-detection",
        title: "The ball in 400 rendered pictures of 224 x 224 pixels, found where boxes overlap by more than half",
        command: "cargo bench -p vision --bench detection",
        columns: &["balls of", "balls", "recall, %", "precision, %"],
    }
    .write(&rows);
    let rows = effects::EFFECTS.map(|(name, change)| {
        let seen = changed(change);
        let mut cells = vec![name.to_owned()];
        cells.extend(OPERATING.iter().flat_map(|&least| {
            let [balls, found, wrong] = count(&seen, 8.0, 1e9, least);
            [share(found, balls), share(found, found + wrong)]
        }));
        cells
    });
    let [usual, strict] = OPERATING;
    let columns = [
        "picture".to_owned(),
        format!("recall at score {usual}, %"),
        format!("precision at score {usual}, %"),
        format!("recall at score {strict}, %"),
        format!("precision at score {strict}, %"),
    ];
    Table {
        name: "ball-changes",
        title: "The same balls over 8 pixels after changes of the finished pictures that nothing was trained on",
        command: "cargo bench -p vision --bench detection",
        columns: &columns.each_ref().map(String::as_str),
    }
    .write(&rows);
}
