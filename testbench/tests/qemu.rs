//! End to end: the robot's own binary in a real Linux kernel under QEMU, on whose PCI bus the virtual card
//! sits. `testbench/qemu/guest.sh` is what happens inside; here is what the host sees of it.
//!
//! Card and guest have one virtual clock (`testbench::qemu`), so the control loop runs at its 1 kHz whatever the
//! host does meanwhile. The bit-true FPGA has its nominal 33.33 MHz; the compiled Verilog is a card whose clock is
//! slow, 2 MHz, which the driver measures as it would any other: at 33 MHz a simulated second would take ten.

use driver::pci::Ids;
use hdl::design::COMMITTED_BITSTREAM;
use runs::robot::Robot;
use simulator::virtual_card::{Faults, VirtualCard};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use testbench::blinker::blinker;
use testbench::qemu::{Initramfs, LockedCard, Options, Tools, run};

/// One machine at a time: two take as long together as one after the other.
static MACHINE: Mutex<()> = Mutex::new(());
const TARGET: &str = "x86_64-unknown-linux-gnu";
/// Clock of the card with compiled Verilog, Hz.
const VERILOG_HZ: f64 = 2e6;
const TWO_POINTS: &str = "x,y,v,omega\n0.4,0,0.5,0\n0.4,0.3,0.5,0\n";
const FAR: &str = "x,y,v,omega\n0,100,0.6,0\n";

fn target_folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap().to_owned()
}

/// The robot's binary: no gateware, no simulation, one static file.
fn binary() -> Vec<u8> {
    static_binary("racbot", &["--no-default-features"])
}

fn static_binary(package: &str, options: &[&str]) -> Vec<u8> {
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let built = Command::new(cargo)
        .args(["build", "--quiet", "--profile", "robot", "--target", TARGET, "-p", package])
        .args(options)
        .arg("--target-dir")
        .arg(target_folder())
        .env("RUSTFLAGS", "-C target-feature=+crt-static")
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .status()
        .unwrap();
    assert!(built.success(), "{package} does not build");
    fs::read(target_folder().join(TARGET).join("robot").join(package)).unwrap()
}

#[test]
fn the_robots_binary_is_one_small_static_file() {
    let binary = binary();
    assert_eq!(&binary[..5], b"\x7fELF\x02", "no 64-bit ELF");
    // Program headers of 56 bytes, their number at byte 56, their offset at 32; type 3 names an interpreter.
    let number = u16::from_le_bytes(binary[56..58].try_into().unwrap()) as usize;
    let offset = u64::from_le_bytes(binary[32..40].try_into().unwrap()) as usize;
    let kinds: Vec<u8> = binary[offset..].chunks(56).take(number).map(|header| header[0]).collect();
    assert!(kinds.contains(&1) && !kinds.contains(&3), "asks for a dynamic linker: {kinds:?}");
    assert!(binary.len() < 6 << 20, "{} bytes", binary.len());
    println!("{} bytes", binary.len());
}

fn robot() -> Robot {
    Robot::racbot()
}

fn initramfs(tools: &Tools, robot: &Robot) -> Vec<u8> {
    let mut corrupt = COMMITTED_BITSTREAM.to_vec();
    corrupt[90_000] ^= 0x10;
    let mut root = Initramfs::default();
    for folder in ["bin", "dev", "proc", "sys", "tmp"] {
        root = root.directory(folder);
    }
    root.file("init", include_bytes!("../qemu/guest.sh"))
        .file("bin/busybox", &fs::read(&tools.busybox).unwrap())
        .file("bin/racbot", &binary())
        .file("bin/testport", &static_binary("testport", &[]))
        .file("rac4i65.bit", COMMITTED_BITSTREAM)
        .file("corrupt.bit", &corrupt)
        .file("other.bit", &blinker())
        .file("robot.toml", robot.to_toml().as_bytes())
        .file("two.csv", TWO_POINTS.as_bytes())
        .file("far.csv", FAR.as_bytes())
        .finish()
}

/// The card and its robot at a moment.
#[derive(Clone, Copy, Debug)]
struct Look {
    configured: bool,
    armed: bool,
    speed: f64,
    kicks: u32,
}

