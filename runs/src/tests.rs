use super::*;
use crate::robot::Robot;
use proptest::prelude::*;
use std::path::{Path, PathBuf};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data/runs").join(name)
}

fn read(text: &str) -> Result<Run, RunError> {
    Run::from_reader(text.as_bytes(), Path::new("run.csv"))
}

fn error(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

#[test]
fn the_shipped_set_is_read_whole() {
    let set = DataSet::open(data("wheel-skew")).unwrap();
    let names: Vec<&str> = set.runs.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names, ["run_01", "run_02", "run_03", "run_04"]);
    let run = &set.runs[0];
    assert_eq!((run.wheel_count(), run.len()), (3, run.counts[2].len()));
    assert_eq!(run.camera[0].tick, 1);
    assert_eq!(run.camera[0].pose, Pose::new(-0.0131, -0.2377, -2.4267));
    assert!((run.tick_s().unwrap() - 0.001).abs() < 1e-12);
    assert!((run.camera.len() as f64 / run.duration_s() - 60.0).abs() < 1.0);
}

#[test]
fn writing_and_reading_gives_the_same_run() {
    let run = Run::read(data("wheel-skew").join("run_01.csv")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run_01.csv");
    run.write(&path).unwrap();
    assert_eq!(Run::read(&path).unwrap(), run);
}

#[test]
fn columns_in_any_order_unknown_ones_kept_gaps_kept() {
    let text = "note,enc_2,t,enc_1,supply_v\n\"a, b\",,0,,7\nc,5,0.5,,\n,6,1,3,7.1\n,7,2,,7\n";
    let run = read(text).unwrap();
    assert_eq!(run.counts, [[3, 3, 3, 3], [5, 5, 6, 7]]);
    assert_eq!(run.count_gaps, [vec![0, 1, 3], vec![0]]);
    assert_eq!(run.other, [("note".to_owned(), vec!["a, b".into(), "c".into(), String::new(), String::new()])]);
    assert!(run.supply_v.as_ref().unwrap()[1].is_nan());
    assert!(run.reference.is_empty() && run.command.is_none() && !run.has_camera);
    let mut written = Vec::new();
    run.write_to(&mut written).unwrap();
    let again = String::from_utf8(written).unwrap();
    assert_eq!(again, "t,enc_1,enc_2,supply_v,note\n0,,,7,\"a, b\"\n0.5,,5,,c\n1,3,6,7.1,\n2,,7,7,\n");
}

#[test]
fn counts_between_two_samples_lie_on_a_line() {
    let run = read("t,enc_1\n0,\n1,10\n1.5,\n2,\n3,16\n4,\n").unwrap();
    assert_eq!(run.cumulative(0), [0.0, 0.0, 1.5, 3.0, 6.0, 6.0]);
}

#[test]
fn windows_files_blanks_and_a_missing_last_line_end_are_accepted() {
    let run = read("\u{feff}t, enc_1\r\n0 , 1\r\n\r\n1,2.0").unwrap();
    assert_eq!((run.t, run.counts), (vec![0.0, 1.0], vec![vec![1, 2]]));
}

#[test]
fn lines_of_one_time_are_one_tick_where_no_field_stands_twice() {
    let run = read("t,enc_1,duty_1,gyro_z\n0,5,,\n0,,0.5,\n0.01,,0.6,1\n0.02,7,,\n0.02,,,2\n0.03,,0.7,\n").unwrap();
    assert_eq!(run.t, [0.0, 0.01, 0.02, 0.03]);
    assert_eq!((run.counts[0].clone(), run.count_gaps[0].clone()), (vec![5, 5, 7, 7], vec![1, 3]));
    assert_eq!(run.duty[0][0], 0.5);
    assert!(run.duty[0][2].is_nan());
    assert_eq!(run.gyro.as_ref().unwrap()[2][2], 2.0);
    assert!(run.gyro.as_ref().unwrap()[0].iter().all(|x| x.is_nan()), "an axis nobody logged");
    assert!((run.tick_s().unwrap() - 0.02).abs() < 1e-12, "the encoder's");
    // So it is of what stands in the place of counts.
    for text in [
        "t,speed_1,gyro_z\n0,1,\n0.01,,2\n0.04,,2\n0.05,1,\n0.06,,2\n0.1,2,\n",
        "t,odom_x,odom_y,odom_theta,gyro_z\n0,1,2,3,\n0.01,,,,2\n0.04,,,,2\n0.05,1,2,3,\n0.06,,,,2\n0.1,2,2,3,\n",
    ] {
        assert!((read(text).unwrap().tick_s().unwrap() - 0.05).abs() < 1e-12, "{text}");
    }
    assert!(error("t,enc_1\n0,1\n0,2\n").contains("time 0 s stands twice"));
}

#[test]
fn a_line_that_repeats_the_one_before_is_left_out_and_said() {
    let run =
        read("t,enc_1,duty_1\n0,5,0.1\n0.01,6,0.1\n0.01,6,0.1\n0.02,8,0.2\n0.02,8,0.2\n0.02,8,0.2\n0.03,9,\n").unwrap();
    assert_eq!((run.t, run.counts), (vec![0.0, 0.01, 0.02, 0.03], vec![vec![5, 6, 8, 9]]));
    assert_eq!(run.notes, ["3 lines repeat the line before them and are left out, the first is line 4"]);
    assert_eq!(read("t,enc_1\n0,5\n0,5\n").unwrap().notes, ["line 3 repeats the line before it and is left out"]);
    let once = read("t,enc_1,duty_1\n0,5,\n0,,0.1\n0,,0.1\n0.01,6,\n").unwrap();
    assert_eq!((once.t.len(), once.duty[0][0]), (2, 0.1), "a signal of its own clock, twice");
    assert!(error("t,enc_1,duty_1\n0,5,0.1\n0,5,0.2\n").contains("time 0 s stands twice"));
}

#[test]
fn every_column_survives_writing_and_reading() {
    let names = "t,speed_1,speed_2,current_1,current_2,odom_x,odom_y,odom_theta,gyro_x,gyro_y,gyro_z,acc_x,acc_y,acc_z,\
                 imu_temp";
    let line = |k: u32| format!("{k}{}", (1..15).map(|i| format!(",{}.5", i * k)).collect::<String>());
    let run = read(&format!("{names}\n{}\n{}\n", line(1), line(2))).unwrap();
    assert_eq!((run.wheel_count(), run.speed.len(), run.current[1][1]), (2, 2, 8.5));
    assert_eq!(run.odometry.as_ref().unwrap()[2], [7.5, 14.5]);
    assert_eq!(run.imu_temp.as_ref().unwrap()[0], 14.5);
    let folder = tempfile::tempdir().unwrap();
    for name in ["again.csv", "again.mcap"] {
        let path = folder.path().join(name);
        run.write(&path).unwrap();
        let again = Run { name: String::new(), ..Run::read(&path).unwrap() };
        assert_eq!(again, run, "{name}");
    }
}

#[test]
fn other_spellings_and_separators_are_read_and_said() {
    let run = read("t;Enc_1;enc 2;duty1;Duty_2;ecn_3\n0;1;2;0,5;-0,25;9\n1;2;3;0,5;0;9\n").unwrap();
    assert_eq!((run.counts.len(), run.duty[0][0], run.duty[1][0]), (2, 0.5, -0.25));
    let notes = run.notes.join("; ");
    for part in ["semicolons", "Enc_1 is read as enc_1", "duty1 is read as duty_1", "ecn_3 is not read: if it is enc_3"]
    {
        assert!(notes.contains(part), "{notes}");
    }
    let latin = [&b"t,enc_1,Geschwindigkeit_in_m\xb2\n0,1,2\n"[..]].concat();
    assert_eq!(Run::from_reader(&latin[..], Path::new("r")).unwrap().counts, [[1]]);
    assert!(read("t,enc_1\n0,1\n").unwrap().notes.is_empty());
}

#[test]
fn one_to_many_wheels() {
    for n in 1..=6 {
        let header: Vec<String> = (1..=n).map(|i| format!("duty_{i}")).collect();
        let text = format!("t,{}\n0,{}\n", header.join(","), vec!["0.5"; n].join(","));
        assert_eq!(read(&text).unwrap().wheel_count(), n);
    }
}

#[test]
fn errors_say_where_what_and_what_to_do() {
    let table = [
        ("", "run.csv: is empty; log at least"),
        ("t\n", "run.csv: has a header but no ticks;"),
        ("x,enc_1\n0,1\n", "run.csv:1:1: t: no such column; name the column"),
        ("0.1,0.2\n0,1\n", "run.csv:1:1: t: no such column; the first line must be a header"),
        ("t,t\n0,1\n", "run.csv:1:3: t: stands twice"),
        ("t,enc_1,enc_3\n0,1,1\n", "run.csv:1:1: enc_2: no such column;"),
        ("t,enc_1,enc_2,duty_1\n0,1,1,0\n", "run.csv:1:1: duty_2: no such column; other columns speak of 2"),
        ("t,cam_x,cam_theta\n0,1,1\n", "run.csv:1:1: cam_y: no such column;"),
        (
            "t,cam_x,cam_y,cam_theta\n0,1,1,1\n1,1,1,\n",
            "run.csv:3:1: cam_x, cam_y, cam_theta: a camera sample has only",
        ),
        ("t,enc_1\n0,1\n1,two\n", "run.csv:3:3: enc_1: \"two\" is no whole number;"),
        ("t,enc_1\n0,1\n1,2.5\n", "run.csv:3:3: enc_1: \"2.5\" is no whole number;"),
        ("t,enc_1\n0,1\n1,1e300\n", "run.csv:3:3: enc_1: \"1e300\" is no whole number;"),
        ("t,duty_1\n0,\"0,5\"\n", "run.csv:2:3: duty_1: \"0,5\" is no number; write numbers with a decimal point"),
        ("t,duty_1\n0,NaN\n", "run.csv:2:3: duty_1: NaN is not a finite number; leave the field empty"),
        ("t,duty_1\n0,-inf\n", "run.csv:2:3: duty_1: -inf is not"),
        ("t,duty_1\n0,55\n", "run.csv:2:3: duty_1: duty 55 is not within ±1"),
        ("t\n0\n1\n0.5\n", "run.csv:4:1: t: time runs backwards, from 1 s to 0.5 s;"),
        ("t,enc_1\n0,1\n1,2\n1,3\n", "run.csv:4:1: t: time 1 s stands twice;"),
        ("t,duty_1\n,0\n", "run.csv:2:1: t: is empty;"),
        ("t,duty_1\n0,0,0\n", "run.csv:2:1: 3 fields, but the header has 2; quote"),
        ("t,duty_1\n0\n1,0\n", "run.csv:2:1: 1 fields, but the header has 2; complete the line"),
        ("t,duty_1\n0,0\n1", "run.csv:3:1: 1 fields, but the header has 2; the file ends too early"),
        ("t,cam_x,cam_y,cam_theta\n0,1,,1\n", "run.csv:2:1: cam_x, cam_y, cam_theta: a camera sample has only"),
        ("t,duty_1\r\n0,0\r\n1,x\r\n", "run.csv:3:3: duty_1: \"x\""),
    ];
    for (text, message) in table {
        let shown = error(text);
        assert!(shown.starts_with(message), "{text:?}\n  gave   {shown}\n  not    {message}");
    }
}

#[test]
fn rows_that_arrived_together_are_no_leaping_counter() {
    let refused = |late: bool, leap: i64| {
        let mut text = "t,enc_1,enc_2,enc_3\n".to_owned();
        for row in 0..40_i64 {
            // Rows every 20 ms; of four the first three waited for the last.
            let waited = if late && (20..23).contains(&row) { 23.0 - 0.002 * (23 - row) as f64 } else { row as f64 };
            text += &format!("{:.6},0,{},0\n", 0.02 * waited, 4000 * row + if row >= 22 { leap } else { 0 });
        }
        read(&text).unwrap().check(&Robot::racbot(), Path::new("run.csv")).map_err(|e| e.to_string())
    };
    assert_eq!(refused(false, 0), Ok(()));
    let together = refused(true, 0).unwrap_err();
    assert!(together.contains("come at once, and together they fit; the times are those of arrival"), "{together}");
    for late in [true, false] {
        let leapt = refused(late, 1 << 20).unwrap_err();
        assert!(leapt.contains("look for a counter that was reset"), "{leapt}");
    }
}

#[test]
fn a_line_whose_time_was_taken_after_a_pause_is_named() {
    // 100 counts a millisecond; for 60 ms the logger stands still after it has read the counts of a row.
    let refused = |leap: i64| {
        let mut text = "t,enc_1,enc_2,enc_3\n".to_owned();
        for row in 0..40_i64 {
            let at = |from: i64| row + if row >= from { 60 } else { 0 };
            let counts = 100 * at(21) + if row >= 21 { leap } else { 0 };
            text += &format!("{:.3},0,{counts},0\n", 1e-3 * at(20) as f64);
        }
        read(&text).unwrap().check(&Robot::racbot(), Path::new("run.csv")).unwrap_err().to_string()
    };
    let paused = refused(0);
    assert!(paused.contains("came 61 ms after its own, and together they fit; the logger stood still"), "{paused}");
    assert!(refused(1 << 20).contains("look for a counter that was reset"));
}

#[test]
fn counts_that_jump_further_than_the_wheel_can_turn_are_refused() {
    // No load at 7.2 V: 1040 rad/s at the motor, 339 counts a millisecond.
    let log = |jump: i64| {
        let text = format!("t,enc_1,enc_2,enc_3\n0,0,0,0\n0.001,0,,0\n0.002,0,{jump},0\n");
        read(&text).unwrap().check(&Robot::racbot(), Path::new("run.csv"))
    };
    // 2 ms since the last sample, factor 3.
    assert_eq!(log(2000), Ok(()));
    assert_eq!(log(-2000), Ok(()));
    let e = log(2100).unwrap_err().to_string();
    assert!(e.starts_with("run.csv:4: enc_2: jumps by 2100 counts in 2.000 ms, but the wheel can turn by 2051"), "{e}");
    assert!(log(i64::MAX).is_err() && log(i64::MIN).is_err());
    let two = read("t,enc_1,enc_2\n0,0,0\n").unwrap();
    let e = two.check(&Robot::racbot(), Path::new("run.csv")).unwrap_err().to_string();
    assert!(e.contains("speaks of 2 wheels, but the robot has 3"), "{e}");
    // A counter that is read every second tick, a row of which is lost, is no lost counter; one that stood for long is.
    let held = |ticks: usize, jump: i64| {
        let mut text = "t,enc_1,enc_2,enc_3\n0,0,0,0\n0.001,0,100,0\n".to_owned();
        (0..ticks).for_each(|k| text += &format!("{:.3},0,100,0\n", 0.002 + 1e-3 * k as f64));
        text += &format!("{:.3},0,{},0\n", 0.002 + 1e-3 * ticks as f64, 100 + jump);
        read(&text).unwrap().check(&Robot::racbot(), Path::new("run.csv")).is_ok()
    };
    for (ticks, jump, right) in
        [(0, 1500, false), (1, 1500, true), (3, 4000, true), (50, 4000, true), (50, 5000, false)]
    {
        assert_eq!(held(ticks, jump), right, "{ticks} {jump}");
    }
}

#[test]
fn folders_without_runs_or_robot_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let open = || DataSet::open(folder.path()).unwrap_err().to_string();
    assert!(open().contains("has no robot.toml"));
    Robot::racbot().save(folder.path().join("robot.toml")).unwrap();
    assert!(open().contains("holds no runs"));
    std::fs::write(folder.path().join("run.csv"), "").unwrap();
    assert!(open().contains("run.csv: is empty"));
    assert!(DataSet::open("/nowhere").unwrap_err().to_string().contains("check the path"));
}

