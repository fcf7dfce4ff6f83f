//! Bitstreams of designs that are none of ours, for the same card: one made by the flow from `designs/blinker.v`, and
//! one that does nothing.

use bitstream::configuration::{Configuration, StartUp};
use bitstream::container::{Header, PART};
use bitstream::device::Device;
use bitstream::flow::synthesis::synthesise;
use bitstream::flow::{Progress, build};
use simulator::gateware::constraints;

/// What it answers on the bus: `BLNK`.
pub const WORD: u32 = 0x424C_4E4B;

/// Its bitstream, by this flow.
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
    file(TOP, &built.configuration)
}

/// The file of a design by this name that has no logic and drives no pin.
#[must_use]
pub fn silent(design: &str) -> Vec<u8> {
    file(design, &Configuration::blank(Device::xc2s200()))
}

fn file(design: &str, configuration: &Configuration) -> Vec<u8> {
    let header =
        Header { design: design.into(), part: PART.into(), date: "2000/01/01".into(), time: "00:00:00".into() };
    configuration.file(Device::xc2s200(), &header, StartUp::default())
}
