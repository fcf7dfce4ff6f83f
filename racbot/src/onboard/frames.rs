//! Where a real robot's pictures come from.

use crate::terminal::Failure;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use vision::picture::{Picture, read};

/// Pictures a second when a folder is played.
const PLAYED_HZ: f64 = 30.0;

/// A stream of pictures.
pub(super) trait Frames: Send {
    /// Waits for the next one; `None` after the last, an error for one that cannot be had.
    fn next(&mut self) -> Option<Result<Picture, String>>;
}

/// Opens a video device or a folder.
pub(super) fn open(place: &Path, size: [usize; 2]) -> Result<Box<dyn Frames>, Failure> {
    if place.is_dir() {
        return Ok(Box::new(Folder::open(place)?));
    }
    device(place, size)
}

#[cfg(not(all(feature = "v4l2", target_os = "linux")))]
fn device(place: &Path, _: [usize; 2]) -> Result<Box<dyn Frames>, Failure> {
    Err(Failure::about(
        place,
        "no folder, and this racbot is built without video devices: build it with --features v4l2 on Linux",
    ))
}

#[cfg(all(feature = "v4l2", target_os = "linux"))]
fn device(place: &Path, size: [usize; 2]) -> Result<Box<dyn Frames>, Failure> {
    Ok(Box::new(v4l2::Device::open(place, size)?))
}

/// The pictures of a folder by name, in real time.
struct Folder {
    files: std::vec::IntoIter<PathBuf>,
    begun: Instant,
    played: u32,
}

impl Folder {
    fn open(folder: &Path) -> Result<Self, Failure> {
        let files = crate::commands::vision::pictures(folder)?;
        Ok(Self { files: files.into_iter(), begun: Instant::now(), played: 0 })
    }
}

impl Frames for Folder {
    fn next(&mut self) -> Option<Result<Picture, String>> {
        let file = self.files.next()?;
        let due = Duration::from_secs_f64(f64::from(self.played) / PLAYED_HZ);
        self.played += 1;
        std::thread::sleep(due.saturating_sub(self.begun.elapsed()));
        Some(read(&file).map_err(|error| error.to_string()))
    }
}

#[cfg(all(feature = "v4l2", target_os = "linux"))]
mod v4l2 {
    //! A video device: motion JPEG, which every USB camera sends.

    use super::{Failure, Frames, Path, Picture};
    use linuxvideo::format::{PixFormat, PixelFormat};
    use linuxvideo::stream::ReadStream;
    use vision::picture::decode;

    pub(super) struct Device(ReadStream);

    impl Device {
        pub(super) fn open(place: &Path, [width, height]: [usize; 2]) -> Result<Self, Failure> {
            let about = |error: std::io::Error| Failure::about(place, error);
            let device = linuxvideo::Device::open(place).map_err(about)?;
            let format = PixFormat::new(width as u32, height as u32, PixelFormat::MJPG);
            let capture = device.video_capture(format).map_err(about)?;
            let got = capture.format();
            if got.pixel_format() != PixelFormat::MJPG {
                return Err(Failure::about(place, format!("sends no motion JPEG but {:?}", got.pixel_format())));
            }
            capture.into_stream().map(Self).map_err(about)
        }
    }

    impl Frames for Device {
        fn next(&mut self) -> Option<Result<Picture, String>> {
            let frame = self.0.dequeue(|view| Ok(decode(&view).map_err(|error| error.to_string())));
            Some(frame.unwrap_or_else(|error| Err(error.to_string())))
        }
    }
}
