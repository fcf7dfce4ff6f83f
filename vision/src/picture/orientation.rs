//! Which way up a picture is by its Exif data (CIPA DC-008, tag 274): one number, too little for a library.

use super::Picture;

/// The tag, and the type of its value: a 16-bit number.
const ORIENTATION: u16 = 274;
const SHORT: u16 = 3;

/// The orientation from 1 (upright) to 8 in Exif data, which is a TIFF header and its directories; 1 where it says none.
pub(super) fn orientation(exif: &[u8]) -> u16 {
    stated(exif).filter(|value| (1..=8).contains(value)).unwrap_or(1)
}

fn stated(exif: &[u8]) -> Option<u16> {
    // Some writers keep the marker's own header.
    let exif = exif.strip_prefix(b"Exif\0\0").unwrap_or(exif);
    let little = match exif.get(..2)? {
        b"II" => true,
        b"MM" => false,
        _ => return None,
    };
    let short = |at: usize| {
        let bytes = exif.get(at..at.checked_add(2)?)?.try_into().ok()?;
        Some(if little { u16::from_le_bytes(bytes) } else { u16::from_be_bytes(bytes) })
    };
    let first = exif.get(4..8)?.try_into().ok()?;
    let first = if little { u32::from_le_bytes(first) } else { u32::from_be_bytes(first) } as usize;
    let entries = usize::from(short(first)?);
    let mut entries = (0..entries).map(|k| first + 2 + 12 * k);
    let entry = entries.find(|&at| short(at) == Some(ORIENTATION) && short(at + 2) == Some(SHORT))?;
    short(entry + 8)
}

/// The picture as it is to be seen.
pub(super) fn upright(picture: Picture, orientation: u16) -> Picture {
    let (width, height) = (picture.width, picture.height);
    let (right, bottom) = (width - 1, height - 1);
    // Where a pixel of the upright picture is in the stored one.
    let from: fn([usize; 2], [usize; 2]) -> [usize; 2] = match orientation {
        2 => |[x, y], [right, _]| [right - x, y],
        3 => |[x, y], [right, bottom]| [right - x, bottom - y],
        4 => |[x, y], [_, bottom]| [x, bottom - y],
        5 => |[x, y], _| [y, x],
        6 => |[x, y], [_, bottom]| [y, bottom - x],
        7 => |[x, y], [right, bottom]| [right - y, bottom - x],
        8 => |[x, y], [right, _]| [right - y, x],
        _ => return picture,
    };
    let (across, down) = if orientation > 4 { (height, width) } else { (width, height) };
    let pixels = (0..across * down).map(|i| {
        let [x, y] = from([i % across, i / across], [right, bottom]);
        picture.pixels[y * width + x]
    });
    Picture { width: across, height: down, pixels: pixels.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exif(order: &[u8; 2], value: u16) -> Vec<u8> {
        let two = |v: u16| if order == b"II" { v.to_le_bytes() } else { v.to_be_bytes() };
        let four = |v: u32| if order == b"II" { v.to_le_bytes() } else { v.to_be_bytes() };
        let mut bytes = [&order[..], &two(42), &four(8), &two(2)].concat();
        bytes.extend([&two(271)[..], &two(2), &four(1), &four(0)].concat());
        bytes.extend([&two(ORIENTATION)[..], &two(SHORT), &four(1), &two(value), &two(0)].concat());
        bytes
    }

    #[test]
    fn the_tag_is_read_in_both_byte_orders_and_nothing_is_made_of_what_is_cut_off() {
        for order in [b"II", b"MM"] {
            let bytes = exif(order, 6);
            assert_eq!(orientation(&bytes), 6);
            assert_eq!(orientation(&[b"Exif\0\0", &bytes[..]].concat()), 6);
            assert!((0..bytes.len() - 4).all(|length| orientation(&bytes[..length]) == 1));
            assert_eq!(orientation(&exif(order, 9)), 1);
        }
    }

    #[test]
    fn every_orientation_brings_the_marked_corner_to_where_the_standard_says() {
        // The stored picture's upper left pixel is red, the one at its right green.
        let mut stored = Picture::new(40, 32, vec![[9; 3]; 40 * 32]).unwrap();
        stored.pixels[0] = [255, 0, 0];
        stored.pixels[39] = [0, 255, 0];
        // Row 0 and column 0 of the stored picture are these sides of the upright one, DC-008 table 7.
        let places = [
            (1, [0, 0], [39, 0]),
            (2, [39, 0], [0, 0]),
            (3, [39, 31], [0, 31]),
            (4, [0, 31], [39, 31]),
            (5, [0, 0], [0, 39]),
            (6, [31, 0], [31, 39]),
            (7, [31, 39], [31, 0]),
            (8, [0, 39], [0, 0]),
        ];
        for (orientation, red, green) in places {
            let seen = upright(stored.clone(), orientation);
            let at = |[x, y]: [usize; 2]| seen.pixels[y * seen.width + x];
            assert_eq!((at(red), at(green)), ([255, 0, 0], [0, 255, 0]), "orientation {orientation}");
        }
    }
}
