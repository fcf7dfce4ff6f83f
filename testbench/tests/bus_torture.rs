//! Random PLX cycles on the emitted Verilog, clock by clock: single and burst, back to back, aborted by
//! the next one, left alone in the middle of a read, at plain, read-only, write-only and reserved words.
//!
//! Checked at every clock: READY# comes in time and never unasked, LAD is driven only for a word of a
//! read. Checked at every word: reserved and write-only words read 0, plain ones what was written last,
//! identification what it always was. A write that was aborted may or may not have happened.

use fixed_kin::card::Card;
use fixed_kin::registers::{self as map, Access};
use hdl::design::{COMMITTED_VERILOG, content_hash};
use hdl::emit::ports::Ports;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use simulator::cosim::{Session, Verilated};

const CYCLES: usize = 10_000;
/// The bound that `testbench/proofs/bus.v` proves.
const LONGEST_WAIT: u32 = 66;
const CORE: &str = "rac4i65_core";

/// What the chip shows after a clock.
#[derive(Clone, Copy, Default)]
struct Shown {
    ready: bool,
    drives: bool,
    lad: u32,
}

struct Bus {
    session: Session,
    random: ChaCha8Rng,
    /// Columns of ads_n, blast_n, lw_r, lad_in.
    inputs: [usize; 4],
    outputs: [usize; 3],
    row: Vec<u32>,
    shown: Shown,
    clocks: u64,
}

impl Bus {
    fn new() -> Self {
        let ports = Ports::parse(COMMITTED_VERILOG, CORE, &["lclk", "synclk"]).unwrap();
        let built = Verilated::build(CORE, COMMITTED_VERILOG, CORE, &ports).unwrap_or_else(|error| panic!("{error}"));
        let layout = built.layout();
        let inputs = ["ads_n", "blast_n", "lw_r", "lad_in"].map(|name| layout.input(name).unwrap());
        let outputs = ["ready_n", "lad_drive", "lad_out"].map(|name| layout.output(name).unwrap());
        let mut row = vec![0; layout.inputs.len()];
        row[layout.input("host_select").unwrap()] = 1;
        row[layout.input("board").unwrap()] = map::BOARD_4I65.word;
        row[layout.input("clock_hz").unwrap()] = map::BOARD_4I65.clock_hz;
        let random = ChaCha8Rng::seed_from_u64(21);
        let session = built.start().unwrap();
        Self { session, random, inputs, outputs, row, shown: Shown::default(), clocks: 0 }
    }

    fn clock(&mut self, ads: bool, last: bool, write: bool, lad: Option<u32>) {
        let lad = lad.unwrap_or_else(|| self.random.next_u32());
        let values = [u32::from(!ads), u32::from(!last), u32::from(write), lad];
        for (column, value) in self.inputs.into_iter().zip(values) {
            self.row[column] = value;
        }
        let row = self.row.clone();
        let answer = self.session.run_batch(&row).unwrap();
        let [ready_n, drive, lad] = self.outputs.map(|column| answer[column]);
        self.shown = Shown { ready: ready_n == 0, drives: drive == 1, lad };
        self.clocks += 1;
    }

    fn idle(&mut self, clocks: u32) {
        for _ in 0..clocks {
            // Direction and data lines may do anything between cycles, BLAST# too.
            let (blast, write) = (self.random.random(), self.random.random());
            self.clock(false, blast, write, None);
            assert!(!self.shown.ready && !self.shown.drives, "an answer to nobody at clock {}", self.clocks);
        }
    }

    /// The address clock. Whatever went on before, the card lets go of LAD at its edge.
    fn address(&mut self, offset: u16, write: bool) {
        let blast = self.random.random();
        self.clock(true, blast, write, Some(offset.into()));
        assert!(!self.shown.ready && !self.shown.drives, "driven against an address at clock {}", self.clocks);
    }

    /// One word, until it is transferred, or `None` after so many clocks without.
    fn word(&mut self, data: Option<u32>, last: bool, patience: u32) -> Option<u32> {
        for wait in 0..patience {
            let before = self.shown;
            self.clock(false, last, data.is_some(), data);
            assert!(data.is_none() || !self.shown.drives, "driven against data at clock {}", self.clocks);
            if before.ready {
                assert!(data.is_some() || before.drives, "a word that is not driven at clock {}", self.clocks);
                let over = !self.shown.ready && (!last || !self.shown.drives);
                assert!(over, "goes on after the last word at clock {}", self.clocks);
                return Some(before.lad);
            }
            assert!(wait < LONGEST_WAIT, "no READY# after {wait} clocks, at clock {}", self.clocks);
        }
        None
    }
}

