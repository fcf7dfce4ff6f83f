//! A colour picture, and reading it from a file.

mod jpeg;
mod orientation;
mod read;

pub use read::{PictureError, decode, read};

/// Smallest side of a picture, pixels: below, a ball of 8 pixels would fill it.
pub const SMALLEST_SIDE: usize = 32;
/// Largest side of a picture, pixels: 8K video.
pub const LARGEST_SIDE: usize = 8192;

/// Share of pixels below [`DARK`] at which a picture shows nothing: a lens cap leaves noise, a dark hall some lamp.
const BLACK_SHARE: f64 = 0.995;
/// Largest component of a dark pixel, of 255: read noise of 0.4 % of full scale, four standard deviations, through the
/// tone curve is 39.
const DARK: u8 = 48;
/// Mean of all components of a black picture, of 255, at most: the same noise has a mean of 8.
const BLACK_MEAN: f64 = 14.0;
/// Share of pixels with two components at the limit at which a picture is over-exposed beyond use: a field with its
/// carpet at the limit has no green left to measure colours by.
const OVER_EXPOSED_SHARE: f64 = 0.9;
/// A component that counts as at the limit, of 255.
const LIMIT: u8 = 250;

/// 8-bit sRGB pixels, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

/// Why a picture cannot be used although it could be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unusable {
    /// Sides out of range.
    #[error(
        "{width} x {height} pixels; both sides must be {SMALLEST_SIDE} to {LARGEST_SIDE}: give the camera's own frame"
    )]
    Size {
        /// Pixels a row.
        width: usize,
        /// Height, pixels.
        height: usize,
    },
    /// Not the size that the camera was calibrated at.
    #[error("{width} x {height} pixels, but the camera is calibrated at {expected_width} x {expected_height}")]
    NotCalibrated {
        /// Pixels a row.
        width: usize,
        /// Height, pixels.
        height: usize,
        /// Pixels a row in the calibration.
        expected_width: usize,
        /// Rows in the calibration.
        expected_height: usize,
    },
    /// Nothing but dark pixels.
    #[error("the picture is black: is the lens covered, or the exposure far too short?")]
    Black,
    /// Nearly all pixels at the sensor's limit.
    #[error("the picture is over-exposed: shorten the exposure or lower the gain")]
    OverExposed,
    /// Every pixel the same.
    #[error("the picture has one colour only: the camera delivers no image")]
    Flat,
    /// The same bytes as the picture before; a live sensor's noise makes that impossible.
    #[error("the picture equals the one before, pixel for pixel: the camera is frozen")]
    Frozen,
}

/// Pixels of a picture in a row of one pixel of the working picture, at least `working` pixels wide.
pub(crate) fn reduction(width: usize, height: usize, working: usize) -> usize {
    // A very wide picture keeps its rows.
    (width / working).min(height / SMALLEST_SIDE).max(1)
}

impl Picture {
    /// A picture of `height` rows of `width` pixels.
    ///
    /// # Errors
    /// [`Unusable::Size`] for sides out of range.
    ///
    /// # Panics
    /// When there are not `width` times `height` pixels.
    pub fn new(width: usize, height: usize, pixels: Vec<[u8; 3]>) -> Result<Self, Unusable> {
        let range = SMALLEST_SIDE..=LARGEST_SIDE;
        if !range.contains(&width) || !range.contains(&height) {
            return Err(Unusable::Size { width, height });
        }
        assert_eq!(pixels.len(), width * height, "a picture of {width} x {height} pixels");
        Ok(Self { width, height, pixels })
    }

    /// Pixels a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height, pixels.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Red, green and blue, row by row.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// Red, green and blue, row by row.
    pub fn pixels_mut(&mut self) -> &mut [[u8; 3]] {
        &mut self.pixels
    }

    /// The picture as a JPEG file of a quality from 1 to 100; `subsampled` stores colour at half the resolution, as video
    /// does.
    ///
    /// # Panics
    /// When memory runs out.
    #[must_use]
    pub fn to_jpeg(&self, quality: u8, subsampled: bool) -> Vec<u8> {
        jpeg::encoded(self, quality, subsampled)
    }

