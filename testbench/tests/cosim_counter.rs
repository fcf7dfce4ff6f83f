//! One small block through rust-hdl's simulation, Verilator and Icarus: three equal answers.

use hdl::sim::cycle;
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;
use simulator::cosim::{Change, Clocks, Levels, Ports, Verilated, icarus, lint};
use std::ops::ControlFlow;

#[derive(LogicBlock, Default)]
struct Accumulator {
    clock: Signal<In, Clock>,
    amount: Signal<In, Bits<16>>,
    enable: Signal<In, Bit>,
    sum: Signal<Out, Bits<16>>,
    wide: Signal<Out, Bits<32>>,
    odd: Signal<Out, Bit>,
    total: DFF<Bits<16>>,
    edges: DFF<Bits<32>>,
    next: Signal<Local, Bits<16>>,
}

impl Logic for Accumulator {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, total, edges);
        self.next.next = self.total.q.val() + self.amount.val();
        if self.enable.val() {
            self.total.d.next = self.next.val();
        }
        self.edges.d.next = self.edges.q.val() + 1;
        self.sum.next = self.total.q.val();
        self.wide.next = self.edges.q.val() ^ 0x25A5_0000;
        self.odd.next = self.next.val().get_bit(0);
    }
}

fn block() -> Accumulator {
    let mut block = Accumulator::default();
    block.connect_all();
    block
}

fn verilated() -> Verilated {
    let block = block();
    Verilated::build("accumulator", &generate_verilog(&block), "top", &Ports::of(&block).unwrap()).unwrap()
}

/// xorshift: any stimulus will do.
fn noise(step: u64) -> u32 {
    let mut x = step.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x ^= x >> 29;
    x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (x >> 32) as u32
}

fn row(step: u64, row: &mut [u32]) {
    row.copy_from_slice(&[noise(step) & 0xffff, noise(step) >> 31]);
}

fn reference(block: &mut Accumulator, row: &[u32]) -> [u32; 3] {
    block.amount.next = u64::from(row[0]).into();
    block.enable.next = row[1] != 0;
    cycle(block, |b, level| b.clock.next = level.into());
    let value = |bits: u64| u32::try_from(bits).unwrap();
    [value(block.sum.val().to_u64()), value(block.wide.val().to_u64()), u32::from(block.odd.val())]
}

#[test]
fn ports_come_from_the_block_and_from_the_text_alike() {
    let block = block();
    let ports = Ports::of(&block).unwrap();
    assert_eq!(ports.clocks, ["clock"]);
    assert_eq!(ports, Ports::parse(&generate_verilog(&block), "top", &["clock"]).unwrap());
}

#[test]
fn verilator_equals_the_simulation() {
    let mut block = block();
    let mut session = verilated().start().unwrap();
    let mut seen = 0;
    let check = |step, row: &[u32], answer: &[u32]| {
        assert_eq!(answer, reference(&mut block, row), "step {step}");
        seen += 1;
        ControlFlow::Continue(())
    };
    session.stream(50_000, row, check).unwrap();
    assert_eq!(seen, 50_000);
}

#[test]
fn icarus_equals_the_simulation() {
    let mut reference_block = block();
    let mut stimulus = vec![0; 2 * 2000];
    for (step, words) in (0..).zip(stimulus.chunks_mut(2)) {
        row(step, words);
    }
    let expected: Vec<_> = stimulus.chunks(2).flat_map(|row| reference(&mut reference_block, row)).collect();
    let ports = Ports::of(&reference_block).unwrap();
    let answer = icarus::run("accumulator", &generate_verilog(&block()), "top", &ports, &stimulus).unwrap();
    assert_eq!(answer, expected);
}

#[test]
fn a_sound_block_passes_the_gate() {
    lint::gate("accumulator", &generate_verilog(&block()), "top").unwrap();
}

#[test]
fn pins_can_be_played_and_recorded() {
    let design = verilated();
    let layout = design.layout().clone();
    let (amount, enable) = (layout.input("amount").unwrap(), layout.input("enable").unwrap());
    let sum = layout.output("sum").unwrap();
    let mut session = design.start().unwrap();
    session.run(1_000_000).unwrap();
    session.set(&[(amount, 3)]).unwrap();
    session.record(&[sum]).unwrap();
    let change = |clock, port, value| Change { clock, port, value };
    let pulses = [change(10, enable, 1), change(12, enable, 0), change(99, enable, 1)];
    let seen = session.play(100, &pulses).unwrap();
    assert_eq!(seen, [change(10, sum, 3), change(11, sum, 6), change(99, sum, 9)]);
    assert_eq!(session.clock(), 1_000_100);
    assert_eq!(session.get_port("wide").unwrap(), 1_000_100 ^ 0x25A5_0000);
}

#[test]
fn clocks_can_stand_still() {
    let design = verilated();
    let stopped = Levels { before: 1, after: 1 }.word();
    let rows = [1, 0, 0, stopped, 0, 0, stopped, 0, 0, 1, 0, 0];
    let answer = design.run_with(&Clocks::PerStep, &rows).unwrap();
    let edges: Vec<_> = answer.chunks(3).map(|row| row[1] ^ 0x25A5_0000).collect();
    assert_eq!(edges, [1, 1, 1, 2]);
}

#[test]
fn a_check_may_stop_or_panic_without_hanging() {
    let mut session = verilated().start().unwrap();
    session
        .stream(
            u64::MAX,
            row,
            |step, _, _| if step == 70_000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) },
        )
        .unwrap();
    let panicked = std::panic::catch_unwind(move || {
        session.stream(u64::MAX, row, |step, _, _| {
            assert!(step < 9, "as meant");
            ControlFlow::Continue(())
        })
    });
    assert!(panicked.is_err());
}

#[test]
fn a_wrong_stimulus_is_named() {
    let message = verilated().run(&[1, 2, 3]).unwrap_err().to_string();
    assert!(message.contains("amount, enable"), "{message}");
}
