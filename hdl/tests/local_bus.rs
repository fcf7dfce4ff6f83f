//! The local bus block against its twin, clock by clock, and against a memory.

use fixed_kin::local_bus::{self as twin, Inputs, Outputs};
use hdl::blocks::local_bus::LocalBus;
use hdl::sim::{cycle, settle};
use rust_hdl::prelude::{Block, Clock};
use std::collections::HashMap;

/// xorshift64*: the same cycles on every machine.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32) as u32
    }

    fn below(&mut self, limit: u32) -> u32 {
        self.next() % limit
    }

    fn one_in(&mut self, n: u32) -> bool {
        self.below(n) == 0
    }
}

fn block() -> LocalBus {
    let mut block = LocalBus::default();
    block.connect_all();
    block
}

fn apply(block: &mut LocalBus, inputs: &Inputs) {
    block.ads_n.next = inputs.ads_n;
    block.blast_n.next = inputs.blast_n;
    block.lw_r.next = inputs.lw_r;
    block.lad_in.next = u64::from(inputs.lad).into();
    block.read_data.next = u64::from(inputs.read_data).into();
    block.write_busy.next = inputs.write_busy;
}

fn outputs(block: &LocalBus) -> Outputs {
    let word = |bits: u64| u32::try_from(bits).unwrap();
    Outputs {
        lad: word(block.lad_out.val().to_u64()),
        lad_drive: block.lad_drive.val(),
        ready_n: block.ready_n.val(),
        address: word(block.address.val().to_u64()),
        read: block.read.val(),
        write: block.write.val(),
        write_data: word(block.write_data.val().to_u64()),
        overrun: block.overrun.val(),
        claims: block.claims.val(),
    }
}

/// A bus master with bad manners: legal cycles, bursts, back to back, aborted by a new ADS#, BLAST#
/// early or never, lines that twitch for no reason.
struct Master {
    noise: Noise,
    words: u32,
    waited: u32,
    busy: bool,
    manners: u32,
}

impl Master {
    fn inputs(&mut self, last: &Outputs) -> Inputs {
        let noise = &mut self.noise;
        if noise.one_in(2000) {
            self.manners = noise.below(4);
        }
        // Long enough now and then that the block gives a write up.
        let toggles = match (self.busy, self.manners) {
            (true, 1) => 100,
            (true, _) => 12,
            _ => 200,
        };
        if noise.one_in(toggles) {
            self.busy = !self.busy && self.manners != 0;
        }
        let mut inputs = Inputs {
            lw_r: noise.one_in(2),
            lad: noise.next(),
            read_data: noise.next(),
            write_busy: self.busy,
            ..Inputs::default()
        };
        self.waited += 1;
        if !last.ready_n {
            self.words = self.words.saturating_sub(1);
            self.waited = 0;
        }
        // The burst may have ended without us: at the end of the window, or by our own twitch.
        if self.waited > twin::WRITE_CLOCKS_MAX {
            self.words = 0;
        }
        let aborts = self.manners >= 2 && noise.one_in(15);
        if (self.words == 0 && !noise.one_in(3)) || aborts {
            inputs.ads_n = false;
            self.waited = 0;
            self.words = if noise.one_in(2) { 1 } else { 1 + noise.below(9) };
            if noise.one_in(20) {
                // The end of the window.
                inputs.lad |= 0xFFF0;
            }
            return inputs;
        }
        inputs.blast_n = self.words != 1;
        if self.manners == 3 {
            inputs.blast_n ^= noise.one_in(10);
        }
        inputs
    }
}

