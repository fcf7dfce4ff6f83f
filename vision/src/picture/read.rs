//! PNG and JPEG files.

use super::orientation::{orientation, upright};
use super::{LARGEST_SIDE, Picture, Unusable};
use std::io::Cursor;
use std::path::Path;
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

/// Largest file, bytes: an uncompressed 8K frame is smaller.
const LARGEST_FILE: u64 = 200_000_000;

/// Why there is no picture to be had of a file.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// A pipe or a device, which may never end.
    #[error("not a regular file")]
    NotRegular,
    /// Larger than any frame of a camera.
    #[error("{0} bytes are no camera frame; at most {LARGEST_FILE}")]
    TooLarge(u64),
    /// Neither of the formats known here.
    #[error("neither PNG nor JPEG by its first bytes; convert it to one of them")]
    Format,
    /// The data ends before the picture does.
    #[error("the {0} file is cut off before its end: copy or record it again")]
    Truncated(&'static str),
    /// The data is wrong.
    #[error("damaged {format} data: {what}")]
    Damaged {
        /// PNG or JPEG.
        format: &'static str,
        /// What the decoder says.
        what: String,
    },
    /// The picture is of no use.
    #[error(transparent)]
    Unusable(#[from] Unusable),
}

/// Reads a PNG or JPEG file, whichever it is by its first bytes, and checks that it shows something.
///
/// # Errors
/// [`PictureError`]
pub fn read(file: &Path) -> Result<Picture, PictureError> {
    let metadata = std::fs::metadata(file)?;
    if !metadata.is_file() {
        return Err(PictureError::NotRegular);
    }
    if metadata.len() > LARGEST_FILE {
        return Err(PictureError::TooLarge(metadata.len()));
    }
    let picture = decode(&std::fs::read(file)?)?;
    picture.check()?;
    Ok(picture)
}

/// Decodes the bytes of a PNG or JPEG file, turned as its Exif data says.
///
/// # Errors
/// [`PictureError`]
pub fn decode(bytes: &[u8]) -> Result<Picture, PictureError> {
    match bytes {
        [] => Err(PictureError::Truncated("empty")),
        [0x89, b'P', b'N', b'G', ..] => png(bytes),
        [0xff, 0xd8, ..] => jpeg(bytes),
        _ => Err(PictureError::Format),
    }
}

fn png(bytes: &[u8]) -> Result<Picture, PictureError> {
    let failed = |error: png::DecodingError| match error {
        png::DecodingError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            PictureError::Truncated("PNG")
        }
        error => PictureError::Damaged { format: "PNG", what: error.to_string() },
    };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), png::Limits { bytes: 1 << 30 });
    decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(failed)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    if width > LARGEST_SIDE || height > LARGEST_SIDE {
        return Err(Unusable::Size { width, height }.into());
    }
    let size = reader.output_buffer_size().ok_or(Unusable::Size { width, height })?;
    let mut buffer = vec![0; size];
    let frame = reader.next_frame(&mut buffer).map_err(failed)?;
    let samples = frame.color_type.samples();
    let pixels = buffer[..frame.buffer_size()].chunks_exact(samples).map(rgb).collect();
    let picture = Picture::new(frame.width as usize, frame.height as usize, pixels)?;
    Ok(upright(picture, reader.info().exif_metadata.as_deref().map_or(1, orientation)))
}

/// Grey, grey with alpha, RGB or RGBA as RGB.
fn rgb(samples: &[u8]) -> [u8; 3] {
    match *samples {
        [r, g, b] | [r, g, b, _] => [r, g, b],
        [grey] | [grey, _] => [grey; 3],
        _ => [0; 3],
    }
}

fn jpeg(bytes: &[u8]) -> Result<Picture, PictureError> {
    // The decoder fills what is missing with grey; the end marker after the last scan tells.
    let marker = |code: u8, from: &[u8]| from.windows(2).rposition(|pair| pair == [0xff, code]);
    let scan = marker(0xda, bytes).ok_or(PictureError::Truncated("JPEG"))?;
    if marker(0xd9, &bytes[scan..]).is_none() {
        return Err(PictureError::Truncated("JPEG"));
    }
    let damaged = |what: &dyn std::fmt::Debug| PictureError::Damaged { format: "JPEG", what: format!("{what:?}") };
    let options = DecoderOptions::default()
        .set_max_width(LARGEST_SIDE)
        .set_max_height(LARGEST_SIDE)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    let data = decoder.decode().map_err(|error| damaged(&error))?;
    let (width, height) = decoder.dimensions().ok_or_else(|| damaged(&"no size"))?;
    if data.len() != 3 * width * height {
        return Err(damaged(&"not three components"));
    }
    let pixels = data.chunks_exact(3).map(rgb).collect();
    Ok(upright(Picture::new(width, height, pixels)?, decoder.exif().map_or(1, |exif| orientation(exif))))
}
