//! Radio: rust-hdl simulation = twin, clock by clock on all outputs.

use fixed_kin::radio::{CLOCKS_PER_BIT, Frame, Inputs, Outputs, Radio};
use hdl::stimulus::{compare, radio};

const CLOCKS: usize = if cfg!(debug_assertions) { 30_000 } else { 1_500_000 };

#[test]
fn simulation_equals_twin() {
    for seed in [4, 5] {
        let mut twin = Radio::new(radio::CLOCKS_PER_BIT);
        let rows = radio::stimulus(seed, CLOCKS / 2);
        compare(&rows, radio::hardware(), |row| twin.clock(row)).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn the_stimulus_reaches_the_corners() {
    let mut twin = Radio::new(radio::CLOCKS_PER_BIT);
    let (mut offered, mut waited, mut before) = (0, 0, Outputs::default());
    let (mut selections, mut accepted, mut dropped) = (0, 0, 0);
    for row in radio::stimulus(5, 3_000_000) {
        let after = twin.clock(&row);
        offered += u32::from(after.offer && !before.offer);
        waited += u32::from(after.offer && before.offer);
        accepted += u32::from(after.accepted != before.accepted);
        dropped += u32::from(after.dropped != before.dropped);
        selections += u32::from(after.selected != before.selected);
        before = after;
    }
    println!("{accepted} frames taken, {dropped} not, {offered} words");
    assert!(accepted > 180 && dropped > 300 && offered > 600 && waited > 1_000 && selections > 5);
}

/// A clock at a time, at the real rate of the line.
struct Line {
    radio: Radio,
    pins: Inputs,
    words: Vec<(u16, u32)>,
}

impl Line {
    fn new(host_select: bool) -> Self {
        let pins = Inputs { rx: true, host_select, robot: 6, ..Inputs::default() };
        let mut line = Self { radio: Radio::default(), pins, words: Vec::new() };
        line.wait(10_000);
        line
    }

    fn wait(&mut self, clocks: u32) {
        for _ in 0..clocks {
            let before = self.radio.outputs();
            if before.offer {
                self.words.push((before.address * 4, before.data));
            }
            self.radio.clock(&Inputs { taken: before.offer, ..self.pins });
        }
    }

    fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let bits = u32::from(*byte) << 1 | 1 << 9;
            for bit in 0..10 {
                self.pins.rx = bits >> bit & 1 == 1;
                self.wait(CLOCKS_PER_BIT.into());
            }
        }
        self.pins.rx = true;
        self.wait(30 * u32::from(CLOCKS_PER_BIT));
    }
}

fn drive(sequence: u8) -> Vec<u8> {
    let mut frame = Frame::new(6, sequence).unwrap();
    frame.set_points([1, 2, 0xFFFF_FFFF, 4]).unwrap();
    frame.bytes().to_vec()
}

#[test]
fn a_frame_becomes_its_writes_once() {
    let mut line = Line::new(false);
    line.send(&drive(0));
    let wanted = [(0x600, 1), (0x604, 2), (0x608, 0xFFFF_FFFF), (0x60C, 4)];
    assert_eq!(line.words[..4], wanted);
    assert_eq!((line.words.len(), line.words[4].0), (5, 0x048));
    line.send(&drive(0));
    assert_eq!(line.words.len(), 5, "a repeated frame does nothing");
    line.send(&drive(1));
    assert_eq!(line.words.len(), 10);
}

#[test]
fn with_the_strap_open_frames_are_counted_and_nothing_else() {
    let mut line = Line::new(true);
    line.send(&drive(0));
    assert_eq!((line.words.len(), line.radio.outputs().accepted), (0, 1));
    // The register selects, but not while armed.
    line.pins.select = true;
    line.pins.select_write = true;
    line.pins.armed = true;
    line.wait(1);
    assert!(!line.radio.outputs().selected);
    line.pins.armed = false;
    line.wait(1);
    line.pins.select_write = false;
    line.send(&drive(1));
    assert_eq!(line.words.len(), 5);
}
