//! What a simulated robot costs: processor time of the field's thread, with sockets, all robots driving and both teams
//! commanding 60 times a second. `cargo bench -p ssl` writes `docs/measured/serve.md`.

use driver::realtime::Clock;
use measured::Table;
use prost::Message;
use runs::robot::Robot;
use rustix::time::{ClockId, clock_gettime};
use ssl::field::Field;
use ssl::front::Team;
use ssl::messages::{MoveCommand, MoveLocalVelocity, RobotCommand, RobotControl, RobotMoveCommand};
use ssl::robot::Kind;
use ssl::server::{Addresses, Sockets, run};
use ssl::world::{Options, World};
use std::net::{Ipv4Addr, UdpSocket};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Simulated time of each row, s.
const SECONDS: u64 = 20;

/// Processor time of this thread, s.
fn spent() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// Time that passes when somebody sleeps; both teams send as it goes.
struct Teams {
    now: Duration,
    socket: UdpSocket,
    ports: [std::net::SocketAddr; 2],
    message: Vec<u8>,
}

impl Clock for Teams {
    fn now(&mut self) -> Duration {
        self.now
    }

    fn sleep_until(&mut self, at: Duration) {
        self.now = self.now.max(at);
        if self.now.as_millis().is_multiple_of(16) {
            for port in self.ports {
                let _ = self.socket.send_to(&self.message, port);
            }
            let mut answer = [0; 2_048];
            while self.socket.recv(&mut answer).is_ok() {}
        }
    }
}

/// Processor time for a second of so many robots a team, and steps lost. Teams that drive straight ahead run into each
/// other and push.
fn measure(robots: u32, velocity: MoveLocalVelocity) -> (f64, u64) {
    let kind = Kind::of(&Robot::racbot());
    let team = |team| (0..robots).map(move |id| (team, id));
    let options = Options {
        field: Field::A,
        robots: team(Team::Blue).chain(team(Team::Yellow)).map(|(team, id)| (team, id, kind.clone())).collect(),
        newcomer: kind.clone(),
        vision_hz: 60.0,
        epoch_s: 0.0,
        seed: 1,
    };
    let mut world = World::new(options).expect("robots fit the card");
    let eyes = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let addresses = Addresses {
        control: 0,
        blue: 0,
        yellow: 0,
        vision: vec![eyes.local_addr().expect("an address")],
        ..Addresses::default()
    };
    let mut sockets = Sockets::open(&addresses).expect("free ports");
    let [_, blue, yellow] = sockets.local().expect("addresses");
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    socket.set_nonblocking(true).expect("a socket");
    let command = |id| RobotCommand {
        id,
        move_command: Some(RobotMoveCommand { command: Some(MoveCommand::LocalVelocity(velocity)) }),
        ..RobotCommand::default()
    };
    let message = RobotControl { robot_commands: (0..robots).map(command).collect() }.encode_to_vec();
    let mut clock = Teams { now: Duration::ZERO, socket, ports: [blue, yellow], message };
    let before = spent();
    let limit = Some(Duration::from_secs(SECONDS));
    let served = run(&mut world, &mut sockets, &mut clock, &AtomicBool::new(false), limit, |_| {});
    ((spent() - before) / SECONDS as f64, served.lost)
}

fn main() {
    let turning = MoveLocalVelocity { forward: 0.3, left: 0.1, angular: 1.0 };
    let ahead = MoveLocalVelocity { forward: 0.5, left: 0.0, angular: 0.0 };
    let rows: Vec<Vec<String>> = [(1, turning, ""), (6, turning, ""), (11, turning, ""), (11, ahead, ", head-on")]
        .into_iter()
        .map(|(robots, velocity, how)| {
            let (cost, lost) = measure(robots, velocity);
            let each = 1e6 * cost / 1e3 / f64::from(2 * robots);
            let name = format!("{robots} + {robots}{how}");
            vec![name, format!("{:.1}", 100.0 * cost), format!("{each:.1}"), lost.to_string()]
        })
        .collect();
    Table {
        name: "serve",
        title: "A simulated field: processor time of its thread",
        command: "cargo bench -p ssl",
        columns: &["robots", "share of a core, %", "a robot and millisecond, µs", "steps lost"],
    }
    .write(&rows);
    for row in rows {
        println!("{}", row.join("  "));
    }
}
