use super::*;
use crate::Run;
use std::f64::consts::FRAC_PI_2;

fn table(bytes: &[u8], name: &str) -> Table {
    Table::of_bytes(bytes, Path::new(name), None, &Clock::default()).unwrap()
}

fn error(bytes: &[u8], name: &str) -> String {
    Table::of_bytes(bytes, Path::new(name), None, &Clock::default()).unwrap_err().to_string()
}

fn run(map: &str, table: &Table) -> Result<Run, String> {
    Map::parse(map, Path::new("map.toml")).and_then(|m| m.run(table, Path::new("in"))).map_err(|e| e.to_string())
}

/// A little-endian CDR message; strings and numbers aligned as the standard has it.
struct Message(Vec<u8>);

impl Message {
    fn new() -> Self {
        Self(vec![0, 1, 0, 0])
    }

    fn align(&mut self, size: usize) {
        while !(self.0.len() - 4).is_multiple_of(size) {
            self.0.push(0);
        }
    }

    fn word(mut self, x: u32) -> Self {
        self.align(4);
        self.0.extend(x.to_le_bytes());
        self
    }

    fn text(mut self, text: &str) -> Self {
        self = self.word(text.len() as u32 + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
        self
    }

    fn doubles(mut self, xs: &[f64]) -> Self {
        self.align(8);
        xs.iter().for_each(|x| self.0.extend(x.to_le_bytes()));
        self
    }

    fn header(self, stamp: (u32, u32), frame: &str) -> Self {
        self.word(stamp.0).word(stamp.1).text(frame)
    }
}

/// A bag of these messages (topic, type, message), a chunk compressed as `compression` says.
fn bag(messages: &[(&str, &str, Vec<u8>)], compression: &str) -> Vec<u8> {
    let field = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let record = |op: u8, body: Vec<u8>| [&[op][..], &(body.len() as u64).to_le_bytes(), &body].concat();
    let mut inner = Vec::new();
    for (i, (topic, kind, data)) in messages.iter().enumerate() {
        let id = (i as u16 + 1).to_le_bytes();
        inner.extend(record(3, [&id[..], &field(kind), &field("ros2msg"), &0_u32.to_le_bytes()].concat()));
        inner.extend(record(4, [&id[..], &id, &field(topic), &field("cdr"), &0_u32.to_le_bytes()].concat()));
        let stamp = (2_000_000_000_u64 + i as u64).to_le_bytes();
        inner.extend(record(5, [&id[..], &0_u32.to_le_bytes(), &stamp, &stamp, data].concat()));
    }
    let packed = match compression {
        "lz4" => {
            let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
            std::io::Write::write_all(&mut encoder, &inner).unwrap();
            encoder.finish().unwrap()
        }
        "zstd" => ruzstd::encoding::compress_to_vec(&inner[..], ruzstd::encoding::CompressionLevel::Fastest),
        _ => inner.clone(),
    };
    let mut chunk = [0_u64.to_le_bytes(), 0_u64.to_le_bytes(), (inner.len() as u64).to_le_bytes()].concat();
    chunk.extend(crc32fast::hash(&inner).to_le_bytes());
    chunk.extend(field(compression));
    chunk.extend((packed.len() as u64).to_le_bytes());
    chunk.extend(packed);
    [mcap::MAGIC, &record(1, [field("ros2"), field("test")].concat())[..], &record(6, chunk), &record(15, vec![0; 4])]
        .concat()
}

fn messages() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    let (s, c) = (0.5_f64.sin(), 0.5_f64.cos());
    let pose = [1.0, 2.0, 0.0, 0.0, 0.0, s, c];
    let odometry = Message::new().header((5, 500_000_000), "odom").text("base").doubles(&pose).doubles(&[0.0; 36]);
    let odometry = odometry.doubles(&[0.3, 0.4, 0.0, 0.0, 0.0, 0.6]).doubles(&[0.0; 36]);
    let joints = Message::new().header((5, 0), "").word(2).text("left").text("right wheel");
    let joints = joints.word(2).doubles(&[1.5, -2.5]).word(1).doubles(&[7.0]).word(0);
    let tf = Message::new().word(1).header((6, 0), "map").text("base").doubles(&pose);
    let twist = Message::new().doubles(&[0.1, 0.2, 0.0, 0.0, 0.0, 0.3]);
    let seen = Message::new().header((5, 0), "map").doubles(&pose);
    let level = Message::new().doubles(&[1.5, 2.5, 0.7]);
    vec![
        ("/odom", "nav_msgs/msg/Odometry", odometry.0),
        ("/joint_states", "sensor_msgs/msg/JointState", joints.0),
        ("/tf", "tf2_msgs/msg/TFMessage", tf.0),
        ("/cmd_vel", "geometry_msgs/msg/Twist", twist.0),
        ("/pose", "geometry_msgs/msg/PoseStamped", seen.0),
        ("/ground_pose", "geometry_msgs/msg/Pose2D", level.0),
        ("/chatter", "std_msgs/msg/String", Message::new().text("hello").0),
    ]
}