fn look(card: &LockedCard) -> Look {
    let mut card = card.lock().unwrap();
    assert_eq!(card.failure(), None);
    let twist = card.machine().plant().twist();
    let register = |card: &mut VirtualCard, register: &fixed_kin::registers::Register| card.peek(register.offset);
    Look {
        configured: card.configured(),
        armed: register(&mut card, &fixed_kin::registers::STATUS).is_some_and(|status| status & 1 == 1),
        speed: twist.vx.hypot(twist.vy),
        kicks: card.kicks(),
    }
}

/// What a machine left behind.
struct Session {
    console: String,
    /// How the card looked at every mark.
    looks: BTreeMap<String, Look>,
    /// Files that the guest sent.
    files: BTreeMap<String, Vec<u8>>,
}

/// Runs a machine.
fn session(card: VirtualCard, ids: Ids, folder: &Path, first_boot: &str) -> Session {
    let _one = MACHINE.lock().unwrap_or_else(PoisonError::into_inner);
    let tools = Tools::in_folder(&target_folder().join("qemu")).unwrap_or_else(|missing| panic!("{missing}"));
    let card: LockedCard = Arc::new(Mutex::new(card.in_told_time()));
    let initramfs = initramfs(&tools, &robot());
    let options = Options {
        tools: &tools,
        initramfs: &initramfs,
        card: card.clone(),
        ids,
        folder,
        // Of the guest; the longest takes half a minute.
        limit: Duration::from_secs(120),
    };
    let (mut looks, mut files) = (BTreeMap::new(), BTreeMap::new());
    let mut boots = 0;
    let outcome = run(&options, |message, machine| {
        let mut words = message.line.split(' ');
        match (words.next(), words.next()) {
            (Some("boot"), None) => {
                boots += 1;
                return if boots == 1 { first_boot.to_owned() } else { boots.to_string() };
            }
            (Some("unplug"), None) => machine.unplug().unwrap(),
            (Some("mark"), Some(name)) => {
                looks.insert(name.to_owned(), look(&card));
            }
            (Some("file"), Some(name)) => {
                files.insert(name.to_owned(), message.content.to_vec());
            }
            (Some("fault"), Some(name)) => {
                let quiet = Faults::default();
                card.lock().unwrap().faults = match name {
                    "none" => quiet,
                    "absent" => Faults { absent: true, ..quiet },
                    "done-low" => Faults { done_low: true, ..quiet },
                    "init-low" => Faults { init_low: true, ..quiet },
                    "lost-byte" => Faults { lost_byte: Some(70_000), hurt_loads: u32::MAX, ..quiet },
                    _ => panic!("the guest asks for the fault {name}"),
                };
            }
            _ => panic!("the guest says {:?}", message.line),
        }
        "done".to_owned()
    })
    .unwrap();
    println!("{}\n{}", outcome.console, outcome.qemu);
    println!("{looks:#?}\n{:?} in the guest took {:?}", outcome.guest_time, outcome.elapsed);
    assert!(outcome.ended, "the guest did not end: {}", outcome.qemu);
    Session { console: outcome.console, looks, files }
}

/// What the guest printed in a scene.
fn scene<'a>(console: &'a str, name: &str) -> &'a str {
    let Some((_, rest)) = console.split_once(&format!("== {name}\n")) else { panic!("no scene {name}") };
    rest.split("\n== ").next().unwrap_or(rest)
}

#[track_caller]
fn says(scene: &str, parts: &[&str]) {
    for part in parts {
        assert!(scene.contains(part), "no {part:?} in:\n{scene}");
    }
}

