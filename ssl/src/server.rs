//! Sockets and a clock around it.

use crate::front::{self, Robots, Team};
use crate::gate::Gate;
#[cfg(feature = "simulation")]
use crate::world::{STEP, World};
#[cfg(feature = "simulation")]
use driver::realtime::Clock;
#[cfg(feature = "simulation")]
use prost::Message;
use std::io::{self, ErrorKind};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
#[cfg(feature = "simulation")]
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Largest datagram.
const LARGEST: usize = 65_535;
/// Datagrams that are taken from one socket before the others have their turn.
const TURN: usize = 64;
/// Time by which the simulation may be late before it gives the rest up, s: a tenth of a second, after which robots stop.
#[cfg(feature = "simulation")]
const LATE: Duration = Duration::from_millis(100);

/// Where to listen and what to send to.
#[derive(Clone, Debug)]
pub struct Addresses {
    /// Address of the interface to listen on and to send vision from; loopback, a network card's, or 0.0.0.0 for all.
    pub interface: Ipv4Addr,
    /// Port of control.
    pub control: u16,
    /// Port of the blue team.
    pub blue: u16,
    /// Port of the yellow team.
    pub yellow: u16,
    /// Where vision goes: multicast groups and single receivers.
    pub vision: Vec<SocketAddr>,
}

impl Addresses {
    /// The group and port of simulated vision.
    pub const VISION: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::new(224, 5, 23, 2)), 10_020);
}

impl Default for Addresses {
    fn default() -> Self {
        Self {
            interface: Ipv4Addr::LOCALHOST,
            control: 10_300,
            blue: 10_301,
            yellow: 10_302,
            vision: vec![Self::VISION],
        }
    }
}

/// Datagrams and frames since the sockets were opened.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Datagrams that were heard.
    pub heard: u64,
    /// Datagrams beyond a sender's rate.
    pub refused: u64,
    /// Frames of vision, each to every receiver.
    pub frames: u64,
    /// Datagrams that the network did not take.
    pub unsent: u64,
}

/// The open sockets.
#[derive(Debug)]
pub struct Sockets {
    control: UdpSocket,
    teams: [(Team, UdpSocket); 2],
    vision: UdpSocket,
    receivers: Vec<SocketAddr>,
    buffer: Vec<u8>,
    gate: Gate,
    traffic: Traffic,
}

impl Sockets {
    /// Opens them all.
    ///
    /// # Errors
    /// A port that is taken, by its number, or an interface that is not there.
    pub fn open(addresses: &Addresses) -> io::Result<Self> {
        let open = |port: u16, what: &str| {
            let at = SocketAddr::from((addresses.interface, port));
            let socket = UdpSocket::bind(at)
                .map_err(|error| io::Error::new(error.kind(), format!("{what}, UDP {at}: {error}")))?;
            socket.set_nonblocking(true)?;
            Ok::<_, io::Error>(socket)
        };
        // Bound to the interface's address, multicast leaves by that interface, loopback too.
        let vision = open(0, "vision")?;
        Ok(Self {
            control: open(addresses.control, "control")?,
            teams: [
                (Team::Blue, open(addresses.blue, "the blue team")?),
                (Team::Yellow, open(addresses.yellow, "the yellow team")?),
            ],
            vision,
            receivers: addresses.vision.clone(),
            buffer: vec![0; LARGEST],
            gate: Gate::default(),
            traffic: Traffic::default(),
        })
    }

    /// Addresses of control, blue and yellow as they are.
    ///
    /// # Errors
    /// As the machine says.
    pub fn local(&self) -> io::Result<[SocketAddr; 3]> {
        Ok([self.control.local_addr()?, self.teams[0].1.local_addr()?, self.teams[1].1.local_addr()?])
    }

    /// Datagrams and frames so far.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        Traffic { refused: self.gate.refused, ..self.traffic }
    }

    /// Hears and answers what waits, up to a turn of every socket. Whether a message of `leader` was among it.
    pub fn serve(&mut self, robots: &mut impl Robots, now: Duration, leader: Option<Team>) -> bool {
        let Self { control, teams, buffer, gate, traffic, .. } = self;
        let mut admits = |sender| gate.admits(sender, now);
        turn(control, buffer, traffic, TURN, &mut admits, |datagram| front::simulator(robots, datagram));
        let mut led = false;
        for (team, socket) in teams {
            let answer = |datagram: &[u8]| front::control(robots, *team, datagram);
            if leader == Some(*team) {
                // Its next message is for the next frame, and as many a second as there are frames computed.
                led = turn(socket, buffer, traffic, 1, |_| true, answer) > 0;
            } else {
                turn(socket, buffer, traffic, TURN, &mut admits, answer);
            }
        }
        led
    }

    /// Sends a frame to every receiver.
    pub fn publish(&mut self, frame: &[u8]) {
        self.traffic.frames += 1;
        for receiver in &self.receivers {
            // A receiver that is not there is none of the simulation's business.
            if self.vision.send_to(frame, receiver).is_err() {
                self.traffic.unsent += 1;
            }
        }
    }

    /// Sends vision to another port from now on.
    pub fn vision_port(&mut self, port: u16) {
        self.receivers.iter_mut().for_each(|receiver| receiver.set_port(port));
    }
}

