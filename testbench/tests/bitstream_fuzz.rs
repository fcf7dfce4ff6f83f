//! The reader of bitstream files against files nobody made on purpose: no panic, no endless loop, a fault with
//! words; and what it accepts is what the device accepts. Seeded; `RACBOT_FUZZ_SECONDS=600` goes on for as long
//! from another seed each round, and adds what is new to the corpus that is replayed here.

use driver::bitstream::{BYTES, Bitstream, Fault};
use hdl::design::COMMITTED_BITSTREAM;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use simulator::circuit::committed;
use simulator::virtual_card::SelectMap;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const SEED: u64 = 0xB175;
/// Cases of the seeded part.
const CASES: u32 = 2_000;
/// Longest file that is kept.
const KEPT: usize = 2_048;

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/bitstream")
}

/// The kind of a fault, without its figures.
fn kind(result: &Result<Bitstream, Fault>) -> String {
    match result {
        Ok(_) => "accepted".to_owned(),
        Err(fault) => format!("{fault:?}").chars().take_while(|c| c.is_alphanumeric()).collect(),
    }
}

/// Whether the device would start.
fn starts(bitstream: &Bitstream) -> bool {
    let later = Duration::from_secs(1);
    let mut device = SelectMap::new(Duration::ZERO);
    for &byte in bitstream.lanes() {
        device.strobe(byte, later);
    }
    device.done(2 * later)
}

fn check(file: &[u8]) -> String {
    let result = Bitstream::parse(file);
    match &result {
        Ok(bitstream) => assert!(starts(bitstream), "accepted, but the device does not start"),
        Err(fault) => {
            let text = fault.to_string();
            assert!(text.len() > 15 && text.is_ascii(), "{text}");
            if let Fault::Truncated { offset, .. }
            | Fault::Field { offset, .. }
            | Fault::Packet { offset, .. }
            | Fault::Crc { offset, .. }
            | Fault::FrameLength { offset, .. } = fault
            {
                assert!(*offset <= file.len(), "{text}: beyond the file");
            }
        }
    }
    kind(&result)
}

/// A file that is nearly one.
fn mutant(good: &[&[u8]], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut file = good[random.random_range(0..good.len())].to_vec();
    for _ in 0..random.random_range(1..4) {
        if file.is_empty() {
            break;
        }
        // Half of all changes hit the header and the first packets, where the structure is.
        let end = if random.random() { file.len().min(160) } else { file.len() };
        let at = random.random_range(0..end);
        match random.random_range(0..7) {
            0 => file[at] = random.random(),
            1 => file[at] ^= 1 << random.random_range(0..8),
            2 => file.truncate(at),
            3 => drop(file.drain(at..(at + random.random_range(1..9)).min(file.len()))),
            4 => file.insert(at, random.random()),
            5 => file[at] = [0, 0xFF, 0x80, 0x7F, b'e'][random.random_range(0..5)],
            _ => {
                let from = random.random_range(0..end);
                let length = random.random_range(1..64).min(file.len() - from).min(file.len() - at);
                let piece = file[from..from + length].to_vec();
                file[at..at + length].copy_from_slice(&piece);
            }
        }
    }
    file
}

fn round(seed: u64, cases: u32, mut seen: impl FnMut(&str, &[u8])) {
    let (bit, prom) = (COMMITTED_BITSTREAM, committed().lanes().to_vec());
    let raw = &bit[bit.len() - BYTES..];
    let header = &bit[..bit.len() - BYTES + 200];
    let good = [bit, header, &prom, raw];
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for _ in 0..cases {
        let file = mutant(&good, &mut random);
        let kind = check(&file);
        seen(&kind, &file);
    }
}

#[test]
fn mutants_are_read_rightly_or_refused_with_words() {
    let mut kinds = BTreeSet::new();
    round(SEED, CASES, |kind, _| {
        kinds.insert(kind.to_owned());
    });
    println!("{kinds:?}");
    assert!(kinds.len() >= 9 && kinds.contains("accepted") && kinds.contains("Crc"), "{kinds:?}");
}

#[test]
fn the_corpus_is_read_as_before() {
    let mut files = 0;
    for entry in fs::read_dir(corpus()).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        assert_eq!(check(&fs::read(&path).unwrap()), name.split('-').next().unwrap(), "{}", path.display());
        files += 1;
    }
    assert!(files >= 8, "{files} files in the corpus");
}

#[test]
fn longer_where_time_is_given() {
    let Some(seconds) = std::env::var("RACBOT_FUZZ_SECONDS").ok().and_then(|text| text.parse().ok()) else {
        println!("RACBOT_FUZZ_SECONDS is not set: the seeded part is all");
        return;
    };
    let begun = Instant::now();
    let (mut rounds, mut cases) = (0, 0_u64);
    while begun.elapsed() < Duration::from_secs(seconds) {
        rounds += 1;
        round(SEED + rounds, 500, |kind, file| {
            cases += 1;
            let path = (0..3).map(|n| corpus().join(format!("{kind}-{n}.bin"))).find(|path| !path.exists());
            if let Some(path) = path.filter(|_| file.len() <= KEPT) {
                fs::write(path, file).unwrap();
            }
        });
    }
    println!("{cases} cases in {:.0} s", begun.elapsed().as_secs_f64());
}
