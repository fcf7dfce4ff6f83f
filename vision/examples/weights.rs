//! Trains the weights of the ball's features, and the nets that weigh them together, on rendered pictures and
//! labelled photographs, and writes them as Rust:
//!
//! ```sh
//! cargo run --release -p vision --example weights -- 20000 23000 [FOLDER ...] >vision/src/ball/weights.rs
//! ```
//!
//! The numbers are ranges of seeds: the first one and the one after the last. Seeds of tests and benches lie below
//! 10 000, so that nothing is measured on what was learnt. Folders hold photographs with labels beside them, as `labelled`
//! says; where the committed weights' photographs are from is in `docs/book/src/smartbot.md`.

mod labelled;
mod nets;

use rayon::prelude::*;
use std::path::Path;
use vision::ball::features::{COUNT, Features, NAMES};
use vision::ball::{Candidate, candidates};
use vision::render::{Label, samples};

/// Side of the pictures, pixels.
const SIDE: usize = 224;
/// Cameras that take each: what they make of colours and edges differs more than what they see.
const CAMERAS: usize = 2;
/// Weights per feature; knots are quantiles of all candidates.
const KNOTS: usize = 9;
/// Overlap from which on a candidate is a ball, and below which it is none; between, nothing is learnt.
const BALL: f64 = 0.6;
const NO_BALL: f64 = 0.3;
/// Less of a ball than this is no ball and no mistake either.
const VISIBLE: f64 = 0.4;
/// Smallest ball that must be found, pixels.
const SMALLEST: f64 = 5.0;
/// Ridge on weights and on their second differences: weights of rare values stay near zero and near their neighbours.
const RIDGE: f32 = 5e-5;
const BENDING: f32 = 5e-4;
const ROUNDS: usize = 1500;
const RATE: f32 = 0.03;

/// Features whose weight may only rise (1) or only fall (−1) with their value, by what a ball is: pictures of other halls
/// have other coincidences, but not another geometry.
const DIRECTION: [i8; COUNT] = [0, 0, 1, 1, -1, 1, -1, 1, 1, 0, 1, 0, 0, 0, -1, 1, 0, 0, 0, 0, -1, -1, 0];

struct Case {
    features: [f32; COUNT],
    ball: bool,
    /// Larger side of the ball, pixels.
    size: f64,
    /// How far it reaches beyond the candidate's box to the left, right, up and down, pixels; of balls alone.
    beyond: Option<[f64; 4]>,
}

fn main() {
    let arguments: Vec<u64> = std::env::args().skip(1).map_while(|a| a.parse().ok()).collect();
    assert!(arguments.len().is_multiple_of(2), "give ranges of seeds: the first and the one after the last");
    let seeds: Vec<u64> = arguments.chunks_exact(2).flat_map(|range| range[0]..range[1]).collect();
    let mut cases: Vec<Case> = seeds
        .into_par_iter()
        .flat_map_iter(|seed| {
            let pictures = samples(seed, SIDE, SIDE, CAMERAS).into_iter().map(|sample| sample.rendered);
            pictures.flat_map(|rendered| cases(&candidates(&rendered.picture), &rendered.balls)).collect::<Vec<_>>()
        })
        .collect();
    for folder in std::env::args().skip(1 + arguments.len()) {
        let photographs = labelled::folder(Path::new(&folder)).unwrap_or_else(|what| panic!("{what}"));
        cases.par_extend(
            photographs
                .par_iter()
                .flat_map_iter(|photograph| self::cases(&candidates(&photograph.picture), &photograph.labels)),
        );
    }
    boxes(&cases);
    train(&cases);
}

/// Says by how much balls' boxes are larger than the candidates', from which `outline` has what it adds.
fn boxes(cases: &[Case]) {
    for sizes in [6.0, 8.0, 12.0, 20.0, 40.0, 200.0].windows(2) {
        let class = || cases.iter().filter(|case| case.size >= sizes[0] && case.size < sizes[1]);
        let medians: Vec<String> = (0..4)
            .map(|side| {
                let mut off: Vec<f64> = class().filter_map(|case| case.beyond.map(|beyond| beyond[side])).collect();
                off.sort_by(f64::total_cmp);
                off.get(off.len() / 2).map_or_else(|| "-".to_owned(), |off| format!("{off:.2}"))
            })
            .collect();
        eprintln!(
            "balls of {} to {} pixels reach beyond their boxes: left, right, up, down {medians:?}",
            sizes[0], sizes[1]
        );
    }
}

