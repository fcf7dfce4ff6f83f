//! Lamps, shadows and how surfaces return light.

use super::Point;
use super::sensor::normal;
use rand_chacha::ChaCha8Rng;

/// A lamp of the hall: a soft ball of light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamp {
    /// Field frame, m.
    pub(super) at: Point,
    /// How soft its shadows are: standard deviation of its size, m.
    pub(super) size: f64,
    /// Light it gives the floor below [`Self::reference`], of white.
    pub(super) strength: f64,
    /// Factors of red, green and blue, about 1.
    pub(super) tint: [f64; 3],
    /// Place on the floor where its strength holds.
    pub(super) reference: Point,
}

/// What a surface returns at one point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finish {
    /// Diffuse reflectance, linear.
    pub(super) albedo: [f64; 3],
    /// Share of a lamp that shines back as a highlight.
    pub(super) gloss: f64,
    /// Exponent of the highlight (Blinn 1977).
    pub(super) sharpness: f64,
}

impl Lamp {
    /// Light on a surface with this normal, where nothing is in the way, and the direction it comes from and how far.
    pub(super) fn onto(&self, at: Point, normal: Point, rng: &mut ChaCha8Rng) -> (f64, Point, f64) {
        let spread = Point::new(self::normal(rng), self::normal(rng), self::normal(rng)) * self.size;
        let to = self.at + spread - at;
        let far = to.norm();
        let towards = to / far;
        let there = self.at - self.reference;
        let scale = there.norm().powi(3) / there.z.max(0.1);
        (self.strength * scale * normal.dot(&towards).max(0.0) / (far * far), towards, far)
    }
}

impl Finish {
    /// Light towards the eye of a lamp of one colour, `amount` strong on the surface.
    pub(super) fn lit(&self, amount: f64, tint: [f64; 3], normal: Point, towards: Point, along: Point) -> [f64; 3] {
        let highlight = if self.gloss == 0.0 {
            0.0
        } else {
            let half = (towards - along).normalize();
            self.gloss * (self.sharpness + 2.0) / 8.0 * normal.dot(&half).max(0.0).powf(self.sharpness)
        };
        [0, 1, 2].map(|i| amount * tint[i] * (self.albedo[i] + highlight))
    }
}
