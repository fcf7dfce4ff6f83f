//! Hours of a match in minutes of patience: `racbot serve` with eleven against eleven, and with the built-in card, while two
//! teams command and somebody hostile sends what he likes. Writes `docs/measured/soak.md`.
//!
//! ```sh
//! cargo bench -p racbot --bench soak -- [SECONDS [SEED]]
//! ```

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Length, s, and seed where none is given.
const SECONDS: u64 = 600;
const SEED: u64 = 1;
/// Time between two commands of a team, as of vision.
const FRAME: Duration = Duration::from_micros(16_667);
/// Time between two bursts of hostile datagrams, and their number: above the rate that a sender is heard at.
const BURST: (Duration, usize) = (Duration::from_millis(10), 30);
/// Largest payload of a datagram, bytes.
const LARGEST: usize = 65_507;

/// A server and its three ports.
struct Server {
    child: Child,
    ports: Vec<u16>,
    errors: std::thread::JoinHandle<Vec<String>>,
}

impl Server {
    fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_racbot"))
            .args(["--json", "serve", "--ports", "0,0,0"])
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("racbot starts");
        let mut errors = BufReader::new(child.stderr.take().expect("its errors")).lines().map_while(Result::ok);
        let line = errors.by_ref().find(|line| line.starts_with("serving: ")).expect("it serves");
        let errors = std::thread::spawn(move || errors.collect());
        let ports = line.split([',', ';']).filter_map(|part| part.rsplit_once("127.0.0.1:")?.1.parse().ok()).take(3);
        Self { child, ports: ports.collect(), errors }
    }

    /// What it said at its end, and its error if it ended with one.
    fn end(mut self) -> (Value, Option<String>) {
        let out = self.child.stdout.take().expect("its answer");
        let said = serde_json::from_reader(out).expect("an answer in JSON");
        let good = self.child.wait().expect("it ends").success();
        let errors = self.errors.join().expect("its errors");
        (said, (!good).then(|| errors.last().cloned().unwrap_or_default()))
    }
}

/// What went to and fro, together.
#[derive(Default)]
struct Counts {
    commands: AtomicU64,
    answers: AtomicU64,
    hostile: AtomicU64,
}

/// `RobotControl` with local velocities of so many robots, as bytes: each on a wave of its own, so that they meet.
fn control(robots: u8, t: f32) -> Vec<u8> {
    let mut bytes = Vec::new();
    for id in 0..robots {
        let phase = t + f32::from(id);
        bytes.extend([0x0a, 0x15, 0x08, id, 0x12, 0x11, 0x12, 0x0f]);
        let velocity = [0.6 * (0.4 * phase).sin(), 0.4 * (0.7 * phase).cos(), 1.5 * (0.2 * phase).sin()];
        for (tag, value) in [0x0d_u8, 0x15, 0x1d].into_iter().zip(velocity) {
            bytes.push(tag);
            bytes.extend(value.to_le_bytes());
        }
    }
    bytes
}

/// A team that commands at the rate of vision and reads the answers.
fn team(port: u16, robots: u8, stop: &AtomicBool, counts: &Counts) {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    socket.set_nonblocking(true).expect("a socket");
    let begun = Instant::now();
    let mut answer = vec![0; LARGEST];
    while !stop.load(Ordering::Relaxed) {
        if socket.send_to(&control(robots, begun.elapsed().as_secs_f32()), ("127.0.0.1", port)).is_ok() {
            counts.commands.fetch_add(1, Ordering::Relaxed);
        }
        std::thread::sleep(FRAME);
        while socket.recv(&mut answer).is_ok() {
            counts.answers.fetch_add(1, Ordering::Relaxed);
        }
    }
}

