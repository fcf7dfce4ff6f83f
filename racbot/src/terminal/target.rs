//! Where files of a command go, and what becomes of files that are there already.

use super::Failure;
use clap::Args;
use runs::output::{Existing, write_whole};
use std::path::Path;
#[cfg(feature = "simulation")]
use std::path::PathBuf;

/// Whether files may be replaced.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct Target {
    /// Replace files that exist; without it they stay and the command is refused
    #[arg(long)]
    force: bool,
}

impl Target {
    /// What to do with files that exist.
    pub(crate) fn existing(self) -> Existing {
        if self.force { Existing::Replace } else { Existing::Refuse }
    }

    /// Writes a whole file and the folders above it.
    pub(crate) fn save<C: AsRef<[u8]> + ?Sized>(self, path: &Path, content: &C) -> Result<(), Failure> {
        Ok(write_whole(path, content.as_ref(), self.existing())?)
    }

    /// Fails where one of the files to write is one that is read: --force replaces what a command made, not what it is
    /// made of.
    pub(crate) fn check_apart<R: AsRef<Path>, W: AsRef<Path>>(
        read: impl IntoIterator<Item = R>,
        written: impl IntoIterator<Item = W>,
    ) -> Result<(), Failure> {
        let read: Vec<_> = read.into_iter().filter_map(|file| file.as_ref().canonicalize().ok()).collect();
        for file in written {
            let file = file.as_ref();
            if file.canonicalize().is_ok_and(|place| read.contains(&place)) {
                return Err(Failure::about(file, "is read by this very command; give another name to write to"));
            }
        }
        Ok(())
    }

    /// Fails where one of these exists and is to stay: before long work.
    pub(crate) fn check_free<P: AsRef<Path>>(self, paths: impl IntoIterator<Item = P>) -> Result<(), Failure> {
        for path in paths {
            runs::output::check_free(path.as_ref(), self.existing())?;
        }
        Ok(())
    }

    /// The place that was asked for, or the command's own: the first of `out/x`, `out/x-2`, `out/x-3` … that is free;
    /// with --force always `out/x`.
    #[cfg(feature = "simulation")]
    pub(crate) fn place(self, asked: Option<&Path>, own: &str) -> PathBuf {
        if let Some(path) = asked {
            return path.to_owned();
        }
        let own = Path::new(own);
        let (stem, extension) = (own.with_extension(""), own.extension());
        let numbered = |number: u32| {
            let mut name = stem.clone().into_os_string();
            name.push(format!("-{number}"));
            extension.map_or_else(|| PathBuf::from(&name), |extension| PathBuf::from(&name).with_extension(extension))
        };
        let free = |path: &PathBuf| self.force || !path.exists();
        std::iter::once(own.to_owned()).chain((2..).map(numbered)).find(free).unwrap_or_else(|| own.to_owned())
    }
}

#[cfg(all(test, feature = "simulation"))]
mod tests {
    use super::*;

    #[test]
    fn a_place_of_ones_own_is_free_and_one_asked_for_is_taken_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let own = folder.path().join("kick.vcd").display().to_string();
        let free = Target::default();
        assert_eq!(free.place(None, &own), Path::new(&own));
        std::fs::write(&own, "").unwrap();
        assert_eq!(free.place(None, &own), folder.path().join("kick-2.vcd"));
        std::fs::write(folder.path().join("kick-2.vcd"), "").unwrap();
        assert_eq!(free.place(None, &own), folder.path().join("kick-3.vcd"));
        assert_eq!(free.place(Some(Path::new("x")), &own), Path::new("x"));
        assert_eq!(Target { force: true }.place(None, &own), Path::new(&own));
    }
}
