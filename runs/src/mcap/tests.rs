use super::*;
use crate::frames::Pose;
use crate::stream::{Layout, RunStream, Tick};
use crate::{CameraSample, DataSet, Run};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::io::{Cursor, Read, Seek};
use std::path::Path;

fn example() -> Run {
    let ticks = 400;
    let column = |scale: f64| (0..ticks).map(|k| (f64::from(k) * scale).sin()).collect::<Vec<_>>();
    let camera = (0..ticks as usize).step_by(16).map(|tick| CameraSample { tick, pose: Pose::new(0.1, -0.2, 3.0) });
    Run {
        name: "run".to_owned(),
        t: (0..ticks).map(|k| f64::from(k) * 1e-3).collect(),
        command: Some([column(0.1), column(0.2), column(0.3)]),
        reference: vec![column(0.4), column(0.5), column(0.6)],
        counts: (0..3).map(|w| (0..i64::from(ticks)).map(|k| k * (w - 1) - 70).collect()).collect(),
        count_gaps: vec![Vec::new(); 3],
        duty: vec![column(0.7), column(0.8), column(0.9)],
        measured: vec![column(1.0), column(1.1), column(1.2)],
        supply_v: Some(vec![7.2; ticks as usize]),
        camera: camera.collect(),
        has_camera: true,
        ..Run::default()
    }
}

fn bytes_of(run: &Run, flush_every: usize, finish: bool) -> Vec<u8> {
    let mut file = tempfile::tempfile().unwrap();
    let writer = std::io::BufWriter::new(file.try_clone().unwrap());
    let mut stream = McapStream::new(writer, run.layout(), 1_700_000_000_000_000_000).unwrap();
    let mut camera = run.camera.iter().peekable();
    for k in 0..run.len() {
        let of = |columns: &[Vec<f64>]| columns.iter().map(|c| c[k]).collect::<Vec<_>>();
        let counts: Vec<_> = run.counts.iter().map(|c| Some(c[k])).collect();
        let c = run.command.as_ref().unwrap();
        let tick = Tick {
            t: run.t[k],
            command: [c[0][k], c[1][k], c[2][k]],
            reference: &of(&run.reference),
            counts: &counts,
            duty: &of(&run.duty),
            measured: &of(&run.measured),
            supply_v: 7.2,
            camera: camera.next_if(|s| s.tick == k).map(|s| s.pose),
            ..Tick::default()
        };
        stream.tick(&tick).unwrap();
        if (k + 1) % flush_every == 0 {
            stream.flush().unwrap();
        }
    }
    if finish {
        stream.finish().unwrap();
    } else {
        // As a kill does: nothing is completed.
        std::mem::forget(stream);
    }
    let mut bytes = Vec::new();
    file.rewind().unwrap();
    file.read_to_end(&mut bytes).unwrap();
    bytes
}

fn read_bytes(bytes: &[u8]) -> Result<Run, String> {
    read(bytes, Path::new("run.mcap")).map(|run| Run { name: "run".to_owned(), ..run }).map_err(|e| e.to_string())
}

#[test]
fn writing_and_reading_gives_the_same_run_and_a_data_set_holds_it() {
    let run = example();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    run.write(&path).unwrap();
    assert_eq!(Run::read(&path).unwrap(), run);
    assert_eq!(read_bytes(&bytes_of(&run, 50, true)).unwrap(), run);
    crate::robot::Robot::racbot().save(folder.path().join("robot.toml")).unwrap();
    assert_eq!(DataSet::open(folder.path()).unwrap().runs, std::slice::from_ref(&run));
    run.write(folder.path().join("run.csv")).unwrap();
    assert_eq!(DataSet::open(folder.path()).unwrap().runs, [run], "the same run twice is one run");
}

