//! An initial RAM file system: the format that `cpio -H newc` writes, uncompressed.

/// Regular file, executable by all.
const FILE: u32 = 0o100_755;
/// File mode of a folder that all may enter.
const DIRECTORY: u32 = 0o040_755;

/// A file system in the making.
#[derive(Clone, Debug, Default)]
pub struct Initramfs {
    archive: Vec<u8>,
    entries: u32,
}

impl Initramfs {
    /// Adds a directory; its parent must be there.
    #[must_use]
    pub fn directory(mut self, path: &str) -> Self {
        self.entry(path, DIRECTORY, &[]);
        self
    }

    /// Adds a file.
    #[must_use]
    pub fn file(mut self, path: &str, content: &[u8]) -> Self {
        self.entry(path, FILE, content);
        self
    }

    /// Ends the archive and gives its bytes.
    #[must_use]
    pub fn finish(mut self) -> Vec<u8> {
        self.entry("TRAILER!!!", 0, &[]);
        self.archive
    }

    fn entry(&mut self, path: &str, mode: u32, content: &[u8]) {
        self.entries += 1;
        let fields = [self.entries, mode, 0, 0, 1, 0, content.len() as u32, 0, 0, 0, 0, path.len() as u32 + 1, 0];
        self.archive.extend(b"070701");
        for field in fields {
            self.archive.extend(format!("{field:08X}").bytes());
        }
        self.archive.extend(path.bytes());
        self.archive.push(0);
        self.pad();
        self.archive.extend(content);
        self.pad();
    }

    fn pad(&mut self) {
        self.archive.resize(self.archive.len().next_multiple_of(4), 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_has_its_header_name_and_content_on_fours() {
        let archive = Initramfs::default().directory("bin").file("bin/a", b"12345").finish();
        assert_eq!(archive.len() % 4, 0);
        assert_eq!(&archive[..14], b"07070100000001");
        let at = archive.windows(5).position(|w| w == b"12345").unwrap();
        assert_eq!(at % 4, 0);
        assert!(archive.windows(10).any(|w| w == b"TRAILER!!!"));
    }
}
