//! Writes `generated/`: `cargo run -p hdl [FOLDER]`.

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../generated")), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    for file in hdl::design::files()? {
        let path = folder.join(&file.name);
        std::fs::write(&path, file.text).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("{}", path.display());
    }
    Ok(())
}