/// Takes datagrams of one socket; how many were heard.
fn turn(
    socket: &UdpSocket,
    buffer: &mut [u8],
    traffic: &mut Traffic,
    most: usize,
    mut admits: impl FnMut(SocketAddr) -> bool,
    mut answer: impl FnMut(&[u8]) -> Vec<u8>,
) -> usize {
    let mut heard = 0;
    for _ in 0..TURN {
        if heard >= most {
            break;
        }
        let (length, sender) = match socket.recv_from(buffer) {
            Ok(datagram) => datagram,
            Err(error) if error.kind() == ErrorKind::WouldBlock => break,
            // A receiver of an answer that is gone shows as an error of the next call.
            Err(_) => continue,
        };
        if !admits(sender) {
            continue;
        }
        heard += 1;
        traffic.heard += 1;
        if socket.send_to(&answer(&buffer[..length]), sender).is_err() {
            traffic.unsent += 1;
        }
    }
    heard
}

/// How a simulation went.
#[cfg(feature = "simulation")]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Served {
    /// Simulated time, s.
    pub simulated_s: f64,
    /// Steps of a millisecond that were simulated.
    pub steps: u64,
    /// Steps that were left out because the machine was late.
    pub lost: u64,
    /// Longest time by which a step was late, s.
    pub latest_s: f64,
    /// Datagrams and frames of the whole time.
    pub traffic: Traffic,
}

/// Simulates in the time of a clock until somebody stops it or `limit` of simulated time is over; `progress` hears of it
/// at every frame.
#[cfg(feature = "simulation")]
pub fn run(
    world: &mut World,
    sockets: &mut Sockets,
    clock: &mut impl Clock,
    stop: &AtomicBool,
    limit: Option<Duration>,
    mut progress: impl FnMut(&Served),
) -> Served {
    let mut served = Served::default();
    let mut due = clock.now();
    while !stop.load(Ordering::Relaxed) && limit.is_none_or(|limit| world.time() < limit) {
        sockets.serve(world, clock.now(), None);
        let speed = world.speed();
        if speed == 0.0 {
            due += STEP;
            clock.sleep_until(due);
            continue;
        }
        if let Some(packet) = world.step() {
            if let Some(port) = world.take_vision_port() {
                sockets.vision_port(port);
            }
            sockets.publish(&packet.encode_to_vec());
            served.simulated_s = world.time().as_secs_f64();
            served.traffic = sockets.traffic();
            progress(&served);
        }
        served.steps += 1;
        due += STEP.div_f64(speed);
        let late = clock.now().saturating_sub(due);
        served.latest_s = served.latest_s.max(late.as_secs_f64());
        if late > LATE {
            // Old time is not caught up with: robots would be driven by old news.
            let lost = late.div_f64(STEP.as_secs_f64() / speed).as_secs_f64() as u64;
            served.lost += lost;
            due = clock.now();
        }
        clock.sleep_until(due);
    }
    served.simulated_s = world.time().as_secs_f64();
    served.traffic = sockets.traffic();
    served
}

/// Simulates in lock-step: a frame of vision passes after every message of the leading team, whose answer is sent before
/// it. What comes out depends on no clock.
#[cfg(feature = "simulation")]
pub fn run_in_lock_step(
    world: &mut World,
    sockets: &mut Sockets,
    leader: Team,
    clock: &mut impl Clock,
    stop: &AtomicBool,
    limit: Option<Duration>,
    mut progress: impl FnMut(&Served),
) -> Served {
    /// How often the sockets are looked at while nobody says anything.
    const LOOK: Duration = Duration::from_micros(100);
    let mut served = Served::default();
    let publish = |world: &mut World, sockets: &mut Sockets| {
        let packet = world.next_frame();
        if let Some(port) = world.take_vision_port() {
            sockets.vision_port(port);
        }
        sockets.publish(&packet.encode_to_vec());
    };
    while !stop.load(Ordering::Relaxed) && limit.is_none_or(|limit| world.time() < limit) {
        let now = clock.now();
        if sockets.serve(world, now, Some(leader)) {
            let before = world.time();
            publish(world, sockets);
            served.steps += ((world.time() - before).as_nanos() / STEP.as_nanos()) as u64;
            served.simulated_s = world.time().as_secs_f64();
            served.traffic = sockets.traffic();
            progress(&served);
        } else {
            clock.sleep_until(now + LOOK);
        }
    }
    served.simulated_s = world.time().as_secs_f64();
    served.traffic = sockets.traffic();
    served
}