#[test]
fn bags_are_read_whatever_their_compression() {
    for compression in ["", "lz4", "zstd"] {
        let table = table(&bag(&messages(), compression), "bag.mcap");
        let value = |name: &str| {
            let s = table.find(name).unwrap_or_else(|| panic!("no {name}"));
            (s.t[0], s.values[0])
        };
        assert_eq!(value("/odom.x"), (5.5, 1.0));
        assert!((value("/odom.theta").1 - 1.0).abs() < 1e-12);
        assert_eq!((value("/odom.vx").1, value("/odom.w").1), (0.3, 0.6));
        assert_eq!(value("/joint_states.position.right wheel"), (5.0, -2.5));
        assert_eq!(value("/joint_states.velocity.left").1, 7.0);
        assert_eq!(value("/tf.map.base.y"), (6.0, 2.0));
        assert!((value("/cmd_vel.vy").0 - 2.0).abs() < 1e-6, "the recording's time");
        assert_eq!(value("/pose.x"), (5.0, 1.0));
        assert_eq!((value("/ground_pose.y").1, value("/ground_pose.theta").1), (2.5, 0.7));
        assert!(table.find("/chatter.data").is_none());
    }
    let cut = |mut m: Vec<(&'static str, &'static str, Vec<u8>)>| {
        m[0].2.truncate(60);
        bag(&m, "lz4")
    };
    assert!(
        error(&cut(messages()), "bag.mcap").contains("topic /odom: a message is shorter than a nav_msgs/msg/Odometry")
    );
    let foreign = bag(&messages()[6..], "");
    assert!(error(&foreign, "bag.mcap").contains("it has /chatter (std_msgs/msg/String)"));
    let mut broken = bag(&messages(), "zstd");
    let middle = broken.len() / 2;
    broken[middle] ^= 0xff;
    assert!(error(&broken, "bag.mcap").starts_with("bag.mcap: byte "));
}

/// The bag's times are 2 s and on, each a nanosecond after the one before.
#[test]
fn stamps_of_a_wrong_clock_are_brought_to_the_recording() {
    let pose = |stamp: u32| Message::new().header((stamp, 0), "map").doubles(&[1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0]).0;
    let kind = "geometry_msgs/msg/PoseStamped";
    let table = table(&bag(&[("/a", kind, pose(90_000)), ("/b", kind, pose(2))], ""), "bag.mcap");
    let first = |name: &str| table.find(name).unwrap().t[0];
    assert!((first("/a.x") - 2.0).abs() < 1e-6 && (first("/b.x") - 2.0).abs() < 1e-6);
    assert!(
        table.remarks.len() == 1 && table.remarks[0].starts_with("/a: its stamps are 89998 s off"),
        "{:?}",
        table.remarks
    );
}

