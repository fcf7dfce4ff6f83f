//! Connected regions above every threshold of redness, and which of them may be a ball.

use super::directions::directions;
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
/// Side below which a region has the less promise the smaller it is, pixels: specks of noise have the contrast of balls,
/// and there are hundreds of them. Of rendered balls over 8 pixels 96.0 % are among the candidates without this and 96.3 %
/// with it (seeds 30 000 to 31 200).
const SPECK: f32 = 8.0;
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

/// What a set of joined pixels is known by.
#[derive(Clone, Copy)]
struct Part {
    /// The next one up, or itself.
    parent: u32,
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
/// (union and find, as in Najman and Couprie 2006 for component trees). Work and memory are for pixels above the least
/// threshold alone, a small part of most pictures.
fn tree(redness: &Raster<f32>, least: f32) -> Vec<Blob> {
    const NOT: u32 = u32::MAX;
    let width = redness.width;
    let level = |value: f32| LEVELS - 1 - (((value - least) * (1.0 / STEP)) as usize).min(LEVELS - 1);
    let (order, ends) = sorted(redness, least, level);
    let mut place = vec![NOT; redness.data.len()];
    for (k, &i) in order.iter().enumerate() {
        place[i as usize] = k as u32;
    }
    let mut parts: Vec<Part> = Vec::with_capacity(order.len());
    let mut told = vec![usize::MAX; order.len()];
    let mut blobs = Vec::new();
    for (level, end) in ends.into_iter().enumerate() {
        let first = parts.len();
        for &i in &order[first..end] {
            let (x, y) = (i as usize % width, i as usize / width);
            let (column, row, this) = (x as u16, y as u16, parts.len() as u32);
            let sum = redness.data[i as usize];
            parts.push(Part { parent: this, left: column, top: row, right: column, bottom: row, area: 1, sum });
            let mut root = this;
            let mut meet = |neighbour: usize| {
                // Later ones, and those below the least threshold, are not there yet.
                if place[neighbour] >= this {
                    return;
                }
                let other = find(&mut parts, place[neighbour]);
                if other != root {
                    let smaller = parts[other as usize].area < parts[root as usize].area;
                    let (small, large) = if smaller { (other, root) } else { (root, other) };
                    parts[large as usize] = joined(parts[large as usize], parts[small as usize]);
                    parts[small as usize].parent = large;
                    root = large;
                }
            };
            let i = i as usize;
            if x > 0 {
                meet(i - 1);
            }
            if x + 1 < width {
                meet(i + 1);
            }
            if y > 0 {
                meet(i - width);
            }
            if y + 1 < redness.height {
                meet(i + width);
            }
        }
        for k in first..end {
            let root = find(&mut parts, k as u32) as usize;
            if told[root] != level && parts[root].area >= SMALLEST {
                told[root] = level;
                blobs.push(blob(parts[root]));
            }
        }
    }
    blobs
}

/// Pixels above the least threshold by level, and for every level the place after its last one.
fn sorted(redness: &Raster<f32>, least: f32, level: impl Fn(f32) -> usize) -> (Vec<u32>, [usize; LEVELS]) {
    let above = || redness.data.iter().enumerate().filter(|(_, value)| **value >= least);
    let mut ends = [0; LEVELS];
    for (_, &value) in above() {
        ends[level(value)] += 1;
    }
    let mut sum = 0;
    let mut next = ends.map(|count| {
        sum += count;
        sum - count
    });
    let mut order = vec![0; sum];
    for (i, &value) in above() {
        let level = level(value);
        order[next[level]] = i as u32;
        next[level] += 1;
    }
    (order, next)
}

fn find(parts: &mut [Part], mut i: u32) -> u32 {
    while parts[i as usize].parent != i {
        let parent = parts[i as usize].parent;
        parts[i as usize].parent = parts[parent as usize].parent;
        i = parent;
    }
    i
}

fn joined(a: Part, b: Part) -> Part {
    Part {
        parent: a.parent,
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

/// Contrast of redness across the outline, weighed by how far the region fills an ellipse and, for specks, by its size.
fn promise(blob: &Blob, redness: &Raster<f32>) -> f32 {
    const AROUND: usize = 16;
    let (cx, cy) = ((blob.left + blob.right) / 2.0, (blob.top + blob.bottom) / 2.0);
    let (a, b) = ((blob.right - blob.left) / 2.0, (blob.bottom - blob.top) / 2.0);
    let (mut sum, mut worst, mut count) = (0.0, f32::NEG_INFINITY, 0.0);
    for [c, s] in directions(AROUND) {
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
    contrast * round * (2.0 * (a * b).sqrt() / SPECK).min(1.0)
}

fn overlap(a: &Blob, b: &Blob) -> f32 {
    let shared = |l1: f32, r1: f32, l2: f32, r2: f32| (r1.min(r2) - l1.max(l2)).max(0.0);
    let both = shared(a.left, a.right, b.left, b.right) * shared(a.top, a.bottom, b.top, b.bottom);
    let area = |blob: &Blob| (blob.right - blob.left) * (blob.bottom - blob.top);
    both / (area(a) + area(b) - both)
}
