//! The files of dist/ are understood by the programs that read them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn dist(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../dist").join(name)
}

/// Whether a program can be run; CI has to have all of them.
fn is_there(program: &str) -> bool {
    let there = Command::new(program).arg("--version").output().is_ok();
    assert!(there || std::env::var("CI").as_deref() != Ok("true"), "{program} is missing: install systemd and udev");
    if !there {
        eprintln!("NOT RUN: {program} is missing");
    }
    there
}

/// What systemd says of a unit, with the command's real place in it.
fn verified(text: &str, name: &str) -> (bool, String) {
    let folder = tempfile::tempdir().unwrap();
    let binary = env!("CARGO_BIN_EXE_racbot");
    let there = |text: &str| text.replace("/usr/local/bin/racbot", binary);
    for unit in ["racbot-load.service", "racbot-drive@.service"] {
        fs::write(folder.path().join(unit), there(&fs::read_to_string(dist(unit)).unwrap())).unwrap();
    }
    let path = folder.path().join(name);
    fs::write(&path, there(text)).unwrap();
    let output = Command::new("systemd-analyze").args(["verify", "--man=no"]).arg(&path).output().unwrap();
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// The lines about our unit; other units of the machine are not our concern.
fn about<'a>(said: &'a str, unit: &str) -> Vec<&'a str> {
    said.lines().filter(|line| line.contains(unit)).collect()
}

#[test]
fn systemd_understands_the_units_and_a_broken_one_is_noticed() {
    if !is_there("systemd-analyze") {
        return;
    }
    for unit in ["racbot-load.service", "racbot-drive@.service"] {
        let text = fs::read_to_string(dist(unit)).unwrap();
        let (good, said) = verified(&text, unit);
        assert!(good && about(&said, unit).is_empty(), "{said}");
        let broken = text.replace("NoNewPrivileges=yes", "NoNewPrivileges=perhaps");
        assert_ne!(broken, text);
        let (_, said) = verified(&broken, unit);
        assert!(about(&said, unit).iter().any(|line| line.contains("perhaps")), "{said}");
    }
}

/// What udev says of a rule, by reading all rules for a device that every machine has.
fn read_by_udev(text: &str, name: &str) -> String {
    let folder = Path::new("/run/udev/rules.d");
    fs::create_dir_all(folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    let output = Command::new("udevadm").args(["test", "/sys/devices/virtual/mem/null"]).output().unwrap();
    fs::remove_file(&path).unwrap();
    String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout)
}

#[test]
fn udev_understands_the_rule_and_a_broken_one_is_noticed() {
    let root = fs::metadata("/proc/self").is_ok_and(|m| std::os::unix::fs::MetadataExt::uid(&m) == 0);
    if !root {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "udev rules are read from /run by root only");
        eprintln!("NOT RUN: udev rules are read from /run by root only");
        return;
    }
    if !is_there("udevadm") {
        return;
    }
    let text = fs::read_to_string(dist("60-racbot.rules")).unwrap();
    let said = read_by_udev(&text, "60-racbot-dist-test.rules");
    assert!(said.contains("Reading rules file: /run/udev/rules.d/60-racbot-dist-test.rules"), "{said}");
    let complaint = "60-racbot-dist-test.rules:";
    let complaints: Vec<&str> = said.lines().filter(|line| line.contains(complaint)).collect();
    assert!(complaints.is_empty(), "{complaints:?}");
    let broken = text.replace("ATTR{vendor}==", "ATRR{vendor}==");
    assert_ne!(broken, text);
    let said = read_by_udev(&broken, "60-racbot-dist-test.rules");
    assert!(said.lines().any(|line| line.contains(complaint)), "{said}");
}

