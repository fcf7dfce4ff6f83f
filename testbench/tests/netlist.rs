//! Gate level: the netlist for the real family against fixed-kin, and pin by pin against the
//! Verilog that it was made from.

use fixed_kin::speed::SpeedMode;
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::Twist;
use simulator::closed_loop::Drive;
use simulator::cosim::Verilated;
use simulator::cross_check::{Traced, play};
use simulator::fpga::{BitTrue, QUIET_CLOCKS, Verilog};
use testbench::netlist::{BLOCK_MEMORY, Netlist, block_memory};
use testbench::pin_stimulus::{Stimulus, assert_lively};

/// Control ticks of the chip at 8 kHz.
const TICKS: usize = 400;
/// Clocks of the comparison of all pins, from power-up.
const CLOCKS: usize = 1_000_000;

fn chip() -> Netlist {
    Netlist::of(COMMITTED_VERILOG, NAME).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_netlist_equals_fixed_kin() {
    let mut drive = Drive { speed_mode: SpeedMode::CountAndTime, limit_s: TICKS as f64 / 8_000.0, ..Drive::fig_6() };
    drive.moving = Twist::new(0.6, 0.5, 0.5);
    drive.believed.control_rate_hz = 8_000.0;
    let mut traced = Traced::new(BitTrue::new().with_quiet_clocks(QUIET_CLOCKS));
    drive.run(&mut traced, |_| {}).unwrap();
    let trace = traced.into_trace();
    let netlist = Verilog::of("rac4i65-netlist", &chip().verilog).unwrap_or_else(|error| panic!("{error}"));
    let check = play(&trace, netlist, |_| {}).unwrap();
    assert_eq!(check.difference, None);
    assert!(check.ticks >= TICKS && check.live_words > 10 * TICKS, "{check:?}");
    println!("netlist: {} ticks, {} clocks, {} words, 0 differ", check.ticks, check.clocks, check.words);
}

#[test]
fn every_pin_of_the_netlist_equals_the_verilog_at_every_clock() {
    let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"]).unwrap();
    let build =
        |name: &str, text: &str| Verilated::build(name, text, NAME, &ports).unwrap_or_else(|error| panic!("{error}"));
    let verilog = build(NAME, COMMITTED_VERILOG);
    let stimulus = Stimulus::whole(verilog.layout(), CLOCKS);
    let netlist = chip();
    // A cell without a start value is one thing here and another on the device.
    assert!(
        !netlist.verilog.contains("INIT(1'hx)") && !netlist.verilog.contains("INIT(1'bx)"),
        "undefined start values"
    );
    let expected = verilog.run(stimulus.rows()).unwrap();
    let got = build("rac4i65-netlist", &netlist.verilog).run(stimulus.rows()).unwrap();
    let outputs = verilog.layout().outputs.len();
    for (clock, (got, expected)) in got.chunks(outputs).zip(expected.chunks(outputs)).enumerate() {
        let pairs = verilog.layout().outputs.iter().zip(got.iter().zip(expected));
        let wrong: Vec<_> = pairs.filter(|(_, (got, expected))| got != expected).collect();
        assert!(wrong.is_empty(), "clock {clock}: {wrong:x?}");
    }
    assert_lively(verilog.layout(), &expected);
    println!("netlist: {} clocks, all pins, 0 differ", expected.len() / outputs);
}

#[test]
fn a_wrong_lookup_table_is_seen() {
    let block = "rac4i65_core_sequencer_multiplier";
    let netlist = Netlist::of(COMMITTED_VERILOG, block).unwrap_or_else(|error| panic!("{error}"));
    let table = ".INIT(16'h";
    let at = netlist.verilog.match_indices(table).nth(20).expect("a lookup table").0 + table.len();
    let mut broken = netlist.verilog.clone();
    let word = u16::from_str_radix(&broken[at..at + 4], 16).expect("hexadecimal");
    broken.replace_range(at..at + 4, &format!("{:04x}", !word));
    let ports = Ports::parse(COMMITTED_VERILOG, block, &["clock"]).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let rows: Vec<u32> = (0..20_000)
        .flat_map(|step| {
            [u32::from(step % 20 == 0), random.random_range(0..4), random.next_u32() >> 3, random.next_u32() >> 3]
        })
        .collect();
    assert_eq!(ports.inputs().map(|p| p.name.clone()).collect::<Vec<_>>(), ["start", "scale", "a", "b"]);
    let run = |name: &str, text: &str| Verilated::build(name, text, block, &ports).unwrap().run(&rows).unwrap();
    let expected = run("multiplier", COMMITTED_VERILOG);
    assert!(run("multiplier-netlist", &netlist.verilog) == expected, "the netlist differs");
    assert!(run("multiplier-broken", &broken) != expected, "an inverted table is not seen");
}

/// The memory as bits, with what its two ports show.
struct Memory {
    bits: Vec<bool>,
    widths: [u32; 2],
    shown: [u32; 2],
}

/// Enable, reset, write, address, data of a port.
type Access = [u32; 5];

impl Memory {
    fn clock(&mut self, ports: [Access; 2]) {
        let before = self.bits.clone();
        let place = |port: usize| {
            let (width, [_, _, _, address, _]) = (self.widths[port], ports[port]);
            (address * width) as usize..((address + 1) * width) as usize
        };
        for port in 0..2 {
            let [enable, reset, write, _, data] = ports[port];
            if enable == 0 {
                continue;
            }
            let ([other_enable, _, other_write, ..], mine, other) = (ports[1 - port], place(port), place(1 - port));
            let meets = other_enable & other_write == 1 && mine.start < other.end && other.start < mine.end;
            let word = mine.clone().rev().fold(0, |word, bit| word << 1 | u32::from(before[bit] != meets));
            self.shown[port] = match (reset, write) {
                (1, _) => 0,
                (_, 1) => data,
                _ => word,
            };
            if write == 1 {
                for (n, bit) in mine.enumerate() {
                    self.bits[bit] = data >> n & 1 == 1;
                }
            }
        }
    }
}

/// A memory with ports of these widths (one or two) against the list of bits.
fn memory_is_right(widths: &[u32]) {
    let names = if widths.len() == 1 { &[""][..] } else { &["A", "B"] };
    let cell = format!("RAMB4{}", widths.iter().map(|width| format!("_S{width}")).collect::<String>());
    let bits: Vec<bool> = (0..4096_u32).map(|bit| (bit.wrapping_mul(2_654_435_761) >> 13) & 1 == 1).collect();
    let row = |row: &[bool]| row.chunks(4).rev().map(|b| (0..4).map(|n| u32::from(b[n]) << n).sum::<u32>()).collect();
    let rows: Vec<Vec<u32>> = bits.chunks(256).map(row).collect();
    let initial: Vec<String> = rows
        .iter()
        .enumerate()
        .map(|(n, row)| format!(".INIT_0{n:X}(256'h{})", row.iter().map(|d| format!("{d:x}")).collect::<String>()))
        .collect();
    let (mut header, mut pins) = (Vec::new(), Vec::new());
    for (p, width) in names.iter().zip(widths) {
        let (word, line) = (width - 1, 11 - width.ilog2());
        header.push(format!(
            "input wire en{p}, input wire rst{p}, input wire we{p}, input wire [{line}:0] addr{p}, \
             input wire [{word}:0] di{p}, output wire [{word}:0] q{p}"
        ));
        pins.push(format!(
            ".EN{p}(en{p}), .RST{p}(rst{p}), .WE{p}(we{p}), .ADDR{p}(addr{p}), .DI{p}(di{p}), .DO{p}(q{p}), .CLK{p}(clock)"
        ));
    }
    let text = format!(
        "module memory (\n    input wire clock, {}\n);\n{cell} #({}) cell ({});\nendmodule\n{BLOCK_MEMORY}{}",
        header.join(",\n    "),
        initial.join(", "),
        pins.join(", "),
        block_memory(&cell).expect("a block memory")
    )
    .replace(" cell (", " inside_it (");
    let ports = Ports::parse(&text, "memory", &["clock"]).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut memory = Memory { bits, widths: [widths[0], *widths.last().unwrap()], shown: [0; 2] };
    let (mut rows, mut expected, mut collisions) = (Vec::new(), Vec::<u32>::new(), 0);
    for _ in 0..20_000 {
        let mut port = |width: u32| -> Access {
            let often = u32::from(random.random_range(0..4) != 0);
            let (reset, write) = (u32::from(random.random_range(0..8) == 0), random.random_range(0..2));
            [often, reset, write, random.random_range(0..4096 / width), random.random_range(0..1 << width)]
        };
        let (a, mut b) = (port(memory.widths[0]), port(memory.widths[1]));
        if widths.len() == 1 {
            b = [0; 5];
        } else if random.random_range(0..4) == 0 {
            b[3] = a[3] * memory.widths[0] / memory.widths[1];
        }
        let overlap = (a[3] * memory.widths[0]).abs_diff(b[3] * memory.widths[1]) < 16;
        // Two writes to one word at a time leave it undefined; no netlist of ours has two writing ports.
        b[2] &= u32::from(a[2] == 0 || !overlap);
        collisions += usize::from(a[0] & b[0] == 1 && overlap && a[2] != b[2]);
        let used = widths.len();
        rows.extend([a, b].into_iter().take(used).flatten());
        memory.clock([a, b]);
        expected.extend(&memory.shown[..used]);
    }
    assert!(collisions > 500 || widths.len() == 1, "{collisions}");
    let built = Verilated::build("block-memory", &text, "memory", &ports).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(built.run(&rows).unwrap(), expected, "{cell}");
}

#[test]
fn the_model_of_the_block_memory_is_that_of_the_data_sheet() {
    memory_is_right(&[16]);
    memory_is_right(&[8]);
    memory_is_right(&[16, 16]);
    memory_is_right(&[2, 8]);
}