#[test]
fn game_logs_are_the_camera() {
    let float = |n: u8, x: f32| [&[n << 3 | 5][..], &x.to_le_bytes()].concat();
    let robot =
        |id: u8, x: f32| [float(1, 0.9), vec![2 << 3, id], float(3, x), float(4, -500.0), float(5, 1.0)].concat();
    let nested = |n: u8, data: Vec<u8>| [vec![n << 3 | 2, data.len() as u8], data].concat();
    let frame = |t: f64, x: f32| {
        let head = [vec![1 << 3, 7, 2 << 3 | 1], t.to_le_bytes().to_vec(), vec![4 << 3, 0]].concat();
        nested(1, [head, nested(6, robot(3, x)), nested(7, robot(4, 0.0))].concat())
    };
    let record = |kind: u32, data: Vec<u8>| {
        [&5_i64.to_be_bytes()[..], &kind.to_be_bytes(), &(data.len() as u32).to_be_bytes(), &data].concat()
    };
    let head = [&b"SSL_LOG_FILE"[..], &1_u32.to_be_bytes()].concat();
    let log =
        [head, record(3, vec![1, 2]), record(4, frame(100.0, 1000.0)), record(4, frame(100.5, 1500.0)), vec![0; 9]]
            .concat();
    let map = "[frame]\nx = \"forward\"\n[columns]\ncam_x = \"yellow.3.x\"\ncam_y = \"yellow.3.y\"\ncam_theta = \"yellow.3.theta\"\n";
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    std::io::Write::write_all(&mut packed, &log).unwrap();
    for (bytes, name) in [(log, "game.log"), (packed.finish().unwrap(), "game.log.gz")] {
        let table = table(&bytes, name);
        assert_eq!(table.find("blue.4.x").unwrap().values, [0.0, 0.0]);
        let run = run(map, &table).unwrap();
        assert_eq!(run.t, [0.0, 0.5]);
        let pose = run.camera[1].pose;
        assert!((pose.x - 1.5).abs() < 1e-6 && (pose.y + 0.5).abs() < 1e-6);
        assert!((pose.theta - (1.0 - FRAC_PI_2)).abs() < 1e-6, "the league's heading points forward");
    }
}

#[test]
fn wpilib_logs_are_read() {
    let text = |s: &str| [&(s.len() as u32).to_le_bytes()[..], s.as_bytes()].concat();
    let record = |entry: u8, stamp: u32, data: Vec<u8>| {
        // Widths: entry 1, size 2, stamp 4 bytes.
        [&[0b0011_0100, entry][..], &(data.len() as u16).to_le_bytes(), &stamp.to_le_bytes(), &data].concat()
    };
    let start = |id: u32, name: &str, kind: &str| {
        [vec![0], id.to_le_bytes().to_vec(), text(name), text(kind), text("")].concat()
    };
    let mut log = [&b"WPILOG"[..], &[0, 1], &2_u32.to_le_bytes(), b"{}"].concat();
    for (id, name, kind) in
        [(1, "left/position", "double"), (2, "pose", "struct:Pose2d"), (3, "volts", "double[]"), (4, "n", "int64")]
    {
        log.extend(record(0, 0, start(id, name, kind)));
    }
    log.extend(record(1, 1_500_000, 2.5_f64.to_le_bytes().to_vec()));
    log.extend(record(2, 1_500_000, [1.0_f64, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()).collect()));
    log.extend(record(3, 1_600_000, [12.0_f64, 11.0].iter().flat_map(|x| x.to_le_bytes()).collect()));
    log.extend(record(4, 1_600_000, (-7_i64).to_le_bytes().to_vec()));
    log.extend([0x34, 1, 8]);
    let table = table(&log, "robot.wpilog");
    let value = |name: &str| table.find(name).map(|s| (s.t[0], s.values[0]));
    assert_eq!(value("left/position"), Some((1.5, 2.5)));
    assert_eq!(value("pose.theta"), Some((1.5, 3.0)));
    assert_eq!((value("volts.1"), value("n")), (Some((1.6, 11.0)), Some((1.6, -7.0))));
}

