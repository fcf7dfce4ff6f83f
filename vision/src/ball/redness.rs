//! Redness: how far a pixel is from green and blue towards red, whatever its brightness.

use crate::carpet::total;
use crate::picture::Raster;

/// Added to the sum of components, of 255: below, noise would make colours of dark pixels.
const DARK: f32 = 40.0;

/// Redness of a pixel: −0.5 for green carpet, 0 for grey, 0.15 for skin and wood, 0.2 to 0.6 for a ball, 0.8 for red.
pub(super) fn of(pixel: [f32; 3]) -> f32 {
    let [r, g, b] = pixel;
    ((r - g) + 0.5 * (r - b)) / (total(pixel) + DARK)
}

/// Redness of all pixels.
pub(super) fn redness(picture: &Raster<[f32; 3]>) -> Raster<f32> {
    picture.map(of)
}
