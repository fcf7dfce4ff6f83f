//! How fast the virtual robot and the chip's simulators are, as ratios of one run: writes `docs/measured/speeds.md`.
//! `cargo bench -p simulator --bench speeds`; half a minute.
//!
//! `… -- --against BENCH COMMIT` measures the loops against an older build of this bench, in turns, and writes
//! `docs/measured/speedup.md`. The older build is asked with `--loops`: one round, one line each. Both count the
//! processor time of the loop's thread, so that other work on the machine does not matter.
//!
//! Rounds of all measurements follow each other, and the best of each counts, so that a machine that is busy for a
//! while slows all of them alike.

use driver::{Board, Registers, Scale, Settings};
use fixed_kin::card::{Card, Pins};
use hdl::design::{COMMITTED_VERILOG, NAME};
use hdl::emit::ports::Ports;
use hdl::sim::cycle;
use model::plant::Plant;
use runs::frames::{Pose, Twist};
use runs::robot::Robot;
use rustix::time::{ClockId, clock_gettime};
use simulator::closed_loop::{Drive, VirtualRobot, whole_tick_clock_hz};
use simulator::cosim::{Verilated, icarus};
use simulator::fpga::BitTrue;
use std::hint::black_box;
use std::process::Command;
use std::time::{Duration, Instant};

const ROUNDS: usize = 7;
/// Control ticks a round; at 1 kHz, ten seconds of the robot's life.
const TICKS: usize = 10_000;
/// A host sends a new command every 20 ms.
const COMMAND_EVERY: usize = 20;

const TABLE: measured::Table<'_> = measured::Table {
    name: "speeds",
    title: "Speeds of one run on one core",
    command: "cargo bench -p simulator --bench speeds",
    columns: &["what", "a second", "of", "ratio"],
};

/// One thing that is timed: what a round does, and how many of what that is.
struct Measured<'a> {
    name: &'static str,
    of: &'static str,
    amount: f64,
    round: Box<dyn FnMut() + 'a>,
    best: Duration,
}

impl<'a> Measured<'a> {
    fn new(name: &'static str, of: &'static str, amount: usize, round: impl FnMut() + 'a) -> Self {
        Self { name, of, amount: amount as f64, round: Box::new(round), best: Duration::MAX }
    }

    fn rate(&self) -> f64 {
        self.amount / self.best.as_secs_f64()
    }
}

fn scale() -> Scale {
    let robot = Robot::racbot();
    Scale::new(&robot, whole_tick_clock_hz(robot.control_rate_hz)).expect("the built-in robot fits")
}

/// A card with its registers and safety, driven as by the driver.
fn armed<R: Registers>(bus: R, first: impl FnOnce(&mut R)) -> Board<R> {
    let mut board = Board::new(bus);
    board.configure(&scale(), &Settings::default()).expect("configures");
    first(&mut board.bus);
    board.arm().expect("arms");
    board
}

fn card() -> Measured<'static> {
    let scale = scale();
    let mut board = armed(Card::new(0), |card| {
        card.tick(&Pins::default());
    });
    let mut pins = Pins::default();
    Measured::new("bit-true card, control ticks of four axes", "ticks", TICKS, move || {
        for tick in 0..TICKS {
            if tick % COMMAND_EVERY == 0 {
                board.set_twist(&scale, Twist::new(0.5, 1.0, 2.0)).expect("commits");
            }
            for encoder in &mut pins.encoders {
                encoder.count = encoder.count.wrapping_add(20);
            }
            black_box(board.bus.tick(&pins));
        }
    })
}

fn closed_loop() -> Measured<'static> {
    let (robot, scale) = (Robot::racbot(), scale());
    Measured::new("closed loop: driver, registers, card, motors, body, encoders", "ticks", TICKS, move || {
        let plant = Plant::new(&robot).expect("drives").at(Pose::default());
        let virtual_robot =
            VirtualRobot::new(BitTrue::new(), plant, robot.supply_v, Duration::from_secs_f64(scale.tick_s()));
        let mut board = armed(virtual_robot.clone(), |_| virtual_robot.tick().expect("ticks"));
        for _ in 0..TICKS {
            board.set_twist(&scale, Twist::new(0.4, 0.6, 1.0)).expect("commits");
            virtual_robot.tick().expect("ticks");
            black_box(board.snapshot().expect("answers"));
        }
    })
}

fn drive() -> Measured<'static> {
    let drive = Drive { limit_s: TICKS as f64 * 1e-3, ..Drive::fig_6() };
    Measured::new("the same with controller, odometry, camera and log", "ticks", TICKS, move || {
        black_box(drive.run(BitTrue::new(), |_| {}).expect("drives"));
    })
}

fn verilator() -> Option<Measured<'static>> {
    const CLOCKS: u64 = 1_000_000;
    let ports = Ports::parse(COMMITTED_VERILOG, NAME, &["lclk", "synclk"]).expect("the committed chip");
    let built = Verilated::build(NAME, COMMITTED_VERILOG, NAME, &ports).and_then(|built| built.start());
    let mut session = built.inspect_err(|error| eprintln!("verilator not measured: {error}")).ok()?;
    Some(Measured::new("whole chip, emitted Verilog in Verilator", "clocks", CLOCKS as usize, move || {
        session.run(CLOCKS).expect("runs");
    }))
}

