use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use super::super::{Imported, Map};
use crate::frames::{Pose, Twist};

const COLUMNS: &str = "[columns]\nenc_1 = \"a\"\nenc_2 = \"b\"\n";
const POSE: &str = "[truth.columns]\ncam_x = \"x\"\ncam_y = \"y\"\ncam_theta = \"yaw\"\n";

/// The same two files for every map.
struct Files(tempfile::TempDir);

impl Files {
    fn new(log: &str, truth: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("log_1.csv"), log).unwrap();
        std::fs::write(folder.path().join("mocap_1.csv"), truth).unwrap();
        Self(folder)
    }

    fn import(&self, truth: &str, columns: &str) -> Result<Imported, String> {
        let map = format!("{COLUMNS}[truth]\nfile = \"mocap_{{number}}.csv\"\n{truth}\n{columns}");
        let map = Map::parse(&map, Path::new("map.toml")).map_err(|e| e.to_string())?;
        map.import(&self.0.path().join("log_1.csv"), None).map_err(|e| e.to_string())
    }
}

/// Twist of a drive of 24 s that never does the same twice.
fn twist(t: f64) -> Twist {
    let gate = |from: f64, to: f64| f64::from(u8::from((from..to).contains(&t)));
    Twist::new(
        0.0,
        0.4 * gate(1.0, 4.0) - 0.3 * gate(7.0, 9.5) + 0.2 * gate(12.0, 20.0),
        1.2 * gate(5.0, 6.5) - 0.7 * gate(8.5, 14.0) + 0.5 * gate(15.0, 16.0),
    )
}

/// Counts of two wheels at `log_hz`, and poses at `pose_hz` from `from_s` on whose clock shows `shift_s` more, with
/// millimetres of noise.
fn drive(log_hz: f64, pose_hz: f64, from_s: f64, shift_s: f64) -> (String, String) {
    let (mut log, mut truth) = ("t,a,b\n".to_owned(), "t,x,y,yaw\n".to_owned());
    let (mut pose, mut ways) = (Pose::default(), [0.0_f64; 2]);
    let (mut next, mut seen) = ([0.0, from_s], 0_u32);
    let step = 5e-4;
    for k in 0..48_000 {
        let t = f64::from(k) * step;
        if t >= next[0] {
            let _ = writeln!(log, "{t:.4},{},{}", (5e3 * ways[0]).round(), (5e3 * ways[1]).round());
            next[0] += log_hz.recip();
        }
        if t >= next[1] {
            seen += 1;
            let noise = 1e-3 * (f64::from(seen) * 12.9898).sin() * (f64::from(seen) * 3.7).cos();
            let yaw = (pose.theta + PI).rem_euclid(2.0 * PI) - PI;
            let _ = writeln!(truth, "{:.4},{},{},{yaw}", t + shift_s, pose.x + noise, pose.y - noise);
            next[1] += pose_hz.recip();
        }
        let now = twist(t);
        pose = pose.advance(now, step);
        ways = [ways[0] + step * (now.vy + 0.1 * now.omega), ways[1] + step * (now.vy - 0.1 * now.omega)];
    }
    (log, truth)
}

#[test]
fn poses_are_ticks_of_their_own_between_the_rows() {
    let log = "t,a,b\n10.00,1,2\n10.02,3,4\n10.04,5,6\n";
    let truth = "t,x,y,yaw\n9.99,9,9,0\n10.00,1,0,0\n10.005,2,0,0\n10.03,3,,0\n10.035,4,0,0\n10.035,5,0,0\n10.05,9,9,0\n10.06,9,9,0\n";
    let files = Files::new(log, truth);
    let Imported { run, joined, .. } = files.import("", POSE).unwrap();
    assert_eq!(run.t, [0.0, 0.005, 0.02, 0.035, 0.04]);
    assert_eq!(run.counts, [[1, 1, 3, 3, 5], [2, 2, 4, 4, 6]]);
    assert_eq!(run.count_gaps, [[1, 3], [1, 3]]);
    let camera: Vec<(usize, f64)> = run.camera.iter().map(|s| (s.tick, s.pose.x)).collect();
    assert_eq!(camera, [(0, 1.0), (1, 2.0), (3, 5.0)]);
    let joined = joined.unwrap();
    assert_eq!((joined.outside, joined.incomplete, joined.alike, joined.offset_s), ([1, 2], 1, 1, 0.0));
    // As one file with both would have it.
    let whole = "t,a,b,x,y,yaw\n10,1,2,1,0,0\n10.005,,,2,0,0\n10.02,3,4,,,\n10.035,,,5,0,0\n10.04,5,6,,,\n";
    let map = format!("{COLUMNS}{}", POSE.replace("[truth.columns]\n", ""));
    let table = super::super::Table::of_bytes(whole.as_bytes(), Path::new("x.csv"), None, &Default::default()).unwrap();
    assert_eq!(Map::parse(&map, Path::new("m")).unwrap().run(&table, Path::new("x.csv")).unwrap(), run);
}

