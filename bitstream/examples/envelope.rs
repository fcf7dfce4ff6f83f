//! What the wire model says of files that are known to run: the longest path of each clock, from the bits alone.
//!
//! ```sh
//! cargo run --release -p bitstream --example envelope -- FILE.bit...
//! ```

use bitstream::configuration::Configuration;
use bitstream::container::Bitstream;
use bitstream::device::Device;
use bitstream::flow::timing::decoded::longest;
use std::path::Path;

fn main() {
    let device = Device::xc2s200();
    for path in std::env::args().skip(1) {
        let bitstream = match Bitstream::open(Path::new(&path)) {
            Ok(bitstream) => bitstream,
            Err(error) => {
                eprintln!("{error}");
                continue;
            }
        };
        let configuration = match Configuration::from_packets(device, &bitstream.packets) {
            Ok(configuration) => configuration,
            Err(error) => {
                eprintln!("{path}: {error}");
                continue;
            }
        };
        println!("{path}");
        for (clock, found) in
            longest(device, &configuration).iter().enumerate().filter(|(_, found)| found.flip_flops > 0)
        {
            println!(
                "  clock {clock}: {} ps, {} of it in wires, {} levels, {} slices with flip-flops",
                found.delay, found.wires, found.levels, found.flip_flops
            );
        }
    }
}