/// Sensors of currents and bridges with a direction of their own log sizes alone.
#[test]
fn a_size_gets_the_sign_of_another_series() {
    let table = table(b"t,amps,asked,pwm,dir\n0,1,0,10,1\n1,2,5,20,0\n2,3,-5,30,0\n3,4,0,40,1\n", "log.csv");
    let map = "[columns]\ncurrent_1 = { from = \"amps\", scale = 0.5, sign = \"asked\" }\n\
               duty_1 = { from = \"pwm\", unit = \"percent\", sign = \"dir\" }\n";
    let made = run(map, &table).unwrap();
    assert_eq!(made.current[0], [0.5, 1.0, -1.5, -2.0]);
    assert_eq!(made.duty[0], [0.1, -0.2, -0.3, 0.4]);
    for (map, message) in [
        (
            "[columns]\ncurrent_1 = { from = \"amps\", sign = \"askd\" }\n",
            "sign: has no series \"askd\"; did you mean asked?",
        ),
        ("[columns]\nenc_1 = { from = \"amps\", sign = \"asked\" }\n", "sign has no meaning here"),
    ] {
        let e = run(map, &table).unwrap_err();
        assert!(e.contains(message), "{map:?}: {e}");
    }
}

#[test]
fn any_csv_by_names_units_signs_and_frame() {
    let text = "__time,/a/left,/a/x,/a/y,yaw,vel.x,vel.y,mode\n10.0,1,1000,50,90,,,auto\n10.5,,,,,0.5,0.1,\n11,3,2000,60,180,,,x\n";
    let table = table(text.as_bytes(), "plotjuggler.csv");
    let map = "[frame]\nx = \"forward\"\ny = \"down\"\nheadings = \"clockwise\"\n[columns]\n\
               enc_1 = { from = \"/a/left\", scale = -2 }\ncam_x = { from = \"/a/x\", unit = \"mm\" }\n\
               cam_y = { from = \"/a/y\", unit = \"cm\", offset = 1 }\ncam_theta = { from = \"yaw\", unit = \"deg\" }\n\
               cmd_vx = \"vel.x\"\ncmd_vy = \"vel.y\"\ncmd_w = \"vel.y\"\n";
    let made = run(map, &table).unwrap();
    assert_eq!(made.t, [0.0, 0.5, 1.0]);
    assert_eq!((made.counts[0].clone(), made.count_gaps[0].clone()), (vec![-2, -2, -6], vec![1]));
    let pose = made.camera[1].pose;
    assert!((pose.x - 2.0).abs() < 1e-12 && (pose.y + 1.6).abs() < 1e-12, "{pose:?}");
    assert!((crate::frames::wrap_angle(pose.theta - FRAC_PI_2)).abs() < 1e-12, "{pose:?}");
    let command = made.command.as_ref().unwrap();
    assert_eq!((command[0][1], command[1][1], command[2][1]), (-0.1, 0.5, -0.1));
    for (map, message) in [
        ("[columns]\nenc_1 = \"/a/lefd\"\n", "in: enc_1: has no series \"/a/lefd\"; did you mean /a/left?"),
        ("[columns]\necn_1 = \"x\"\n", "map.toml: columns.ecn_1: is no column of a run; did you mean enc_1?"),
        ("[columns]\nenc_1 = { from = \"x\", unit = \"furlong\" }\n", "\"furlong\" is no unit that is known"),
        ("[columns]\nenc_1 = { from = \"x\", scale = 0 }\n", "its scale or offset is no number"),
        ("[columns]\ncam_x = \"/a/x\"\n", "cam_y: no such column in the map"),
        ("[columns]\nduty_1 = \"/a/x\"\n", "duty 1000 is not within"),
        ("[time]\nunit = \"h\"\n", "\"h\" is no unit of time"),
        ("format = \"xls\"\n", "\"xls\" is no format"),
        ("[frames]\n", "map.toml:1:2: unknown field"),
        ("", "none of its series is a column of ours"),
    ] {
        let e = run(map, &table).unwrap_err();
        assert!(e.contains(message), "{map:?}: {e}");
    }
    assert!(error(b"a,b\n1,2\n", "x.csv").contains("no column of time; name it in the map"));
    assert!(error(b"t,b\nx,2\n", "x.csv").starts_with("x.csv:2:1: t: \"x\" is no time"));
}