proptest! {
    #[test]
    fn no_soup_of_bytes_panics_the_reader(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        let _ = Run::from_reader(&bytes[..], Path::new("soup"));
    }

    #[test]
    fn no_soup_of_tokens_panics_the_reader_and_what_it_accepts_survives(
        tokens in proptest::collection::vec(proptest::sample::select(vec![
            "t", "enc_1", "enc_2", "duty_1", "cam_x", "cam_y", "cam_theta", "note", ",", ",", ",", "\n", "\n", "\r\n",
            "0", "1", "2", "-3", "0.5", "1e9", "nan", "inf", "\"", "\"\"", "é", " ", "9223372036854775807",
        ]), 0..60),
    ) {
        let text = format!("t,enc_1,note\n{}", tokens.concat());
        for text in [tokens.concat(), text] {
            if let Ok(run) = Run::from_reader(text.as_bytes(), Path::new("soup")) {
                let mut written = Vec::new();
                run.write_to(&mut written).unwrap();
                let again = Run::from_reader(&written[..], Path::new("again")).unwrap();
                // NaN stands for "no sample" and is not equal to itself, so the texts are compared.
                let mut twice = Vec::new();
                again.write_to(&mut twice).unwrap();
                prop_assert_eq!(String::from_utf8_lossy(&written), String::from_utf8_lossy(&twice));
                let _ = run.check(&Robot::racbot(), Path::new("soup"));
            }
        }
    }
}

