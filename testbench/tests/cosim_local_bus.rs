//! The emitted local bus block against its twin: a million clocks of legal, aborted and senseless
//! cycles; and the gate.

use fixed_kin::local_bus::{Inputs, LocalBus as Twin};
use hdl::blocks::local_bus::LocalBus;
use hdl::emit::verilog;
use rust_hdl::prelude::Block;
use simulator::cosim::{Ports, Verilated, lint};
use std::ops::ControlFlow;

const CLOCKS: u64 = if cfg!(debug_assertions) { 1_000_000 } else { 4_000_000 };

fn text() -> String {
    let mut block = LocalBus::default();
    block.connect_all();
    verilog::emit(&block, "local_bus")
}

/// Lines that are mostly quiet, in stretches of different temper, some of them busy for long.
fn stimulus(seed: &mut u64, step: u64, row: &mut [u32]) {
    let mut noise = || {
        *seed ^= *seed >> 12;
        *seed ^= *seed << 25;
        *seed ^= *seed >> 27;
        (seed.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32) as u32
    };
    let stretch = step / 256;
    let ads_every = [5, 17, 90, 3][stretch as usize % 4];
    let blast_every = [2, 9, 4, 1000][stretch as usize / 4 % 4];
    let ads_n = u32::from(!noise().is_multiple_of(ads_every));
    let blast_n = u32::from(!noise().is_multiple_of(blast_every));
    let busy = u32::from(stretch % 7 == 2 || noise().is_multiple_of(5));
    row.copy_from_slice(&[ads_n, blast_n, noise() & 1, noise(), noise(), busy]);
}

#[test]
fn a_million_clocks_equal_the_twin() {
    let text = text();
    let ports = Ports::parse(&text, "local_bus", &["clock"]).unwrap();
    let design = Verilated::build("local_bus", &text, "local_bus", &ports).unwrap();
    let names: Vec<_> = design.layout().inputs.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["ads_n", "blast_n", "lw_r", "lad_in", "read_data", "write_busy"]);
    let names: Vec<_> = design.layout().outputs.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(
        names,
        ["lad_out", "lad_drive", "ready_n", "address", "read", "write", "write_data", "overrun", "claims"]
    );
    let (mut twin, mut seed) = (Twin::new(), 3);
    let mut counts = [0; 4];
    let mut session = design.start().unwrap();
    let check = |step, row: &[u32], answer: &[u32]| {
        let write_busy = row[5] != 0;
        let (ads_n, blast_n, lw_r) = (row[0] != 0, row[1] != 0, row[2] != 0);
        twin.clock(&Inputs { ads_n, blast_n, lw_r, lad: row[3], read_data: row[4], write_busy });
        let o = twin.outputs(write_busy);
        let bit = u32::from;
        let expected = [
            o.lad,
            bit(o.lad_drive),
            bit(o.ready_n),
            o.address,
            bit(o.read),
            bit(o.write),
            o.write_data,
            bit(o.overrun),
            bit(o.claims),
        ];
        assert_eq!(answer, expected, "clock {step}: {row:?}");
        for (count, now) in counts.iter_mut().zip([o.read, o.write, o.overrun, !o.ready_n]) {
            *count += u32::from(now);
        }
        ControlFlow::Continue(())
    };
    session.stream(CLOCKS, |step, row| stimulus(&mut seed, step, row), check).unwrap();
    assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
}

#[test]
fn the_gate_finds_nothing() {
    lint::gate("local_bus", &text(), "local_bus").unwrap();
}

#[test]
fn a_block_that_forgets_blast_is_caught() {
    let broken = text().replace("~blast_n", "1'b0");
    let ports = Ports::parse(&broken, "local_bus", &["clock"]).unwrap();
    let design = Verilated::build("local_bus_broken", &broken, "local_bus", &ports).unwrap();
    let (mut twin, mut seed, mut differs) = (Twin::new(), 3, false);
    let check = |_, row: &[u32], answer: &[u32]| {
        let (ads_n, blast_n, lw_r) = (row[0] != 0, row[1] != 0, row[2] != 0);
        let write_busy = row[5] != 0;
        twin.clock(&Inputs { ads_n, blast_n, lw_r, lad: row[3], read_data: row[4], write_busy });
        differs = answer[2] != u32::from(twin.outputs(write_busy).ready_n);
        if differs { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let mut session = design.start().unwrap();
    session.stream(10_000, |step, row| stimulus(&mut seed, step, row), check).unwrap();
    assert!(differs);
}