/// What racbot recorded is listed as any file is, and its draft maps every column to itself.
#[test]
fn a_run_is_listed_and_drafted_like_others_logs() {
    use crate::import::{Clock, Map, Table, draft};
    let path = Path::new("run.mcap");
    let table = Table::of_bytes(&bytes_of(&example(), 50, true), path, None, &Clock::default()).unwrap();
    let (counts, seen) = (table.find("enc_3").unwrap(), table.find("cam_theta").unwrap());
    assert_eq!((counts.values.len(), counts.values[1], counts.t[1]), (400, -69.0, 1e-3));
    assert_eq!((seen.values.len(), seen.values[0], seen.t[1]), (25, 3.0, 0.016));
    assert!(table.remarks[0].contains("it is a run as it stands"), "{:?}", table.remarks);
    let cut = &bytes_of(&example(), 400, false)[..2_000];
    let error = Table::of_bytes(cut, path, None, &Clock::default()).unwrap_err().to_string();
    assert!(error.contains("holds no whole message; copy the file again"), "{error}");
    let run = Map::parse(&draft(&table), Path::new("map.toml")).unwrap().run(&table, path).unwrap();
    assert_eq!((run.counts, run.duty[1].len()), (example().counts, 400));
}

#[test]
fn gaps_and_missing_groups_stay_what_they_are() {
    let text = "t,enc_1,enc_2,supply_v\n0,,0,7\n0.5,,5,\n1,3,,7.1\n2,,7,\n";
    let run = Run::from_reader(text.as_bytes(), Path::new("run.csv")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.mcap");
    run.write(&path).unwrap();
    let again = Run::read(&path).unwrap();
    let mut csv = Vec::new();
    again.write_to(&mut csv).unwrap();
    assert_eq!(String::from_utf8(csv).unwrap(), text);
    assert_eq!((again.counts, again.count_gaps), (run.counts, run.count_gaps));
}

/// However a file is cut off, all ticks of the chunks before the cut are there.
#[test]
fn a_file_that_was_cut_off_is_read_up_to_its_last_flush() {
    let run = example();
    let bytes = bytes_of(&run, 50, false);
    let mut lengths: Vec<usize> = Vec::new();
    for cut in (0..=bytes.len()).rev().step_by(7) {
        match read_bytes(&bytes[..cut]) {
            Ok(part) => {
                assert_eq!(part.len() % 50, 0, "only whole chunks");
                assert_eq!(part.t, run.t[..part.len()]);
                assert_eq!(part.counts[2], run.counts[2][..part.len()]);
                lengths.push(part.len());
            }
            Err(message) => assert!(message.contains("run.mcap: "), "{message}"),
        }
    }
    assert_eq!(lengths[0], 400);
    assert!(lengths.is_sorted_by(|a, b| a >= b) && lengths.contains(&50));
}

#[test]
fn others_files_are_read_by_the_names_of_their_fields() {
    let mut writer = mcap::Writer::new(Cursor::new(Vec::new())).unwrap();
    let channel = writer.add_channel(0, "/log", "json", &Default::default()).unwrap();
    let foreign = writer.add_channel(0, "/image", "ros1", &Default::default()).unwrap();
    for k in 0..3_u32 {
        let header = |channel_id| mcap::records::MessageHeader {
            channel_id,
            sequence: k,
            log_time: 5_000_000_000 + 1_000_000 * u64::from(k),
            publish_time: 0,
        };
        let text = format!("{{\"enc_1\": {k}, \"duty_1\": 0.5, \"note\": \"x\"}}");
        writer.write_to_known_channel(&header(foreign), b"\xff\x00").unwrap();
        writer.write_to_known_channel(&header(channel), text.as_bytes()).unwrap();
    }
    writer.finish().unwrap();
    let run = read_bytes(&writer.into_inner().into_inner()).unwrap();
    assert_eq!((run.counts, run.duty), (vec![vec![0, 1, 2]], vec![vec![0.5; 3]]));
    assert!((run.t[2] - 0.002).abs() < 1e-6 && run.t[0] == 0.0);
}

#[test]
fn errors_say_where_what_and_what_to_do() {
    let write = |layout: Layout, ticks: &[(f64, f64)]| {
        let mut cursor = Cursor::new(Vec::new());
        let mut stream = McapStream::new(&mut cursor, layout, 0).unwrap();
        for (t, duty) in ticks {
            let tick = Tick {
                t: *t,
                command: [0.0; 3],
                reference: &[],
                counts: &[],
                duty: &[*duty],
                measured: &[],
                supply_v: f64::NAN,
                ..Tick::default()
            };
            stream.tick(&tick).unwrap();
        }
        stream.finish().unwrap();
        drop(stream);
        cursor.into_inner()
    };
    let duty = Layout { duties: 1, ..Layout::default() };
    let good = write(duty, &[(0.0, 0.0), (1.0, 0.5)]);
    let mut crc = good.clone();
    let at = crc.windows(8).position(|w| w == 0.5_f64.to_le_bytes()).unwrap();
    crc[at + 1] ^= 1;
    let table = [
        (b"t,duty_1\n".to_vec(), "run.mcap: does not start as an MCAP file does; give an MCAP file, or rename a CSV"),
        (write(duty, &[]), "run.mcap: holds no ticks; log at least one message"),
        (write(duty, &[(0.0, 0.0), (0.0, 0.5)]), "run.mcap: t: message 2: time 0 s stands twice; log one"),
        (write(duty, &[(1.0, 0.0), (0.0, 0.5)]), "run.mcap: t: message 2: time runs backwards, from 1 s to 0 s;"),
        (write(duty, &[(1.0, 55.0)]), "run.mcap: duty_1: message 1: duty 55 is not within ±1;"),
        (write(duty, &[(1.0, f64::INFINITY)]), "run.mcap: duty_1: message 1: inf is not a finite number;"),
        (crc, "run.mcap: byte "),
    ];
    assert_eq!(read_bytes(&good).unwrap().duty, [[0.0, 0.5]]);
    for (bytes, message) in table {
        let shown = read_bytes(&bytes).unwrap_err();
        assert!(shown.starts_with(message), "gave {shown}\n not {message}");
    }
}

/// What the fuzzer found in the crate's own reader: lengths that no file has overflow it, or are allocated.
#[test]
fn lengths_beyond_the_file_are_refused() {
    let good = bytes_of(&example(), 400, true);
    for length in [u64::MAX, u64::MAX / 2, good.len() as u64] {
        // The first record: its length stands after the magic and the kind of record.
        let mut bytes = good.clone();
        bytes[9..17].copy_from_slice(&length.to_le_bytes());
        assert!(read_bytes(&bytes).is_err_and(|shown| shown.starts_with("run.mcap: byte 8: ")));
    }
}

/// `RACBOT_FUZZ_S=600 cargo test --release -p model mcap::tests::no_damage` runs for ten minutes.
#[test]
fn no_damage_panics_the_reader() {
    let seconds = std::env::var("RACBOT_FUZZ_S").ok().and_then(|s| s.parse::<u64>().ok());
    let begun = std::time::Instant::now();
    let mut short = example();
    for column in [&mut short.t].into_iter().chain(&mut short.reference).chain(&mut short.duty) {
        column.truncate(40);
    }
    let seeds = [bytes_of(&example(), 50, true), bytes_of(&short, 10, false)];
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut cases = 0_u64;
    while seconds.map_or(cases < 3_000, |s| begun.elapsed().as_secs() < s) {
        let mut bytes = seeds[random.random_range(0..2)].clone();
        for _ in 0..random.random_range(1..6) {
            let at = random.random_range(0..bytes.len());
            match random.random_range(0..5) {
                0 => bytes[at] ^= 1 << random.random_range(0..8),
                1 => bytes[at] = random.random(),
                2 => bytes.truncate(at.max(1)),
                3 => {
                    let mut noise = [0; 9];
                    random.fill_bytes(&mut noise);
                    bytes.splice(at..at, noise);
                }
                _ => {
                    let end = (at + random.random_range(1..64)).min(bytes.len());
                    bytes.drain(at..end);
                    bytes.push(0);
                }
            }
        }
        if let Ok(run) = read_bytes(&bytes) {
            assert!(run.t.windows(2).all(|w| w[0] < w[1]));
            assert!(run.counts.iter().all(|c| c.len() == run.len()));
        }
        cases += 1;
    }
    println!("{cases} damaged files");
}
