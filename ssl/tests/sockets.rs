//! The shell around the field: real sockets on free ports, and a clock that the tests own.

mod support;

use driver::Board;
use driver::drive::{Ending, NoSource, Plan};
use driver::realtime::Clock;
use model::plant::Plant;
use prost::Message;
use runs::robot::Robot;
use runs::vision::WrapperPacket;
use simulator::closed_loop::{VirtualRobot, whole_tick_clock_hz};
use simulator::fpga::BitTrue;
use ssl::card::{Link, Served, drive};
use ssl::front::Team;
use ssl::messages::{RobotControl, RobotControlResponse, SimulatorResponse};
use ssl::server::{Addresses, Sockets, run, run_in_lock_step};
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use support::{field_of, local};

fn client() -> UdpSocket {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    socket.set_nonblocking(true).unwrap();
    socket
}

fn sockets(vision: Vec<SocketAddr>) -> Sockets {
    Sockets::open(&Addresses { control: 0, blue: 0, yellow: 0, vision, ..Addresses::default() }).unwrap()
}

fn waiting(socket: &UdpSocket) -> Vec<Vec<u8>> {
    let mut buffer = vec![0; 65_535];
    std::iter::from_fn(|| socket.recv(&mut buffer).ok().map(|length| buffer[..length].to_vec())).collect()
}

fn ahead(id: u32) -> Vec<u8> {
    RobotControl { robot_commands: vec![local(id, 0.3, 0.0, 0.0)] }.encode_to_vec()
}

/// A clock that jumps to where it is told to sleep, and calls before every sleep. Loopback hands datagrams over at once.
struct Staged<C, F> {
    inner: C,
    before: F,
}

impl<C: Clock, F: FnMut(Duration) -> Duration> Clock for Staged<C, F> {
    fn now(&mut self) -> Duration {
        self.inner.now()
    }
    fn sleep_until(&mut self, at: Duration) {
        let late = (self.before)(at);
        self.inner.sleep_until(at + late);
    }
}

/// Time that passes when somebody sleeps.
#[derive(Default)]
struct Told(Duration);

impl Clock for Told {
    fn now(&mut self) -> Duration {
        self.0
    }
    fn sleep_until(&mut self, at: Duration) {
        self.0 = self.0.max(at);
    }
}

#[test]
fn commands_come_in_answers_and_vision_go_out() {
    let (team, eyes) = (client(), client());
    let mut sockets = sockets(vec![eyes.local_addr().unwrap()]);
    let [control, blue, yellow] = sockets.local().unwrap();
    let mut world = field_of(&[Robot::racbot()]);
    let before = world.robot_of(Team::Blue, 0).unwrap().pose();
    let (mut answers, mut frames) = (Vec::new(), Vec::new());
    let stage = |at: Duration| {
        if at.as_millis().is_multiple_of(16) {
            team.send_to(&ahead(0), blue).unwrap();
        }
        if at.as_millis() == 100 {
            team.send_to(b"\xff\xff", control).unwrap();
            team.send_to(&ahead(4), yellow).unwrap();
        }
        answers.extend(waiting(&team));
        frames.extend(waiting(&eyes));
        Duration::ZERO
    };
    let mut clock = Staged { inner: Told::default(), before: stage };
    let limit = Some(Duration::from_secs(1));
    let served = run(&mut world, &mut sockets, &mut clock, &AtomicBool::new(false), limit, |_| {});
    assert_eq!((served.steps, served.lost, served.traffic.refused, served.traffic.unsent), (1_000, 0, 0, 0));
    assert!(world.robot_of(Team::Blue, 0).unwrap().pose().distance(before) > 0.15);
    let right = answers.iter().filter(|a| RobotControlResponse::decode(&a[..]).is_ok_and(|a| a.errors.is_empty()));
    assert!(right.count() >= 60);
    assert!(answers.iter().any(|a| {
        SimulatorResponse::decode(&a[..])
            .is_ok_and(|a| a.errors.first().is_some_and(|error| error.code.as_deref() == Some("UNREADABLE")))
    }));
    assert!(answers.iter().any(|a| String::from_utf8_lossy(a).contains("UNKNOWN_ROBOT")));
    assert!((59..=61).contains(&frames.len()), "{}", frames.len());
    let last = WrapperPacket::decode(&frames[frames.len() - 1][..]).unwrap();
    assert_eq!(last.detection.unwrap().robots_blue.len(), 1);
}

#[test]
fn a_machine_that_is_late_loses_time_and_counts_it() {
    let mut sockets = sockets(Vec::new());
    let mut world = field_of(&[Robot::racbot()]);
    // Once the machine stands still for 350 ms, once for 50.
    let stage = |at: Duration| match at.as_millis() {
        200 => Duration::from_millis(350),
        700 => Duration::from_millis(50),
        _ => Duration::ZERO,
    };
    let mut clock = Staged { inner: Told::default(), before: stage };
    let limit = Some(Duration::from_secs(1));
    let served = run(&mut world, &mut sockets, &mut clock, &AtomicBool::new(false), limit, |_| {});
    assert!((345..=350).contains(&served.lost), "{served:?}");
    assert_eq!(served.steps, 1_000);
    assert!(served.latest_s > 0.34);
}

