//! Loading, against the card's lines as its manual has them: bit 11 is DONE, 14 INIT, 23 WRITE, 26 PROGRAM.

use super::*;
use crate::pci::{Bar, PciError};
use fixed_kin::card::Card;
use fixed_kin::registers::TIME;

const LINES: u32 = 0x54;
const DONE: u32 = 1 << 11;
const INIT: u32 = 1 << 14;
const WRITE: u32 = 1 << 23;
const PROGRAM: u32 = 1 << 26;

const HASH: u32 = 0x1234_5678;
const CLOCK_HZ: f64 = 33_000_000.0;

/// A card whose FPGA is configured once it has so many bytes; some of its lines may be stuck high.
struct Bench {
    design: Card,
    outputs: u32,
    descriptors: [u32; 4],
    bytes: usize,
    whole: usize,
    stuck: u32,
    now: Duration,
}

impl Bench {
    fn blank(bitstream: &Bitstream) -> Self {
        let (outputs, whole) = (WRITE | PROGRAM, bitstream.lanes().len());
        let (design, now) = (Card::new(HASH), Duration::ZERO);
        Self { design, outputs, descriptors: [0, 2, 0, 2], bytes: 0, whole, stuck: 0, now }
    }

    fn lines(&self) -> u32 {
        let init = if self.outputs & PROGRAM == 0 { 0 } else { INIT };
        let done = if self.bytes >= self.whole { DONE } else { 0 };
        self.outputs | init | done | self.stuck
    }
}

impl PciCard for Bench {
    fn read32(&mut self, bar: Bar, offset: u32) -> Result<u32, PciError> {
        self.now += Duration::from_micros(1);
        Ok(match (bar, offset) {
            (Bar::Bridge, LINES) => self.lines(),
            (Bar::Bridge, _) => self.descriptors[(offset - 0x28) as usize / 4],
            _ if self.lines() & DONE == 0 => 0,
            _ if offset == u32::from(TIME.offset) => (self.now.as_secs_f64() * CLOCK_HZ) as u32,
            _ => self.design.read(offset as u16),
        })
    }
    fn write32(&mut self, bar: Bar, offset: u32, data: u32) -> Result<(), PciError> {
        match (bar, offset) {
            (Bar::Bridge, LINES) => {
                self.outputs = data & !(DONE | INIT);
                self.bytes = if data & PROGRAM == 0 { 0 } else { self.bytes };
            }
            (Bar::Bridge, _) => self.descriptors[(offset - 0x28) as usize / 4] = data,
            _ => self.design.write(offset as u16, data),
        }
        Ok(())
    }
    fn write8(&mut self, _: Bar, _: u32, _: u8) -> Result<(), PciError> {
        assert_eq!(self.outputs & (WRITE | PROGRAM), PROGRAM, "a byte while the FPGA does not listen");
        self.bytes += 1;
        Ok(())
    }
    fn has(&self, bar: Bar) -> bool {
        bar.is_memory()
    }
    fn now(&mut self) -> Duration {
        self.now
    }
    fn sleep(&mut self, time: Duration) {
        self.now += time;
    }
}

fn bitstream() -> Bitstream {
    Bitstream::parse(include_bytes!("../../../generated/rac4i65.bit")).unwrap()
}

#[test]
fn a_blank_card_is_loaded_once_and_again_only_for_another_design() {
    let bitstream = bitstream();
    let mut card = Bench::blank(&bitstream);
    let state = inspect(&mut card).unwrap();
    assert!(!state.done && state.init && state.program && state.identity.is_none());
    let options = Options { content_hash: Some(HASH), ..Options::default() };
    let mut sent = 0;
    let loaded = load(&mut card, &bitstream, &options, |bytes| sent = bytes).unwrap();
    assert_eq!((loaded.kept, loaded.tries, loaded.ready_enabled), (false, 1, 2));
    assert_eq!((sent, card.bytes, loaded.identity.content_hash), (card.whole, card.whole, HASH));
    assert!((loaded.clock_hz / CLOCK_HZ - 1.0).abs() < 1e-4, "{}", loaded.clock_hz);
    let state = inspect(&mut card).unwrap();
    assert!(state.done && state.ready_enabled == [true; 4] && state.identity == Some(loaded.identity));

    let kept = load(&mut card, &bitstream, &options, |_| panic!("nothing is sent")).unwrap();
    assert_eq!((kept.kept, kept.tries), (true, 0));
    let other = Options { content_hash: Some(!HASH), ..options };
    let refused = load(&mut card, &bitstream, &other, |_| ()).unwrap_err();
    assert!(matches!(refused.cause(), LoadError::OtherDesign { found: HASH, .. }), "{refused}");
    assert_eq!((card.bytes, card.outputs & PROGRAM), (0, 0), "the FPGA is not clear");
}

#[test]
fn a_line_that_does_not_fall_with_program_is_named() {
    let bitstream = bitstream();
    for (stuck, name) in [(DONE, "DONE"), (INIT, "INIT")] {
        let mut card = Bench { stuck, ..Bench::blank(&bitstream) };
        let error = load(&mut card, &bitstream, &Options::default(), |_| panic!("a byte is sent")).unwrap_err();
        assert!(matches!(error.cause(), LoadError::NotCleared { line } if *line == name), "{error}");
    }
}