/// Two motors that were logged in turn: each keeps its own ticks alone.
#[test]
fn an_axis_has_the_ticks_at_which_something_is_logged_of_it() {
    let text =
        "t,enc_1,enc_2,duty_1,duty_2,supply_v\n0,1,,0.1,,12\n0.002,,7,,0.2,\n0.01,3,,0.3,,11.9\n0.012,,9,,0.4,\n";
    let run = read(text).unwrap();
    let [first, second] = [0, 1].map(|axis| run.axis(axis));
    assert_eq!((first.t.clone(), first.counts.clone()), (vec![0.0, 0.01], vec![vec![1, 3]]));
    assert_eq!((second.t, second.duty, second.counts), (vec![0.002, 0.012], vec![vec![0.2, 0.4]], vec![vec![7, 9]]));
    assert_eq!((first.supply_v.unwrap(), first.count_gaps), (vec![12.0, 11.9], vec![Vec::new()]));
    // A tick that has something of it stays, and its gap.
    let text = "t,enc_1,enc_2,duty_1,duty_2\n0,1,5,0.1,0\n0.01,,6,0.1,0\n0.02,,7,,0\n";
    let held = read(text).unwrap().axis(0);
    assert_eq!((held.t, held.counts, held.count_gaps), (vec![0.0, 0.01], vec![vec![1, 1]], vec![vec![1]]));
}

#[test]
fn rows_of_a_camera_alone_are_told_from_ticks() {
    let text = "t,enc_1,enc_2,duty_1,duty_2,cam_x,cam_y,cam_theta\n0,1,1,0.1,0.2,,,\n0.013,,,,,0.1,0.2,0.3\n0.02,5,,0.3,0.4,,,\n";
    let run = read(text).unwrap();
    let ticks = run.told_of(0..2, true);
    assert_eq!(ticks, [0, 2]);
    let ticks = run.of_ticks(&ticks);
    assert_eq!((ticks.t, ticks.counts), (vec![0.0, 0.02], vec![vec![1, 5], vec![1, 1]]));
    assert_eq!((ticks.duty, ticks.count_gaps), (vec![vec![0.1, 0.3], vec![0.2, 0.4]], vec![vec![], vec![1]]));
    assert!(ticks.camera.is_empty() && !ticks.has_camera);
}
