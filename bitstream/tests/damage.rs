//! Damaged files: errors that say what and where, never a panic, whatever bits are flipped.

use bitstream::configuration::{Attributes, Configuration, StartUp};
use bitstream::container::{Bitstream, Header, PART};
use bitstream::device::{Bit, Device, FRAME_BITS, FRAMES};
use bitstream::netlist::extract;
use bitstream::report::Decoded;
use bitstream::verilog;

struct Noise(u64);

impl Noise {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit
    }
}

fn blank_file() -> Vec<u8> {
    let device = Device::xc2s200();
    let header = Header { design: "blank.ncd".into(), part: PART.into(), date: "d".into(), time: "t".into() };
    Configuration::blank(device).file(device, &header, StartUp::default())
}

/// Any bits at all, with a right CRC: the whole way to Verilog or to faults, and attributes that lose nothing.
#[test]
fn any_frames_give_a_circuit_or_faults() {
    let device = Device::xc2s200();
    let blank = Configuration::blank(device);
    let (mut circuits, mut refused) = (0, 0);
    for seed in 0..60u64 {
        let mut noise = Noise(seed);
        let mut configuration = blank.clone();
        // From one bit to a fifth of the device.
        for _ in 0..1usize << (seed % 18) {
            let bit = Bit { frame: noise.below(FRAMES) as u16, bit: noise.below(FRAME_BITS) as u16 };
            configuration.set_bit(bit, !configuration.bit(bit));
        }
        match extract(device, &configuration) {
            Ok(netlist) => {
                circuits += 1;
                assert!(verilog::emit(&netlist, "noise").contains("endmodule"));
            }
            Err(faults) => {
                refused += 1;
                assert!(faults.iter().all(|fault| fault.to_string().contains('X')), "no place in {}", faults[0]);
            }
        }
        if let Ok(attributes) = Attributes::read(device, &configuration) {
            assert_eq!(attributes.write(device), configuration);
        }
    }
    assert!(circuits > 5 && refused > 5, "{circuits} circuits, {refused} refused");
}

/// Truncated, flipped and overwritten files: refused, or still whole.
#[test]
fn damaged_files_are_refused() {
    let device = Device::xc2s200();
    let file = blank_file();
    let whole = Bitstream::parse(&file).expect("a file");
    assert_eq!(whole.encode(&whole.packets), file);
    let mut noise = Noise(1);
    let mut refused = 0;
    for n in 0..400 {
        let mut damaged = file.clone();
        match n % 3 {
            0 => damaged.truncate(noise.below(file.len())),
            1 => damaged[noise.below(file.len())] ^= 1 << noise.below(8),
            _ => {
                let at = noise.below(file.len() - 8);
                damaged[at..at + 4].fill(noise.below(256) as u8);
            }
        }
        match Bitstream::parse(&damaged) {
            Err(fault) => {
                refused += 1;
                assert!(!fault.to_string().is_empty());
            }
            Ok(read) => {
                let decoded = Decoded::new(device, &read);
                assert!(decoded.is_err() || decoded.is_ok_and(|decoded| decoded.report.faults.is_empty()));
            }
        }
    }
    assert!(refused > 380, "only {refused} of 400 refused");
}

#[test]
fn a_blank_device_uses_nothing() {
    let device = Device::xc2s200();
    let decoded = Decoded::new(device, &Bitstream::parse(&blank_file()).expect("a file")).expect("its frames");
    assert!(decoded.report.pads.is_empty() && decoded.report.faults.is_empty());
    assert_eq!((decoded.report.unexplained, decoded.report.absent, decoded.report.bytes), (0, 0, 166_980));
    assert!(decoded.report.used.iter().all(|(_, used, _)| *used == 0));
}

/// One file of every kind of fault, as kept for the loader.
#[test]
fn the_corpus_is_refused_with_reasons() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../testbench/tests/corpus/bitstream");
    let mut files = 0;
    for entry in std::fs::read_dir(folder).expect("the corpus") {
        let file = std::fs::read(entry.expect("an entry").path()).expect("a file");
        assert!(Bitstream::parse(&file).is_err_and(|fault| !fault.to_string().is_empty()));
        files += 1;
    }
    assert!(files >= 20, "{files} files");
}
