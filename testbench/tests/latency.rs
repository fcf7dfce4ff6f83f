//! From an encoder sample to the PWM, in clocks, and what a control tick costs on the bus.

use driver::{Board, BusError, Registers, Scale, Settings};
use fixed_kin::AXES;
use fixed_kin::control::SetPointMode;
use fixed_kin::registers as map;
use fixed_kin::speed::SpeedMode;
use hdl::design::COMMITTED_VERILOG;
use hdl::emit::ports::Ports;
use measured::Table;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use runs::frames::Twist;
use runs::robot::Robot;
use simulator::cosim::{Change, Session, Verilated};
use simulator::fpga::edges::lines;

const CORE: &str = "rac4i65_core";
const PERIOD: u32 = map::MIN_TICK_PERIOD;
const TICKS: u32 = 1_000;

/// The core behind its bus, words counted.
struct Chip {
    session: Session,
    words: [usize; 2],
}

impl Registers for Chip {
    fn read(&mut self, offset: u16) -> Result<u32, BusError> {
        self.words[0] += 1;
        self.session.bus_read(offset.into()).map_err(|error| BusError::read(offset, error))
    }
    fn write(&mut self, offset: u16, data: u32) -> Result<(), BusError> {
        self.words[1] += 1;
        self.session.bus_write(offset.into(), data).map_err(|error| BusError::write(offset, error))
    }
    fn read_block(&mut self, offset: u16, words: &mut [u32]) -> Result<(), BusError> {
        self.words[0] += words.len();
        let read = self.session.bus_burst_read(offset.into(), words.len() as u32);
        words.copy_from_slice(&read.map_err(|error| BusError::read(offset, error))?);
        Ok(())
    }
}

/// The committed core with two more outputs: the tick that samples the encoders, and the strobes that
/// hand a duty to the PWM of an axis.
fn watched() -> String {
    let head = format!("module {CORE} (\n");
    let begin = COMMITTED_VERILOG.find(&head).expect("the core") + head.len();
    let end = begin + COMMITTED_VERILOG[begin..].find("endmodule").expect("its end");
    let ports = "    output wire seen_tick,\n    output wire [3:0] seen_load,\n";
    let loads: Vec<_> = (0..AXES).rev().map(|axis| format!("drives_{axis}_load")).collect();
    let wires = format!("    assign seen_tick = tick;\n    assign seen_load = {{{}}};\n", loads.join(", "));
    let (before, rest) = COMMITTED_VERILOG.split_at(begin);
    let (body, after) = rest.split_at(end - begin);
    [before, ports, body, &wires, after].concat()
}

#[test]
fn a_duty_follows_its_encoder_sample_within_a_tick() {
    let text = watched();
    let ports = Ports::parse(&text, CORE, &["lclk", "synclk"]).unwrap();
    let mut session =
        Verilated::build("latency", &text, CORE, &ports).unwrap_or_else(|error| panic!("{error}")).start().unwrap();
    session.set_port("emergency_stop", 0).unwrap();
    session.set_port("host_select", 1).unwrap();
    let (a, b) = (session.layout().input("encoder_a").unwrap(), session.layout().input("encoder_b").unwrap());
    let (tick, load) = (session.layout().output("seen_tick").unwrap(), session.layout().output("seen_load").unwrap());

    let mut robot = Robot::racbot();
    robot.control_rate_hz = 33_333_333.0 / f64::from(PERIOD);
    let scale = Scale::new(&robot, 33_333_333.0).unwrap();
    let settings =
        Settings { speed_mode: SpeedMode::CountAndTime, set_point_mode: SetPointMode::Twist, ..Settings::default() };
    let mut board = Board::new(Chip { session, words: [0; 2] });
    board.configure(&scale, &settings).unwrap();
    board.bus.session.run(2 * u64::from(PERIOD)).unwrap();
    board.arm().unwrap();

    board.bus.session.record(&[tick, load]).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(12);
    let mut position = 0_i64;
    let mut most_words = [0; 2];
    for _ in 0..TICKS {
        let start = board.bus.session.clock();
        let mut changes = Vec::new();
        let mut clock = start;
        while clock < start + u64::from(PERIOD) {
            clock += random.random_range(10..200);
            position += if random.random_range(0..10) == 0 { -1 } else { 1 };
            let level = lines(position);
            let all = |bit: u32| (level >> bit & 1) * 0xF;
            changes.extend([(a, all(0)), (b, all(1))].map(|(port, value)| Change { clock, port, value }));
        }
        board.bus.session.schedule(&changes).unwrap();
        board.bus.words = [0; 2];
        let mut pick = |limit: f64| random.random_range(-limit..limit);
        board.set_twist(&scale, Twist { vx: pick(2.0), vy: pick(2.0), omega: pick(8.0) }).unwrap();
        let mut words = [0; map::SNAPSHOT_WORDS];
        board.bus.read_block(map::SNAPSHOT_SEQUENCE.offset, &mut words).unwrap();
        most_words = std::array::from_fn(|way| most_words[way].max(board.bus.words[way]));
        let rest = (start + u64::from(PERIOD)).saturating_sub(board.bus.session.clock());
        board.bus.session.run(rest).unwrap();
    }

    let (mut sampled, mut least, mut most, mut updates) = (None, [u64::MAX; AXES], [0; AXES], [0; AXES]);
    for change in board.bus.session.take_recorded().unwrap() {
        if change.port == tick && change.value == 1 {
            sampled = Some(change.clock);
        } else if change.port == load
            && let Some(sampled) = sampled
        {
            for axis in (0..AXES).filter(|axis| change.value >> axis & 1 == 1) {
                let clocks = change.clock - sampled;
                (least[axis], most[axis]) = (least[axis].min(clocks), most[axis].max(clocks));
                updates[axis] += 1;
            }
        }
    }
    let period = board.bus.read(map::PWM_PERIOD.offset).unwrap();
    let table = Table {
        name: "latency",
        title: "From an encoder sample to the duty, and bus words, on the emitted Verilog",
        command: "cargo test --release -p testbench --test latency",
        columns: &["what", "least", "most"],
    };
    let row = |what: String, least: u64, most: u64| vec![what, least.to_string(), most.to_string()];
    let mut rows: Vec<_> = (0..AXES)
        .map(|axis| row(format!("sample to duty, axis {}, clocks", axis + 1), least[axis], most[axis]))
        .collect();
    rows.push(row("then until the pin follows, clocks".to_owned(), 0, u64::from(period)));
    rows.push(row("bus words read a tick".to_owned(), 0, most_words[0] as u64));
    rows.push(row("bus words written a tick".to_owned(), 0, most_words[1] as u64));
    table.check(&rows);
    assert!(updates.iter().all(|updates| *updates + 5 > TICKS), "{updates:?}");
    assert!(most.iter().all(|clocks| *clocks < u64::from(PERIOD)), "{most:?}");
    assert!(most_words[0] <= 24 && most_words[1] <= 8, "{most_words:?}");
}