#[test]
fn clocks_are_brought_together_as_the_map_says() {
    let (log, truth) = drive(50.0, 360.0, 0.25, 1.6e9);
    let files = Files::new(&log, &truth);
    let apart = files.import("", POSE).unwrap_err();
    for part in [
        "mocap_1.csv: truth.clock: its times, 1600000000.250 to 1600000023.9",
        "0.000 to 23.980 s",
        "clock = \"own\"",
        "offset_s",
    ] {
        assert!(apart.contains(part), "no {part:?} in {apart}");
    }
    let shifted = files.import("offset_s = -1.6e9", POSE).unwrap();
    let joined = shifted.joined.unwrap();
    assert_eq!((joined.offset_s, joined.apart_s, joined.outside[0]), (-1.6e9, None, 0));
    // All but what came after the last row of the log, within one of its steps.
    assert!(shifted.run.camera.len() + 8 >= truth.lines().count() - 1, "{}", shifted.run.camera.len());
    let own = files.import("clock = \"own\"", POSE).unwrap().joined.unwrap();
    assert!((own.offset_s + 1.6e9 + 0.25).abs() < 1e-6 && own.apart_s.is_none(), "{own:?}");
    // What `gap` would not find is said.
    let off = files.import("clock = \"own\"\noffset_s = 2", POSE).unwrap().joined.unwrap();
    assert!((off.apart_s.unwrap() + 1.75).abs() < 0.02, "{off:?}");
    // Epoch nanoseconds that are taken for seconds.
    let lasts = files.import("[truth.time]\nunit = \"ms\"", POSE).unwrap_err();
    assert!(lasts.contains("the log lasts about 1000 times as long"), "{lasts}");
}

#[test]
fn the_motion_tells_the_offset_whatever_the_rates() {
    for (log_hz, pose_hz, from_s, shift_s, within) in
        [(50.0, 360.0, 3.0, 1.6e9, 0.005), (1000.0, 5.0, 0.0, -40.0, 0.03), (100.0, 100.0, 0.7, 3.3, 0.005)]
    {
        let (log, truth) = drive(log_hz, pose_hz, from_s, shift_s);
        let Imported { run, joined, .. } = Files::new(&log, &truth).import("clock = \"match\"", POSE).unwrap();
        let joined = joined.unwrap();
        let found = joined.matched.unwrap();
        assert!((joined.offset_s + shift_s).abs() < within, "{log_hz} {pose_hz}: {joined:?}");
        assert!(found.share > 0.9 && found.rival < 0.8, "{found:?}");
        assert!(run.camera.len() as f64 > 0.95 * (24.0 - from_s) * pose_hz, "{}", run.camera.len());
    }
}

#[test]
fn what_the_motion_does_not_tell_is_refused() {
    let said = |log: &str, truth: &str| Files::new(log, truth).import("clock = \"match\"", POSE).unwrap_err();
    let (log, truth) = drive(50.0, 60.0, 0.0, 5.0);
    // Another drive: the same poses backwards.
    let rows: Vec<&str> = truth.lines().skip(1).collect();
    let times = rows.iter().map(|row| row.split_once(',').unwrap().0);
    let backwards: Vec<String> =
        times.zip(rows.iter().rev()).map(|(t, row)| format!("{t},{}", row.split_once(',').unwrap().1)).collect();
    let other = said(&log, &format!("t,x,y,yaw\n{}\n", backwards.join("\n")));
    assert!(other.contains("truth.clock: the motion does not tell how the clocks stand"), "{other}");
    // Nothing moves.
    let still: String = (0..400).map(|k| format!("{},0,0,0\n", 0.05 * f64::from(k))).collect();
    assert!(said(&log, &format!("t,x,y,yaw\n{still}")).contains("too little of it moves"));
    // The same every 2 s.
    let (mut log, mut truth) = ("t,a,b\n".to_owned(), "t,x,y,yaw\n".to_owned());
    for k in 0..1_000 {
        let t = 0.02 * f64::from(k);
        let way = 0.2 * (PI * t).sin();
        let _ = writeln!(log, "{t},{0},{0}", (1e4 * way).round());
        let _ = writeln!(truth, "{t},0,{way},0");
    }
    let twice = said(&log, &truth);
    assert!(twice.contains("fit about as well, as where a drive repeats itself"), "{twice}");
}

