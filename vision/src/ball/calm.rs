//! Noise: where it would break a ball into specks, the picture is smoothed first.

use super::redness::of;
use crate::picture::Raster;

/// Median difference of neighbours' redness from which on a picture is smoothed. Coloured noise of 4 % of full scale makes 0.05
/// of a hall in good light; of balls over 8 pixels under it 85.0 % are found without smoothing and 88.7 % with it. From
/// 0.03 to 0.06 the balls found in quieter pictures are the same within 0.3 %; smoothing every picture loses balls on
/// photographs (c) of docs/book/src/smartbot.md: 4 % of them are no candidates any more.
const NOISY: f32 = 0.04;
/// One pair of neighbours of so many tells of noise; prime, so that every column is met.
const EVERY: usize = 37;

/// Means of 3 by 3 pixels, the middle weighed most; `None` where noise is little.
pub(super) fn calmed(picture: &Raster<[f32; 3]>) -> Option<Raster<[f32; 3]>> {
    (noise(picture) >= NOISY).then(|| smoothed(picture))
}

fn noise(picture: &Raster<[f32; 3]>) -> f32 {
    let pairs = picture.data.windows(2).step_by(EVERY);
    let mut differences: Vec<f32> = pairs.map(|pair| (of(pair[0]) - of(pair[1])).abs()).collect();
    let middle = differences.len() / 2;
    *differences.select_nth_unstable_by(middle, f32::total_cmp).1
}

/// The binomial filter of 3 by 3. Edges are passed on as they are where there is no neighbour.
fn smoothed(picture: &Raster<[f32; 3]>) -> Raster<[f32; 3]> {
    let width = picture.width;
    let mut across = picture.data.clone();
    for (row, from) in across.chunks_exact_mut(width).zip(picture.data.chunks_exact(width)) {
        mean(&mut row.as_flattened_mut()[3..], from.as_flattened(), 3);
    }
    let mut data = across.clone();
    mean(&mut data.as_flattened_mut()[3 * width..], across.as_flattened(), 3 * width);
    Raster { width, height: picture.height, data }
}

/// A quarter, a half and a quarter of numbers that lie `apart`, for as many as have both neighbours.
fn mean(to: &mut [f32], from: &[f32], apart: usize) {
    let neighbours = from.iter().zip(&from[apart..]).zip(&from[2 * apart..]);
    for (to, ((before, here), after)) in to.iter_mut().zip(neighbours) {
        *to = 0.25 * (before + after) + 0.5 * here;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A carpet of 64 by 64 pixels whose red and green differ by `by` from one pixel to the next.
    fn carpet(by: f32) -> Raster<[f32; 3]> {
        let pixel = |i: usize| if i.is_multiple_of(2) { [50.0 + by, 100.0 - by, 60.0] } else { [50.0, 100.0, 60.0] };
        Raster { width: 64, height: 64, data: (0..64 * 64).map(pixel).collect() }
    }

    #[test]
    fn a_quiet_picture_stays_and_a_noisy_one_loses_three_quarters_of_its_noise() {
        assert!(calmed(&carpet(2.0)).is_none());
        let noisy = carpet(20.0);
        let calm = calmed(&noisy).expect("neighbours differ by more than the limit");
        assert_eq!((calm.width, calm.height, calm.data.len()), (64, 64, 64 * 64));
        assert!(noise(&calm) < 0.25 * noise(&noisy), "{} of {}", noise(&calm), noise(&noisy));
    }
}
