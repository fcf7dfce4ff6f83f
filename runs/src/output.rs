//! Files that are written: whole or not at all, and never over another by accident.
//!
//! What is written at once goes to a temporary name in the same folder and is renamed when it is whole, so a
//! reader or a crash never meets half of it. A recording that grows while a robot drives cannot: it grows under
//! its own name, which must be free, and holds whole ticks at every moment.
//!
//! Only ordinary files are replaced. A device, a pipe or a folder of that name would be gone for every program:
//! `/dev/null` as the place of a recording nobody wants, in root's hands.

use crate::error::InputError;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

/// Permissions of a new file, of which the user's mask takes away.
const MODE: u32 = 0o666;

/// What to do where the file exists already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// Leave it, and fail; a file that holds the same already is no failure.
    #[default]
    Refuse,
    /// Put the new one in its place, once that is whole.
    Replace,
}

/// The error for a file that exists.
#[must_use]
pub fn exists(path: &Path) -> InputError {
    InputError::new(path, "exists already", "choose another name, or replace it with --force")
}

/// Writes a whole file and the folders above it.
///
/// # Errors
/// [`InputError`]: the file exists and is to stay, or the system refuses; nothing has changed then.
pub fn write_whole(path: &Path, content: &[u8], existing: Existing) -> Result<(), InputError> {
    let is_there = |path: &Path| is_ordinary(path) && fs::read(path).is_ok_and(|found| found == content);
    if existing == Existing::Refuse && is_there(path) {
        return Ok(());
    }
    write_with(path, existing, |file| file.write_all(content))
}

/// The same for a content that is written piece by piece.
///
/// # Errors
/// As [`write_whole`], and what `write` fails with.
pub fn write_with(
    path: &Path,
    existing: Existing,
    write: impl FnOnce(&mut File) -> io::Result<()>,
) -> Result<(), InputError> {
    let io = |error: io::Error| InputError::io(path, &error);
    // Whoever makes temporary files names them in the error: nobody asked for that file.
    let unnamed = |error: io::Error| io::Error::from(error.kind());
    let place = &place_of(path, existing)?;
    let folder = folder_of(place);
    fs::create_dir_all(folder).map_err(|error| InputError::io(folder, &error))?;
    let mut temporary = tempfile::Builder::new()
        .prefix(".racbot-")
        .permissions(fs::Permissions::from_mode(MODE))
        .tempfile_in(folder)
        .map_err(|error| io(unnamed(error)))?;
    write(temporary.as_file_mut()).map_err(io)?;
    let placed = match existing {
        Existing::Replace => temporary.persist(place),
        Existing::Refuse => temporary.persist_noclobber(place),
    };
    match placed {
        Ok(_) => Ok(()),
        // Somebody was quicker.
        Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => Err(exists(path)),
        Err(error) => Err(io(error.error)),
    }
}

/// Creates the file of a recording that grows.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`] where it exists and is to stay, [`io::ErrorKind::InvalidInput`] where it is no file,
/// or what the system says.
pub fn create_growing(path: &Path, existing: Existing) -> io::Result<File> {
    let mut place = path.to_owned();
    if existing == Existing::Replace {
        place = behind_links(path);
        if let Some(kind) = kind_if_none(path) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, format!("is {kind}; {NAME_A_FILE}")));
        }
        match fs::remove_file(&place) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    OpenOptions::new().write(true).create_new(true).open(place).map_err(|error| match error.kind() {
        io::ErrorKind::AlreadyExists => io::Error::new(error.kind(), "exists already; replace it with --force"),
        _ => error,
    })
}

/// Fails early, before long work, where a file exists that is to stay, or something that is no file.
///
/// # Errors
/// [`InputError`] that names it.
pub fn check_free(path: &Path, existing: Existing) -> Result<(), InputError> {
    place_of(path, existing).map(drop)
}

/// What to do about a name that is none of a file.
const NAME_A_FILE: &str = "give the name of a file";

/// Where a file of this name is written: behind links, which stay.
fn place_of(path: &Path, existing: Existing) -> Result<PathBuf, InputError> {
    if let Some(kind) = kind_if_none(path) {
        return Err(InputError::new(path, format!("is {kind}"), NAME_A_FILE));
    }
    match existing {
        Existing::Refuse if fs::symlink_metadata(path).is_ok() => Err(exists(path)),
        Existing::Refuse => Ok(path.to_owned()),
        Existing::Replace => Ok(behind_links(path)),
    }
}