#[test]
fn angles_become_counts_and_quaternions_headings() {
    let text = "time_us,left,right,q/x,q/y,q/z,q/w,vx,w\n0,0.0,0.1,0,0,0.6,0.8,0.5,0.1\n500000,1.5707963,0.3,0,0,0.6,0.8,0.5,0.1\n";
    let read = table(text.as_bytes(), "joints.csv");
    assert_eq!(read.time, Some(("time_us".to_owned(), 1e-6)));
    let map = "[frame]\nx = \"forward\"\n[columns]\nenc_1 = { from = \"left\", unit = \"rad\", counts_per_rev = 1440 }\n\
               cmd_vx = \"vx\"\ncmd_w = \"w\"\ncam_x = \"vx\"\ncam_y = \"w\"\ncam_theta = \"q/yaw\"\n";
    let made = run(map, &read).unwrap();
    assert_eq!((made.t[1], made.counts[0].clone()), (0.5, vec![0, 360]));
    // Two wheels on an axle: forward is our y, and nothing goes sideways.
    let command = made.command.as_ref().unwrap();
    assert_eq!((command[0][0].abs(), command[1][0], command[2][0]), (0.0, 0.5, 0.1));
    let heading = 2.0 * f64::atan2(0.6, 0.8) - FRAC_PI_2;
    assert!((made.camera[0].pose.theta - heading).abs() < 1e-12);
    for (column, message) in [
        ("enc_1 = \"right\"", "in: enc_1: series \"right\" has fractions, which no counter has; an angle needs"),
        ("enc_1 = { from = \"left\", unit = \"rad\" }", "counts cannot be in \"rad\"; say what the encoder counts"),
        ("enc_1 = { from = \"left\", counts_per_rev = 9 }", "counts_per_rev = 9 has no meaning here"),
        ("cmd_vx = \"vx\"", "cmd_vy: no such column in the map; map cmd_vx, cmd_vy and cmd_w (only"),
    ] {
        let e = run(&format!("[frame]\nx = \"forward\"\n[columns]\n{column}\n"), &read).unwrap_err();
        assert!(e.contains(message), "{column}: {e}");
    }
    assert!(run("[columns]\nspeed_1 = \"left\"\n", &read).is_ok());
    let slow = table(b"t_motor,Zeit [ms],a\n20,1000,1\n20,1500,2\n", "x.csv");
    assert_eq!((slow.find("a").unwrap().t[1], slow.find("t_motor").unwrap().values[0]), (1.5, 20.0));
}

#[test]
fn no_soup_of_bytes_panics_an_importer() {
    use rand::{Rng, SeedableRng};
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
    let heads: [&[u8]; 7] =
        [b"", mcap::MAGIC, b"WPILOG", b"SSL_LOG_FILE", b"t,a\n", b"{\"t\": [1, ", b"A 1 2\nB 2 3\n"];
    for k in 0..400 {
        let mut bytes = vec![0; k % 97];
        rng.fill_bytes(&mut bytes);
        let _ = Table::of_bytes(&[heads[k % 7], &bytes].concat(), Path::new("soup"), None, &Clock::default());
        let mut bag = bag(&messages(), ["", "lz4", "zstd"][k % 3]);
        let at = rng.next_u32() as usize % bag.len();
        bag[at] ^= 1 << (k % 8);
        let _ = Table::of_bytes(&bag, Path::new("soup"), None, &Clock::default());
    }
    // What tables are made of, in any order: a line may be a separator and no more.
    for text in ["x\n;", "A 1 2\nB 2 3\n;\n", "A 1 2\n\n;\nB 2 3\n", ";\nA 1 2\nB 2 3\n"] {
        let _ = Table::of_bytes(text.as_bytes(), Path::new("soup"), None, &Clock { rows: true, ..Clock::default() });
    }
    let letters = b"0123,.;|\t\n\n-e: \"{}[]tabx#\xff";
    for k in 0..20_000 {
        let text: Vec<u8> = (0..k % 61).map(|_| letters[rng.next_u32() as usize % letters.len()]).collect();
        let clock = Clock { rows: k % 2 == 0, ..Clock::default() };
        let Ok(table) = Table::of_bytes(&text, Path::new("soup"), None, &clock) else { continue };
        let map = draft(&table);
        assert!(Map::parse(&map, Path::new("map.toml")).is_ok(), "{text:?}\n{map}");
    }
}