/// Noise, huge datagrams, and messages with some bytes changed or cut off, to every port.
fn hostile(ports: &[u16], seed: u64, stop: &AtomicBool, counts: &Counts) {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    while !stop.load(Ordering::Relaxed) {
        for _ in 0..BURST.1 {
            let mut datagram = match random.random_range(0..20) {
                0 => vec![0x0a; LARGEST],
                1..8 => vec![0; random.random_range(0..300)],
                _ => control(16, random.random()),
            };
            if datagram.len() < 1_000 && random.random() {
                random.fill_bytes(&mut datagram);
            }
            for _ in 0..random.random_range(0..4) {
                if let Some(byte) = random.random_range(0..datagram.len().max(1)).checked_sub(1) {
                    datagram[byte] = random.random();
                }
            }
            datagram.truncate(random.random_range(0..=datagram.len().max(1) * 2));
            // Not the control port's: a teleport is no fault, and would hide one.
            let port = ports[random.random_range(1..ports.len())];
            if socket.send_to(&datagram, ("127.0.0.1", port)).is_ok() {
                counts.hostile.fetch_add(1, Ordering::Relaxed);
            }
        }
        std::thread::sleep(BURST.0);
    }
}

/// Runs a server for so long; the row of the table. A card whose watchdog switched off is started again, and that is
/// counted: where the host comes too late, it has to.
fn soak(name: &str, seconds: u64, seed: u64, arguments: &[&str], robots: u8) -> Vec<String> {
    let counts = Counts::default();
    let (mut ticks, mut lost, mut refused, mut latest, mut faults) = (0, 0, 0, None, Vec::new());
    let begun = Instant::now();
    let end = begun + Duration::from_secs(seconds);
    while Instant::now() < end {
        let server = Server::start(arguments);
        let process = server.child.id().to_string();
        let stop = AtomicBool::new(false);
        let ports = server.ports.clone();
        let (said, wrong) = std::thread::scope(|scope| {
            for port in &ports[1..] {
                scope.spawn(|| team(*port, robots, &stop, &counts));
            }
            scope.spawn(|| hostile(&ports, seed, &stop, &counts));
            // By the time of the wall: a field that loses time takes longer for its own.
            scope.spawn(|| {
                while !stop.load(Ordering::Relaxed) {
                    if Instant::now() >= end {
                        let _ = Command::new("kill").args(["-INT", &process]).status();
                    }
                    std::thread::sleep(Duration::from_millis(500));
                }
            });
            let ended = server.end();
            stop.store(true, Ordering::Relaxed);
            ended
        });
        let number = |keys: &[&str]| keys.iter().find_map(|key| said[*key].as_u64()).expect("a number");
        // The card's answer has how many ticks were not seen, the field's how many steps were left out.
        ticks += number(&["steps", "ticks"]);
        lost += number(&["lost", "unseen"]);
        refused += number(&["refused"]);
        latest = said["latest_s"].as_f64().or(latest);
        if let Some(wrong) = wrong {
            println!("{name}: {wrong}");
            assert!(wrong.contains("watchdog"), "no matter of time: {wrong}");
            faults.push(wrong);
        }
    }
    let count = |of: &AtomicU64| of.load(Ordering::Relaxed).to_string();
    vec![
        name.to_owned(),
        format!("{:.1}", begun.elapsed().as_secs_f64() / 60.0),
        ticks.to_string(),
        lost.to_string(),
        latest.map_or("-".to_owned(), |late| format!("{:.0}", 1e3 * late)),
        faults.len().to_string(),
        count(&counts.commands),
        count(&counts.answers),
        count(&counts.hostile),
        refused.to_string(),
    ]
}

fn main() {
    let numbers: Vec<u64> = std::env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let (seconds, seed) = (numbers.first().copied().unwrap_or(SECONDS), numbers.get(1).copied().unwrap_or(SEED));
    let rows = std::thread::scope(|scope| {
        let card = scope.spawn(move || soak("the built-in card", seconds, seed, &["--card", "virtual"], 1));
        let match_ = ["--blue", "11", "--yellow", "11", "--field", "a", "--vision", "none"];
        let field = soak("11 + 11 robots", seconds, seed + 1, &match_, 11);
        vec![field, card.join().expect("a row")]
    });
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').nth(1).unwrap_or("unknown").to_owned();
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    let title = format!(
        "`racbot serve` beside hostile datagrams, in real time: {cores} cores, load average {load} with other programs"
    );
    measured::Table {
        name: "soak",
        title: &title,
        command: "cargo bench -p racbot --bench soak",
        columns: &[
            "what",
            "minutes",
            "ticks",
            "lost",
            "latest, ms",
            "watchdog",
            "commands",
            "answered",
            "hostile datagrams",
            "refused by rate",
        ],
    }
    .write(&rows);
    for row in rows {
        println!("{}", row.join("  "));
    }
}
