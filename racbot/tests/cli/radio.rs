//! The base station, over a pseudo-terminal and into a file.

use super::racbot;
use assert_cmd::cargo::cargo_bin;
use fixed_kin::AXES;
use fixed_kin::card::{Card, Pins};
use fixed_kin::radio::{CRC_BYTES, HEADER_BYTES, WRITE_BYTES};
use fixed_kin::registers::ACTIVE_SET_POINTS;
use fixed_kin::speed::EncoderSample;
use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::tcgetattr;
use std::fs::{self, File};
use std::io::Read;
use std::process::{Command, Stdio};
use tempfile::tempdir;

const ROBOT: u8 = 11;

/// A robot that takes frames one by one, each 10 ms after the one before. Its wheels turn, so that no stall ends
/// a drive, however many frames are under way when it is stopped.
struct Robot {
    card: Card,
    wheels: EncoderSample,
    armed: usize,
    velocities: Vec<i32>,
}

impl Robot {
    fn new() -> Self {
        let mut card = Card::slave(0, ROBOT);
        card.tick(&Pins::default());
        Self { card, wheels: EncoderSample::default(), armed: 0, velocities: Vec::new() }
    }

    fn take(&mut self, frame: &[u8]) {
        self.card.receive(frame).unwrap();
        for _ in 0..10 {
            self.wheels.count = self.wheels.count.wrapping_add(1);
            self.card.tick(&Pins { encoders: [self.wheels; AXES], ..Pins::default() });
        }
        self.armed += usize::from(self.card.armed());
        self.velocities.push(self.card.read(ACTIVE_SET_POINTS.at(1)) as i32);
    }
}

/// Frames after which the robot is stopped.
const ENOUGH: usize = 40;

#[test]
fn frames_over_a_serial_line_arm_drive_and_switch_off() {
    let far = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&far).unwrap();
    unlockpt(&far).unwrap();
    let device = ptsname(&far, Vec::new()).unwrap().into_string().unwrap();
    // Ours, so that the line stays open when the command has closed it.
    let near = File::options().read(true).write(true).open(&device).unwrap();
    let mut child = Command::new(cargo_bin("racbot"))
        .args(["radio", "--number", "11", "--line", &device, "--velocity", "0,0.4,0", "--seconds", "3600"])
        .stdout(Stdio::piped())
        .stderr(Stdio::inherit())
        .spawn()
        .unwrap();
    let radio = Pid::from_child(&child);
    let reader = std::thread::spawn(move || {
        let (mut robot, mut bytes, mut far) = (Robot::new(), Vec::new(), File::from(far));
        let mut frames = 0;
        while frames == 0 || robot.card.armed() {
            let mut part = [0; 512];
            let count = far.read(&mut part).unwrap();
            bytes.extend_from_slice(&part[..count]);
            // Of the frames that switch it off the first is enough, though several may have come at once.
            while frames == 0 || robot.card.armed() {
                let writes = bytes.get(2).map_or(usize::MAX, |n| usize::from(*n));
                let length = (writes < 96).then(|| HEADER_BYTES + writes * WRITE_BYTES + CRC_BYTES);
                let Some(length) = length.filter(|length| bytes.len() >= *length) else { break };
                robot.take(&bytes.drain(..length).collect::<Vec<_>>());
                frames += 1;
                // Enough, however long that took.
                if frames == ENOUGH {
                    kill_process(radio, Signal::INT).unwrap();
                }
            }
        }
        (robot, frames, far)
    });
    // The other end stays, too, until the last frame is sent.
    let (robot, frames, _far) = reader.join().unwrap();
    let mode = tcgetattr(&near).unwrap();
    assert_eq!((mode.output_speed(), mode.input_speed()), (115_200, 115_200));
    let status = child.wait().unwrap();
    let mut text = String::new();
    child.stdout.unwrap().read_to_string(&mut text).unwrap();
    assert!(
        status.success() && text.contains("3 boot frames") && text.contains("stopped early; switched off"),
        "{text}"
    );
    // Armed until the first of the frames that switch off.
    assert!(frames > ENOUGH && robot.armed == frames - 1, "{frames} {}", robot.armed);
    let fastest = robot.velocities.iter().max().unwrap();
    assert!(*fastest > 0 && robot.velocities.iter().all(|v| *v == 0 || v == fastest), "{:?}", robot.velocities);
    assert_eq!(robot.velocities.last(), Some(&0), "it stands when it is switched off");
}