#[test]
fn a_flood_of_one_sender_leaves_the_others_their_answers() {
    let (flood, team) = (client(), client());
    let mut sockets = sockets(Vec::new());
    let [control, blue, _] = sockets.local().unwrap();
    let mut world = field_of(&[Robot::racbot()]);
    let junk = vec![0x0a; 60_000];
    let mut answers = Vec::new();
    let stage = |at: Duration| {
        for length in [0, 1, 60_000, 9] {
            let _ = flood.send_to(&junk[..length], control);
            let _ = flood.send_to(&junk[..length], blue);
        }
        if at.as_millis().is_multiple_of(16) {
            let _ = team.send_to(&ahead(0), blue);
        }
        answers.extend(waiting(&team));
        drop(waiting(&flood));
        Duration::ZERO
    };
    let mut clock = Staged { inner: Told::default(), before: stage };
    let limit = Some(Duration::from_secs(1));
    let served = run(&mut world, &mut sockets, &mut clock, &AtomicBool::new(false), limit, |_| {});
    // 8000 came; a sender has 2000 a second and 400 at once.
    assert!(served.traffic.refused > 5_000 && served.traffic.heard < 2_600, "{served:?}");
    assert!(answers.len() >= 60, "{}", answers.len());
    assert_eq!(served.steps, 1_000);
}

#[test]
fn in_lock_step_a_frame_passes_for_every_message_of_the_leader() {
    let (team, other, eyes) = (client(), client(), client());
    let mut sockets = sockets(vec![eyes.local_addr().unwrap()]);
    let [_, blue, yellow] = sockets.local().unwrap();
    let mut world = field_of(&[Robot::racbot()]);
    let stop = AtomicBool::new(false);
    let mut calls = 0;
    let stage = |_: Duration| {
        calls += 1;
        other.send_to(&ahead(0), yellow).unwrap();
        if calls <= 20 {
            team.send_to(&ahead(0), blue).unwrap();
            team.send_to(&ahead(0), blue).unwrap();
        }
        stop.store(calls > 60, Ordering::Relaxed);
        Duration::ZERO
    };
    let mut clock = Staged { inner: Told::default(), before: stage };
    let served = run_in_lock_step(&mut world, &mut sockets, Team::Blue, &mut clock, &stop, None, |_| {});
    assert_eq!(served.traffic.frames, 40);
    assert_eq!(waiting(&eyes).len(), 40);
    assert_eq!(waiting(&team).len(), 40);
}

fn is_armed(card: &VirtualRobot<BitTrue>) -> bool {
    card.fpga(|fpga| Board::new(fpga).status().unwrap().armed)
}

/// Serves the paper's robot on a bit-true card as blue 5 for so many seconds; `stage` is called before every sleep.
fn serve_card(
    limit_s: f64,
    fault_ends: bool,
    mut stage: impl FnMut(u128, &VirtualRobot<BitTrue>, [SocketAddr; 2]),
) -> Served {
    let mut sockets = sockets(Vec::new());
    let [control, blue, _] = sockets.local().unwrap();
    let robot = Robot::racbot();
    let plan = Plan { limit_s, ..Plan::new(&robot, &[]) };
    let clock_hz = whole_tick_clock_hz(robot.control_rate_hz);
    let period = Duration::from_secs_f64(plan.scale(clock_hz).unwrap().tick_s());
    let card = VirtualRobot::new(BitTrue::new(), Plant::new(&robot).unwrap(), robot.supply_v, period);
    let seen = card.clone();
    let before = |at: Duration| {
        stage(at.as_millis(), &seen, [control, blue]);
        Duration::ZERO
    };
    let clock = Staged { inner: card.clone(), before };
    let link = Link { board: Board::new(card.clone()), clock_hz, clock, source: NoSource, recording: None, fault_ends };
    let served = drive(&plan, (Team::Blue, 5), link, &mut sockets, &AtomicBool::new(false)).unwrap();
    assert!(!is_armed(&card));
    served
}