/// The file that a name leads to; the name itself where there is none yet.
fn behind_links(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Whether there is a file in the ordinary sense, itself or behind a link.
fn is_ordinary(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|found| found.is_file())
}

/// What stands there that is no file in the ordinary sense.
fn kind_if_none(path: &Path) -> Option<&'static str> {
    let kind = fs::metadata(path).ok()?.file_type();
    let other = if kind.is_dir() { "a folder" } else { "a device or a pipe, no file" };
    (!kind.is_file()).then_some(other)
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn an_existing_file_stays_unless_it_is_to_be_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/run.csv");
        write_whole(&path, b"one", Existing::Refuse).unwrap();
        write_whole(&path, b"one", Existing::Refuse).unwrap();
        let error = write_whole(&path, b"two", Existing::Refuse).unwrap_err().to_string();
        assert!(error.contains("run.csv") && error.contains("exists already") && error.contains("--force"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"one");
        write_whole(&path, b"two", Existing::Replace).unwrap();
        assert_eq!(
            (fs::read(&path).unwrap().as_slice(), names(path.parent().unwrap())),
            (&b"two"[..], vec!["run.csv".to_owned()])
        );
        // Readable by others, as the mask says, not by the owner alone as temporary files are.
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        fs::write(folder.path().join("ordinary"), "").unwrap();
        assert_eq!(mode(&path), mode(&folder.path().join("ordinary")));
    }

    #[test]
    fn what_fails_half_way_leaves_nothing_and_changes_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.html");
        let fails = |file: &mut File| {
            file.write_all(b"half")?;
            Err(io::Error::other("the disk is full"))
        };
        for existing in [Existing::Refuse, Existing::Replace] {
            let error = write_with(&path, existing, fails).unwrap_err().to_string();
            assert!(error.contains("the disk is full"), "{error}");
            assert!(names(folder.path()).is_empty());
        }
        fs::write(&path, "old").unwrap();
        write_with(&path, Existing::Replace, fails).unwrap_err();
        assert_eq!((fs::read(&path).unwrap().as_slice(), names(folder.path()).len()), (&b"old"[..], 1));
    }

    /// Nobody knows the temporary name that is meant to become the user's.
    #[test]
    fn what_cannot_be_made_is_named_as_it_was_asked_for() {
        // No file can be made there, in whosever hands.
        let path = Path::new("/proc/self/report.html");
        let error = write_whole(path, b"new", Existing::Refuse).unwrap_err().to_string();
        assert!(error.starts_with("/proc/self/report.html: ") && !error.contains(".racbot-"), "{error}");
    }

    #[test]
    fn what_is_no_file_is_never_replaced_and_links_stay() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        // A socket stands for devices, which only root can make: neither is read, written or removed.
        let _bound = std::os::unix::net::UnixListener::bind(place("socket")).unwrap();
        fs::create_dir(place("folder")).unwrap();
        fs::write(place("robot.toml"), "old").unwrap();
        std::os::unix::fs::symlink("robot.toml", place("link")).unwrap();
        std::os::unix::fs::symlink("socket", place("to-socket")).unwrap();
        let before = names(folder.path());
        for (name, kind) in [("socket", "a device"), ("to-socket", "a device"), ("folder", "a folder")] {
            for existing in [Existing::Refuse, Existing::Replace] {
                for error in [
                    check_free(&place(name), existing).unwrap_err().to_string(),
                    write_whole(&place(name), b"new", existing).unwrap_err().to_string(),
                ] {
                    assert!(error.contains(kind) && !error.contains("--force"), "{error}");
                }
            }
            let error = create_growing(&place(name), Existing::Replace).unwrap_err().to_string();
            assert!(error.contains(kind), "{error}");
        }
        write_whole(&place("link"), b"new", Existing::Replace).unwrap();
        assert!(fs::symlink_metadata(place("link")).unwrap().is_symlink());
        assert_eq!(fs::read(place("robot.toml")).unwrap(), b"new");
        create_growing(&place("link"), Existing::Replace).unwrap().write_all(b"t\n").unwrap();
        assert_eq!(fs::read(place("robot.toml")).unwrap(), b"t\n");
        assert_eq!(names(folder.path()), before);
    }

    #[test]
    fn a_recording_grows_only_under_a_free_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        create_growing(&path, Existing::Refuse).unwrap().write_all(b"t\n").unwrap();
        let error = create_growing(&path, Existing::Refuse).unwrap_err().to_string();
        assert!(error.contains("--force"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"t\n");
        create_growing(&path, Existing::Replace).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"");
    }
}