/// What a word must read as, where that is known.
fn expected(card: &mut Card, offset: u16) -> Option<u32> {
    match map::lookup(offset).map(|(register, _)| register.access) {
        None | Some(Access::WriteOnly) => Some(0),
        Some(Access::ReadOnly) if offset < map::TIME.offset => Some(card.read(offset)),
        Some(Access::ReadWrite | Access::LockedWhileArmed | Access::Staged) => Some(card.read(offset)),
        Some(Access::ReadOnly | Access::WriteOneToClear) => None,
    }
}

fn offset(random: &mut ChaCha8Rng) -> u16 {
    match random.random_range(0..4) {
        0 => random.random_range(0..0x4000) * 4,
        1 => random.random_range(0..0x260) * 4,
        _ => {
            let register = map::REGISTERS[random.random_range(0..map::REGISTERS.len())];
            register.at(random.random_range(0..usize::from(register.words)))
        }
    }
}

fn check(bus: &Bus, card: &mut Card, at: u16, got: u32) -> usize {
    let Some(expected) = expected(card, at) else { return 0 };
    assert_eq!(got, expected, "offset {at:#06x} at clock {}", bus.clocks);
    1
}

#[test]
fn random_cycles_are_answered_and_right() {
    let mut bus = Bus::new();
    let mut card = Card::new(content_hash());
    bus.idle(1);
    let (mut compared, mut aborted, mut happened, mut left) = (0, 0, 0, 0);
    for _ in 0..CYCLES {
        let at = offset(&mut bus.random);
        let count = match bus.random.random_range(0..3) {
            0 => bus.random.random_range(1..30_u16),
            _ => 1,
        };
        let count = count.min((0xFFFC - at) / 4 + 1);
        let write: bool = bus.random.random();
        // The word at which the master loses patience, and after how many clocks.
        let abort = (bus.random.random_range(0..5) == 0)
            .then(|| (bus.random.random_range(0..count), bus.random.random_range(0..5_u32)));
        bus.address(at, write);
        let mut open = None;
        for index in 0..count {
            let patience = abort.filter(|(word, _)| *word == index).map_or(u32::MAX, |(_, clocks)| clocks);
            let data = write.then(|| bus.random.next_u32() >> bus.random.random_range(0..32));
            let at = at + 4 * index;
            match (bus.word(data, index + 1 == count && abort.is_none(), patience), data) {
                (Some(_), Some(data)) => card.write(at, data),
                (Some(got), None) => compared += check(&bus, &mut card, at, got),
                (None, data) => {
                    aborted += 1;
                    open = Some((at, data));
                    break;
                }
            }
        }
        match open {
            None if abort.is_none() => {
                let gap = bus.random.random_range(0..4);
                bus.idle(gap);
            }
            // The master stays silent in the middle of a read; the next cycle finds the card well.
            Some((_, None)) if bus.random.random() => {
                left += 1;
                for _ in 0..bus.random.random_range(1..50) {
                    bus.clock(false, false, false, None);
                }
            }
            Some((at, Some(data))) => {
                // It may act while the first cycle after it reads: the second one says what became of it.
                let [first, got] = [(); 2].map(|()| {
                    bus.address(at, false);
                    bus.word(None, true, u32::MAX).expect("patient")
                });
                if let Some(old) = expected(&mut card, at) {
                    let mut after = card.clone();
                    after.write(at, data);
                    let new = expected(&mut after, at);
                    assert!(
                        [first, got].iter().all(|word| *word == old || Some(*word) == new),
                        "offset {at:#06x}: {got:#x}, neither {old:#x} nor {new:x?}"
                    );
                    if got != old {
                        card = after;
                        happened += 1;
                    }
                }
            }
            _ => {}
        }
    }
    println!("{CYCLES} cycles, {} clocks, {compared} words compared; {aborted} aborted, {left} left alone", bus.clocks);
    assert!(compared > CYCLES && aborted > CYCLES / 10 && left > CYCLES / 50, "{compared} {aborted} {left}");
    assert!(happened > 10, "no aborted write ever happened: {happened}");
}
