//! JPEG files as cameras write them.

use super::Picture;
use jpeg_encoder::{Encoder, ImageBuffer, JpegColorType, SamplingFactor, rgb_to_ycbcr};

/// A JPEG file of a quality from 1 to 100, with colour at half the resolution or at the whole.
pub(super) fn encoded(picture: &Picture, quality: u8, subsampled: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, quality);
    encoder.set_sampling_factor(if subsampled { SamplingFactor::F_2_2 } else { SamplingFactor::F_1_1 });
    encoder.encode_image(Rows { picture, cell: if subsampled { 2 } else { 1 } }).expect("memory takes every picture");
    bytes
}

/// Rows for the encoder, which takes one pixel's colour for all of a cell: each pixel here has the mean colour of its cell,
/// so that colour neither moves by half a pixel nor is that of one pixel in four.
struct Rows<'a> {
    picture: &'a Picture,
    /// Pixels across and down of one value of colour.
    cell: usize,
}

impl ImageBuffer for Rows<'_> {
    fn get_jpeg_color_type(&self) -> JpegColorType {
        JpegColorType::Ycbcr
    }

    fn width(&self) -> u16 {
        // Sides are at most LARGEST_SIDE.
        self.picture.width as u16
    }

    fn height(&self) -> u16 {
        self.picture.height as u16
    }

    fn fill_buffers(&self, y: u16, buffers: &mut [Vec<u8>; 4]) {
        let Picture { width, height, pixels } = self.picture;
        let at = |x: usize, y: usize| {
            let [r, g, b] = pixels[y * width + x];
            rgb_to_ycbcr(r, g, b)
        };
        let top = usize::from(y) / self.cell * self.cell;
        let bottom = (top + self.cell).min(*height);
        let [light, blue, red, _] = buffers;
        light.extend((0..*width).map(|x| at(x, usize::from(y)).0));
        for left in (0..*width).step_by(self.cell) {
            let right = (left + self.cell).min(*width);
            let count = ((right - left) * (bottom - top)) as u32;
            let cell = (top..bottom).flat_map(|y| (left..right).map(move |x| at(x, y)));
            let [b, r] = cell.fold([count / 2; 2], |[b, r], (_, cb, cr)| [b + u32::from(cb), r + u32::from(cr)]);
            for _ in left..right {
                blue.push((b / count) as u8);
                red.push((r / count) as u8);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::decode;
    use super::*;

    /// Where the redness of a picture has its middle, pixels.
    fn middle(picture: &Picture) -> [f64; 2] {
        let mut sums = [0.0; 3];
        for (i, [r, g, _]) in picture.pixels.iter().enumerate() {
            let weight = (f64::from(*r) - f64::from(*g) + 60.0).max(0.0);
            let place = [(i % picture.width) as f64 + 0.5, (i / picture.width) as f64 + 0.5, 1.0];
            sums = std::array::from_fn(|k| sums[k] + weight * place[k]);
        }
        [sums[0] / sums[2], sums[1] / sums[2]]
    }

    #[test]
    fn colour_at_half_the_resolution_stays_where_it_is() {
        for (left, top) in [(20, 20), (21, 20), (20, 21), (21, 21)] {
            let inside = |i: usize| (left..left + 9).contains(&(i % 64)) && (top..top + 9).contains(&(i / 64));
            let pixels = (0..64 * 64).map(|i| if inside(i) { [210, 90, 20] } else { [60, 120, 60] }).collect();
            let picture = Picture { width: 64, height: 64, pixels };
            let seen = decode(&picture.to_jpeg(95, true)).expect("what was just encoded can be decoded");
            let (was, is) = (middle(&picture), middle(&seen));
            for k in 0..2 {
                // The encoder's own choice of colour moves it by 0.5.
                assert!((is[k] - was[k]).abs() < 0.15, "{is:?} of {was:?}");
            }
        }
    }

    #[test]
    fn sides_need_not_be_even() {
        let pixels: Vec<_> = (0..33 * 37).map(|i| [(i % 33 * 7) as u8, (i / 33 * 6) as u8, 60]).collect();
        let picture = Picture { width: 33, height: 37, pixels };
        for subsampled in [false, true] {
            let seen = decode(&picture.to_jpeg(97, subsampled)).expect("what was just encoded can be decoded");
            assert_eq!((seen.width, seen.height), (33, 37));
            let off = |(a, b): (&u8, &u8)| f64::from(a.abs_diff(*b));
            let all = seen.pixels.as_flattened().iter().zip(picture.pixels.as_flattened()).map(off).sum::<f64>();
            assert!(all / (33.0 * 37.0 * 3.0) < 4.0, "{all}");
        }
    }
}
