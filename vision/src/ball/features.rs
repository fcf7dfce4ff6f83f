//! What speaks for and against a ball.

use super::outline::Outline;
pub use super::weights::COUNT;
use super::weights::{KNOTS, LARGE, NETS, OFFSET, SMALL};
use crate::carpet::{Carpet, total};
use crate::picture::Raster;

/// Names of the features, in order.
pub const NAMES: [&str; COUNT] = [
    "redness inside",
    "hue, degrees from red to yellow",
    "redness inside less outside",
    "outline: share of rays that agree",
    "outline: roughness, radii",
    "share of the inside that is red",
    "share of the surroundings that is red",
    "share of carpet below",
    "share of carpet around",
    "width over height, logarithm",
    "bottom below the field's boundary, heights of the picture",
    "size, logarithm of pixels",
    "upper less lower green",
    "unevenness of colour inside",
    "redness of the reddest candidate less its own",
    "share of the outline in the picture",
    "brightness over the carpet's, logarithm",
    "red over green against the carpet, logarithm",
    "green over blue against the carpet, logarithm",
    "brightness outside against inside, unevenness",
    "outline: bulge towards the box's corners, radii",
    "outline: roughness, pixels",
    "height over bottom below the field's boundary, logarithm",
];

/// The features of a candidate, by [`NAMES`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Features(pub [f32; COUNT]);

/// Share of a half of a candidate that must be in the picture to tell of shading, and the shading of what is cut off:
/// the median of balls.
const HALF_SHOWN: f32 = 0.5;
const USUAL_SHADING: f32 = 0.1;
/// Added to the sum of two means of green, of 255: below, noise would be shading. Shading is of green: an orange ball's red is
/// at the sensor's limit when its green is half-way, and what is at the limit has no shading.
const DIM: f32 = 10.0;

/// Samples from the middle of a candidate to its outline at most: means of a thousand pixels are as good as of all.
const MOST_ACROSS: f32 = 18.0;

/// Samples around an outline.
const AROUND: usize = 24;

/// Share of the nets in the odds. On rendered pictures half is better than a quarter by 0.6 % of recall; on photographs that
/// nothing was trained on (docs/measured/ball-photographs.md) half missed balls and made more mistakes.
const OF_NETS: f32 = 0.25;

/// Place of the size among the features.
const SIZE: usize = 11;

/// Radius, pixels, up to which a candidate is small, and from which on it is large; between, it is partly both. What a feature
/// means depends on the size: at four pixels an outline is rough by the grid and its colour is that of blurred edges. With one set
/// of weights for all sizes the precision on rendered pictures is 1.3 % less at equal recall (seeds 30 000 to 31 499).
const SMALL_TO_LARGE: [f32; 2] = [3.5, 9.0];

impl Features {
    pub(super) fn of(
        picture: &Raster<[f32; 3]>,
        redness: &Raster<f32>,
        carpet: Option<&Carpet>,
        outline: &Outline,
    ) -> Self {
        let inner = Inner::of(picture, redness, outline);
        let outer = Outer::of(picture, redness, carpet, outline, inner.middle);
        let height = picture.height as f32;
        let bottom = (outline.cy + outline.b).min(height);
        let boundary = carpet.map_or(height, |carpet| carpet.begins(outline.cx));
        let [r, g, b] = inner.colour;
        let ground = carpet.map_or([100.0, 130.0, 100.0], |carpet| carpet.colour);
        let ratio = |x: f32, y: f32| ((x + 8.0) / (y + 8.0)).ln();
        Self([
            outline.inside,
            hue([r, g, b]),
            outline.inside - outer.redness,
            outline.agreeing,
            outline.rough,
            inner.filled,
            outer.leaking,
            outer.below,
            outer.carpet,
            (outline.a / outline.b).ln(),
            ((bottom - boundary) / height).clamp(-0.5, 0.5),
            (outline.a * outline.b).sqrt().ln(),
            inner.shading,
            inner.uneven,
            0.0,
            outline.shown,
            ratio(total(inner.colour), total(ground)),
            ratio(r, g) - ratio(ground[0], ground[1]),
            ratio(g, b) - ratio(ground[1], ground[2]),
            outer.uneven,
            outline.corners,
            outline.rough * (outline.a * outline.b).sqrt(),
            // What stands on the floor is as many times as high as it lies below the horizon, wherever it stands.
            (2.0 * outline.b / (bottom - boundary).max(1.0)).ln().clamp(-4.0, 4.0),
        ])
    }

