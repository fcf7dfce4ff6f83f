//! Flips seeded configuration bits of used tiles and says what notices each: the decoder, the proof, or nothing,
//! because the circuit is proven to be the same.
//!
//! ```sh
//! cargo run --release -p bitstream --example mutants -- NETLIST.json CONSTRAINTS.ucf TOP [COUNT [SEED]]
//! ```
//!
//! The netlist is what `racbot bitstream build --netlist` writes.

use bitstream::device::{Bit, Device};
use bitstream::flow::constraints::Constraints;
use bitstream::flow::netlist::Netlist;
use bitstream::flow::prove::prove;
use bitstream::flow::{Progress, build};
use bitstream::netlist::extract;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, json, constraints, top, rest @ ..] = &arguments[..] else {
        eprintln!("mutants NETLIST.json CONSTRAINTS.ucf TOP [COUNT [SEED]]");
        std::process::exit(2);
    };
    let number = |at: usize, preset: u64| rest.get(at).and_then(|text| text.parse().ok()).unwrap_or(preset);
    let read = |path: &String| std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let (json, constraints) = (read(json), Constraints::parse(&read(constraints)).expect("constraints"));
    let built = build(&json, top, &constraints, 1, &mut Progress::silent()).expect("a design");
    assert!(built.proof.holds(), "the design itself is not proven");
    let netlist = Netlist::from_yosys(&json, top).expect("a netlist");
    let device = Device::xc2s200();
    // Used tiles: those in which a bit differs from the blank device.
    let blank = bitstream::configuration::Configuration::blank(device);
    let mut bits: Vec<(Bit, String)> = Vec::new();
    for (tile, _) in device.tiles() {
        let class = device.class(tile);
        let own =
            || class.attributes.iter().flat_map(|attribute| attribute.bits.iter().map(move |bit| (attribute, *bit)));
        if own().any(|(_, bit)| built.configuration.bit(device.bit(tile, bit)) != blank.bit(device.bit(tile, bit))) {
            bits.extend(own().map(|(attribute, bit)| (device.bit(tile, bit), attribute.name.clone())));
        }
    }
    let mut random = ChaCha8Rng::seed_from_u64(number(1, 1));
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut kinds: BTreeMap<(&str, String), usize> = BTreeMap::new();
    let count = number(0, 2_000);
    for _ in 0..count {
        let (bit, attribute) = &bits[(random.next_u64() % bits.len() as u64) as usize];
        let mut broken = built.configuration.clone();
        broken.set_bit(*bit, !broken.bit(*bit));
        let verdict = match extract(device, &broken) {
            Err(_) => "decoder",
            Ok(found) if !prove(device, &netlist, &constraints, &built.drivers, &found).holds() => "proof",
            Ok(_) => "harmless",
        };
        *counts.entry(verdict).or_default() += 1;
        let kind = attribute.split(['.', ':']).next().unwrap_or("").split('[').next().unwrap_or("").to_owned();
        *kinds.entry((verdict, kind)).or_default() += 1;
    }
    println!("{count} bits of {} in used tiles flipped: {counts:?}", bits.len());
    for ((verdict, kind), number) in kinds {
        println!("{verdict:9} {kind:8} {number}");
    }
}
