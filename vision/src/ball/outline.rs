//! A candidate's outline: an upright ellipse through the points where redness is half-way between inside and outside.

use super::Region;
use super::directions::directions;
use super::regions::Blob;
use crate::picture::Raster;
use nalgebra::{Matrix4, Vector4};

/// Rays from the middle.
pub(super) const RAYS: usize = 32;
/// Times the ellipse is fitted again from its new middle.
const ROUNDS: usize = 2;
/// How far a ray looks, in radii.
const REACH: f32 = 1.8;
/// A crossing farther than this from the ellipse, in radii, is of something else: a highlight, a neighbour.
const OUTLIER: f32 = 0.2;
/// A bulge counts up to this, in radii: a box's corner lies 0.26 beyond the ellipse that fits its outline.
const BULGE: f32 = 0.4;
/// How far a fit may move a box's sides, in radii.
const TRUSTED: f32 = 0.5;

/// What half-way misses of a ball's width and height, pixels: between the medians over rendered balls of 8 pixels and more
/// (0.5 and 0.8: the lower part is dim, and video stores colour at half the resolution), and those over people's labels,
/// from 0 to 2.
const MISSED: [f32; 2] = [0.6, 0.9];

/// An upright ellipse and how well the picture agrees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    pub(super) cx: f32,
    pub(super) cy: f32,
    pub(super) a: f32,
    pub(super) b: f32,
    /// Typical redness inside.
    pub(super) inside: f32,
    /// Share of rays, of those within the picture, that cross near the ellipse.
    pub(super) agreeing: f32,
    /// Root mean square distance of those crossings from the ellipse, in radii.
    pub(super) rough: f32,
    /// How far it bulges towards the corners of its box, radii: the fourth harmonic of the crossings' distance.
    pub(super) corners: f32,
    /// Share of rays within the picture.
    pub(super) shown: f32,
}

impl Outline {
    /// The outline of a region; `None` where redness makes none.
    pub(super) fn refine(redness: &Raster<f32>, blob: Blob) -> Option<Self> {
        let (a, b) = ((blob.right - blob.left) / 2.0, (blob.bottom - blob.top) / 2.0);
        let (cx, cy) = (blob.left + a, blob.top + b);
        let first = Self { cx, cy, a, b, inside: 0.0, agreeing: 0.0, rough: 1.0, corners: 0.0, shown: 0.0 };
        let mut now = first;
        for round in 0..=ROUNDS {
            now.inside = now.typical(redness)?;
            let crossings = now.crossings(redness);
            let shown = crossings.iter().filter(|crossing| !matches!(crossing, Crossing::Outside)).count();
            now.judge(&crossings, shown);
            if round == ROUNDS {
                break;
            }
            // Without a fit another round would find the same.
            let Some(fit) = now.fitted(&crossings).filter(|fit| fit.near(&first)) else { break };
            now = fit;
        }
        Some(now)
    }

    /// The box, clipped to the picture, in pixels of a picture `by` times as large.
    pub(super) fn region<T: Copy>(&self, working: &Raster<T>, by: usize) -> Region {
        let span = |middle: f32, half: f32, size: usize| {
            let (low, high) = ((middle - half).max(0.0), (middle + half).min(size as f32));
            (f64::from(low + high) / 2.0 * by as f64, f64::from(high - low) * by as f64)
        };
        let (x, width) = span(self.cx, self.a + MISSED[0] / 2.0, working.width);
        let (y, height) = span(self.cy, self.b + MISSED[1] / 2.0, working.height);
        Region { x, y, width, height }
    }

    /// Points on the ellipse blown up by `scale`.
    pub(super) fn points(&self, count: usize, scale: f32) -> impl Iterator<Item = [f32; 2]> {
        let Self { cx, cy, a, b, .. } = *self;
        directions(count).map(move |[c, s]| [cx + scale * a * c, cy + scale * b * s])
    }

    /// The 60th percentile of redness inside: neither highlight nor blurred edge.
    fn typical(&self, redness: &Raster<f32>) -> Option<f32> {
        let (mut values, mut count) = ([0.0; 64], 0);
        for ring in [0.0, 0.3, 0.55, 0.75] {
            for value in self.points(16, ring).filter_map(|[x, y]| redness.sample(x, y)) {
                values[count] = value;
                count += 1;
            }
        }
        (count >= 12).then(|| *values[..count].select_nth_unstable_by(count * 6 / 10, f32::total_cmp).1)
    }

    fn crossings(&self, redness: &Raster<f32>) -> [Crossing; RAYS] {
        let mut crossings = [Crossing::None; RAYS];
        for (crossing, direction) in crossings.iter_mut().zip(directions(RAYS)) {
            *crossing = self.crossing(redness, direction);
        }
        crossings
    }

    fn crossing(&self, redness: &Raster<f32>, [c, s]: [f32; 2]) -> Crossing {
        let (across, down) = (self.a * c, self.b * s);
        let at = |scale: f32| redness.sample(self.cx + scale * across, self.cy + scale * down);
        let Some(_) = at(1.0) else { return Crossing::Outside };
        // One pixel beyond the ellipse is outside for large and small ones alike.
        let pixel = 1.0 / self.a.min(self.b).max(1.0);
        let outside = match [1.25, 1.45].map(|scale| at(scale + pixel * 0.7)) {
            [Some(near), Some(far)] => (near + far) / 2.0,
            [Some(one), None] | [None, Some(one)] => one,
            [None, None] => return Crossing::Outside,
        };
        if self.inside - outside < 0.3 * self.inside.abs().max(0.1) {
            return Crossing::None;
        }
        let half = (self.inside + outside) / 2.0;
        let step = (0.7 * pixel).clamp(0.03, 0.2);
        let mut before = f32::NAN;
        let mut scale = 0.45;
        // Of several the nearest counts: a highlight has edges too.
        let mut nearest = Crossing::None;
        while scale < REACH {
            let Some(value) = at(scale) else { break };
            if value < half && before >= half {
                let found = scale - step * (half - value) / (before - value);
                match nearest {
                    Crossing::At(other) if (other - 1.0).abs() < (found - 1.0).abs() => break,
                    _ => nearest = Crossing::At(found),
                }
                if found > 1.0 {
                    break;
                }
            }
            before = value;
            scale += step;
        }
        nearest
    }