#[test]
fn the_same_messages_drive_a_card_and_silence_stops_it() {
    let team = client();
    let (mut speeds, mut answers) = (Vec::new(), Vec::new());
    let Served { driven, faults } = serve_card(3.0, false, |ms, seen, [control, blue]| {
        if ms.is_multiple_of(16) && ms < 1_000 {
            team.send_to(&ahead(5), blue).unwrap();
        }
        if ms == 40 {
            team.send_to(&ahead(0), blue).unwrap();
            team.send_to(&[], control).unwrap();
        }
        answers.extend(waiting(&team));
        speeds.push((ms, seen.twist().vy));
    });
    assert!(matches!(driven.ending, Ending::TimeLimit) && faults.is_empty(), "{:?} {faults:?}", driven.ending);
    assert!(driven.switched_off.is_ok());
    let at = |time: u128| speeds.iter().find(|(ms, _)| *ms >= time).unwrap().1;
    assert!((at(950) - 0.3).abs() < 0.03 && (at(1_080) - 0.3).abs() < 0.03, "{} {}", at(950), at(1_080));
    assert!(at(2_800).abs() < 0.01, "{}", at(2_800));
    for code in ["UNKNOWN_ROBOT", "NOT_SIMULATED"] {
        assert!(answers.iter().any(|answer| String::from_utf8_lossy(answer).contains(code)), "{code}");
    }
}

/// An encoder fails at 1.0 s and is whole again at 2.0 s. The team asks for motion until 2.5 s, for none until 3.5 s, and
/// then for motion again. What came of it, its answers, and whether the card was armed at each millisecond.
fn an_encoder_fails(fault_ends: bool) -> (Served, Vec<String>, Vec<(u128, bool, f64)>) {
    let team = client();
    let (mut looks, mut answers) = (Vec::new(), Vec::new());
    let served = serve_card(5.0, fault_ends, |ms, seen, [_, blue]| {
        let order = if (2_500..3_500).contains(&ms) { 0.0 } else { 0.3 };
        if ms.is_multiple_of(16) {
            team.send_to(&RobotControl { robot_commands: vec![local(5, order, 0.0, 0.0)] }.encode_to_vec(), blue)
                .unwrap();
        }
        seen.fpga(|fpga| fpga.pins.encoder_errors = u8::from((1_000..2_000).contains(&ms)));
        answers.extend(waiting(&team).iter().map(|answer| String::from_utf8_lossy(answer).into_owned()));
        looks.push((ms, is_armed(seen), seen.twist().vy));
    });
    (served, answers, looks)
}

#[test]
fn a_card_with_a_fault_rests_and_is_had_back_once_nobody_asks_for_motion() {
    let (Served { driven, faults }, answers, looks) = an_encoder_fails(false);
    assert!(matches!(driven.ending, Ending::TimeLimit), "{:?}", driven.ending);
    assert!(matches!(&faults[..], [(t, what)] if (0.99..1.02).contains(t) && what.contains("encoder")), "{faults:?}");
    assert!(answers.iter().any(|answer| answer.contains("ROBOT_FAULT") && answer.contains("encoder")), "{answers:?}");
    let armed = |from, to| looks.iter().filter(move |(ms, ..)| (from..to).contains(ms)).map(|(_, armed, _)| *armed);
    assert!(armed(100, 1_000).all(|armed| armed) && armed(1_010, 3_000).all(|armed| !armed));
    assert!(armed(3_100, 4_900).all(|armed| armed));
    let speed = looks.iter().find(|(ms, ..)| *ms == 4_800).unwrap().2;
    assert!((speed - 0.3).abs() < 0.03, "{speed}");
}

#[test]
fn a_card_told_to_stay_off_ends_at_its_first_fault() {
    let (Served { driven, faults }, ..) = an_encoder_fails(true);
    assert!(matches!(driven.ending, Ending::Fault(_)) && faults.is_empty(), "{:?}", driven.ending);
    assert!((0.99..1.02).contains(&driven.t) && driven.switched_off.is_ok(), "{}", driven.t);
}

#[test]
fn after_an_emergency_stop_only_a_person_starts_a_card_again() {
    // Pressed while it drives, and while it rests after an encoder that failed for a moment.
    for pressed in [1_000..1_100, 1_600..1_601] {
        let Served { driven, .. } = serve_card(5.0, false, |ms, seen, _| {
            seen.fpga(|fpga| {
                fpga.pins.emergency_stop = pressed.contains(&ms);
                fpga.pins.encoder_errors = u8::from(pressed.start == 1_600 && (1_500..1_510).contains(&ms));
            });
        });
        assert!(matches!(driven.ending, Ending::Fault(_)) && driven.t < 2.2, "{:?} {}", driven.ending, driven.t);
    }
}

#[test]
fn a_client_that_joins_by_the_loopback_interface_sees_multicast() {
    let eyes = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).unwrap();
    eyes.set_nonblocking(true).unwrap();
    let group = Ipv4Addr::new(224, 5, 23, 2);
    if let Err(error) = eyes.join_multicast_v4(&group, &Ipv4Addr::LOCALHOST) {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "multicast on loopback: {error}");
        eprintln!("NOT RUN: this machine has no multicast on loopback: {error}");
        return;
    }
    let mut sockets = sockets(vec![SocketAddr::from((group, eyes.local_addr().unwrap().port()))]);
    sockets.publish(b"frame");
    assert_eq!(sockets.traffic().unsent, 0);
    assert_eq!(waiting(&eyes), [b"frame".to_vec()]);
}
