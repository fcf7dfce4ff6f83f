//! Points on the field's lines: thin and bright across, with carpet on both sides.

use crate::carpet::{Carpet, total};
use crate::picture::Raster;

/// Brightness of a line over the carpet's at least; worn paint on sunlit carpet.
const BRIGHTER: f32 = 1.25;
/// Chromaticity of a line lies at least this far from saturation: the components' range over their sum.
const COLOUR: f32 = 0.22;
/// Widest line, as share of the picture's width: 10 mm from 10 cm away.
pub(crate) const WIDEST: f32 = 0.09;
/// Pixels beside a line within which carpet must begin: blur makes a fringe.
pub(crate) const FRINGE: usize = 3;

/// Where a scan crosses a painted line: the middle, weighed by brightness, to parts of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePoint {
    /// From the left, pixels.
    pub x: f64,
    /// From the top, pixels.
    pub y: f64,
    /// Thickness in the direction it was crossed, pixels.
    pub width: f64,
}

/// Points on lines, by scans down every `every`th column and across every `every`th row.
pub(crate) fn points(picture: &Raster<[f32; 3]>, carpet: &Carpet, by: usize, every: usize) -> Vec<LinePoint> {
    let ground = total(carpet.colour);
    let bright = |place: usize| {
        let pixel = picture.data[place];
        let sum = total(pixel);
        let [r, g, b] = pixel;
        sum > BRIGHTER * ground && r.max(g).max(b) - r.min(g).min(b) < COLOUR * sum
    };
    let weight = |place: usize| (total(picture.data[place]) - ground).max(0.0);
    let mask = |place: usize| carpet.mask.data[place];
    let widest = (WIDEST * picture.width as f32) as usize;
    let scale = by as f64;
    let mut points = Vec::new();
    let mut scan = |length: usize, first: usize, stride: usize, place: &dyn Fn(f64) -> [f64; 2]| {
        let at = |k: usize| first + k * stride;
        crossings(
            length,
            widest,
            |k| bright(at(k)),
            |k| mask(at(k)),
            |k| weight(at(k)),
            |middle, width| {
                let [x, y] = place(middle);
                points.push(LinePoint { x: x * scale, y: y * scale, width: width * scale });
            },
        );
    };
    for x in (every / 2..picture.width).step_by(every) {
        scan(picture.height, x, picture.width, &|middle| [x as f64 + 0.5, middle]);
    }
    for y in (every / 2..picture.height).step_by(every) {
        scan(picture.width, y * picture.width, 1, &|middle| [middle, y as f64 + 0.5]);
    }
    points
}

/// Middles and widths of bright runs between carpet.
fn crossings(
    length: usize,
    widest: usize,
    bright: impl Fn(usize) -> bool,
    carpet: impl Fn(usize) -> bool,
    weight: impl Fn(usize) -> f32,
    mut found: impl FnMut(f64, f64),
) {
    let mut i = 0;
    while i < length {
        if !bright(i) {
            i += 1;
            continue;
        }
        let from = i;
        while i < length && bright(i) {
            i += 1;
        }
        let before = from.checked_sub(FRINGE + 1).is_some_and(&carpet);
        let after = i + FRINGE < length && carpet(i + FRINGE);
        if i - from <= widest && before && after {
            let (low, high) = (from.saturating_sub(1), (i + 1).min(length));
            let sum: f64 = (low..high).map(|k| f64::from(weight(k))).sum();
            let moment: f64 = (low..high).map(|k| f64::from(weight(k)) * (k as f64 + 0.5)).sum();
            if sum > 0.0 {
                found(moment / sum, (i - from) as f64);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_between_carpet_counts_and_a_wall_behind_carpet_does_not() {
        let row: Vec<u8> = b"ccccccwwcccccccccccwwwwwwwww".to_vec();
        let mut found = Vec::new();
        let weight = |i: usize| f32::from(u8::from(row[i] == b'w'));
        crossings(
            row.len(),
            4,
            |i| row[i] == b'w',
            |i| row[i] == b'c',
            weight,
            |middle, width| {
                found.push((middle, width));
            },
        );
        assert_eq!(found, [(7.0, 2.0)]);
    }
}