#[test]
fn frames_in_a_file_follow_the_commands_of_a_log() {
    let folder = tempdir().unwrap();
    let log = "t,cmd_vx,cmd_vy,cmd_w\n0,0,0.5,0\n0.1,0,,0\n0.2,0,-0.25,0\n0.3,0,0,0\n";
    fs::write(folder.path().join("run.csv"), log).unwrap();
    let arguments = ["radio", "--number", "11", "--commands", "run.csv", "--out", "frames.txt", "--json"];
    let json = racbot(folder.path(), &arguments).done().json();
    assert_eq!((json["boots"].as_u64(), json["velocities"].as_u64()), (Some(3), Some(80)));
    let text = fs::read_to_string(folder.path().join("frames.txt")).unwrap();
    let (mut robot, mut last) = (Robot::new(), -1.0);
    for line in text.lines() {
        let (time, bytes) = line.split_once(' ').unwrap();
        let time: f64 = time.parse().unwrap();
        assert!(time > last);
        last = time;
        let bytes: Vec<u8> = bytes.split(' ').map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect();
        robot.take(&bytes);
    }
    let count = |sign: i32| robot.velocities.iter().filter(|v| v.signum() == sign).count();
    assert_eq!((count(1), count(-1), robot.card.armed()), (20, 10, false));
    assert_eq!(-2 * robot.velocities.iter().min().unwrap(), *robot.velocities.iter().max().unwrap());
}

#[test]
fn what_no_robot_can_be_told_is_refused() {
    let folder = tempdir().unwrap();
    let base = ["radio", "--number", "3"];
    let with = |more: &[&str]| racbot(folder.path(), &[&base[..], more].concat());
    with(&["--velocity", "1,2,3", "--seconds", "1"]).refused(2, &["--line"]);
    with(&["--out", "f", "--velocity", "1,2", "--seconds", "1"]).refused(2, &["'1,2' is no velocity"]);
    with(&["--out", "f", "--velocity", "1,2,inf", "--seconds", "1"]).refused(2, &["is no velocity"]);
    with(&["--out", "f", "--velocity", "1,2,3"]).refused(2, &["--seconds"]);
    with(&["--out", "f", "--velocity", "1,2,3", "--seconds", "0"])
        .refused(2, &["0 is not more than 0 and at most 3600"]);
    with(&["--out", "f"]).refused(2, &["--velocity"]);
    racbot(folder.path(), &["radio", "--number", "16", "--out", "f"]).refused(2, &["16 is not in 0..=15"]);
    // What the paper's motors cannot turn without any load.
    with(&["--out", "f", "--velocity", "1e9,0,0", "--seconds", "1"])
        .refused(2, &["--velocity: wheel ", "at most 0.00"]);
    fs::write(folder.path().join("fast.csv"), "t,cmd_vx,cmd_vy,cmd_w\n0,0,0,0\n0.1,0,0,\n0.2,40,,0\n").unwrap();
    with(&["--out", "f", "--commands", "fast.csv"]).refused(1, &["fast.csv: at 0.2 s: wheel ", "rad/s"]);
    with(&["--line", "nowhere", "--velocity", "0,0.4,0", "--seconds", "1"]).refused(1, &["nowhere: "]);
    fs::write(folder.path().join("file"), "").unwrap();
    with(&["--line", "file", "--velocity", "0,0.4,0", "--seconds", "1"])
        .refused(1, &["file: is no serial port", "--out"]);
    fs::write(folder.path().join("bare.csv"), "t,enc_1\n0,0\n0.001,0\n").unwrap();
    with(&["--out", "f", "--commands", "bare.csv"]).refused(1, &["bare.csv: ", "cmd_vx"]);
}
