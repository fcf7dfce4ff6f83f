//! `serve` as a team's software meets it: through the sockets.

use super::racbot;
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tempfile::tempdir;

/// Most that an answer may take, on a machine that does other things too.
const PATIENCE: Duration = Duration::from_secs(60);

/// A server, its ports, and what it said; ended when dropped.
struct Server {
    child: Child,
    ports: [u16; 3],
}

impl Server {
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let fixed = ["--json", "serve", "--ports", "0,0,0"];
        let mut child = Command::new(env!("CARGO_BIN_EXE_racbot"))
            .args(fixed)
            .args(arguments)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut errors = BufReader::new(child.stderr.take().unwrap()).lines();
        let line = errors.by_ref().map(Result::unwrap).find(|line| line.starts_with("serving: ")).expect("it serves");
        std::thread::spawn(move || errors.for_each(drop));
        let ports: Vec<u16> =
            line.split([',', ';']).filter_map(|part| part.rsplit_once("127.0.0.1:")?.1.parse().ok()).take(3).collect();
        Self { child, ports: ports.try_into().unwrap() }
    }

    /// Ends it as Ctrl-C does; what it printed.
    fn end(mut self) -> Value {
        let interrupt = Command::new("kill").args(["-INT", &self.child.id().to_string()]).status().unwrap();
        assert!(interrupt.success());
        let out = self.child.stdout.take().unwrap();
        let printed = serde_json::from_reader(out).unwrap();
        assert!(self.child.wait().unwrap().success());
        printed
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
    }
}

fn client() -> UdpSocket {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(PATIENCE)).unwrap();
    socket
}

fn ask(socket: &UdpSocket, port: u16, datagram: &[u8]) -> Vec<u8> {
    socket.send_to(datagram, ("127.0.0.1", port)).unwrap();
    let mut answer = vec![0; 65_535];
    let length = socket.recv(&mut answer).unwrap();
    answer.truncate(length);
    answer
}

/// `RobotControl` for robot 0 at 0.3 m/s ahead, as bytes.
const AHEAD: &[u8] =
    &[0x0a, 0x15, 0x08, 0x00, 0x12, 0x11, 0x12, 0x0f, 0x0d, 0x9a, 0x99, 0x99, 0x3e, 0x15, 0, 0, 0, 0, 0x1d, 0, 0, 0, 0];

/// The `bash` blocks of the manual's page, one after the other.
fn printed() -> String {
    let page = include_str!("../../../docs/book/src/serve.md");
    page.split("```bash\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

#[test]
fn the_printed_script_drives_squares_and_finds_the_skew_from_vision_and_commands_alone() {
    if !Command::new("python3").arg("--version").output().is_ok_and(|output| output.status.success()) {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "apt install python3");
        eprintln!("NOT RUN: apt install python3");
        return;
    }
    let folder = tempdir().unwrap();
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap();
    std::os::unix::fs::symlink(repository.join("ssl"), folder.path().join("ssl")).unwrap();
    // The same on ports that nobody else has.
    let sockets = [(); 4].map(|()| UdpSocket::bind("127.0.0.1:0").unwrap());
    let ports = sockets.map(|socket| socket.local_addr().unwrap().port().to_string());
    let (three, vision) = (ports[..3].join(","), &ports[3]);
    let script = printed()
        .replace("racbot serve", &format!("racbot serve --ports {three}"))
        .replace("square.py recorded", &format!("square.py recorded --ports {three} --vision {vision}"))
        .replace(":10020", &format!(":{vision}"));
    assert!(script.contains("--skew-deg 4,-3,2") && script.matches("racbot").count() >= 4, "{script}");
    let command = Path::new(env!("CARGO_BIN_EXE_racbot")).parent().unwrap();
    let path = format!("{}:{}", command.display(), std::env::var("PATH").unwrap());
    let output = Command::new("bash").args(["-e", "-c", &script]).env("PATH", path).current_dir(folder.path()).output();
    let output = output.unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");

    let found = fs::read_to_string(folder.path().join("out/gap/gap.json")).unwrap();
    let found: Value = serde_json::from_str(&found).unwrap();
    assert_eq!(found["verdict"], "missing-effect", "{said}");
    let effects = found["effects"].as_array().unwrap();
    let named = effects.iter().find(|effect| effect["name"] == "wheel-skew").expect("wheel-skew");
    for (wheel, degrees) in [4.0_f64, -3.0, 2.0].into_iter().enumerate() {
        let parameter = &named["parameters"][format!("skew_{}_rad", wheel + 1)];
        let found = parameter["value"].as_f64().unwrap().to_degrees();
        assert!((found - degrees).abs() < 1.0, "wheel {}: {found} for {degrees}\n{said}", wheel + 1);
    }
}

#[test]
fn floods_and_garbage_do_not_stop_a_server() {
    let folder = tempdir().unwrap();
    let lock_step = ["--blue", "1", "--yellow", "1", "--lock-step", "blue", "--vision", "none"];
    let server = Server::start(folder.path(), &lock_step);
    let [control, blue, yellow] = server.ports;
    let hostile = client();
    let mut junk = vec![0_u8; 60_000];
    for round in 0..500_u32 {
        junk.iter_mut().enumerate().for_each(|(i, byte)| *byte = (i as u32).wrapping_mul(round | 1) as u8);
        let length = [0, 1, 7, 60_000][round as usize % 4];
        for port in [control, yellow] {
            let _ = hostile.send_to(&junk[..length], ("127.0.0.1", port));
        }
    }
    let team = client();
    let answer = ask(&team, blue, AHEAD);
    // Feedback of robot 0 and no error.
    assert_eq!(answer, [0x12, 0x04, 0x08, 0x00, 0x10, 0x00]);
    let unreadable = ask(&team, blue, &[0xff; 100]);
    assert!(String::from_utf8_lossy(&unreadable).contains("UNREADABLE"));
    let served = server.end();
    assert!(served["heard"].as_u64().unwrap() >= 2 && served["lost"] == 0, "{served}");
}

#[test]
fn mistakes_of_a_call_are_said_before_anything_is_served() {
    let folder = tempdir().unwrap();
    let refused = |arguments: &[&str], parts: &[&str]| {
        racbot(folder.path(), &[&["serve"], arguments].concat()).refused(2, parts);
    };
    refused(&["--ports", "1,2"], &["three ports"]);
    refused(&["--robot", "green:1=x.toml"], &["green", "neither blue nor yellow"]);
    refused(&["--vision", "here"], &["--vision"]);
    refused(&["--vision-hz", "0"], &["--vision-hz"]);
    racbot(folder.path(), &["serve", "--robot", "none.toml"]).refused(1, &["none.toml"]);
    let taken = UdpSocket::bind("127.0.0.1:0").unwrap();
    let ports = format!("{},0,0", taken.local_addr().unwrap().port());
    racbot(folder.path(), &["serve", "--ports", &ports]).refused(1, &["control, UDP", "--ports"]);
    // An address for documents, which no machine has.
    racbot(folder.path(), &["serve", "--interface", "203.0.113.1", "--ports", "0,0,0"])
        .refused(1, &["--interface is an address of this machine"]);
}
