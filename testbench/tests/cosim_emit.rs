//! The emitted text behaves as rust-hdl's own, passes the gate, and its top module works the card's
//! tri-state bus: a small core with the real local bus block, seen through the pins.

use hdl::blocks::local_bus::LocalBus;
use hdl::board::{Assignment, Board, Buffer, Place};
use hdl::emit::{top, verilog};
use rust_hdl::prelude::*;
use rust_hdl_widgets::prelude::*;
use simulator::cosim::{BusConfig, BusOperation, Ports, Verilated, icarus, lint};
use std::collections::HashMap;

/// Two equal chains of two accumulators.
#[derive(LogicBlock, Default)]
struct Chains {
    clock: Signal<In, Clock>,
    amount: [Signal<In, Bits<8>>; 2],
    value: [Signal<Out, Bits<8>>; 2],
    chain: [Chain; 2],
}

#[derive(LogicBlock, Default)]
struct Chain {
    clock: Signal<In, Clock>,
    amount: Signal<In, Bits<8>>,
    value: Signal<Out, Bits<8>>,
    first: DFF<Bits<8>>,
    second: DFF<Bits<8>>,
}

impl Logic for Chain {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, first, second);
        self.first.d.next = self.first.q.val() + self.amount.val();
        self.second.d.next = self.second.q.val() ^ self.first.q.val();
        self.value.next = self.second.q.val();
    }
}

impl Logic for Chains {
    #[hdl_gen]
    fn update(&mut self) {
        for i in 0..2 {
            self.chain[i].clock.next = self.clock.val();
            self.chain[i].amount.next = self.amount[i].val();
            self.value[i].next = self.chain[i].value.val();
        }
    }
}

/// Four registers behind the bus; writes are refused three clocks out of four.
#[derive(LogicBlock, Default)]
struct Registers {
    clock: Signal<In, Clock>,
    ads_n: Signal<In, Bit>,
    blast_n: Signal<In, Bit>,
    lw_r: Signal<In, Bit>,
    lad_in: Signal<In, Bits<32>>,
    lad_out: Signal<Out, Bits<32>>,
    lad_drive: Signal<Out, Bit>,
    ready_n: Signal<Out, Bit>,
    led_n: Signal<Out, Bits<4>>,
    bus: LocalBus,
    register: [DFF<Bits<32>>; 4],
    picked: DFF<Bits<32>>,
    fetched: DFF<Bits<32>>,
    turn: DFF<Bits<2>>,
    overruns: DFF<Bits<4>>,
    address: Signal<Local, Bits<2>>,
    chosen: Signal<Local, Bits<32>>,
}

impl Logic for Registers {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, picked, fetched, turn, overruns);
        clock!(self, clock, bus);
        for i in 0..4 {
            self.register[i].clock.next = self.clock.val();
            self.register[i].d.next = self.register[i].q.val();
        }
        self.bus.ads_n.next = self.ads_n.val();
        self.bus.blast_n.next = self.blast_n.val();
        self.bus.lw_r.next = self.lw_r.val();
        self.bus.lad_in.next = self.lad_in.val();
        self.lad_out.next = self.bus.lad_out.val();
        self.lad_drive.next = self.bus.lad_drive.val();
        self.ready_n.next = self.bus.ready_n.val();

        self.turn.d.next = self.turn.q.val() + 1;
        self.bus.write_busy.next = self.turn.q.val().any();
        self.address.next = self.bus.address.val().get_bits::<2>(0);
        self.chosen.next = 0.into();
        for i in 0..4 {
            if self.address.val().index() == i {
                self.chosen.next = self.register[i].q.val();
                if self.bus.write.val() {
                    self.register[i].d.next = self.bus.write_data.val();
                }
            }
        }
        if self.bus.read.val() {
            self.picked.d.next = self.chosen.val();
        }
        self.fetched.d.next = self.picked.q.val();
        self.bus.read_data.next = self.fetched.q.val();
        if self.bus.overrun.val() {
            self.overruns.d.next = self.overruns.q.val() + 1;
        }
        self.led_n.next = self.overruns.q.val();
    }
}

