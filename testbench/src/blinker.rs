//! A bitstream of a design that is none of ours, for the same card: made by the flow from `designs/blinker.v`.

use bitstream::configuration::StartUp;
use bitstream::container::{Header, PART};
use bitstream::device::Device;
use bitstream::flow::synthesis::synthesise;
use bitstream::flow::{Progress, build};
use simulator::gateware::constraints;

/// What it answers on the bus: `BLNK`.
pub const WORD: u32 = 0x424C_4E4B;

/// The file.
///
/// # Panics
/// Without yosys.
#[must_use]
pub fn blinker() -> Vec<u8> {
    const TOP: &str = "blinker";
    let folder = tempfile::tempdir().expect("a folder");
    let quiet = &mut Progress::silent();
    let constraints = constraints().expect("constraints");
    let json = synthesise(include_str!("../designs/blinker.v"), TOP, folder.path(), quiet)
        .unwrap_or_else(|error| panic!("{error}"));
    let built = build(&json, TOP, &constraints, 1, quiet).unwrap_or_else(|error| panic!("{error}"));
    assert!(built.proof.holds(), "{:?}", built.proof.differences);
    let header = Header { design: TOP.into(), part: PART.into(), ..Header::default() };
    built.configuration.file(Device::xc2s200(), &header, StartUp::default())
}