fn cases(candidates: &[Candidate], labels: &[Label]) -> Vec<Case> {
    candidates
        .iter()
        .filter_map(|candidate| {
            let nearest = labels.iter().map(|l| (l.region.overlap(&candidate.region), l));
            let (overlap, label) = nearest.max_by(|a, b| a.0.total_cmp(&b.0)).unzip();
            let overlap = overlap.unwrap_or(0.0);
            let clear = label.is_some_and(|l| l.visible >= VISIBLE && l.region.width.max(l.region.height) > SMALLEST);
            match overlap {
                o if o >= BALL && clear => Some(true),
                o if o < NO_BALL => Some(false),
                _ => None,
            }
            .map(|ball| {
                let (c, l) = (candidate.region, label.filter(|_| ball).map_or(candidate.region, |label| label.region));
                let (x, y) = (c.x - l.x, c.y - l.y);
                let (width, height) = ((l.width - c.width) / 2.0, (l.height - c.height) / 2.0);
                let beyond = ball.then_some([width + x, width - x, height + y, height - y]);
                Case { features: candidate.features.0, ball, size: l.width.max(l.height), beyond }
            })
        })
        .collect()
}

fn quantiles(cases: &[Case], feature: usize) -> [f32; KNOTS] {
    // Half of the knots where balls are, half where the others are.
    let of = |ball: bool| {
        let mut values: Vec<f32> = cases.iter().filter(|c| c.ball == ball).map(|c| c.features[feature]).collect();
        values.sort_by(f32::total_cmp);
        move |share: f32| values[((values.len() - 1) as f32 * share) as usize]
    };
    let (balls, others) = (of(true), of(false));
    let mut knots = [
        balls(0.01),
        balls(0.1),
        balls(0.35),
        balls(0.65),
        balls(0.9),
        balls(0.99),
        others(0.05),
        others(0.5),
        others(0.95),
    ];
    knots.sort_by(f32::total_cmp);
    let apart = ((knots[KNOTS - 1] - knots[0]) / 40.0).max(1e-3);
    for i in 1..KNOTS {
        knots[i] = knots[i].max(knots[i - 1] + apart);
    }
    knots
}

/// Which two knots a value lies between, and the share of the upper one.
fn place(value: f32, knots: &[f32; KNOTS]) -> (usize, f32) {
    let above = knots.partition_point(|knot| *knot <= value).clamp(1, KNOTS - 1);
    let share = (value - knots[above - 1]) / (knots[above] - knots[above - 1]);
    (above, share.clamp(0.0, 1.0))
}

/// Sets of weights: of large candidates and of small ones.
const SETS: usize = 2;
/// Numbers of a set.
const SET: usize = COUNT * KNOTS;