#[test]
fn every_clock_equals_the_twin() {
    let clocks = if cfg!(debug_assertions) { 100_000 } else { 1_500_000 };
    let (mut block, mut twin) = (block(), twin::LocalBus::new());
    let mut master = Master { noise: Noise(7), words: 0, waited: 0, busy: false, manners: 0 };
    let mut last = twin.outputs(false);
    let (mut reads, mut writes, mut overruns, mut waited) = (0, 0, 0, 0);
    for n in 0..clocks {
        let inputs = master.inputs(&last);
        twin.clock(&inputs);
        last = twin.outputs(inputs.write_busy);
        apply(&mut block, &inputs);
        cycle(&mut block, |b, level| b.clock.next = Clock { clk: level });
        assert_eq!(outputs(&block), last, "clock {n}: {inputs:?}");
        reads += u32::from(last.read);
        writes += u32::from(last.write);
        overruns += u32::from(last.overrun);
        waited += u32::from(inputs.write_busy);
    }
    let much = clocks / 20;
    assert!(reads > much && writes > much && overruns > 10 && waited > much, "{reads} {writes} {overruns} {waited}");
}

/// A memory behind the block: data two clocks after the strobe, busy as it likes.
#[derive(Default)]
struct Memory {
    words: HashMap<u32, u32>,
    pipeline: [u32; 2],
    strobes: u32,
}

impl Memory {
    fn clock(&mut self, bus: &Outputs) {
        if bus.write {
            self.words.insert(bus.address, bus.write_data);
        }
        self.strobes += u32::from(bus.read);
        // Nothing asked for, nothing sensible there.
        let asked = if bus.read { *self.words.get(&bus.address).unwrap_or(&0) } else { 0xDEAD_BEEF };
        self.pipeline = [asked, self.pipeline[0]];
    }
}

/// The other side: a well-mannered PLX that knows nothing of phases, only of READY#. Master, memory
/// and block all sample at the same edge what holds before it.
struct Host {
    block: LocalBus,
    memory: Memory,
    noise: Noise,
    busy: u32,
}

impl Host {
    /// One clock; gives READY# and the bus as the master samples them.
    fn clock(&mut self, inputs: Inputs) -> (bool, u32) {
        self.busy = match self.busy {
            0 if self.noise.one_in(20) => 1 + self.noise.below(twin::OFFER_CLOCKS - 2),
            busy => busy.saturating_sub(1),
        };
        let inputs = Inputs { read_data: self.memory.pipeline[1], write_busy: self.busy > 0, ..inputs };
        apply(&mut self.block, &inputs);
        self.block.clock.next = Clock { clk: false };
        settle(&mut self.block);
        let before_edge = outputs(&self.block);
        self.block.clock.next = Clock { clk: true };
        settle(&mut self.block);
        self.memory.clock(&before_edge);
        (before_edge.ready_n, if before_edge.lad_drive { before_edge.lad } else { 0xA5A5_A5A5 })
    }
}

#[test]
fn a_memory_behind_it_reads_back_what_was_written() {
    let cycles = if cfg!(debug_assertions) { 3_000 } else { 60_000 };
    let mut host = Host { block: block(), memory: Memory::default(), noise: Noise(99), busy: 0 };
    let mut reference: HashMap<u32, u32> = HashMap::new();
    let mut words_read = 0;
    for _ in 0..cycles {
        let write = host.noise.one_in(2);
        let count = if host.noise.one_in(2) { 1 } else { 1 + host.noise.below(20) };
        let first = host.noise.below(64);
        host.clock(Inputs { ads_n: false, lw_r: write, lad: first << 2, ..Inputs::default() });
        for n in 0..count {
            let data = host.noise.next();
            let lad = if write { data } else { 0xA5A5_A5A5 };
            let inputs = Inputs { blast_n: n + 1 < count, lad, ..Inputs::default() };
            let mut clocks = 0;
            let read = loop {
                let (ready_n, lad) = host.clock(inputs);
                clocks += 1;
                assert!(clocks <= twin::WRITE_CLOCKS_MAX, "no READY#");
                if !ready_n {
                    break lad;
                }
            };
            if write {
                reference.insert(first + n, data);
            } else {
                words_read += 1;
                assert_eq!(clocks, twin::READ_CLOCKS);
                assert_eq!(read, *reference.get(&(first + n)).unwrap_or(&0));
            }
        }
        for _ in 0..host.noise.below(3) {
            host.clock(Inputs::default());
        }
    }
    assert_eq!(host.memory.words, reference);
    assert_eq!(host.memory.strobes, words_read, "one strobe a word, none ahead");
}
