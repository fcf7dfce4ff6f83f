//! `racbot vision`: pictures of an on-board camera.

use super::racbot;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// A ball on a carpet as a binary PPM cannot be read, so a PNG by hand: stored blocks, no compression.
fn picture(file: &Path, colour: impl Fn(f64, f64) -> [u8; 3]) {
    let (width, height) = (96_u32, 64_u32);
    let mut rows = Vec::new();
    for y in 0..height {
        rows.push(0);
        for x in 0..width {
            rows.extend(colour(f64::from(x) + 0.5, f64::from(y) + 0.5));
        }
    }
    let mut zlib = vec![0x78, 0x01];
    let (mut a, mut b) = (1_u32, 0_u32);
    for byte in &rows {
        a = (a + u32::from(*byte)) % 65_521;
        b = (b + a) % 65_521;
    }
    let blocks: Vec<&[u8]> = rows.chunks(60_000).collect();
    for (i, block) in blocks.iter().enumerate() {
        let length = block.len() as u16;
        zlib.push(u8::from(i + 1 == blocks.len()));
        zlib.extend(length.to_le_bytes());
        zlib.extend((!length).to_le_bytes());
        zlib.extend(*block);
    }
    zlib.extend(((b << 16) | a).to_be_bytes());
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    header.extend([8, 2, 0, 0, 0]);
    for (kind, data) in [(b"IHDR", &header), (b"IDAT", &zlib), (b"IEND", &Vec::new())] {
        let body = [kind.as_slice(), data].concat();
        png.extend((data.len() as u32).to_be_bytes());
        png.extend(&body);
        png.extend(crc32(&body).to_be_bytes());
    }
    fs::write(file, png).unwrap();
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

/// A shaded orange disc on green with a little texture.
fn field(x: f64, y: f64) -> [u8; 3] {
    let (u, v) = ((x - 40.0) / 9.0, (y - 38.0) / 9.0);
    let grain = ((x * 7.3).sin() * (y * 5.1).cos() * 6.0) as i16;
    let base: [i16; 3] = if y < 12.0 {
        [150, 150, 155]
    } else if u * u + v * v < 1.0 {
        let light = 1.0 - 0.25 * v;
        [light * 205.0, light * 95.0, light * 30.0].map(|c| c as i16)
    } else {
        [40, 120, 55]
    };
    base.map(|c| (c + grain).clamp(0, 255) as u8)
}

#[test]
fn a_ball_is_found_and_bad_files_are_named_without_stopping_the_rest() {
    let folder = tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    picture(&at("a.png"), field);
    picture(&at("b.png"), |_, _| [3, 2, 4]);
    fs::write(at("c.jpg"), b"\xff\xd8\xff\xe0cut").unwrap();
    fs::write(at("d.txt"), "no picture").unwrap();
    let outcome = racbot(folder.path(), &["--json", "vision", "detect", "."]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let list = outcome.json();
    assert_eq!(list.as_array().unwrap().len(), 3, "{list}");
    let ball = &list[0]["balls"][0];
    let near = |key: &str, value: f64| (ball[key].as_f64().unwrap() - value).abs() < 1.5;
    assert!(near("x", 40.0) && near("y", 38.0) && near("width", 18.0) && near("height", 18.0), "{ball}");
    assert!(ball["score"].as_f64().unwrap() > 0.3 && list[0]["file"].as_str().unwrap().ends_with("a.png"));
    assert!(list[1]["error"].as_str().unwrap().contains("black"), "{list}");
    assert!(list[2]["error"].as_str().unwrap().contains("cut off"), "{list}");
    assert!(
        outcome.stderr.contains("b.png: ") && outcome.stderr.contains("1 more of 3 pictures"),
        "{}",
        outcome.stderr
    );

    let one = racbot(folder.path(), &["vision", "detect", "a.png", "--json"]).done();
    assert_eq!(one.json()[0]["file"], "a.png");
    racbot(folder.path(), &["vision", "detect", "a.png"]).done().fits_80_columns();
    let frozen = racbot(folder.path(), &["vision", "detect", "--sequence", "a.png", "a.png", "--json"]);
    assert!(frozen.json()[1]["error"].as_str().unwrap().contains("frozen"));
}

#[test]
fn no_file_or_folder_of_whatever_kind_costs_the_others_their_results() {
    let folder = tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for nested in ["empty", "nest/deeper", "nest/dir.png"] {
        fs::create_dir_all(at(nested)).unwrap();
    }
    picture(&at("good.png"), field);
    picture(&at("nest/deeper/ball.png"), field);
    fs::write(at("nest/nothing.jpg"), []).unwrap();
    fs::write(at("text.png"), "no picture").unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        std::os::unix::fs::symlink("nowhere", at("nest/dangling.png")).unwrap();
        std::os::unix::fs::symlink("..", at("nest/circle")).unwrap();
        fs::copy(at("good.png"), folder.path().join(std::ffi::OsStr::from_bytes(b"nest/\xff.png"))).unwrap();
    }
    let inputs = ["text.png", "missing.png", "empty", "nest", "/dev/null", "good.png"];
    let outcome = racbot(folder.path(), &[&["vision", "detect", "--json"], &inputs[..]].concat());
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let list = outcome.json();
    let seen: Vec<(&str, String, usize)> = list
        .as_array()
        .unwrap()
        .iter()
        .map(|one| {
            let error = one["error"].as_str().unwrap_or_default().to_owned();
            (one["file"].as_str().unwrap(), error, one["balls"].as_array().unwrap().len())
        })
        .collect();
    let is = |file: &str, what: &str, balls: usize| {
        let found = seen.iter().any(|(name, error, count)| *name == file && error.contains(what) && *count == balls);
        assert!(found, "{file}: {what}\n{seen:?}");
    };
    is("text.png", "neither PNG nor JPEG", 0);
    is("missing.png", "cannot be read", 0);
    is("empty", "no pictures in this folder", 0);
    is("nest/deeper/ball.png", "", 1);
    is("nest/nothing.jpg", "cut off", 0);
    is("good.png", "", 1);
    if cfg!(unix) {
        is("/dev/null", "not a regular file", 0);
        is("nest/dangling.png", "cannot be read", 0);
        is("nest/\u{fffd}.png", "", 1);
        assert_eq!(seen.len(), 9, "{seen:?}");
    }
}

#[test]
fn folders_without_pictures_and_impossible_scores_are_refused() {
    let folder = tempdir().unwrap();
    let empty = racbot(folder.path(), &["vision", "detect", ".", "--json"]);
    assert!(empty.code == Some(1) && empty.stderr.contains("no pictures"), "{}", empty.stderr);
    assert!(empty.json()[0]["error"].as_str().unwrap().contains("no pictures"));
    racbot(folder.path(), &["vision", "detect", "x.png", "--least", "2"]).refused(2, &["from 0 to 1"]);
    let missing = racbot(folder.path(), &["vision", "detect", "nowhere.png"]);
    assert!(missing.code == Some(1) && missing.stderr.contains("nowhere.png: "), "{}", missing.stderr);
}

/// How well the poses are is measured in `simulator::blackout`, which knows the truth.
#[test]
fn an_on_board_camera_gives_a_drive_its_poses_and_its_options_are_checked() {
    let folder = tempdir().unwrap();
    let run = |arguments: &[&str]| racbot(folder.path(), arguments);
    fs::write(folder.path().join("there.csv"), "1.2,0.6,1,0,stop\n0.2,1.0,1,0,stop\n").unwrap();
    let drive = ["drive", "--card", "virtual", "--setpoints", "there.csv", "--skew-deg", "4,4,4", "--json"];
    let seen = run(&[&drive[..], &["--vision", "onboard", "--record", "seen/a.csv"]].concat()).done().json();
    assert_eq!(seen["ended"], "finished", "{seen}");
    let log = runs::Run::read(folder.path().join("seen/a.csv")).unwrap();
    assert!(log.camera.len() > 5, "{} poses", log.camera.len());

    fs::write(folder.path().join("field.toml"), "length = 9\nwidth = 6000\n").unwrap();
    let with = |more: &[&str]| run(&[&drive[..7], more].concat());
    with(&["--vision", "onboard", "--field", "field.toml"]).refused(1, &["field.toml:2:1: width: 6000 m"]);
    with(&["--vision", "onboard", "--camera"]).refused(2, &["--camera"]);
    with(&["--vision", "onboard", "--real-time"]).refused(2, &["--real-time"]);
    with(&["--vision", "onboard", "--frames", "."]).refused(2, &["--frames is for a real robot"]);
    fs::write(folder.path().join("lens.toml"), "width = 320\n").unwrap();
    with(&["--vision", "onboard", "--lens", "lens.toml"]).refused(1, &["lens.toml:1:1: missing field `height`"]);
}

/// A robot that was told a wrong start: it notices, stops, turns round, finds its place and drives on; or says that it cannot.
#[test]
fn a_robot_that_is_not_where_it_was_told_finds_its_place_or_stays_where_it_is() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("there.csv"), "3.4,0.6,1,0,stop\n2.2,-1.0,1,0,stop\n").unwrap();
    let drive = ["drive", "--card", "virtual", "--setpoints", "there.csv", "--vision", "onboard", "--json"];
    let told = |start: &str, stands: &str| {
        racbot(folder.path(), &[&drive[..], &["--start", start, "--stands", stands]].concat())
    };
    let found = told("2.4,-1.2,0", "3.44,-0.7,20").done().json();
    let number = |name: &str, i: usize| found[name][i].as_f64().unwrap();
    let off = (number("stands", 0) - 2.2).hypot(number("stands", 1) + 1.0);
    assert!(found["looked_round"] == 1 && off < 0.05, "{off} m: {found}");

    // Far from every line the wheels are all that it has, and soon too little.
    fs::write(folder.path().join("wide.toml"), "length = 60\nwidth = 60\n").unwrap();
    fs::write(folder.path().join("there.csv"), "16,10,1,0,stop\n").unwrap();
    let lost = racbot(folder.path(), &[&drive[..], &["--field", "wide.toml", "--start", "10,10,0"]].concat());
    assert!(
        lost.code == Some(1) && lost.stderr.contains("lost: the place is known"),
        "{} {}",
        lost.stdout,
        lost.stderr
    );
    let json = lost.json();
    let way = json["stands"][0].as_f64().unwrap() - 10.0;
    assert!(json["outputs_off"] == true && (1.0..3.0).contains(&way), "{json}");
    racbot(folder.path(), &[&drive[..], &["--sure-m", "0"]].concat()).refused(2, &["--sure-m: give metres above 0"]);
}

#[test]
fn a_start_without_overhead_camera_leaves_runs_pictures_and_a_page() {
    let folder = tempdir().unwrap();
    let json = racbot(folder.path(), &["simulate", "--smart", "--seed", "0", "--out", "smart", "--json"]).done().json();
    let camera = &json["outcomes"][2];
    assert!(camera["off_m"].as_f64().unwrap() < 0.05 && camera["ball_m"].as_f64().unwrap() < 0.05, "{json}");
    let page = fs::read_to_string(folder.path().join("smart/report.html")).unwrap();
    assert!(page.contains("<ellipse") && page.contains("pictures/0000.jpg"));
    assert!(fs::read(folder.path().join("smart/pictures/0000.jpg")).unwrap().starts_with(b"\xff\xd8"));
    assert!(runs::Run::read(folder.path().join("smart/leg-1.csv")).unwrap().len() > 100);
    let again = racbot(folder.path(), &["simulate", "--smart", "--out", "smart"]);
    assert!(again.code == Some(1) && again.stderr.contains("report.html"), "{}", again.stderr);
    racbot(folder.path(), &["simulate", "--smart", "--controller", "paper"]).refused(2, &["--smart"]);
}