fn train(cases: &[Case]) {
    let knots: [[f32; KNOTS]; COUNT] = std::array::from_fn(|feature| quantiles(cases, feature));
    let places: Vec<[(usize, f32); COUNT]> =
        cases.iter().map(|case| std::array::from_fn(|i| place(case.features[i], &knots[i]))).collect();
    let size = SETS * SET + 1;
    let (mut weights, mut mean, mut square) = (vec![0.0_f32; size], vec![0.0_f32; size], vec![0.0_f32; size]);
    let mut loss = 0.0;
    for round in 1..=ROUNDS {
        let (sums, total) = cases
            .par_iter()
            .zip(&places)
            .fold(
                || (vec![0.0_f32; size], 0.0_f64),
                |(mut sums, mut total), (case, places)| {
                    let small = Features(case.features).smallness();
                    let parts = [(0, 1.0 - small), (SET, small)];
                    let mut odds = weights[size - 1];
                    for (set, part) in parts.iter().filter(|(_, part)| *part > 0.0) {
                        let terms = places.iter().enumerate().map(|(i, &(above, share))| {
                            let at = set + i * KNOTS + above;
                            weights[at - 1] * (1.0 - share) + weights[at] * share
                        });
                        odds += part * terms.sum::<f32>();
                    }
                    let truth = f32::from(u8::from(case.ball));
                    let error = 1.0 / (1.0 + (-odds).exp()) - truth;
                    total += f64::from((1.0 + (if case.ball { -odds } else { odds }).exp()).ln());
                    for (set, part) in parts.iter().filter(|(_, part)| *part > 0.0) {
                        for (i, &(above, share)) in places.iter().enumerate() {
                            let at = set + i * KNOTS + above;
                            sums[at - 1] += error * part * (1.0 - share);
                            sums[at] += error * part * share;
                        }
                    }
                    sums[size - 1] += error;
                    (sums, total)
                },
            )
            .reduce(
                || (vec![0.0; size], 0.0),
                |(mut a, x), (b, y)| {
                    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
                    (a, x + y)
                },
            );
        loss = total / cases.len() as f64;
        let mut slope: Vec<f32> = sums.iter().map(|s| s / cases.len() as f32).collect();
        for (part, slope) in weights.chunks_exact(KNOTS).zip(slope.chunks_exact_mut(KNOTS)) {
            for k in 0..KNOTS {
                slope[k] += RIDGE * part[k];
            }
            for k in 1..KNOTS - 1 {
                let bend = part[k - 1] - 2.0 * part[k] + part[k + 1];
                slope[k - 1] += BENDING * bend;
                slope[k] -= 2.0 * BENDING * bend;
                slope[k + 1] += BENDING * bend;
            }
        }
        // Kingma and Ba 2015.
        for k in 0..size {
            mean[k] = 0.9 * mean[k] + 0.1 * slope[k];
            square[k] = 0.999 * square[k] + 0.001 * slope[k] * slope[k];
            let m = mean[k] / (1.0 - 0.9_f32.powi(round as i32));
            let v = square[k] / (1.0 - 0.999_f32.powi(round as i32));
            weights[k] -= RATE * m / (v.sqrt() + 1e-8);
        }
        for (part, direction) in weights.chunks_exact_mut(KNOTS).zip(DIRECTION.iter().cycle()) {
            monotone(part, f32::from(*direction));
        }
    }
    let balls = cases.iter().filter(|case| case.ball).count();
    eprintln!("{balls} balls among {} candidates, loss {loss:.4}", cases.len());
    let ranges = std::array::from_fn(|i| [knots[i][0], knots[i][KNOTS - 1]]);
    let inputs: Vec<([f32; COUNT], bool)> = cases.iter().map(|case| (case.features, case.ball)).collect();
    print(&knots, &weights, &nets::trained(&inputs, &ranges));
}

/// The nearest weights that only rise (or fall): neighbours that violate that are pooled.
fn monotone(weights: &mut [f32], direction: f32) {
    if direction == 0.0 {
        return;
    }
    let mut pools: Vec<(f32, usize)> = Vec::with_capacity(weights.len());
    for &weight in weights.iter() {
        let mut pool = (weight, 1);
        while let Some(&(mean, count)) = pools.last().filter(|(mean, _)| (pool.0 - mean) * direction < 0.0) {
            pools.pop();
            pool = ((mean * count as f32 + pool.0 * pool.1 as f32) / (count + pool.1) as f32, count + pool.1);
        }
        pools.push(pool);
    }
    let pooled = pools.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count));
    weights.iter_mut().zip(pooled).for_each(|(weight, mean)| *weight = mean);
}

fn print(knots: &[[f32; KNOTS]; COUNT], weights: &[f32], nets: &[String]) {
    println!("//! Weights of the ball's features. Written by `vision/examples/weights.rs`, not by hand.\n");
    println!("use super::net::Net;\n");
    println!("/// Number of features.\npub const COUNT: usize = {COUNT};\n");
    println!("/// Odds of a candidate whose weights are all zero, logarithm.");
    println!("pub(super) const OFFSET: f32 = {:.3};\n", weights[SETS * SET]);
    let about = |what: &str| {
        println!("/// {what}\n#[rustfmt::skip]");
        println!(r#"#[allow(clippy::approx_constant, reason = "a trained number may resemble one of mathematics")]"#);
    };
    let rows = |name: &str, what: &str, row: &dyn Fn(usize) -> Vec<f32>| {
        about(what);
        println!("pub(super) const {name}: [[f32; {KNOTS}]; COUNT] = [");
        for (i, name) in NAMES.iter().enumerate() {
            let numbers: Vec<String> = row(i).iter().map(|n| format!("{n:.3}")).collect();
            println!("    [{}], // {name}", numbers.join(", "));
        }
        println!("];");
    };
    rows("KNOTS", "Values of a feature at which its weight is given.", &|i| knots[i].to_vec());
    println!();
    for (name, what, set) in [("LARGE", "large", 0), ("SMALL", "small", SET)] {
        let what = format!("Logarithm of odds at each knot, of {what} candidates.");
        rows(name, &what, &|i| weights[set + i * KNOTS..][..KNOTS].to_vec());
    }
    println!();
    about("Nets; the last number of a row is what is added.");
    println!("pub(super) const NETS: [Net<{{ COUNT + 1 }}>; {}] = [\n{}\n];", nets.len(), nets.join("\n"));
}
