//! From light to bytes: lens, exposure, noise, processing and compression of a small camera.

use crate::picture::{Picture, decode};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// What a camera does to the light that falls on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Full well over mid-grey illumination: 1 is right, 2 burns highlights out.
    pub exposure: f64,
    /// Gains of red, green and blue, of its white balance against the light.
    pub white_balance: [f64; 3],
    /// Share of the automatic white balance that makes the picture's mean grey: a green field then looks dull and all else
    /// pink.
    pub grey_world: f64,
    /// Colour saturation, 1 is true.
    pub saturation: f64,
    /// Exponent of the tone curve, 1 / 2.2 is standard.
    pub gamma: f64,
    /// Light that falls on everything: flare and black level.
    pub haze: f64,
    /// Darkening in the corners, 0 to 1.
    pub vignette: f64,
    /// Standard deviation of defocus, pixels.
    pub blur: f64,
    /// Share of the Laplacian that sharpening subtracts.
    pub sharpening: f64,
    /// Standard deviation of shot noise at full well and of read noise, of full scale.
    pub noise: [f64; 2],
    /// Spots of dirt on the lens.
    pub dirt: usize,
    /// JPEG quality, 1 to 100; `None` keeps the pixels.
    pub quality: Option<u8>,
    /// Whether colour is stored at half the resolution, as video does.
    pub subsampled: bool,
}

impl Sensor {
    /// A good camera in good light.
    pub const GOOD: Self = Self {
        exposure: 1.0,
        white_balance: [1.0; 3],
        grey_world: 0.0,
        saturation: 1.0,
        gamma: 1.0 / 2.2,
        haze: 0.01,
        vignette: 0.1,
        blur: 0.5,
        sharpening: 0.2,
        noise: [0.01, 0.004],
        dirt: 0,
        quality: Some(90),
        subsampled: true,
    };

    /// Develops light (linear, 1 is white in right exposure) into a picture.
    pub(super) fn develop(&self, width: usize, height: usize, light: Vec<[f64; 3]>, rng: &mut ChaCha8Rng) -> Picture {
        let mut light = blurred(light, width, self.blur);
        self.soil(&mut light, width, height, rng);
        let gains = self.gains(&light);
        let centre = [width as f64 / 2.0, height as f64 / 2.0];
        for (i, pixel) in light.iter_mut().enumerate() {
            let at = [(i % width) as f64 + 0.5, (i / width) as f64 + 0.5];
            let r2 = ((at[0] - centre[0]) / centre[0]).powi(2) + ((at[1] - centre[1]) / centre[1]).powi(2);
            let shade = 1.0 - self.vignette * r2 / 2.0;
            for (c, gain) in pixel.iter_mut().zip(gains) {
                let signal = (*c * shade + self.haze) * self.exposure;
                let variance = self.noise[0].powi(2) * signal.clamp(0.0, 1.0) + self.noise[1].powi(2);
                let noise = variance.sqrt() * normal(rng);
                *c = (signal + noise).min(1.0) * gain;
            }
        }
        let light = sharpened(light, width, self.sharpening);
        let pixels = light.into_iter().map(|pixel| self.tone(pixel)).collect();
        let picture = Picture::new(width, height, pixels).expect("a renderer draws pictures of usable size");
        match self.quality {
            None => picture,
            Some(quality) => compressed(&picture, quality, self.subsampled),
        }
    }

    /// Gains of red, green and blue, manual and automatic.
    fn gains(&self, light: &[[f64; 3]]) -> [f64; 3] {
        let mean = |i: usize| light.iter().map(|pixel| (pixel[i] * self.exposure).min(1.0)).sum::<f64>() + 1e-6;
        [0, 1, 2].map(|i| self.white_balance[i] * (mean(1) / mean(i)).powf(self.grey_world))
    }

    fn tone(&self, pixel: [f64; 3]) -> [u8; 3] {
        let curved = pixel.map(|c| c.clamp(0.0, 1.0).powf(self.gamma));
        let grey = 0.299 * curved[0] + 0.587 * curved[1] + 0.114 * curved[2];
        curved.map(|c| ((grey + self.saturation * (c - grey)).clamp(0.0, 1.0) * 255.0).round() as u8)
    }

    /// Dust is out of focus: it takes light from a round patch and spreads it.
    fn soil(&self, light: &mut [[f64; 3]], width: usize, height: usize, rng: &mut ChaCha8Rng) {
        for _ in 0..self.dirt {
            let (x, y) = (rng.random_range(0.0..width as f64), rng.random_range(0.0..height as f64));
            let radius = rng.random_range(0.02..0.12) * width as f64;
            let (loss, glow) = (rng.random_range(0.05..0.35), rng.random_range(0.0..0.06));
            for (i, pixel) in light.iter_mut().enumerate() {
                let r = ((i % width) as f64 - x).hypot((i / width) as f64 - y) / radius;
                let share = (1.0 - r * r).max(0.0);
                *pixel = pixel.map(|c| c * (1.0 - loss * share) + glow * share);
            }
        }
    }
}

/// Through the encoder of a camera and back.
fn compressed(picture: &Picture, quality: u8, subsampled: bool) -> Picture {
    decode(&picture.to_jpeg(quality, subsampled)).expect("what was just encoded can be decoded")
}

/// Gaussian of standard deviation `sd` pixels, first along rows, then along columns.
fn blurred(light: Vec<[f64; 3]>, width: usize, sd: f64) -> Vec<[f64; 3]> {
    if sd < 0.1 {
        return light;
    }
    let reach = (3.0 * sd).ceil() as isize;
    let weights: Vec<f64> = (-reach..=reach).map(|i| (-0.5 * (i as f64 / sd).powi(2)).exp()).collect();
    let total: f64 = weights.iter().sum();
    let weights: Vec<f64> = weights.into_iter().map(|weight| weight / total).collect();
    let height = light.len() / width;
    let pass = |from: &[[f64; 3]], across: bool| {
        let mut to = Vec::with_capacity(from.len());
        for i in 0..from.len() {
            let (x, y) = ((i % width) as isize, (i / width) as isize);
            let mut sum = [0.0; 3];
            for (k, weight) in weights.iter().enumerate() {
                let step = k as isize - reach;
                let (px, py) = if across { (x + step, y) } else { (x, y + step) };
                let (px, py) = (px.clamp(0, width as isize - 1), py.clamp(0, height as isize - 1));
                let pixel = from[py as usize * width + px as usize];
                for (sum, c) in sum.iter_mut().zip(pixel) {
                    *sum += weight * c;
                }
            }
            to.push(sum);
        }
        to
    };
    pass(&pass(&light, true), false)
}

fn sharpened(light: Vec<[f64; 3]>, width: usize, share: f64) -> Vec<[f64; 3]> {
    if share <= 0.0 {
        return light;
    }
    let soft = blurred(light.clone(), width, 1.0);
    light.iter().zip(soft).map(|(pixel, soft)| [0, 1, 2].map(|i| pixel[i] + share * (pixel[i] - soft[i]))).collect()
}

/// Nearly standard normal, for noise of pixels: the sum of four uniform numbers, whose tails end at 3.5.
pub(super) fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let bits: u64 = rng.random();
    let sum: f64 = (0..4).map(|k| ((bits >> (16 * k)) & 0xffff) as f64).sum();
    // Mean 4 · 32767.5, variance 4 · 65536² / 12.
    (sum - 131_070.0) / 37_837.23
}
