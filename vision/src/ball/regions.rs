//! Connected regions above every threshold of redness, and which of them may be a ball.

use crate::picture::Raster;

/// Thresholds, from the least one up.
const LEVELS: usize = 48;
/// Distance of two thresholds.
const STEP: f32 = 0.018;
/// The least threshold, and how much redder than the carpet it is at least.
const LEAST: f32 = 0.03;
const ABOVE_CARPET: f32 = 0.08;
/// Smallest region, pixels: a ball of 4 pixels.
const SMALLEST: u32 = 9;
/// Share of its box that an ellipse fills is π/4; a ball with a highlight or behind something fills less.
const FILLED: [f32; 2] = [0.42, 0.96];
/// Width over height: a wide picture squeezed to a square makes 0.56 of 1, blur and the picture's edge more or less.
const ASPECT: [f32; 2] = [0.33, 2.6];
/// Share of the picture's sides beyond which nothing is a ball.
const LARGEST: f32 = 0.75;
/// Overlap, as intersection over union, of regions that count as one.
const SAME: f32 = 0.55;

/// A region's box and its means.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blob {
    pub(super) left: f32,
    pub(super) top: f32,
    pub(super) right: f32,
    pub(super) bottom: f32,
    /// Share of the box that belongs to it.
    fill: f32,
    /// Mean redness.
    mean: f32,
}

#[derive(Clone, Copy)]
struct Part {
    left: u16,
    top: u16,
    right: u16,
    bottom: u16,
    area: u32,
    sum: f32,
}

/// The `most` most likely regions.
pub(super) fn regions(redness: &Raster<f32>, ground: f32, most: usize) -> Vec<Blob> {
    let least = LEAST.max(ground + ABOVE_CARPET);
    let mut blobs: Vec<(f32, Blob)> = tree(redness, least)
        .into_iter()
        .filter(|blob| shaped(blob, redness))
        .map(|blob| (promise(&blob, redness), blob))
        .filter(|(promise, _)| *promise > 0.0)
        .collect();
    blobs.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut kept: Vec<Blob> = Vec::new();
    for (_, blob) in blobs {
        if kept.iter().all(|other| overlap(other, &blob) < SAME) {
            kept.push(blob);
            if kept.len() == most {
                break;
            }
        }
    }
    kept
}

/// All connected regions above all thresholds: pixels are added from the reddest down and joined to their neighbours
/// (union and find, as in Najman and Couprie 2006 for component trees).
fn tree(redness: &Raster<f32>, least: f32) -> Vec<Blob> {
    let (width, height) = (redness.width, redness.height);
    let level = |value: f32| (((value - least) / STEP) as usize).min(LEVELS - 1);
    let mut buckets: Vec<Vec<u32>> = vec![Vec::new(); LEVELS];
    for (i, &value) in redness.data.iter().enumerate() {
        if value >= least {
            buckets[level(value)].push(i as u32);
        }
    }
    const NONE: u32 = u32::MAX;
    let mut parent = vec![NONE; width * height];
    let nothing = Part { left: 0, top: 0, right: 0, bottom: 0, area: 0, sum: 0.0 };
    let mut parts = vec![nothing; width * height];
    let mut blobs = Vec::new();
    let mut touched: Vec<u32> = Vec::new();
    for bucket in buckets.iter().rev() {
        for &i in bucket {
            let (x, y) = (i as usize % width, i as usize / width);
            let (column, row) = (x as u16, y as u16);
            let value = redness.data[i as usize];
            parts[i as usize] = Part { left: column, top: row, right: column, bottom: row, area: 1, sum: value };
            parent[i as usize] = i;
            let mut root = i;
            let neighbours = [
                (x > 0).then(|| i - 1),
                (x + 1 < width).then(|| i + 1),
                (y > 0).then(|| i - width as u32),
                (y + 1 < height).then(|| i + width as u32),
            ];
            for neighbour in neighbours.into_iter().flatten() {
                if parent[neighbour as usize] == NONE {
                    continue;
                }
                let other = find(&mut parent, neighbour);
                if other != root {
                    let (small, large) = if parts[other as usize].area < parts[root as usize].area {
                        (other, root)
                    } else {
                        (root, other)
                    };
                    parent[small as usize] = large;
                    parts[large as usize] = joined(parts[large as usize], parts[small as usize]);
                    root = large;
                }
            }
        }
        touched.clear();
        touched.extend(bucket.iter().map(|&i| find(&mut parent, i)));
        touched.sort_unstable();
        touched.dedup();
        blobs.extend(touched.iter().map(|&root| parts[root as usize]).filter(|part| part.area >= SMALLEST).map(blob));
    }
    blobs
}

fn find(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

fn joined(a: Part, b: Part) -> Part {
    Part {
        left: a.left.min(b.left),
        top: a.top.min(b.top),
        right: a.right.max(b.right),
        bottom: a.bottom.max(b.bottom),
        area: a.area + b.area,
        sum: a.sum + b.sum,
    }
}

fn blob(part: Part) -> Blob {
    let [left, top, right, bottom] = [part.left, part.top, part.right + 1, part.bottom + 1].map(f32::from);
    let fill = part.area as f32 / ((right - left) * (bottom - top));
    Blob { left, top, right, bottom, fill, mean: part.sum / part.area as f32 }
}

fn shaped(blob: &Blob, redness: &Raster<f32>) -> bool {
    let (width, height) = (blob.right - blob.left, blob.bottom - blob.top);
    let cut = blob.left <= 0.0
        || blob.top <= 0.0
        || blob.right >= redness.width as f32
        || blob.bottom >= redness.height as f32;
    let tolerance = if cut { 2.0 } else { 1.0 };
    let aspect = width / height;
    width >= 3.0
        && height >= 3.0
        && width <= LARGEST * redness.width as f32
        && height <= LARGEST * redness.height as f32
        && (FILLED[0]..FILLED[1] * tolerance).contains(&blob.fill)
        && (ASPECT[0] / tolerance..ASPECT[1] * tolerance).contains(&aspect)
}

/// Contrast of redness across the outline, weighed by how far the region fills an ellipse.
fn promise(blob: &Blob, redness: &Raster<f32>) -> f32 {
    const AROUND: usize = 16;
    let (cx, cy) = ((blob.left + blob.right) / 2.0, (blob.top + blob.bottom) / 2.0);
    let (a, b) = ((blob.right - blob.left) / 2.0, (blob.bottom - blob.top) / 2.0);
    let (mut sum, mut worst, mut count) = (0.0, f32::NEG_INFINITY, 0.0);
    for k in 0..AROUND {
        let (s, c) = (std::f32::consts::TAU * k as f32 / AROUND as f32).sin_cos();
        if let Some(value) = redness.sample(cx + c * (1.25 * a + 1.0), cy + s * (1.25 * b + 1.0)) {
            sum += value;
            worst = worst.max(value);
            count += 1.0;
        }
    }
    if count < 3.0 {
        return 0.0;
    }
    let contrast = blob.mean - sum / count - 0.25 * (worst - blob.mean).max(0.0);
    let round = 1.0 - 2.0 * (blob.fill - std::f32::consts::FRAC_PI_4).abs();
    contrast * round
}

fn overlap(a: &Blob, b: &Blob) -> f32 {
    let shared = |l1: f32, r1: f32, l2: f32, r2: f32| (r1.min(r2) - l1.max(l2)).max(0.0);
    let both = shared(a.left, a.right, b.left, b.right) * shared(a.top, a.bottom, b.top, b.bottom);
    let area = |blob: &Blob| (blob.right - blob.left) * (blob.bottom - blob.top);
    both / (area(a) + area(b) - both)
}
