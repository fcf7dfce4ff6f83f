//! Loads any bitstreams into simulated chips behind the card's pins and shows what each answers at HostMot2's
//! identification, 0x100 to 0x108: `55aacafe HOSTMOT2` where it is one.
//!
//! ```sh
//! cargo run --release -p testbench --example real_files -- FILE.bit...
//! ```

use bitstream::container::Bitstream;
use simulator::chip::Chip;
use simulator::circuit::{Circuit, decode};
use simulator::fpga::FpgaError;
use std::path::Path;

fn answer(file: &Bitstream) -> Result<([u32; 3], usize), FpgaError> {
    let netlist = decode(&file.packets)?;
    let mut circuit = Circuit::new(&netlist)?;
    // Delay-locked loops lock meanwhile.
    circuit.run(100)?;
    let mut words = [0; 3];
    for (offset, word) in (0x100..).step_by(4).zip(&mut words) {
        circuit.read(offset, std::slice::from_mut(word))?;
    }
    Ok((words, netlist.cells.len()))
}

fn main() {
    for path in std::env::args().skip(1) {
        match Bitstream::open(Path::new(&path)) {
            Err(error) => println!("{error}"),
            Ok(file) => match answer(&file) {
                Err(error) => println!("{path}: {error}"),
                Ok(([cookie, name @ ..], cells)) => {
                    let name: Vec<u8> = name.into_iter().flat_map(u32::to_le_bytes).collect();
                    println!("{path}: {cells} cells, {cookie:08x} {}", String::from_utf8_lossy(&name).escape_debug());
                }
            },
        }
    }
}