/// The rule's ids are those that the driver looks for.
#[test]
fn the_rule_matches_the_card_that_the_driver_finds() {
    let ids = driver::pci::Ids::MESA_4I65;
    let text = fs::read_to_string(dist("60-racbot.rules")).unwrap();
    for (attribute, id) in [
        ("vendor", ids.vendor),
        ("device", ids.device),
        ("subsystem_vendor", ids.subsystem_vendor),
        ("subsystem_device", ids.subsystem_device),
    ] {
        assert!(text.contains(&format!("ATTR{{{attribute}}}==\"0x{id:04x}\"")), "{attribute}");
    }
}

/// A rule for one action is not run by another: what the notes say to type makes the action of the rule.
#[test]
fn the_printed_trigger_runs_the_rule() {
    let rule = fs::read_to_string(dist("60-racbot.rules")).unwrap();
    let notes = fs::read_to_string(dist("INSTALL.md")).unwrap();
    let wanted = rule.split("ACTION==\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
    let command = notes.split("udevadm trigger").nth(1).and_then(|rest| rest.lines().next()).unwrap();
    // udevadm's own action is "change".
    let made = command.split("--action=").nth(1).and_then(|rest| rest.split_whitespace().next()).unwrap_or("change");
    assert_eq!(made, wanted);
}

/// Nothing that the notes install stays where they take it off, but for what is the owner's.
#[test]
fn what_is_installed_is_taken_off() {
    let notes = fs::read_to_string(dist("INSTALL.md")).unwrap();
    let (on, off) = notes.split_once("**Taking it off.**").unwrap();
    let mut places = 0;
    for line in on.lines().filter(|line| line.contains("sudo install ") && !line.contains(" /etc/racbot/")) {
        let words = line.split_whitespace().map(|word| word.trim_matches(['`', ',']));
        let words: Vec<&str> = words.skip_while(|word| *word != "install").skip(1).collect();
        let end = words.iter().position(|word| word.starts_with('/')).unwrap();
        let place = words[end];
        let (folder, _) = place.rsplit_once('/').unwrap();
        for file in words[..end].iter().filter(|word| word.contains(['/', '.'])) {
            let name = file.rsplit('/').next().unwrap();
            let whole = if place.ends_with('/') { format!("{place}{name}") } else { place.to_owned() };
            let gone = |path: &str| off.split_whitespace().any(|word| word == path);
            assert!(gone(&whole) || gone(folder), "{whole} stays");
            places += 1;
        }
    }
    assert!(places > 6, "{places} of what is installed");
}

/// The unit's command, as systemd hands it to the shell, on the built-in card: a drive can be started again.
#[test]
fn a_drive_that_is_started_twice_is_recorded_twice() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    for name in ["etc", "var", "bin"] {
        fs::create_dir(place(name)).unwrap();
    }
    fs::write(place("etc/square.csv"), "1,0,1,0\n").unwrap();
    fs::copy(dist("../data/robot.toml"), place("etc/robot.toml")).unwrap();
    // Time that passes from start to start without waiting for it.
    fs::write(place("bin/date"), "#!/bin/sh\necho $$\n").unwrap();
    Command::new("chmod").arg("755").arg(place("bin/date")).status().unwrap();
    let unit = fs::read_to_string(dist("racbot-drive@.service")).unwrap();
    let line = unit.lines().find_map(|line| line.strip_prefix("ExecStart=/bin/sh -c '")?.strip_suffix('\'')).unwrap();
    let built_in = format!("{} drive --card virtual --limit-s 0.1", env!("CARGO_BIN_EXE_racbot"));
    let text = line
        .replace("/usr/local/bin/racbot drive", &built_in)
        .replace("/etc/racbot", &place("etc").display().to_string())
        .replace("/var/lib/racbot", &place("var").display().to_string())
        .replace("%i", "square")
        .replace("%%", "%")
        .replace("$$", "$");
    let path = format!("{}:{}", place("bin").display(), std::env::var("PATH").unwrap());
    for _ in 0..2 {
        let output = Command::new("/bin/sh").args(["-c", &text]).env("PATH", &path).output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
    }
    let files: Vec<_> = fs::read_dir(place("var")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(files.iter().filter(|f| f.to_string_lossy().ends_with(".mcap")).count(), 2, "{files:?}");
}

fn release(folder: &Path, arguments: &[&str]) -> std::process::Output {
    Command::new(dist("release.sh")).args(arguments).current_dir(folder).output().unwrap()
}

fn said(output: &std::process::Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// The command that is tested stands for both of the archive's: building them takes minutes and is a stage of test.sh.
#[test]
fn the_release_archive_is_whole_and_the_same_twice() {
    let folder = tempfile::tempdir().unwrap();
    let command = env!("CARGO_BIN_EXE_racbot");
    let make = |out: &str| {
        let made = release(folder.path(), &["--out", out, "--pc", command, "--robot", command]);
        assert!(made.status.success(), "{}", said(&made));
        folder.path().join(said(&made).trim())
    };
    let archive = make("a");
    assert_eq!(fs::read(&archive).unwrap(), fs::read(make("b")).unwrap(), "two archives of the same differ");
    let run = |program: &str, arguments: &[&str], place: &Path| {
        let output = Command::new(program).args(arguments).current_dir(place).output().unwrap();
        assert!(output.status.success(), "{program}: {}", said(&output));
        said(&output)
    };
    let name = archive.file_name().unwrap().to_str().unwrap();
    run("sha256sum", &["-c", &format!("{name}.sha256")], &folder.path().join("a"));
    run("tar", &["-xzf", archive.to_str().unwrap()], folder.path());
    let root = folder.path().join(name.strip_suffix(".tar.gz").unwrap());
    run("sha256sum", &["--quiet", "-c", "SHA256SUMS"], &root);
    let listed = fs::read_to_string(root.join("SHA256SUMS")).unwrap().lines().count();
    let there = run("find", &[".", "-type", "f"], &root).lines().count();
    assert_eq!(listed + 1, there, "files without a checksum");
    for file in [
        "robot/rac4i65.bit",
        "robot/racbot-load.service",
        "robot/60-racbot.rules",
        "share/man/man1/racbot-gap.1",
        "share/completions/racbot.zsh",
        "LICENSE-MIT",
    ] {
        assert!(fs::metadata(root.join(file)).is_ok_and(|f| f.len() > 100), "{file}");
    }
    // What README, the book and the notes point to is there, but for what only the sources have.
    for page in ["README.md", "docs/book/src/SUMMARY.md", "docs/book/src/gap.md", "docs/book/src/calibration.md"] {
        let text = fs::read_to_string(root.join(page)).unwrap();
        let links = text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
        let ours: Vec<&str> = links.filter(|link| !link.is_empty() && !link.contains("://")).collect();
        assert!(!ours.is_empty());
        for link in ours {
            let there = root.join(page).parent().unwrap().join(link);
            assert!(there.exists(), "{page}: {link} is not in the archive");
        }
    }
    let notes = fs::read_to_string(root.join("robot/INSTALL.md")).unwrap();
    for file in notes.split("dist/").skip(1).filter_map(|rest| rest.split([' ', '`']).next()) {
        assert!(file == "release.sh" || root.join("robot").join(file).exists(), "INSTALL.md: {file}");
    }
    assert!(run("robot/racbot", &["--version"], &root).starts_with("racbot 0."));
    let checked = run("bin/racbot", &["load", "--check", "robot/rac4i65.bit"], &root);
    assert!(checked.contains("2s200"), "{checked}");
    let pages: Vec<String> = run("ls", &["share/man/man1"], &root).lines().map(str::to_owned).collect();
    assert!(pages.len() > 20, "{pages:?}");
}

#[test]
fn a_release_with_wrong_words_makes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, what) in [(&["--zip", "x"][..], "--zip: unknown"), (&["--out"], "its value is missing")] {
        let refused = release(folder.path(), arguments);
        assert!(refused.status.code() == Some(2) && said(&refused).contains(what), "{}", said(&refused));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