    /// The probability of a ball, from 0 to 1: the weighed odds of an additive logistic model, whose weights are linear between
    /// knots and rise or fall as geometry says, and of nets, which know what features mean together.
    #[must_use]
    pub fn score(&self) -> f64 {
        let small = self.smallness();
        let terms = self.0.iter().zip(&KNOTS).zip(LARGE.iter().zip(&SMALL)).map(|((value, knots), (large, tiny))| {
            (1.0 - small) * between(*value, knots, large) + small * between(*value, knots, tiny)
        });
        let additive = OFFSET + terms.sum::<f32>();
        let odds = (1.0 - OF_NETS) * additive + OF_NETS * self.together();
        1.0 / (1.0 + f64::from(-odds).exp())
    }

    /// How far the weights of small candidates count, from 0 to 1.
    #[must_use]
    pub fn smallness(&self) -> f32 {
        let [small, large] = SMALL_TO_LARGE.map(f32::ln);
        ((large - self.0[SIZE]) / (large - small)).clamp(0.0, 1.0)
    }

    /// Logarithm of the odds of a ball, the mean of all nets. What lies beyond the knots counts as the nearest one: there was
    /// nothing to learn from.
    fn together(&self) -> f32 {
        let within: [f32; COUNT] = std::array::from_fn(|i| self.0[i].clamp(KNOTS[i][0], KNOTS[i][KNOTS[i].len() - 1]));
        NETS.iter().map(|net| net.odds(&within)).sum::<f32>() / NETS.len() as f32
    }
}

/// The weight of a value: linear between knots, level beyond.
fn between(value: f32, knots: &[f32], weights: &[f32]) -> f32 {
    let above = knots.partition_point(|knot| *knot <= value);
    if above == 0 {
        return weights[0];
    }
    if above == knots.len() {
        return weights[above - 1];
    }
    let share = (value - knots[above - 1]) / (knots[above] - knots[above - 1]);
    weights[above - 1] * (1.0 - share) + weights[above] * share
}

/// Fills in what depends on all candidates of a picture.
pub(super) fn rank(found: &mut [(Outline, Features)]) {
    let credible = |(_, features): &&(Outline, Features)| features.0[3] > 0.6 && features.0[6] < 0.4;
    let reddest = found.iter().filter(credible).map(|(_, f)| f.0[0]).fold(f32::NEG_INFINITY, f32::max);
    for (_, features) in found {
        features.0[14] = (reddest - features.0[0]).max(0.0);
    }
}

/// Degrees from red towards yellow, negative towards pink.
fn hue([r, g, b]: [f32; 3]) -> f32 {
    (3.0_f32.sqrt() * (g - b)).atan2(2.0 * r - g - b).to_degrees()
}

/// What is seen inside.
struct Inner {
    colour: [f32; 3],
    /// Half-way between redness inside and grey.
    middle: f32,
    filled: f32,
    shading: f32,
    uneven: f32,
}

impl Inner {
    fn of(picture: &Raster<[f32; 3]>, redness: &Raster<f32>, outline: &Outline) -> Self {
        let (left, right) = ((outline.cx - outline.a) as usize, (outline.cx + outline.a).ceil() as usize);
        let (top, bottom) = ((outline.cy - outline.b) as usize, (outline.cy + outline.b).ceil() as usize);
        let middle = outline.inside / 2.0;
        let (mut count, mut red, mut sum, mut halves) = (0.0, 0.0, [0.0; 3], [[0.0_f32; 2]; 2]);
        let (mut spread, mut reds) = (0.0, 0.0);
        let every = ((outline.a.max(outline.b) / MOST_ACROSS) as usize).max(1);
        for y in (top..bottom.min(picture.height)).step_by(every) {
            for x in (left..right.min(picture.width)).step_by(every) {
                let (u, v) = ((x as f32 + 0.5 - outline.cx) / outline.a, (y as f32 + 0.5 - outline.cy) / outline.b);
                if u * u + v * v > 0.8 {
                    continue;
                }
                let (pixel, value) = (picture.at(x, y), redness.at(x, y));
                count += 1.0;
                let half = &mut halves[usize::from(v > 0.0)];
                half[0] += pixel[1];
                half[1] += 1.0;
                if value > middle {
                    red += 1.0;
                    for (sum, c) in sum.iter_mut().zip(pixel) {
                        *sum += c;
                    }
                    reds += value;
                    spread += value * value;
                }
            }
        }
        let inside = f32::max(red, 1.0);
        let whole = 0.4 * std::f32::consts::PI * outline.a * outline.b / (every * every) as f32;
        let shown = halves.iter().all(|[_, count]| *count > HALF_SHOWN * whole);
        let [upper, lower] = halves.map(|[sum, count]| sum / f32::max(count, 1.0));
        let mean = reds / inside;
        Self {
            colour: sum.map(|c| c / inside),
            middle,
            filled: red / f32::max(count, 1.0),
            shading: if shown { (upper - lower) / (upper + lower + DIM) } else { USUAL_SHADING },
            uneven: (spread / inside - mean * mean).max(0.0).sqrt() / outline.inside.abs().max(0.05),
        }
    }
}