/// Busy for three clocks after a start.
#[derive(LogicBlock, Default)]
struct Worker {
    clock: Signal<In, Clock>,
    start: Signal<In, Bit>,
    busy: Signal<Out, Bit>,
    left: DFF<Bits<2>>,
    running: Signal<Local, Bit>,
    next: Signal<Local, Bits<2>>,
}

impl Logic for Worker {
    #[hdl_gen]
    fn update(&mut self) {
        dff_setup!(self, clock, left);
        self.running.next = self.left.q.val().any();
        self.next.next = self.left.q.val();
        if self.running.val() {
            self.next.next = self.left.q.val() - 1;
        }
        if self.start.val() {
            self.next.next = 3.into();
        }
        self.left.d.next = self.next.val();
        self.busy.next = self.running.val();
    }
}

/// Starts a worker that is not busy: no signal depends on itself, but each block's `update` reads
/// what the other's writes.
#[derive(LogicBlock, Default)]
struct Employer {
    clock: Signal<In, Clock>,
    request: Signal<In, Bit>,
    refused: Signal<Out, Bit>,
    worker: Worker,
    free: Signal<Local, Bit>,
}

impl Logic for Employer {
    #[hdl_gen]
    fn update(&mut self) {
        self.worker.clock.next = self.clock.val();
        self.free.next = !self.worker.busy.val();
        self.worker.start.next = self.request.val() & self.free.val();
        self.refused.next = self.request.val() & !self.free.val();
    }
}

/// A board with the card's bus and nothing else.
fn small_board() -> Board {
    let mut board = Board::mesa_4i65_7i30();
    board.assignments.retain(|a| matches!(a.port.as_str(), "lclk" | "ads_n" | "blast_n" | "lw_r" | "ready_n" | "lad"));
    let led = |bit| Assignment {
        port: "led_n".into(),
        bit: Some(bit),
        place: Place::Io(bit),
        buffer: Buffer::Output { drive_ma: 24, fast: false },
    };
    board.assignments.extend((0..4).map(led));
    board
}

fn chip() -> (String, Ports) {
    let mut core = Registers::default();
    core.connect_all();
    let text = top::chip(&core, &small_board(), "rac4i65").unwrap();
    let ports = Ports::parse(&text, "rac4i65", &["lclk"]).unwrap();
    (text, ports)
}

fn noise(seed: &mut u64) -> u32 {
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    (seed.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32) as u32
}

#[test]
fn renamed_and_merged_text_behaves_as_before() {
    let mut block = Chains::default();
    block.connect_all();
    let (raw, emitted) = (generate_verilog(&block), verilog::emit(&block, "chains"));
    lint::gate("chains", &emitted, "chains").unwrap();
    let before = Verilated::build("chains_raw", &raw, "top", &Ports::of(&block).unwrap()).unwrap();
    let ports = Ports::parse(&emitted, "chains", &["clock"]).unwrap();
    let after = Verilated::build("chains", &emitted, "chains", &ports).unwrap();
    let mut seed = 5;
    let stimulus: Vec<_> = (0..200_000).map(|_| noise(&mut seed) & 0xff).collect();
    let answer = after.run(&stimulus).unwrap();
    assert_eq!(before.run(&stimulus).unwrap(), answer);
    assert_eq!(icarus::run("chains", &emitted, "chains", &ports, &stimulus[..4000]).unwrap(), answer[..4000]);
}

#[test]
fn blocks_that_talk_to_each_other_are_no_loop() {
    let mut block = Employer::default();
    block.connect_all();
    let loops = |text: &str, top| {
        let findings = lint::verilator("employer", text, top).unwrap();
        findings.iter().filter(|f| f.kind == "UNOPTFLAT").count()
    };
    let (raw, emitted) = (generate_verilog(&block), verilog::emit(&block, "employer"));
    assert_ne!(loops(&raw, "top"), 0, "nothing to repair any more");
    assert_eq!(loops(&emitted, "employer"), 0);
    lint::gate("employer", &emitted, "employer").unwrap();
    let ports = Ports::parse(&emitted, "employer", &["clock"]).unwrap();
    let stimulus = [0, 1, 1, 1, 1, 1, 0];
    let answer = Verilated::build("employer", &emitted, "employer", &ports).unwrap().run(&stimulus).unwrap();
    assert_eq!(answer, icarus::run("employer", &emitted, "employer", &ports, &stimulus).unwrap());
    assert_eq!(answer, [0, 1, 1, 1, 0, 1, 0]);
}