#[test]
fn virtual_machine_from_power_up_to_reset() {
    let folder = tempfile::tempdir().unwrap();
    let Session { console, looks, files } =
        session(VirtualCard::new(&robot()).unwrap(), Ids::MESA_4I65, folder.path(), "1");
    let scene = |name| scene(&console, name);
    says(scene("find"), &["0000:00:05.0  Mesa 4I65", "not configured"]);
    says(scene("load"), &["2 CRC words right", "try 1", "the committed gateware", "disarmed"]);
    says(scene("kept"), &["kept, the right design runs already"]);
    says(scene("drive"), &["exit 0"]);
    says(scene("kick"), &["exit 0"]);
    says(scene("kill"), &["exit 137"]);
    says(scene("reload"), &["try 1", "exit 0"]);
    says(scene("corrupt"), &["corrupt.bit: the CRC word at byte", "exit 1"]);
    says(scene("other"), &["cookie reads 0x424c4e4b", "outputs off", "exit 1"]);
    says(scene("done-low"), &["DONE stayed low", "outputs off", "exit 1"]);
    says(scene("init-low"), &["INIT stayed low", "exit 1"]);
    says(scene("lost-byte"), &["outputs off", "exit 1"]);
    says(scene("gone"), &["gone", "exit 1"]);
    says(scene("reset"), &["kept, the right design runs already"]);
    says(scene("unplugged"), &["cookie reads", "exit 1", "no Mesa 4I65"]);

    let at = |mark: &str| looks.get(mark).unwrap_or_else(|| panic!("the guest never came to {mark}"));
    assert!(at("loaded").configured && !at("loaded").armed);
    assert!(!at("driven").armed && at("driven").speed < 0.1, "{:?}", at("driven"));
    assert_eq!((at("driven").kicks, at("kicked").kicks), (0, 1));
    assert!(!at("kicked").armed);
    for moving in ["moving", "before-gone", "before-reset", "before-unplugged"] {
        assert!(at(moving).armed && at(moving).speed > 0.2, "{moving}: {:?}", at(moving));
    }
    for stopped in ["silent", "reloaded", "gone", "after-reset", "unplugged"] {
        assert!(!at(stopped).armed, "{stopped}: {:?}", at(stopped));
    }
    // A bad file touches no card; a bad card ends clear.
    assert!(at("reloaded").configured && at("corrupt").configured);
    assert!(!at("other").configured && !at("done-low").configured);
    assert!(at("after-reset").configured, "a PCI reset clears the FPGA");
    recorded(&files["recording.tar"], folder.path());
}

/// The recorded run leaves the guest, and the analysis reads it.
fn recorded(archive: &[u8], folder: &Path) {
    let (set, file) = (folder.join("set"), folder.join("recording.tar"));
    fs::create_dir(&set).unwrap();
    fs::write(&file, archive).unwrap();
    let untarred = Command::new("tar").arg("xzf").arg(&file).arg("-C").arg(&set).status().unwrap();
    assert!(untarred.success());
    let set = runs::DataSet::open(&set).unwrap();
    let run = &set.runs[0];
    let expected = run.duration_s() * robot().control_rate_hz;
    assert!(run.duration_s() > 1.0 && run.len() as f64 > 0.98 * expected, "{} of {expected} ticks", run.len());
    let analysis = gap::analyse(&set, &gap::Options::default()).unwrap();
    println!("{}", analysis.terminal_summary());
    // Not the command link: the guest's time reaches the card in steps of a quarter of a tick, so that its clock is measured
    // to some tenths of a percent, the control loop slides past the card's tick, and a command acts up to two ticks late.
    let replayed = analysis.exact.iter().find(|l| l.link.name() == "controller").and_then(|l| l.replay.as_ref());
    assert!(replayed.is_some_and(|r| r.compared > 2_000 && r.different == 0), "{replayed:?}");
}

#[test]
fn virtual_machine_with_another_card_and_none() {
    let folder = tempfile::tempdir().unwrap();
    let ids = Ids { subsystem_device: 0x1234, ..Ids::MESA_4I65 };
    let Session { console, .. } = session(VirtualCard::new(&robot()).unwrap(), ids, folder.path(), "other");
    let scene = |name| scene(&console, name);
    says(scene("other-card"), &["no Mesa card among", "0000:00:05.0 has the same bridge", "10b5:1234", "exit 1"]);
    says(scene("no-card"), &["no Mesa 4I65", "exit 1"]);
    assert!(!scene("no-card").contains("same bridge"));
}

#[test]
fn virtual_machine_with_compiled_verilog() {
    let folder = tempfile::tempdir().unwrap();
    let card = VirtualCard::new(&robot()).unwrap().with_clock(VERILOG_HZ).with_verilog().unwrap();
    let Session { console, looks, files } = session(card, Ids::MESA_4I65, folder.path(), "verilog");
    let scene = |name| scene(&console, name);
    says(scene("load"), &["the committed gateware", "exit 0"]);
    says(scene("drive"), &["at rest", "exit 0"]);
    says(scene("kick"), &["kicked", "exit 0"]);
    says(scene("kill"), &["exit 137"]);
    assert!(looks["moving"].armed && looks["moving"].speed > 0.2, "{:?}", looks["moving"]);
    assert!(!looks["silent"].armed && looks["silent"].kicks == 1, "{:?}", looks["silent"]);
    recorded(&files["recording.tar"], folder.path());
}