fn rust_hdl() -> Measured<'static> {
    const CLOCKS: usize = 5_000;
    let mut core = Box::new(hdl::design::core());
    core.ads_n.next = true;
    core.blast_n.next = true;
    Measured::new("the core in rust-hdl's simulation", "clocks", CLOCKS, move || {
        for _ in 0..CLOCKS {
            cycle(&mut *core, |core, level| {
                core.lclk.next = level.into();
                core.synclk.next = level.into();
            });
        }
    })
}

fn icarus() -> Option<Measured<'static>> {
    const CLOCKS: usize = 20_000;
    let core = hdl::emit::verilog::emit(&hdl::design::core(), "chip");
    let ports = Ports::parse(&core, "chip", &["lclk", "synclk"]).expect("the core");
    let stimulus: Vec<u32> =
        (0..CLOCKS).flat_map(|_| ports.inputs().map(|port| u32::from(port.name.ends_with("_n")))).collect();
    icarus::run("chip", &core, "chip", &ports, &stimulus)
        .inspect_err(|error| eprintln!("icarus not measured: {error}"))
        .ok()?;
    Some(Measured::new("the core in Icarus, its compilation included", "clocks", CLOCKS, move || {
        black_box(icarus::run("chip", &core, "chip", &ports, &stimulus).expect("runs"));
    }))
}

/// What a rate is compared with: ticks with real time at 1 kHz, clocks with rust-hdl's simulation.
fn ratio(measured: &Measured<'_>, rust_hdl: f64) -> String {
    match measured.of {
        "ticks" => format!("{:.0} × real time at 1 kHz", measured.rate() / 1e3),
        _ => format!("{:.2} × rust-hdl", measured.rate() / rust_hdl),
    }
}

/// Rounds in turns; a child process has to warm up each time.
const TURNS: usize = 40;

fn time(all: &mut [Measured<'_>]) {
    for measured in all {
        let begin = Instant::now();
        (measured.round)();
        measured.best = measured.best.min(begin.elapsed());
    }
}

/// Processor time of this thread.
fn processor_time() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec.try_into().expect("nanoseconds"))
}

fn time_loops(loops: &mut [Measured<'_>]) {
    for measured in loops {
        let begin = processor_time();
        (measured.round)();
        measured.best = measured.best.min(processor_time() - begin);
    }
}

/// One round each, after one to warm up; a line with the name and the ticks a second.
fn print_loops() {
    let mut loops = [card(), closed_loop(), drive()];
    time_loops(&mut loops);
    loops.iter_mut().for_each(|measured| measured.best = Duration::MAX);
    time_loops(&mut loops);
    for measured in &loops {
        println!("{}\t{}", measured.name, measured.rate());
    }
}

/// Writes the speeds against an older build of this bench.
fn against(older: &str, commit: &str) {
    let mut loops = [card(), closed_loop(), drive()];
    // Seconds of all turns, then and now: sums, so that a coarse clock does not matter.
    let mut times = [[0.0_f64; 2]; 3];
    time_loops(&mut loops);
    for _ in 0..TURNS {
        let output = Command::new(older).arg("--loops").output().expect("an older build of this bench");
        let text = String::from_utf8(output.stdout).expect("text");
        for ((measured, time), line) in loops.iter().zip(&mut times).zip(text.lines()) {
            let (name, rate) = line.split_once('\t').expect("name and rate");
            assert_eq!(name, measured.name);
            time[0] += measured.amount / rate.parse::<f64>().expect("a rate");
        }
        for (measured, time) in loops.iter_mut().zip(&mut times) {
            measured.best = Duration::MAX;
            time_loops(std::slice::from_mut(measured));
            time[1] += measured.best.as_secs_f64();
        }
    }
    let row = |(measured, [then, now]): (&Measured<'_>, [f64; 2])| {
        let rate = |time: f64| format!("{:.2e}", measured.amount * TURNS as f64 / time);
        vec![measured.name.to_owned(), rate(then), rate(now), format!("{:.2}", then / now)]
    };
    let rows: Vec<_> = loops.iter().zip(times).map(row).collect();
    rows.iter().for_each(|row| println!("{}", row.join(" | ")));
    let table = measured::Table {
        name: "speedup",
        title: &format!(
            "The loops of today and of commit {commit}, in turns in one run, by processor time of their thread"
        ),
        command: "cargo bench -p simulator --bench speeds -- --against BENCH COMMIT",
        columns: &["what", "then, ticks a second", "now", "ratio"],
    };
    table.write(&rows);
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if arguments.iter().any(|a| a == "--loops") {
        return print_loops();
    }
    if let Some(at) = arguments.iter().position(|a| a == "--against") {
        let next = |n| arguments.get(at + n).expect("--against needs the path of an older build, and its commit");
        return against(next(1), next(2));
    }
    let mut all = vec![card(), closed_loop(), drive(), rust_hdl()];
    all.extend(verilator());
    all.extend(icarus());
    for _ in 0..ROUNDS {
        time(&mut all);
    }
    let rust_hdl = all.iter().find(|m| m.name.contains("rust-hdl")).map_or(f64::NAN, Measured::rate);
    let rows: Vec<Vec<String>> = all
        .iter()
        .map(|m| vec![m.name.to_owned(), format!("{:.2e}", m.rate()), m.of.to_owned(), ratio(m, rust_hdl)])
        .collect();
    for row in &rows {
        println!("{}", row.join(" | "));
    }
    TABLE.write(&rows);
}