#[test]
fn maps_that_cannot_be_meant_are_refused_with_their_place() {
    let files = Files::new("t,a,b\n0,1,2\n1,2,3\n", "t,x,y,yaw\n0,1,2,3\n1,,2,3\n");
    for (truth, columns, parts) in [
        ("clok = 1", POSE, &["map.toml:6:1", "unknown field `clok`"][..]),
        ("clock = \"gps\"", POSE, &["unknown variant `gps`, expected one of `same`, `own`, `match`"]),
        ("clock = \"match\"\noffset_s = 1", POSE, &["truth.offset_s"]),
        ("format = \"xls\"", POSE, &["map.toml: truth.format: \"xls\" is no format"]),
        ("[truth.time]\nkeep = true", POSE, &["truth.time.keep: the run has the log's time"]),
        ("[truth.time]\nunit = \"h\"", POSE, &["truth.time.unit: \"h\" is no unit of time"]),
        ("", "[truth.columns]\nenc_1 = \"x\"", &["truth.columns.enc_1: the second file has the pose alone"]),
        ("", "[truth.columns]\ncam_z = \"x\"", &["truth.columns.cam_z: is no column of a run"]),
        ("", "[truth.columns]\ncam_x = \"x\"", &["mocap_1.csv: cam_y: no such column in the map"]),
        (
            "",
            &POSE.replace("\"yaw\"", "\"jaw\""),
            &["mocap_1.csv: cam_theta: has no series \"jaw\"", "did you mean yaw"],
        ),
        ("", "", &["mocap_1.csv: none of its series is a column of ours: name them in [truth.columns]"]),
    ] {
        let error = files.import(truth, columns).unwrap_err();
        parts.iter().for_each(|part| assert!(error.contains(part), "no {part:?} in {error}"));
    }
    let both = Map::parse("[columns]\ncam_x = \"x\"\n[truth]\n", Path::new("map.toml")).unwrap_err().to_string();
    assert!(both.contains("the pose is in two files: cam_x is in [columns], too"), "{both}");
    let log = files.0.path().join("log_1.csv");
    let unnamed = Map::parse("[truth]\n", Path::new("map.toml")).unwrap().import(&log, None).unwrap_err().to_string();
    assert!(unnamed.contains("map.toml: truth.file: the map does not say which file"), "{unnamed}");
    let none = Map::parse(COLUMNS, Path::new("map.toml")).unwrap().import(&log, Some(&log)).unwrap_err().to_string();
    assert!(none.contains("has no [truth]"), "{none}");
}

#[test]
fn positions_alone_are_joined_where_the_clocks_are_known() {
    let log: String = (0..40).map(|k| format!("{},{k},{k}\n", 0.1 * f64::from(k))).collect();
    let seen: String =
        (0..12).map(|k| format!("{},{},0.5,\n", 0.05 + 0.3 * f64::from(k), 0.1 * f64::from(k))).collect();
    let files = Files::new(&format!("t,a,b\n{log}"), &format!("t,x,y,yaw\n{seen}"));
    let columns = "[truth.columns]\ncam_x = \"x\"\ncam_y = \"y\"\n";
    let run = files.import("clock = \"same\"", columns).unwrap().run;
    assert_eq!(run.camera.len(), 12);
    assert!(run.camera.iter().all(|sample| sample.pose.y == 0.5 && sample.pose.theta.is_nan()));
    let error = files.import("clock = \"match\"", columns).unwrap_err();
    assert!(error.contains("positions without headings do not tell how the clocks stand"), "{error}");
}