    fn judge(&mut self, crossings: &[Crossing], shown: usize) {
        let off = crossings.iter().filter_map(|crossing| match crossing {
            Crossing::At(scale) if (scale - 1.0).abs() < OUTLIER => Some((scale - 1.0).powi(2)),
            _ => None,
        });
        let (count, sum) = off.fold((0, 0.0), |(count, sum), off| (count + 1, sum + off));
        let bulges = crossings.iter().zip(directions(RAYS)).filter_map(|(crossing, [c, s])| match crossing {
            // cos 4t = 1 - 8 sin² t cos² t
            Crossing::At(scale) => Some((scale - 1.0).clamp(-BULGE, BULGE) * (8.0 * c * c * s * s - 1.0)),
            _ => None,
        });
        self.corners = 2.0 * bulges.sum::<f32>() / RAYS as f32;
        self.shown = shown as f32 / RAYS as f32;
        self.agreeing = if shown == 0 { 0.0 } else { count as f32 / shown as f32 };
        self.rough = if count == 0 { OUTLIER } else { (sum / count as f32).sqrt() };
    }

    /// The ellipse through the crossings: u² / a² + v² / b² linear in its coefficients, twice, the second time without
    /// what is far from the first.
    fn fitted(&self, crossings: &[Crossing]) -> Option<Self> {
        let points = || {
            crossings.iter().zip(directions(RAYS)).filter_map(|(crossing, [c, s])| match crossing {
                Crossing::At(scale) => Some([scale * c, scale * s]),
                _ => None,
            })
        };
        let first = ellipse(points())?;
        let [cu, cv, a, b] = ellipse(points().filter(|p| distance(&first, *p).abs() < OUTLIER))?;
        Some(Self { cx: self.cx + cu * self.a, cy: self.cy + cv * self.b, a: a * self.a, b: b * self.b, ..*self })
    }

    fn near(&self, first: &Self) -> bool {
        let moved = |now: f32, was: f32, radius: f32| (now - was).abs() < TRUSTED * radius + 1.0;
        moved(self.cx - self.a, first.cx - first.a, first.a)
            && moved(self.cx + self.a, first.cx + first.a, first.a)
            && moved(self.cy - self.b, first.cy - first.b, first.b)
            && moved(self.cy + self.b, first.cy + first.b, first.b)
    }
}

/// Where a ray leaves the candidate.
#[derive(Clone, Copy, Debug)]
enum Crossing {
    /// At this multiple of the ellipse's radius.
    At(f32),
    /// Nowhere: what is outside is as red.
    None,
    /// Beyond the picture's edge.
    Outside,
}

/// Middle and half axes of the upright ellipse through points, in least squares of A u² + B v² + C u + D v = 1.
fn ellipse(points: impl Iterator<Item = [f32; 2]>) -> Option<[f32; 4]> {
    let (mut m, mut right, mut count) = (Matrix4::<f32>::zeros(), Vector4::zeros(), 0);
    for [u, v] in points {
        let row = Vector4::new(u * u, v * v, u, v);
        m += row * row.transpose();
        right += row;
        count += 1;
    }
    if count < 10 {
        return None;
    }
    let [[a, b, c, d]] = m.cholesky()?.solve(&right).data.0;
    if a <= 0.0 || b <= 0.0 {
        return None;
    }
    let (cu, cv) = (-c / (2.0 * a), -d / (2.0 * b));
    let scale = 1.0 + a * cu * cu + b * cv * cv;
    Some([cu, cv, (scale / a).sqrt(), (scale / b).sqrt()])
}

fn distance(ellipse: &[f32; 4], p: [f32; 2]) -> f32 {
    let [cu, cv, a, b] = *ellipse;
    ((p[0] - cu) / a).hypot((p[1] - cv) / b) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_highlight_does_not_move_the_outline() {
        // A red disc of radius 12 on green, with a white spot of radius 2.5 near its edge.
        let within =
            |i: usize, [x, y]: [f32; 2], r: f32| ((i % 64) as f32 + 0.5 - x).hypot((i / 64) as f32 + 0.5 - y) < r;
        let value = |i: usize| match i {
            i if within(i, [26.0, 26.0], 2.5) => 0.0,
            i if within(i, [32.0, 32.0], 12.0) => 0.4,
            _ => -0.3,
        };
        let redness = Raster { width: 64, height: 64, data: (0..64 * 64).map(value).collect() };
        let blob = super::super::regions::regions(&redness, -0.3, 1)[0];
        let outline = Outline::refine(&redness, blob).expect("the disc has an outline");
        assert!(outline.agreeing > 0.99 && outline.rough < 0.05, "{outline:?}");
        assert!((outline.cx - 32.0).hypot(outline.cy - 32.0) < 0.3, "{outline:?}");
    }
}
