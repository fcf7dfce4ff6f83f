//! Changes of finished pictures that neither the renderer makes nor the detector was trained on.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f32::consts::{FRAC_PI_6, TAU};
use vision::picture::{Picture, decode};

/// A change and its name in the table.
pub(crate) type Effect = (&'static str, fn(&mut Picture, u64));

/// All of them. One stop is a factor of two in light.
pub(crate) const EFFECTS: [Effect; 11] = [
    ("as rendered", |_, _| {}),
    ("hue turned by -10 degrees", |picture, _| hue(picture, -FRAC_PI_6 / 3.0)),
    ("hue turned by 10 degrees", |picture, _| hue(picture, FRAC_PI_6 / 3.0)),
    ("one stop darker", |picture, _| exposure(picture, 0.5)),
    ("one stop brighter", |picture, _| exposure(picture, 2.0)),
    ("both: 10 degrees, one stop brighter", |picture, _| {
        hue(picture, FRAC_PI_6 / 3.0);
        exposure(picture, 2.0);
    }),
    ("both: -10 degrees, one stop darker", |picture, _| {
        hue(picture, -FRAC_PI_6 / 3.0);
        exposure(picture, 0.5);
    }),
    ("moved over 5 pixels", motion),
    ("coloured noise of 4 %", noise),
    ("corners darker by 60 %", |picture, _| corners(picture)),
    ("JPEG of quality 20, colour at half resolution", |picture, _| {
        *picture = decode(&picture.to_jpeg(20, true)).expect("what was just encoded can be decoded");
    }),
];

fn each(picture: &mut Picture, change: impl Fn([f32; 3]) -> [f32; 3]) {
    for pixel in picture.pixels_mut() {
        *pixel = change(pixel.map(f32::from)).map(|c| c.round().clamp(0.0, 255.0) as u8);
    }
}

/// Turns colours about the axis of grey (Rodrigues).
fn hue(picture: &mut Picture, angle: f32) {
    let (s, c) = angle.sin_cos();
    let (even, odd) = ((1.0 - c) / 3.0, s / 3.0_f32.sqrt());
    each(picture, |[r, g, b]| {
        let turned = |x: f32, y: f32, z: f32| x * (c + even) + y * (even - odd) + z * (even + odd);
        [turned(r, g, b), turned(g, b, r), turned(b, r, g)]
    });
}

/// Light times `factor`, through a tone curve of exponent 1 / 2.2.
fn exposure(picture: &mut Picture, factor: f32) {
    let factor = factor.powf(1.0 / 2.2);
    each(picture, |pixel| pixel.map(|c| c * factor));
}

/// The mean along a line of 5 pixels in a direction that the seed gives.
fn motion(picture: &mut Picture, seed: u64) {
    const PIXELS: i32 = 5;
    let (s, c) = (ChaCha8Rng::seed_from_u64(seed).random::<f32>() * TAU).sin_cos();
    let before = picture.clone();
    let (width, height) = (before.width() as i32, before.height() as i32);
    let at = |x: i32, y: i32| before.pixels()[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
    for (i, pixel) in picture.pixels_mut().iter_mut().enumerate() {
        let (x, y) = (i as i32 % width, i as i32 / width);
        let mut sum = [0.0; 3];
        for step in -PIXELS / 2..=PIXELS / 2 {
            let other = at(x + (step as f32 * c).round() as i32, y + (step as f32 * s).round() as i32);
            sum = std::array::from_fn(|k| sum[k] + f32::from(other[k]) / PIXELS as f32);
        }
        *pixel = sum.map(|c| c.round() as u8);
    }
}

/// Noise of a standard deviation of 4 % of full scale, each component on its own.
fn noise(picture: &mut Picture, seed: u64) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    // The sum of three uniform numbers from -1 to 1 has a standard deviation of 1.
    let mut normal = || (0..3).map(|_| rng.random_range(-1.0..1.0_f32)).sum::<f32>();
    for c in picture.pixels_mut().as_flattened_mut() {
        *c = (f32::from(*c) + 0.04 * 255.0 * normal()).round().clamp(0.0, 255.0) as u8;
    }
}

/// Light falls to 40 % in the corners.
fn corners(picture: &mut Picture) {
    let (width, height) = (picture.width(), picture.height());
    for (i, pixel) in picture.pixels_mut().iter_mut().enumerate() {
        let part = |place: usize, size: usize| ((place as f32 + 0.5) / size as f32 - 0.5).powi(2) * 4.0;
        let light = 1.0 - 0.6 * (part(i % width, width) + part(i / width, height)) / 2.0;
        *pixel = pixel.map(|c| (f32::from(c) * light.powf(1.0 / 2.2)).round() as u8);
    }
}
