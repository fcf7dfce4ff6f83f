//! What only tests use: proofs, netlists, place and route, machines under QEMU, faults, blind data.

pub mod blind;
pub mod blinker;
pub mod equivalence;
pub mod faults;
pub mod formal;
pub mod netlist;
pub mod open_board;
pub mod pin_stimulus;
pub mod place;
pub mod qemu;
pub mod whole_chip;

/// The folder of the repository, absolute.
///
/// # Panics
/// Where the sources this was built from are gone.
#[must_use]
pub fn repository() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the sources this was built from")
}
