//! The carpet: its colour in this light, where it is, and where it ends.

use crate::picture::Raster;

/// Bins of red and of green chromaticity: one is 0.02 wide, a fifth of what separates carpet from lines.
const BINS: usize = 50;
/// One pixel of so many votes for the carpet's colour, and tells it: a thousand pixels are as good as all. Both numbers
/// are prime, so that they meet every column.
const VOTERS: usize = 3;
const MEMBERS: usize = 7;
/// Distance in chromaticity within which a pixel has the carpet's colour; the noise of a dim 8-bit picture is 0.03.
const NEAR: f32 = 0.055;
/// Brightness of carpet as multiples of its median: shadow of a robot to the patch below a window.
const BRIGHTNESS: [f32; 2] = [0.25, 2.6];
/// Least share of a picture's lower part that makes a carpet.
const LEAST_SHARE: f32 = 0.04;
/// Weight of a colour that is not green: a field under coloured light, if nothing is green.
const NOT_GREEN: f32 = 0.08;
/// Rows of carpet, as share of the picture's height, that end the search for the boundary from above.
const BOUNDARY_RUN: f32 = 0.03;

/// The carpet of a picture.
#[derive(Clone, Debug)]
pub(crate) struct Carpet {
    /// Typical red, green and blue, 0 to 255.
    pub(crate) colour: [f32; 3],
    /// Of the picture's size; true where a pixel is carpet.
    pub(crate) mask: Raster<bool>,
    /// For every column the row where it begins, from above; the height where a column has none.
    pub(crate) boundary: Vec<f32>,
}

impl Carpet {
    /// Finds the carpet: the most frequent green of the lower two thirds. `None` where there is none.
    pub(crate) fn find(picture: &Raster<[f32; 3]>) -> Option<Self> {
        let lower = &picture.data[picture.width * (picture.height / 3)..];
        let mut votes = vec![0.0_f32; BINS * BINS];
        for &pixel in lower.iter().step_by(VOTERS) {
            let sum = total(pixel);
            if sum > 36.0 {
                let [r, g] = chromaticity(pixel);
                let bin = |c: f32| ((c * BINS as f32) as usize).min(BINS - 1);
                votes[bin(g) * BINS + bin(r)] += if green(r, g) { 1.0 } else { NOT_GREEN };
            }
        }
        let around = |bin: usize| -> f32 {
            let (x, y) = (bin % BINS, bin / BINS);
            let near = |c: usize| c.saturating_sub(1)..=(c + 1).min(BINS - 1);
            near(y).flat_map(|y| near(x).map(move |x| y * BINS + x)).map(|bin| votes[bin]).sum()
        };
        let peak = (0..BINS * BINS).max_by(|&a, &b| around(a).total_cmp(&around(b)))?;
        if around(peak) < LEAST_SHARE * (lower.len() / VOTERS) as f32 * NOT_GREEN {
            return None;
        }
        let centre = [peak % BINS, peak / BINS].map(|c| (c as f32 + 0.5) / BINS as f32);
        let mut members: Vec<[f32; 3]> = lower.iter().copied().step_by(MEMBERS).filter(|&p| near(p, centre)).collect();
        if members.len() * MEMBERS < (LEAST_SHARE * lower.len() as f32) as usize {
            return None;
        }
        let middle = members.len() / 2;
        let colour = [0, 1, 2].map(|i| members.select_nth_unstable_by(middle, |a, b| a[i].total_cmp(&b[i])).1[i]);
        let (centre, typical) = (chromaticity(colour), total(colour));
        let [darkest, brightest] = BRIGHTNESS.map(|share| share * typical);
        let mask = picture.map(|pixel| near(pixel, centre) && (darkest..brightest).contains(&total(pixel)));
        let boundary = boundary(&mask);
        Some(Self { colour, mask, boundary })
    }

    /// The row where the carpet begins in the column of `x`.
    pub(crate) fn begins(&self, x: f32) -> f32 {
        self.boundary[(x.max(0.0) as usize).min(self.boundary.len() - 1)]
    }
}

pub(crate) fn total(pixel: [f32; 3]) -> f32 {
    pixel[0] + pixel[1] + pixel[2]
}

fn chromaticity(pixel: [f32; 3]) -> [f32; 2] {
    let sum = total(pixel).max(1.0);
    [pixel[0] / sum, pixel[1] / sum]
}

fn near(pixel: [f32; 3], centre: [f32; 2]) -> bool {
    // Multiplied by the sum: a division a pixel less.
    let sum = total(pixel).max(1.0);
    let (r, g, reach) = (pixel[0] - centre[0] * sum, pixel[1] - centre[1] * sum, NEAR * sum);
    r * r + g * g < reach * reach
}

/// Hues from yellowish to bluish green, with a little colour at least.
fn green(r: f32, g: f32) -> bool {
    let b = 1.0 - r - g;
    g > 0.345 && g > r + 0.005 && g > b - 0.03
}

/// The first row, from above, from which on carpet goes on for a while, smoothed: a robot or a person hides it in some
/// columns, and a field is convex, so that the hidden row is between its neighbours'.
fn boundary(mask: &Raster<bool>) -> Vec<f32> {
    let run = ((mask.height as f32 * BOUNDARY_RUN) as usize).max(3);
    let first = |x: usize| {
        let mut length = 0;
        for y in 0..mask.height {
            length = if mask.at(x, y) { length + 1 } else { 0 };
            if length == run {
                return (y + 1 - run) as f32;
            }
        }
        mask.height as f32
    };
    let raw: Vec<f32> = (0..mask.width).map(first).collect();
    upper_hull(&raw, mask.height as f32)
}

/// The convex hull of the columns' first rows, from above: all that the boundary of a convex field can be. Columns that
/// lie high by themselves alone (green things beyond the field) do not count.
fn upper_hull(raw: &[f32], bottom: f32) -> Vec<f32> {
    const REACH: usize = 4;
    let believed = |x: usize| {
        let from = &raw[x.saturating_sub(REACH)..(x + REACH + 1).min(raw.len())];
        let mut near = [0.0; 2 * REACH + 1];
        let near = &mut near[..from.len()];
        near.copy_from_slice(from);
        near.sort_unstable_by(f32::total_cmp);
        near[near.len() / 2]
    };
    let points = (0..raw.len()).map(|x| (x as f32, believed(x))).filter(|(_, y)| *y < bottom);
    let mut hull: Vec<(f32, f32)> = Vec::new();
    for p in points {
        while let [.., a, b] = hull[..] {
            // Keep b only where it lies above the line from a to p.
            if (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0) > 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(p);
    }
    let mut rows = vec![bottom; raw.len()];
    for pair in hull.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let from = a.0 as usize;
        for (step, row) in rows[from..=b.0 as usize].iter_mut().enumerate() {
            *row = a.1 + (b.1 - a.1) * step as f32 / (b.0 - a.0);
        }
    }
    if let [(x, y)] = hull[..] {
        rows[x as usize] = y;
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boundary_is_straight_behind_a_robot_and_blind_to_a_green_thing_on_the_wall() {
        let mut raw = vec![20.0; 100];
        raw[30..45].fill(60.0);
        raw[70] = 2.0;
        let rows = upper_hull(&raw, 80.0);
        assert!(rows.iter().all(|row| (row - 20.0).abs() < 1e-3), "{rows:?}");
    }
}