/// What is seen around.
struct Outer {
    redness: f32,
    leaking: f32,
    below: f32,
    carpet: f32,
    uneven: f32,
}

impl Outer {
    fn of(
        picture: &Raster<[f32; 3]>,
        redness: &Raster<f32>,
        carpet: Option<&Carpet>,
        outline: &Outline,
        middle: f32,
    ) -> Self {
        let gap = 1.0 / outline.a.min(outline.b).max(1.0);
        let (mut values, mut count, mut red) = (Vec::with_capacity(2 * AROUND), 0.0, 0.0);
        let (mut green, mut low, mut low_green) = (0.0, 0.0, 0.0);
        let mut lights = Vec::with_capacity(2 * AROUND);
        for scale in [1.15 + gap, 1.45 + gap] {
            for (k, [x, y]) in outline.points(AROUND, scale).enumerate() {
                let Some(value) = redness.under(x, y) else { continue };
                let is_carpet = carpet.is_some_and(|carpet| carpet.mask.under(x, y).unwrap_or(false));
                let lower = k > AROUND / 12 && k < AROUND * 5 / 12;
                values.push(value);
                lights.extend(picture.under(x, y).map(total));
                count += 1.0;
                red += f32::from(u8::from(value > middle));
                green += f32::from(u8::from(is_carpet));
                if lower {
                    low += 1.0;
                    low_green += f32::from(u8::from(is_carpet));
                }
            }
        }
        let all = f32::max(count, 1.0);
        let median = values.len() / 2;
        let typical = if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(median, f32::total_cmp).1 };
        let mean = lights.iter().sum::<f32>() / all;
        let spread = (lights.iter().map(|l| (l - mean).powi(2)).sum::<f32>() / all).sqrt();
        // Where the picture ends below, there is what is around.
        let below = if low > 0.0 { low_green / low } else { green / all };
        Self { redness: typical, leaking: red / all, below, carpet: green / all, uneven: spread / (mean + 20.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_whose_red_is_at_the_limit_has_the_shading_of_its_green() {
        let pixel = |i: usize| if i < 32 * 64 { [255.0, 150.0, 30.0] } else { [255.0, 90.0, 15.0] };
        let picture = Raster { width: 64, height: 64, data: (0..64 * 64).map(pixel).collect() };
        let redness = picture.map(super::super::redness::of);
        let outline = Outline {
            cx: 32.0,
            cy: 32.0,
            a: 12.0,
            b: 12.0,
            inside: 0.4,
            agreeing: 1.0,
            rough: 0.0,
            corners: 0.0,
            shown: 1.0,
        };
        let shading = Inner::of(&picture, &redness, &outline).shading;
        // By the sum of all components it is 0.09.
        assert!((shading - 60.0 / 250.0).abs() < 0.01, "{shading}");
    }

    #[test]
    fn what_is_small_is_weighed_as_such_by_and_by() {
        let small = |radius: f32| {
            let mut features = Features([0.0; COUNT]);
            features.0[SIZE] = radius.ln();
            features.smallness()
        };
        assert_eq!([2.0, SMALL_TO_LARGE[0]].map(small), [1.0; 2]);
        assert_eq!([SMALL_TO_LARGE[1] * 1.001, 40.0].map(small), [0.0; 2]);
        assert!((small((SMALL_TO_LARGE[0] * SMALL_TO_LARGE[1]).sqrt()) - 0.5).abs() < 1e-3);
        assert_eq!(NAMES[SIZE], "size, logarithm of pixels");
    }
}
