//! QEMU, a kernel and a shell, as `testbench/qemu/fetch.sh` brings them from Debian's packages.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Something is not there.
#[derive(Debug, thiserror::Error)]
#[error("{what} is not in {}; run testbench/qemu/fetch.sh, which brings it from Debian's packages", .folder.display())]
pub struct MissingTool {
    what: &'static str,
    folder: PathBuf,
}

/// QEMU, and what its guest is started with.
#[derive(Clone, Debug)]
pub struct Tools {
    root: PathBuf,
    /// Linux image that QEMU starts.
    pub kernel: PathBuf,
    /// A static shell for the guest.
    pub busybox: PathBuf,
}

impl Tools {
    /// In the folder that the script fills.
    ///
    /// # Errors
    /// [`MissingTool`] names what is not there.
    pub fn in_folder(folder: &Path) -> Result<Self, MissingTool> {
        let missing = |what| MissingTool { what, folder: folder.to_owned() };
        let root = folder.join("root");
        let kernels = std::fs::read_dir(root.join("boot")).map_err(|_| missing("a kernel"))?;
        let kernel = kernels
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("vmlinuz-")))
            .max()
            .ok_or_else(|| missing("a kernel"))?;
        let busybox = root.join("bin/busybox");
        if !busybox.is_file() {
            return Err(missing("busybox"));
        }
        if !root.join("usr/bin/qemu-system-x86_64").is_file() {
            return Err(missing("qemu-system-x86_64"));
        }
        Ok(Self { root, kernel, busybox })
    }

    /// QEMU with its own libraries and firmware.
    #[must_use]
    pub fn qemu(&self) -> Command {
        let mut command = Command::new(self.root.join("usr/bin/qemu-system-x86_64"));
        let libraries = ["usr/lib/x86_64-linux-gnu", "lib/x86_64-linux-gnu"].map(|path| self.root.join(path));
        command.env("LD_LIBRARY_PATH", std::env::join_paths(libraries).unwrap_or_default());
        for firmware in ["usr/share/qemu", "usr/share/seabios", "usr/lib/ipxe/qemu"] {
            command.arg("-L").arg(self.root.join(firmware));
        }
        command
    }
}