#[test]
fn commands_stand_for_wheels_that_nobody_logged() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("robot.toml"), crate::robot::Robot::racbot().to_toml()).unwrap();
    let table = table(b"t,cmd_vx,cmd_vy,cmd_w\n0,0,0,1\n1,0.5,0,0\n", "in.csv");
    let parse = |text: &str| Map::parse(text, &folder.path().join("map.toml")).map_err(|e| e.to_string());
    let map = parse("[derive]\nspeeds = \"robot.toml\"\n").unwrap();
    let run = map.run(&table, Path::new("in")).unwrap();
    // Positive wheels turn the robot clockwise: R/r for a rad/s, and wheel 1 drives to the right.
    assert_eq!(run.speed.len(), 3);
    assert!((run.speed[2][0] + 0.085 / 0.0275).abs() < 1e-9 && (run.speed[0][1] - 0.5 / 0.0275).abs() < 1e-9);
    assert!(parse("[derive]\nspeeds = \"none.toml\"\n").unwrap_err().contains("none.toml"));
    let bare = Table::of_bytes(b"t,enc_1\n0,1\n1,2\n", Path::new("in.csv"), None, &Clock::default()).unwrap();
    assert!(map.run(&bare, Path::new("in")).unwrap_err().to_string().contains("the wheels are logged"));
}

#[test]
fn what_is_no_text_is_not_read_as_text() {
    for (bytes, what) in [
        (&b"#ROSBAG V2.0\nE\0\0\0\0"[..], "is a bag of ROS 1; convert it once"),
        (b"SQLite format 3\0", "is a bag of ROS 2 in SQLite"),
        (b"MATLAB 5.0 MAT-file", "is a file of MATLAB"),
        (b"\xff\xfet\0,\0", "UTF-16"),
        (b"At time 1.5\n- Translation: [0.7, 0.1, 0.0]\n", "is what `tf_echo` prints; record /tf"),
        (b"header: \n  seq: 1\n---\n", "repeat it with -p"),
        (b"1,2\0\0\0\x01", "is no text"),
    ] {
        assert!(error(bytes, "log.csv").contains(what), "{}", error(bytes, "log.csv"));
    }
}

#[test]
fn lines_of_several_kinds_may_have_dates_and_words() {
    let text = "IMU;2022:06:01 13:42:57.75;Orientation;0.1;0.2\nOdometry;2022:06:01 13:42:57.75;Position;1;2;Speed;0.5\n\
                IMU;2022:06:01 13:42:58.00;Orientation;0.3;0.2\nOdometry;2022:06:01 13:42:58.25;Position;2;2;Speed;0.5\n";
    let clock = Clock { column: Some("column_2"), ..Clock::default() };
    let table = Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &clock).unwrap();
    let x = table.find("Odometry/column_4").unwrap();
    assert_eq!(x.values, [1.0, 2.0]);
    assert!((x.t[1] - x.t[0] - 0.5).abs() < 1e-6);
    assert_eq!(table.find("IMU/column_4").unwrap().values, [0.1, 0.3]);
}