    /// Checks that the picture shows something.
    ///
    /// # Errors
    /// [`Unusable::Flat`], [`Unusable::Black`], [`Unusable::OverExposed`].
    pub fn check(&self) -> Result<(), Unusable> {
        let all = self.pixels.len() as f64;
        let sum: u64 = self.pixels.as_flattened().iter().map(|&c| u64::from(c)).sum();
        let mean = sum as f64 / (3 * self.pixels.len()) as f64;
        let dark = |pixel: &&[u8; 3]| pixel.iter().all(|&c| c < DARK);
        if mean < BLACK_MEAN && self.pixels.iter().filter(dark).count() as f64 >= BLACK_SHARE * all {
            return Err(Unusable::Black);
        }
        let over = |pixel: &&[u8; 3]| pixel.iter().map(|&c| u8::from(c >= LIMIT)).sum::<u8>() >= 2;
        if self.pixels.iter().filter(over).count() as f64 >= OVER_EXPOSED_SHARE * all {
            return Err(Unusable::OverExposed);
        }
        if self.pixels.iter().all(|pixel| *pixel == self.pixels[0]) {
            return Err(Unusable::Flat);
        }
        Ok(())
    }

    /// The picture in floating point, sides divided by the whole number that brings the width to `width` or little
    /// more; and that number.
    pub(crate) fn reduced(&self, width: usize) -> (Raster<[f32; 3]>, usize) {
        let by = reduction(self.width, self.height, width);
        let (columns, rows) = (self.width / by, self.height / by);
        if by == 1 {
            let data = self.pixels.iter().map(|pixel| pixel.map(f32::from)).collect();
            return (Raster { width: columns, height: rows, data }, 1);
        }
        let mut data = Vec::with_capacity(columns * rows);
        // The usual sizes as constants: the compiler unrolls them.
        match by {
            2 => self.blocks(2, &mut data),
            3 => self.blocks(3, &mut data),
            _ => self.blocks(by, &mut data),
        }
        (Raster { width: columns, height: rows, data }, by)
    }

    /// Means of blocks of `by` times `by` pixels.
    #[inline(always)]
    fn blocks(&self, by: usize, means: &mut Vec<[f32; 3]>) {
        let scale = 1.0 / (by * by) as f32;
        for rows in self.pixels.chunks_exact(by * self.width) {
            for left in (0..=self.width - by).step_by(by) {
                let mut sum = [0_u32; 3];
                for row in 0..by {
                    for [r, g, b] in &rows[row * self.width + left..][..by] {
                        sum = [sum[0] + u32::from(*r), sum[1] + u32::from(*g), sum[2] + u32::from(*b)];
                    }
                }
                means.push(sum.map(|c| c as f32 * scale));
            }
        }
    }
}

/// Values on a grid of pixels, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Raster<T> {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) data: Vec<T>,
}

impl<T: Copy> Raster<T> {
    /// The same grid with other values.
    pub(crate) fn map<U>(&self, value: impl Fn(T) -> U) -> Raster<U> {
        Raster { width: self.width, height: self.height, data: self.data.iter().map(|&old| value(old)).collect() }
    }

    /// The value at a pixel.
    pub(crate) fn at(&self, x: usize, y: usize) -> T {
        self.data[y * self.width + x]
    }

    /// The value of the pixel that a point lies in; `None` outside.
    pub(crate) fn under(&self, x: f32, y: f32) -> Option<T> {
        let inside = x >= 0.0 && y >= 0.0 && (x as usize) < self.width && (y as usize) < self.height;
        inside.then(|| self.at(x as usize, y as usize))
    }
}

impl Raster<f32> {
    /// The value at a point, bilinear between pixel centres; `None` outside the picture.
    pub(crate) fn sample(&self, x: f32, y: f32) -> Option<f32> {
        if x < 0.0 || y < 0.0 || x >= self.width as f32 || y >= self.height as f32 {
            return None;
        }
        let (x, y) = ((x - 0.5).max(0.0), (y - 0.5).max(0.0));
        let (left, top) = (x as usize, y as usize);
        let (right, bottom) = ((left + 1).min(self.width - 1), (top + 1).min(self.height - 1));
        let (fx, fy) = (x - left as f32, y - top as f32);
        let upper = self.at(left, top) * (1.0 - fx) + self.at(right, top) * fx;
        let lower = self.at(left, bottom) * (1.0 - fx) + self.at(right, bottom) * fx;
        Some(upper * (1.0 - fy) + lower * fy)
    }
}