#[test]
fn the_whole_file_passes_the_gate() {
    let (text, _) = chip();
    lint::gate("chip", &text, "rac4i65").unwrap();
}

#[test]
fn registers_behind_the_pins_read_back() {
    let (text, ports) = chip();
    let mut session = Verilated::build("chip", &text, "rac4i65", &ports).unwrap().start().unwrap();
    let mut seed = 11;
    let mut reference: HashMap<u32, u32> = HashMap::new();
    for round in 0..300 {
        session.attach_bus(&BusConfig { gap: round % 3, ..BusConfig::default() }).unwrap();
        let (mut operations, mut expected) = (Vec::new(), Vec::new());
        for _ in 0..50 {
            let first = noise(&mut seed) % 4;
            let count = 1 + noise(&mut seed) % (4 - first);
            let address = first * 4;
            if noise(&mut seed) & 1 == 0 {
                let data: Vec<_> = (0..count).map(|_| noise(&mut seed)).collect();
                reference.extend((first..).zip(data.iter().copied()));
                operations.push(BusOperation::Write { address, data });
            } else {
                expected.extend((first..first + count).map(|word| reference.get(&word).copied().unwrap_or(0)));
                operations.push(BusOperation::Read { address, count });
            }
        }
        assert_eq!(session.bus(&operations).unwrap(), expected, "round {round}");
    }
    assert_eq!(session.get_port("led_n").unwrap(), 0, "overruns");
}

#[test]
fn latencies_through_the_pins_are_as_stated() {
    use fixed_kin::local_bus::{READ_CLOCKS, WRITE_CLOCKS};
    let (text, ports) = chip();
    let mut session = Verilated::build("chip", &text, "rac4i65", &ports).unwrap().start().unwrap();
    session.attach_bus(&BusConfig { gap: 0, ..BusConfig::default() }).unwrap();
    let mut clocks = |operation: BusOperation| {
        let start = session.clock();
        session.bus(&[operation]).unwrap();
        u32::try_from(session.clock() - start).unwrap()
    };
    // The clock of ADS# comes on top.
    assert_eq!(clocks(BusOperation::Read { address: 0, count: 1 }), 1 + READ_CLOCKS);
    assert_eq!(clocks(BusOperation::Read { address: 0, count: 24 }), 1 + 24 * READ_CLOCKS);
    let fastest = (0..8).map(|_| clocks(BusOperation::Write { address: 0, data: vec![1] })).min();
    assert_eq!(fastest, Some(1 + WRITE_CLOCKS));
}

#[test]
fn icarus_sees_the_same_on_the_tristate_bus() {
    let (text, ports) = chip();
    // ads_n, blast_n, lw_r, lad, lad.drive: a write of one word, idle, a read of it.
    let idle = [1, 1, 0, 0, 1];
    let mut stimulus = vec![idle; 4];
    stimulus.push([0, 1, 1, 8, 1]);
    stimulus.extend([[1, 0, 1, 0x1234_5678, 1]; 6]);
    stimulus.extend([idle; 2]);
    stimulus.push([0, 1, 0, 8, 1]);
    // Nobody drives the bus in the turn-around: Icarus would say Z, so the harness keeps driving there.
    stimulus.push([1, 0, 0, 0, 1]);
    stimulus.extend([[1, 0, 0, 0, 0]; 2]);
    let layout = Verilated::build("chip", &text, "rac4i65", &ports).unwrap().layout().clone();
    let names: Vec<_> = layout.inputs.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["ads_n", "blast_n", "lw_r", "lad", "lad.drive"]);
    let flat = stimulus.concat();
    let compiled = Verilated::build("chip", &text, "rac4i65", &ports).unwrap().run(&flat).unwrap();
    assert_eq!(icarus::run("chip", &text, "rac4i65", &ports, &flat).unwrap(), compiled);
    let lad = layout.output("lad").unwrap();
    let last = &compiled[compiled.len() - layout.outputs.len()..];
    assert_eq!(last[lad], 0x1234_5678);
}
