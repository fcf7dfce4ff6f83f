use std::path::Path;

use super::super::{Clock, Map};
use super::*;

mod poses;

fn drafted(header: &str, rows: [&str; 3]) -> String {
    let text = format!("{header}\n{}\n", rows.join("\n"));
    let table =
        Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock { rows: true, ..Clock::default() }).unwrap();
    let map = draft(&table);
    let parsed = Map::parse(&map, Path::new("map.toml")).unwrap_or_else(|e| panic!("{e}\n{map}"));
    if table.time.is_some() {
        // Read again, as a map is used: by its unit of time.
        let table = Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &parsed.time().unwrap()).unwrap();
        parsed.run(&table, Path::new("x.csv")).unwrap_or_else(|e| panic!("{e}\n{map}"));
    }
    map
}

#[test]
fn names_of_five_robots_are_understood() {
    let omni = drafted(
        "Zeit [ms];Motor 1 (ticks);Motor 2 (ticks);vx soll [mm/s];vy soll [mm/s];omega soll [deg/s];vision x;vision y;vision phi",
        ["5;0;0;0,0;0,0;0,00;301,4;-202,1;28,41", "10;1;2;13,3;0,0;1,43;;;", "15;2;4;13,3;0,0;1,43;301,4;-202,1;99,5"],
    );
    for line in [
        "column = \"Zeit [ms]\"\nunit = \"ms\"",
        "enc_2 = \"Motor 2 (ticks)\"",
        "cmd_w = { from = \"omega soll [deg/s]\", unit = \"deg/s\" }",
        "cam_x = { from = \"vision x\", unit = \"mm\" }",
        "cam_theta = { from = \"vision phi\", unit = \"deg\" }",
    ] {
        assert!(omni.contains(line), "{line}\n{omni}");
    }
    let two = drafted(
        "timestamp,/cmd_vel/linear/x,/cmd_vel/angular/z,/left_wheel/ticks,/right_wheel/ticks,/mocap/pose/x,/mocap/pose/y,/mocap/pose/yaw",
        ["1.0,0.1,0.2,1,2,0.5,0.6,1.0", "1.1,0.1,0.2,3,4,,,", "1.2,0.1,0.2,5,6,0.5,0.6,1.0"],
    );
    for line in ["cmd_vx = \"/cmd_vel/linear/x\"", "cmd_w = ", "enc_2 = \"/left_wheel/ticks\"", "cam_theta = "] {
        assert!(two.contains(line), "{line}\n{two}");
    }
    let mecanum = drafted("t,fl,fr,rl,rr,x,y,yaw", ["0,0,1,2,3,0.1,0.2,0.3", "1,0,1,2,3,,,", "2,0,1,2,3,1,2,3"]);
    assert!(mecanum.contains("enc_3 = \"rl\"") && mecanum.contains("cam_theta = \"yaw\""), "{mecanum}");
    let servo =
        drafted("time_us,pos_counts,ref_rpm,pwm_percent,vbus", ["0,0,60,50,24", "1000,7,60,40,24", "2000,9,60,-30,24"]);
    for line in ["unit = \"us\"", "enc_1 = ", "ref_1 = { from = \"ref_rpm\", unit = \"rpm\" }", "supply_v = "] {
        assert!(servo.contains(line), "{line}\n{servo}");
    }
    let joints = drafted(
        "__time,/joint_states/right_wheel/position,/joint_states/right_wheel/velocity,/pose/position/x,/pose/position/y,/pose/orientation/x,/pose/orientation/y,/pose/orientation/z,/pose/orientation/w,mode",
        ["0,0.25,1,1,2,0,0,0.6,0.8,7", "1,0.5,1,1,2,0,0,0.6,0.8,7", "2,1.75,1,1,2,0,0,0.6,0.8,7"],
    );
    for line in [
        "enc_1 = { from = \"/joint_states/right_wheel/position\", unit = \"rad\", counts_per_rev",
        "speed_1 = ",
        "cam_theta = \"/pose/orientation/yaw\"",
        "# \"mode\", 7 to 7",
    ] {
        assert!(joints.contains(line), "{line}\n{joints}");
    }
}

#[test]
fn a_table_of_blanks_in_milliseconds_is_understood() {
    let rows = [
        "  1128   16.04  -30.36  1.58  -3   1",
        "  1199   16.05  -30.38  1.58  -3   1",
        "  1327   16.01  -30.38  1.58  -3   7",
    ];
    let map = drafted("n_time  pose_x  pose_y  pose_theta  tick_L  tick_R", rows);
    for line in ["column = \"n_time\"\nunit = \"ms\"", "enc_1 = \"tick_R\"", "enc_2 = \"tick_L\"", "cam_y = \"pose_y\""]
    {
        assert!(map.contains(line), "{line}\n{map}");
    }
    let bare = "0.00 1 2\n0.01 2 3\n0.02 3 4\n";
    let clock = Clock { column: Some("column_1"), ..Clock::default() };
    let table = Table::of_bytes(bare.as_bytes(), Path::new("x.dat"), None, &clock).unwrap();
    assert_eq!(table.find("column_3").unwrap().values, [2.0, 3.0, 4.0]);
}

#[test]
fn words_run_together_and_times_without_a_name_are_understood() {
    let mouse =
        drafted("time, targetSpeed, leftEncoder, leftCommand, rightEncoder", ["0,1,2,3,4", "2,1,3,3,5", "4,1,4,3,6"]);
    for line in ["ref_1 = \"targetSpeed\"", "enc_2 = \"leftEncoder\"", "enc_1 = \"rightEncoder\"", "# \"leftCommand\""]
    {
        assert!(mouse.contains(line), "{line}\n{mouse}");
    }
    let bare = drafted(
        "100; 0.0069; 0; -67305",
        ["100; 0.0129; 2; -67304", "100; 0.0191; 6; -67304", "100; 0.0248; 6; -67304"],
    );
    assert!(bare.contains("column = \"column_2\" # is it?"), "{bare}");
    // A row that stands twice, as where a logger asked more often than there was news.
    let twice = drafted("5; 204; 7", ["5; 415; 7\n5; 415; 7", "6; 620; 8\n7; 830; 9", "8; 1041; 9"]);
    assert!(twice.contains("column = \"column_2\" # is it?"), "{twice}");
    let printed = |t: u32| format!("time {t} left motor speed {}.5 right motor speed {}", t % 7, t % 5);
    let words = drafted(&printed(10), [20, 30, 40].map(printed).each_ref().map(String::as_str));
    for line in ["column = \"time\"", "speed_2 = \"left motor speed\"", "speed_1 = \"right motor speed\""] {
        assert!(words.contains(line), "{line}\n{words}");
    }
}

/// A speed of the body is no wheel's where wheels have numbers, and the rate of an encoder is no count.
#[test]
fn numbers_and_rates_in_names_are_understood() {
    let omni = drafted(
        "t,set rotational robot velocity,1st motor set speed,2nd motor set speed,1st motor position,2nd motor position",
        ["0,0,1,2,3,4", "1,0,1,2,4,6", "2,0,1,2,5,8"],
    );
    for line in
        ["ref_1 = \"1st motor set speed\"", "ref_2 = \"2nd motor", "# \"set rotational robot velocity\"", "enc_2 = "]
    {
        assert!(omni.contains(line), "{line}\n{omni}");
    }
    let rates = drafted("t,left_encoder_rate,right_encoder_rate", ["0,0.5,1.5", "1,2.5,3.5", "2,2.5,4.5"]);
    for line in ["speed_1 = \"right_encoder_rate\"", "speed_2 = \"left_encoder_rate\""] {
        assert!(rates.contains(line), "{line}\n{rates}");
    }
    // The r of a unit is no right wheel.
    let units =
        drafted("t,wheel velocity [r/s] left,wheel velocity [r/s] right", ["0,0.5,1.5", "1,2.5,3.5", "2,2.5,4.5"]);
    for line in ["speed_1 = \"wheel velocity [r/s] right\"", "speed_2 = \"wheel velocity [r/s] left\""] {
        assert!(units.contains(line), "{line}\n{units}");
    }
}

#[test]
fn a_file_without_a_time_column_asks_for_it() {
    let map = drafted("a,b\"c", ["1,2", "2,3", "3,4"]);
    assert!(
        map.contains("which column is the time?") && map.contains("rate_hz") && map.contains("# \"b\\\"c\", 2 to 4"),
        "{map}"
    );
}

#[test]
fn two_files_make_one_map() {
    let read = |text: &str, name: &str| {
        Table::of_bytes(text.as_bytes(), Path::new(name), None, &Clock { rows: true, ..Clock::default() }).unwrap()
    };
    let log = read("t,left,right,x,y,yaw\n0,0,1,0,0,0\n1,5,7,0,0,0\n2,5,8,0,0,0\n", "run_1.csv");
    let mocap = read(
        "stamp_ns,frame,robot pos x,robot pos y,robot pos z,robot qx,robot qy,robot qz,robot qw,vx\n\
         1600000000000000000,1,900,0,300,0,0,0.6,0.8,7\n1600000000010000000,2,901,0,300,0,0,0.6,0.8,8\n",
        "take_1.csv",
    );
    let map = draft_two([(&log, Path::new("set/run_1.csv")), (&mocap, Path::new("set/take_1.csv"))]);
    for line in [
        "[truth] # the pose\nfile = \"take_{number}.csv\" #",
        "clock = \"match\" #",
        "[truth.time]\ncolumn = \"stamp_ns\"\nunit = \"ns\"\n",
        "[truth.columns]\ncam_x = { from = \"robot pos x\", unit = \"mm\" }\ncam_y = { from = \"robot pos y\", unit = \"mm\" }\ncam_theta = \"robot qyaw\"\n",
        "# \"vx\", 7 to 8",
        "# \"yaw\", 0 to 0",
    ] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    Map::parse(&map, Path::new("map.toml")).unwrap();
}

#[test]
fn a_servo_and_a_motor_on_a_bench_are_understood() {
    let servo = drafted(
        "timestamp,position,speed,load,input_volts,goal_position",
        ["0.000,0.5,0,3,7.3,0.5", "0.005,0.25,1,65534,7.4,0.75", "0.010,0.125,1,65533,7.3,1.5"],
    );
    for line in [
        "enc_1 = { from = \"position\", unit = \"rad\"",
        "supply_v = \"input_volts\"",
        "# \"goal_position\", 0.5 to 1.5\n",
        "# \"load\", 3 to 65534; 16 bits read without their sign? wraps = 65536",
    ] {
        assert!(servo.contains(line), "{line}\n{servo}");
    }
    assert!(!servo.contains("enc_2"), "{servo}");
    let motor = drafted("time,voltage,rpm", ["0.00,0,0", "0.01,-8,-120", "0.02,4,60"]);
    for line in [
        "speed_1 = { from = \"rpm\", unit = \"rpm\" }",
        "duty_1 = { from = \"voltage\", scale = 0.1250 } # of 8 V, the most in this file: write 1 / supply_v",
        "# supply_v = 8 # and here supply_v",
    ] {
        assert!(motor.contains(line), "{line}\n{motor}");
    }
}

#[test]
fn motors_have_one_supply_and_one_full_duty() {
    let volts = drafted("time,left_volts,right_volts", ["0.00,0,0", "0.01,-8,-7.9", "0.02,4,5"]);
    assert_eq!(volts.matches("scale = 0.1250 } # of 8 V").count(), 2, "{volts}");
    let steps = drafted("time,pwm_left,pwm_right", ["0.00,0,0", "0.01,-250,-90", "0.02,4,60"]);
    let full = "scale = 0.003922 } # of 255: is that the full duty? The most in this file is 250";
    assert_eq!(steps.matches(full).count(), 2, "{steps}");
    let permille = drafted("time,pwm", ["0.00,0", "0.01,-900", "0.02,4"]);
    assert!(permille.contains("scale = 0.001000 } # of 1000"), "{permille}");
    let speeds = drafted("time,leftSpeed,rightSpeed,targetSpeed", ["0.00,0,0,0", "0.01,120,9,200", "0.02,130,9,200"]);
    for line in ["speed_2 = \"leftSpeed\" # in rad/s at the wheel?", "ref_1 = \"targetSpeed\" # in rad/s at the wheel?"]
    {
        assert!(speeds.contains(line), "{line}\n{speeds}");
    }
    let counter = drafted("time,n,pwm", ["0,4294967290,1", "1,4294967295,1", "2,4,0"]);
    assert!(counter.contains("32 bits read without their sign? wraps = 4294967296"), "{counter}");
}

/// Whatever counts up beside them: the dates are the time.
#[test]
fn dates_without_a_name_of_a_time_are_not_asked_for() {
    let row = |k: usize| format!("ODOM 2024-05-01T12:00:{k:02}.25 {} {}\n", 10 * k, 11 * k);
    let text: String = (0..60).map(row).collect();
    let clock = Clock { rows: true, ..Clock::default() };
    let map = draft(&Table::of_bytes(text.as_bytes(), Path::new("x.txt"), None, &clock).unwrap());
    assert!(map.contains("column = \"ODOM/column_2\"\nunit = \"s\"\n"), "{map}");
    assert!(!map.contains("is it?") && map.contains("ODOM/column_3"), "{map}");
}

#[test]
fn a_controller_s_own_log_and_a_test_stand_are_understood() {
    let names =
        "ms_today;input_voltage;current_motor;current_in;duty_cycle;d_axis_voltage;gnss_posTime;encoder_position";
    let log = drafted(names, ["100;54;2.5;0.5;0;-0.03;7;0.5", "150;53;7;1;0.5;1.5;7;1.25", "200;54;3;1;0.25;1;8;2.5"]);
    for line in
        ["duty_1 = \"duty_cycle\"\n", "current_1 = \"current_motor\"\n", "# \"current_in\"", "# \"gnss_posTime\""]
    {
        assert!(log.contains(line), "{line}\n{log}");
    }
    let stand = drafted(
        "time [s],a1 q-axis cmd [A],a1 position [rad],a1 q-axis [A],ina1 voltage [V],ina1 current [A]",
        ["0.000,1,0.5,0.9,0,0", "0.005,2,0.6,1.9,0,0", "0.010,1,0.75,1,0,0"],
    );
    for line in ["current_1 = \"a1 q-axis [A]\"\n", "enc_1 = { from = \"a1 position [rad]\"", "# \"a1 q-axis cmd [A]\""]
    {
        assert!(stand.contains(line), "{line}\n{stand}");
    }
    assert!(!stand.contains("duty_1"), "{stand}");
}

#[test]
fn units_below_the_names_and_rows_of_nan_are_no_numbers() {
    let text =
        "Time;1st motor position;1st motor current;\nms;ticks;A;\nt;m1pos;m1cur;\n0.5;0;0.1;\n30.5;7;0.2;\n60;9;0.1;\n";
    let read = |text: &str| {
        let clock = Clock { rows: true, ..Clock::default() };
        draft(&Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &clock).unwrap())
    };
    let map = read(text);
    for line in [
        "column = \"Time [ms]\"\nunit = \"ms\"",
        "enc_1 = \"1st motor position [ticks]\"",
        "current_1 = \"1st motor current [A]\"",
    ] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    let text =
        "%by me\n%timestep,voltage,position\n%[#],[V],[turns]\nnan,nan,nan;\n11,0.5,0.25;\n68,1,0.5;\n114,2,1.5;\n";
    let map = read(text);
    for line in [
        "column = \"timestep\" # is it? it increases from row to row\nper_second = 1000 #",
        "duty_1 = { from = \"voltage [V]\", scale = 0.5000 }",
        "enc_1 = { from = \"position [turns]\", unit = \"rev\"",
    ] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    let map = "[time]\ncolumn = \"timestep\"\nper_second = 8000\n[columns]\nduty_1 = { from = \"voltage [V]\", scale = 0.5 }\n\
         enc_1 = { from = \"position [turns]\", unit = \"rev\", counts_per_rev = 4 }\n";
    let map = Map::parse(map, Path::new("map.toml")).unwrap();
    let table = Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &map.time().unwrap()).unwrap();
    let run = map.run(&table, Path::new("x.csv")).unwrap();
    assert_eq!((run.t, run.counts), (vec![0.0, 57.0 / 8000.0, 103.0 / 8000.0], vec![vec![1, 2, 6]]));
    let error = |time: &str| {
        Map::parse(time, Path::new("map.toml")).and_then(|m| m.time().map(|_| ())).unwrap_err().to_string()
    };
    assert!(error("[time]\nper_second = 0\n").contains("0 of them are no second"));
    assert!(error("[time]\nper_second = 8000\nunit = \"ms\"\n").contains("is beside a unit"));
}

/// A controller's loop that was counted: whatever its numbers look like, they are no milliseconds.
#[test]
fn a_clock_that_counts_has_no_unit_of_time() {
    let of = |name: &str, rows: [&str; 3]| drafted(&format!("{name},voltage [V]"), rows);
    let counted = ["2,0.1", "57,0.2", "109,0.3"];
    for name in ["timestep (8Hz)", "loop.ticks", "control cycle", "Sample"] {
        let map = of(name, counted);
        assert!(map.contains("per_second = 1000 # it counts") && !map.contains("unit = \"ms\""), "{map}");
        assert!(Map::parse(&map, Path::new("map.toml")).unwrap().time().is_ok(), "{map}");
    }
    // What has a unit, parts of one, or another name is a time.
    for (name, rows) in
        [("ticks_us", counted), ("steps", ["0.002,0.1", "0.057,0.2", "0.109,0.3"]), ("stepped since", counted)]
    {
        let map = of(name, rows);
        assert!(map.contains("unit = \"") && !map.contains("per_second"), "{name}: {map}");
    }
}

/// A test stand's time in seconds with rows seconds apart, its shares, and a bench with inputs called u.
#[test]
fn units_of_time_shares_and_inputs_are_understood() {
    let stand = drafted("Time (s),Motor Efficiency (%),Motor state,Motor ticks", ["0,1,3,1", "5.5,2,3,2", "11,3,3,4"]);
    assert!(stand.contains("unit = \"s\"") && stand.contains("enc_1 = \"Motor ticks\""), "{stand}");
    assert!(!stand.contains("= \"Motor Efficiency"), "{stand}");
    let bench = drafted("t u1 u2 enc_1 enc_2", ["0 0 0 0 0", "0.1 1 -0.5 3 -1", "0.2 -1 0.5 4 -2"]);
    assert!(bench.contains("duty_1 = \"u1\"") && bench.contains("duty_2 = \"u2\""), "{bench}");
    assert!(!drafted("t u1 enc_1", ["0 0 0", "0.1 7 3", "0.2 -9 4"]).contains("duty_1"));
}

/// A ramp of one experiment among others is no time of them all.
#[test]
fn a_ramp_among_tables_of_other_lengths_is_no_time() {
    let json = r#"{"a": [{"u": [0.0,0.1,0.25,0.3,0.4,0.5,0.62,0.7], "y": [0,1,1,0,3,1,2,1]},
        {"u": [0,1,0,1,0,1,0,1,0,1], "y": [0,1,0,1,0,1,0,2,0,1]}]}"#;
    let clock = Clock { rows: true, ..Clock::default() };
    let table = Table::of_bytes(json.as_bytes(), Path::new("x.json"), None, &clock).unwrap();
    assert!(draft(&table).contains("column = \"?\""), "{}", draft(&table));
}

/// What a robot's program told its sides, as a share or in numbers of its own.
#[test]
fn commands_of_a_side_are_duties_where_they_are_shares() {
    let rows = ["0,0.5,-0.25,10,20", "0.02,1,-1,12,18", "0.04,0,0.75,15,15"];
    let shares = drafted("t,leftCommand,rightCommand,leftEncoder,rightEncoder", rows);
    assert!(shares.contains("duty_1 = \"rightCommand\"") && shares.contains("duty_2 = \"leftCommand\""), "{shares}");
    assert!(shares.contains("enc_2 = \"leftEncoder\""), "{shares}");
    let own =
        drafted("t,leftCommand,rightCommand,leftTicks,rightTicks", ["0,200,3,1,1", "0.1,-255,9,3,2", "0.2,40,7,2,3"]);
    assert!(!own.contains("= \"leftCommand") && own.contains("enc_1 = \"rightTicks\""), "{own}");
}

#[test]
fn what_only_the_owner_knows_is_left_open() {
    let bench = drafted("Time (s),Voltage (V),Speed (steps/s)", ["0,6,0", "0.05,6,999.4", "0.1,6,1898.9"]);
    for line in [
        "duty_1 = { from = \"Voltage (V)\", scale = 0.1667 } # of 6 V",
        "# speed_1 = { from = \"Speed (steps/s)\", unit = \"counts/s\", counts_per_rev = ... }",
    ] {
        assert!(bench.contains(line), "{line}\n{bench}");
    }
    let text = "time (seconds),encoderLeft (meters),vRight wheel speed [m/s]\n0,1.5,1\n1,1.6,1\n2,2,1\n";
    let rover = draft(&Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock::default()).unwrap());
    for line in [
        "# enc_2 = { from = \"encoderLeft (meters)\", unit = \"rad\", scale = ...",
        "# speed_1 = { from = \"vRight wheel speed [m/s]\", scale = ... }",
    ] {
        assert!(rover.contains(line), "{line}\n{rover}");
    }
}

#[test]
fn what_a_motor_is_called_and_where_it_should_be_are_no_encoders() {
    let map = drafted(
        "time,motor_id,position,velocity,torque_feedback,position_cmd",
        ["0,5,0.11,0.5,0.1,0", "0.02,5,0.12,0.5,0.1,0", "0.04,5,0.13,0.5,0.1,0"],
    );
    assert!(map.contains("enc_1 = { from = \"position\", unit = \"rad\""), "{map}");
    assert!(!map.contains("enc_2") && map.contains("current_1 = \"torque_feedback\""), "{map}");
}

#[test]
fn motors_may_be_counted_from_zero() {
    let rows = ["0,0,1,2,0.1,0.2,0.3,0", "0.1,4,5,6,0.1,0.2,0.3,0", "0.2,7,8,9,0.1,0.2,0.3,0"];
    let map = drafted("t,enc0,enc1,enc2,axis0 current,axis1 current,axis2 current,over_current", rows);
    for line in
        ["enc_1 = \"enc0\"", "enc_3 = \"enc2\"", "current_1 = \"axis0 current\"", "current_3 = \"axis2 current\""]
    {
        assert!(map.contains(line), "{line}\n{map}");
    }
    assert!(map.contains("# \"over_current\", 0 to 0"), "{map}");
}

#[test]
fn a_message_has_the_time_of_its_stamp() {
    let header =
        "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.left_encoder,field.right_encoder";
    let text = format!(
        "{header}\n1494449924173,1,1494449924125,base,4,5\n1494449924175,2,1494449924145,base,6,7\n\
                        1494449924176,3,1494449924165,base,8,9\n"
    );
    let table = Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock::default()).unwrap();
    let map = draft(&table);
    assert!(map.contains("column = \"field.header.stamp\" # when it was measured"), "{map}");
    // Messages that nobody stamped keep the time at which they were received.
    let zeros = text.replace("1494449924125", "0").replace("1494449924145", "0").replace("1494449924165", "0");
    let table = Table::of_bytes(zeros.as_bytes(), Path::new("x.csv"), None, &Clock::default()).unwrap();
    assert!(draft(&table).contains("column = \"time\""), "{}", draft(&table));
}

/// Joints and motors on a bench log an angle and a torque under the letters of a book, and what was asked for beside it.
#[test]
fn angles_and_torques_of_joints_are_understood() {
    let pendulum = drafted("time,position,velocity,torque", ["0,0.5,0,0.25", "1,0.25,1,-0.5", "2,1.75,1,3"]);
    assert!(pendulum.contains("current_1 = \"torque\" # Nm at the output shaft"), "{pendulum}");
    let joints = drafted(
        "time,q1,q2,dq1,dq2,tau1,tau2",
        ["0,0.5,0.25,0,0,1,1.5", "1,0.25,0.5,1,1,2,2.5", "2,1.75,0.5,1,1,3,3.5"],
    );
    for line in ["enc_1 = { from = \"q1\", unit = \"rad\"", "enc_2 = { from = \"q2\"", "current_2 = \"tau2\" #"] {
        assert!(joints.contains(line), "{line}\n{joints}");
    }
    let measured = drafted(
        "time,pos_meas1,pos_filt1,tau_con1,tau_fric1,tau_meas1",
        ["0,0.5,0.5,1,0,1.5", "1,0.25,0.5,2,0,2.5", "2,1.75,0.5,3,0,3.5"],
    );
    assert!(measured.contains("current_1 = \"tau_meas1\"") && !measured.contains("current_2"), "{measured}");
    let qube = drafted(
        "t,target_theta,target_alpha,theta,alpha,plant_input",
        ["0,0,0.5,0.25,0,1", "1,0,0.5,0.5,1,2", "2,0,0.5,0.75,2,3"],
    );
    assert!(qube.contains("enc_1 = { from = \"theta\"") && !qube.contains("ref_1"), "{qube}");
    // What its loops are off by is no second motor, and the torque that they ask for is what drives.
    let cascade = drafted(
        "Time,Position,Velocity,Position Error,Velocity Setpoint,Velocity Error,Target Torque,Target Pos",
        ["0.0,-3.5,0,183.5,-78.5,78.5,-32,180", "0.1,-3.25,1.5,183.25,-78,79.5,-31.5,180", "0.2,-2,2,182,-77,79,5,180"],
    );
    for line in ["ref_1 = \"Velocity Setpoint\"", "enc_1 = { from = \"Position\"", "current_1 = \"Target Torque\" # Nm"]
    {
        assert!(cascade.contains(line), "{line}\n{cascade}");
    }
    assert!(!cascade.contains("enc_2 =") && !cascade.contains("ref_2 ="), "{cascade}");
    let speeds = drafted(
        "time_s,commanded_deg_s,angle_deg,feedback_deg_s",
        ["0.0,800,135.81,0.0", "0.1,800,139.56,757.13", "0.2,800,143.47,794.44"],
    );
    for line in ["ref_1 = { from = \"commanded_deg_s\", unit = \"deg/s\" }", "speed_1 = { from = \"feedback_deg_s\""] {
        assert!(speeds.contains(line), "{line}\n{speeds}");
    }
    let quaternion = drafted("time,current,q0,q1,q2,q3", ["0,1,1,0,0,0.5", "1,2,0.5,0.5,0,0.5", "2,3,0.5,0.5,0.5,0.5"]);
    assert!(!quaternion.contains("enc_1 = {"), "{quaternion}");
}

/// What one motor alone was told is its duty, and what it took in watts is not.
#[test]
fn the_power_of_one_motor_is_its_duty() {
    let told = drafted("time,m_power,motor_current,motor_position", ["0,0,0.5,3", "1,0.5,0.7,7", "2,0.95,0.8,12"]);
    assert!(told.contains("duty_1 = \"m_power\""), "{told}");
    let watts = drafted("time,Power (W),motor_current,motor_position", ["0,0,0.5,3", "1,0.5,0.7,7", "2,0.95,0.8,12"]);
    assert!(!watts.contains("duty_1"), "{watts}");
}

/// Volts that nobody measured are some 1e-124, and no drive.
#[test]
fn volts_that_were_not_measured_are_none() {
    let stand = drafted("time,Voltage (V),rpm", ["0,6.2e-124,0", "1,3.7e-125,10", "2,5.3e-124,20"]);
    assert!(stand.contains("speed_1 = ") && !stand.contains("duty_1"), "{stand}");
}

/// A lecture's robot on a map, whose commands have no axes.
#[test]
fn commands_without_axes_and_poses_on_a_map_are_known() {
    let names = "time_ns,velocity_command,rotation_command,map_x,map_y,map_theta,odom_x,odom_y,odom_theta,beacon_x";
    let map = drafted(
        names,
        ["0,0.1,0.2,1,2,0.5,1,2,0.3,4", "50000000,0.1,0.2,1,2,0.5,1,2,0.3,4", "100000000,0,0.2,1,2,0.5,1,2,0.3,4"],
    );
    for line in
        ["cmd_vx = \"velocity_command\"", "cmd_w = \"rotation_command\"", "cam_x = \"map_x\"", "odom_x = \"odom_x\""]
    {
        assert!(map.contains(line), "{line}: {map}");
    }
    let motor = drafted("time,velocity_command,velocity,position", ["0,1,0.5,0", "0.01,2,0.7,0.1", "0.02,2,0.8,0.1"]);
    assert!(!motor.contains("cmd_vx"), "{motor}");
}

/// A three-wheeled robot of a thesis, whose commands are set points of its body's velocities.
#[test]
fn speeds_and_set_points_of_control_engineers_are_understood() {
    let names = "t, ax, ay, alpha, w1, w2, w3, vbx_sp, vby_sp, wb_sp";
    let rows = [
        "0.01,0.1,0,6.2,-4.8,2.4,9.5,0.35,0,-1.2",
        "0.02,0.1,0,6.2,-4.8,2.4,9.5,0.35,0,0",
        "0.03,0,0,6,-5,2,9,0.35,0,0",
    ];
    let map = drafted(names, rows);
    for line in [
        "speed_1 = \"w1\" # in rad/s at the wheel?",
        "speed_3 = \"w3\" # in rad/s at the wheel?",
        "cmd_vx = \"vbx_sp\"",
        "cmd_vy = \"vby_sp\"",
        "cmd_w = \"wb_sp\"",
    ] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    // Where it should be is no velocity.
    let map = drafted("t,enc_1,target_x,target_y,target_theta", ["0,1,1,1,1", "1,2,1,1,1", "2,3,1,1,1"]);
    assert!(!map.contains("\ncmd_"), "{map}");
}

/// A file of lines each of which begins with what it is: all have their time in one column.
#[test]
fn lines_of_several_kinds_have_each_their_own_time() {
    let rows = |loops: [&str; 3]| {
        let row =
            |i: usize| format!("odom2 {0} 0.5 0 0.1\nangle {0} 0.3\nloop {1} 7\n", 0.1 * i as f64 + 0.03, loops[i]);
        (0..3).map(row).collect::<String>()
    };
    let map = |loops: [&str; 3]| {
        let bytes = rows(loops);
        let clock = Clock { rows: true, ..Clock::default() };
        draft(&Table::of_bytes(bytes.as_bytes(), Path::new("x.txt"), None, &clock).unwrap())
    };
    let timed = map(["0.05", "0.15", "0.25"]);
    assert!(timed.contains("column = \"column_2\" # is it?"), "{timed}");
    // A kind whose second column is no time says nothing of the others'.
    let other = map(["3", "1", "2"]);
    assert!(other.contains("column = \"odom2/column_2\" # is it?"), "{other}");
}

/// A file of a course, with names in a remark above blanks and units in brackets, beside its motion capture.
#[test]
fn names_in_remarks_and_units_in_brackets_are_understood() {
    let table = |text: &str| {
        Table::of_bytes(text.as_bytes(), Path::new("x.dat"), None, &Clock { rows: true, ..Clock::default() }).unwrap()
    };
    let log = table(
        "# made in 2009\n# Time [s]    forward velocity [m/s]    angular velocity[rad/s]\n1248444187.156 \t 0.086 \t -0.398\n\
         1248444187.186 \t 0.086 \t -0.398\n1248444197.197 \t 0.087 \t -0.398\n",
    );
    let truth = table(
        "# Time [s]    x [m]    y [m]    orientation [rad]\n1248444187.103 \t 1.41 \t -3.89 \t 2.26\n\
         1248444188.115 \t 1.42 \t -3.9 \t 2.27\n1248444196.141 \t 1.43 \t -3.91 \t 2.3\n",
    );
    let map = draft_two([(&log, Path::new("odom.dat")), (&truth, Path::new("gt.dat"))]);
    for line in [
        "column = \"Time [s]\"\nunit = \"s\"",
        "\nodom_vx = \"forward velocity [m/s]\"",
        "\nodom_w = \"angular velocity[rad/s]\"",
        "clock = \"same\"",
        "\ncam_x = \"x [m]\"",
        "\ncam_theta = \"orientation [rad]\"",
    ] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    Map::parse(&map, Path::new("map.toml")).unwrap();
    // The same without names: what increases is the time, is not called unused, and tells how the clocks stand.
    let bare = |text: &str| table(&text.lines().filter(|l| !l.starts_with('#')).collect::<Vec<_>>().join("\n"));
    let texts = [
        "1600000000.5 1 2\n1600000000.6 2 2\n1600000009.7 3 2\n",
        "1600000001.5 1 2\n1600000003.6 2 2\n1600000009.2 3 2\n",
    ];
    let [log, truth] = texts.map(bare);
    let map = draft_two([(&log, Path::new("odom.dat")), (&truth, Path::new("gt.dat"))]);
    assert!(map.contains("clock = \"same\"") && !map.contains("# \"column_1\""), "{map}");
    assert!(map.contains("column = \"column_1\" # is it?") && map.contains("# \"column_3\", 2 to 2"), "{map}");
}

#[test]
fn epochs_tell_the_unit_of_time() {
    for (first, step, unit) in [(1.6e9, 0.5, "s"), (1.6e12, 5000.0, "ms"), (1.6e15, 5000.0, "us"), (5.0, 5000.0, "us")]
    {
        let row = |k: f64| format!("{},{k}", first + k * step);
        let map = drafted("t,enc_1", [&row(0.0), &row(1.0), &row(2.0)]);
        assert!(map.contains(&format!("column = \"t\"\nunit = \"{unit}\"")), "{first}\n{map}");
    }
}

#[test]
fn what_is_now_is_no_current() {
    let ssl = drafted(
        "t,CURRENT_M1,CURRENT_M2,PWM_M1,PWM_M2,DESIRED_M1,DESIRED_M2",
        ["0,0,0,15,15,40,40", "0.1,3.1,2.3,15,15,40,40", "0.2,6.1,5.4,15,15,40,40"],
    );
    for line in
        ["speed_1 = \"CURRENT_M1\" # in rad/s", "speed_2 = \"CURRENT_M2\"", "ref_1 = \"DESIRED_M1\"", "duty_2 = "]
    {
        assert!(ssl.contains(line), "{line}\n{ssl}");
    }
    let servo = drafted("t,currentPosition,current,pwm", ["0,0,0.5,10", "0.1,7,0.5,10", "0.2,9,0.4,10"]);
    assert!(servo.contains("enc_1 = \"currentPosition\"") && servo.contains("current_1 = \"current\""), "{servo}");
    let motor = drafted("t,current,target,rpm", ["0,0.1,50,10", "0.1,0.7,50,20", "0.2,0.9,50,30"]);
    assert!(motor.contains("current_1 = \"current\""), "{motor}");
}

#[test]
fn counts_that_are_asked_for_are_no_speed() {
    let servo = drafted("Time,EncoderPosition,TargetCounts", ["0,0,700", "0.1,7,700", "0.2,9,700"]);
    assert!(servo.contains("enc_1 = \"EncoderPosition\"") && !servo.contains("ref_1"), "{servo}");
}

#[test]
fn volts_of_a_side_are_of_a_motor() {
    let volts = "t,motor voltage left [V],motor voltage right [V],battery [V],wheel velocity left,wheel velocity right";
    let map = drafted(volts, ["0,1.1,1.2,12,0,0", "0.1,1.9,1.8,12,2,2", "0.2,1.9,1.8,12,3,3"]);
    for line in
        ["duty_1 = { from = \"motor voltage right", "duty_2 = { from = \"motor voltage left", "supply_v = \"battery"]
    {
        assert!(map.contains(line), "{line}\n{map}");
    }
}

#[test]
fn inputs_and_speeds_of_sides_are_no_encoders() {
    let skid = drafted(
        "t_cmd,u_right,u_left,t_odom,w_right,w_left",
        ["0.5,0,0,0.55,0,0.1", "1.0,63,63,1.05,9.5,9.1", "1.5,-63,-63,1.56,-9.5,-9.2"],
    );
    for line in [
        "speed_1 = \"w_right\"",
        "speed_2 = \"w_left\"",
        "\"u_left\", -63 to 63; what drives it? duty_2 = { from = \"u_left\", scale",
    ] {
        assert!(skid.contains(line), "{line}\n{skid}");
    }
    assert!(!skid.contains("enc_"), "{skid}");
    let shares = drafted("t,u_right,u_left,ticks_right,ticks_left", ["0,0,0,1,2", "1,1,-1,5,6", "2,1,0,7,9"]);
    assert!(shares.contains("duty_1 = \"u_right\"") && shares.contains("enc_2 = \"ticks_left\""), "{shares}");
}

/// Joints that have names, and no torque yet.
#[test]
fn torques_stand_beside_their_joints() {
    let names = ["elbow/effort", "elbow/position", "wrist/effort", "wrist/position"].map(|n| format!("/arm_joint/{n}"));
    let rows = ["0,0,0.1,0,0.3", "1,0,0.2,0,0.35", "2,0,0.4,0,0.5"];
    let arm = drafted(&format!("t,{}", names.join(",")), rows);
    for line in [
        "enc_1 = { from = \"/arm_joint/elbow/position\"",
        "enc_2 = { from = \"/arm_joint/wrist/position\"",
        "current_1 = \"/arm_joint/elbow/effort\"",
        "current_2 = \"/arm_joint/wrist/effort\"",
    ] {
        assert!(arm.contains(line), "{line}\n{arm}");
    }
}

/// Lists of three in JSON: a robot that pushes something.
#[test]
fn a_pose_that_is_a_list_has_its_parts() {
    let row = |t: f64| {
        let of = |x: f64| format!("{{\"pose\":[{x},0.{t},1.5],\"target_velocity\":[0.05,{x},0.01]}}");
        format!("{{\"time\":{t},\"object\":{},\"robot\":{}}}", of(0.3 + 0.1 * t), of(0.1 * t))
    };
    let text = format!("[{},{},{}]", row(0.0), row(1.0), row(2.0));
    let table = Table::of_bytes(text.as_bytes(), Path::new("x.json"), None, &Clock::default()).unwrap();
    let pushing = draft(&table);
    for line in [
        "cmd_vx = \"robot/target_velocity/1\"",
        "cmd_w = \"robot/target_velocity/3\"",
        "cam_x = \"robot/pose/1\"",
        "cam_y = \"robot/pose/2\"",
        "cam_theta = \"robot/pose/3\"",
    ] {
        assert!(pushing.contains(line), "{line}\n{pushing}");
    }
    assert!(!pushing.contains("\nref_1"), "{pushing}");
}

/// Lines with every number after its name: a tricycle's own reckoning beside a tracker of its laser.
#[test]
fn of_two_poses_in_lists_the_trackers_is_the_cameras() {
    let line = |k: u32| {
        let (x, y) = (0.1 * f64::from(k), 0.02 * f64::from(k * k));
        format!("time: {k}.5 ticks: {} {} model_pose: {x} {y} 0.1 tracker_pose: {y} {x} 0.2\n", 290 + k, 4000 + 7 * k)
    };
    let text: String = (0..40).map(line).collect();
    let tricycle = draft(&Table::of_bytes(text.as_bytes(), Path::new("x.txt"), None, &Clock::default()).unwrap());
    for line in ["cam_x = \"tracker_pose_1\"", "cam_y = \"tracker_pose_2\"", "cam_theta = \"tracker_pose_3\""] {
        assert!(tricycle.contains(line), "{line}\n{tricycle}");
    }
    assert!(!tricycle.contains("= \"model_pose"), "{tricycle}");
}

/// Of a driver that measures no efforts.
#[test]
fn what_drives_is_left_open_where_it_is_never_anything_but_0() {
    let rows = ["0,0,0.1,0,0.3", "1,0,0.2,0,0.35", "2,0,0.4,0,0.5"];
    let header = "t,elbow/effort,elbow/position,wrist/effort,wrist/position";
    let idle = drafted(header, rows);
    assert!(idle.contains("\n# current_1 = \"elbow/effort\"") && idle.contains("\n# current_2 = "), "{idle}");
    let one = drafted(header, ["0,0,0.1,0,0.3", "1,0,0.2,0.5,0.35", "2,0,0.4,0,0.5"]);
    assert!(one.contains("\ncurrent_1 = \"elbow/effort\"") && one.contains("\ncurrent_2 = "), "{one}");
}

#[test]
fn the_one_speed_beside_volts_is_the_motors() {
    let motor = drafted("time,voltage,velocity", ["0,-3,-20.5", "0.01,3,20.5", "0.02,12,20.5"]);
    assert!(motor.contains("speed_1 = \"velocity\"") && motor.contains("duty_1 = "), "{motor}");
    let stepped = drafted("time,voltage [V],motor velocity [rpm]", ["0,12,0", "0.01,12,20.5", "0.02,12,90.5"]);
    for line in ["speed_1 = { from = \"motor velocity [rpm]\", unit = \"rpm\" }", "duty_1 = "] {
        assert!(stepped.contains(line), "{line}\n{stepped}");
    }
    let drive = drafted(
        "time [ms],Velocity actual value averaged [rpm],Torque actual value averaged [%]",
        ["0,-199,-31.9", "6.4,-201,-30.2", "12.8,-150,-12.5"],
    );
    for line in
        ["speed_1 = { from = \"Velocity actual value averaged [rpm]\"", "%]\", scale = 0.01 } # write 0.01 times"]
    {
        assert!(drive.contains(line), "{line}\n{drive}");
    }
    // A body's is none, and of several nobody knows.
    for body in ["velocity x", "linear velocity [m/s]", "velocity,speed_ref,speed"] {
        let map = drafted(&format!("time,voltage,{body}"), ["0,-3,1.5,2,3", "1,3,2.5,3,4", "2,4,2.5,5,6"]);
        assert!(!map.contains("\nspeed_1 = \"velocity\""), "{map}");
    }
}

/// A robot of the FIRST Tech Challenge: what its motors are told, its pose and the velocities of its body.
#[test]
fn corners_that_reach_all_of_a_share_are_duties_beside_a_body() {
    let names = "time,battery_voltage,fl,fr,bl,br,x_position,y_position,angle,x_velocity,y_velocity,angular_velocity";
    let rows = ["0.05,12.7,0,-0,0,0,-0.27,-0.05,-0.01,0.2,0.1,0.02", "0.1,9.4,0.9,-1,0.9,1,0.7,0.01,1.1,1.3,-0.2,-5.3"];
    let map = drafted(names, [rows[0], rows[1], "0.16,9.3,1,-0.9,1,0.9,2.4,0.02,1.2,1.2,0.1,-5.6"]);
    let lines = ["duty_1 = \"fl\"", "duty_2 = \"fr\"", "duty_3 = \"bl\"", "duty_4 = \"br\"", "cam_x = \"x_position\""];
    for line in lines.into_iter().chain(["cam_y = \"y_position\"", "cam_theta = \"angle\"", "# \"angular_velocity\""]) {
        assert!(map.contains(line), "{line}: {map}");
    }
}

/// Motors whose number is part of the word, and what a robot of a league saw of itself: a velocity is no place.
#[test]
fn a_motor_with_its_number_drives_and_turns_and_a_velocity_is_no_place() {
    let names = "time,motor1_cmd,motor2_cmd,motor1_speed,motor2_speed,motor1_temp";
    let map = drafted(names, ["0,-0.08,0.1,0,0,30", "10,-0.08,0.1,-2.4,2.2,31", "20,0.08,0.2,-3.4,3.6,31"]);
    for line in ["duty_1 = \"motor1_cmd\"", "duty_2 = ", "speed_2 = \"motor2_speed\"", "# \"motor1_temp\""] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    let rows = ["0.1,0.5,0.1,0,0,0.3,0,1", "0.2,0.51,0.1,0,0.1,0.3,0.01,2", "0.3,0.52,0.1,0,0.1,0.3,0.01,3"];
    let seen = drafted("time,px,vx,py,vy,pt,vt,enc_1", rows);
    let body =
        drafted("t,vx,vy,w,gt_vx,gt_vy,enc_1", ["0,0.1,0.2,0.3,0,0,1", "1,0.2,0.1,0.2,1,1,2", "2,0.3,0,0.1,2,2,3"]);
    assert!(!seen.contains("\ncam_") && !body.contains("\ncam_"), "{seen}{body}");
}

/// Way and turn since the row before, as loggers of dead reckoning write them beside poses.
#[test]
fn steps_of_way_and_turn_are_an_odometry() {
    let table = |text: &str, name: &str| {
        Table::of_bytes(text.as_bytes(), Path::new(name), None, &Clock { rows: true, ..Clock::default() }).unwrap()
    };
    let truth = table("time,x,y,heading\n0,0,0,0\n1,1,1,1\n2,2,1,0\n", "gt.csv");
    let of = |header: &str| {
        let log = table(&format!("{header}\n0.2,0.1,0.01\n0.4,0.2,0.02\n0.6,0.1,-0.01\n"), "log.csv");
        draft_two([(&log, Path::new("log.csv")), (&truth, Path::new("gt.csv"))])
    };
    let map = of("Time,Delta Dist. Trav. (m),Delta Heading (rad)");
    for line in [
        "odom_x = { from = \"Delta Dist. Trav. (m)\", increments = true }",
        "odom_theta = { from = \"Delta Heading (rad)\", increments = true }",
    ] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    let degrees = of("Time,delta_distance [cm],delta_yaw [deg]");
    assert!(
        degrees.contains("unit = \"deg\", increments = true") && degrees.contains("unit = \"cm\", incr"),
        "{degrees}"
    );
    assert!(!of("Time,Dist. Trav. (m),Heading error").contains("increments"));
}

/// As a team of the small-size league writes it: a unit at the first of two, rpm of motors, and what vision saw.
#[test]
fn a_log_of_a_league_s_team_is_understood() {
    let map = drafted(
        "time_ms,vx_cmd [mm/s],vy_cmd,omega_cmd,M1 rpm,M2 rpm,ssl_x [mm],ssl_y,ssl_o,ssl_ball_x,ssl_ball_y",
        [
            "0,30,30,-0.1,-24,61,-0.1,1.4,-0.44,800,1",
            "10,60,60,-0.2,-52,131,,,,,",
            "20,90,90,-0.3,-76,190,2,1.4,-0.5,800,1",
        ],
    );
    for line in [
        "cmd_vx = { from = \"vx_cmd [mm/s]\", unit = \"mm/s\" }",
        "cmd_vy = { from = \"vy_cmd\", unit = \"mm/s\" }",
        "speed_2 = { from = \"M2 rpm\", unit = \"rpm\" } # at the wheel? At the motor with scale = 1 / gear_ratio",
        "cam_x = { from = \"ssl_x [mm]\", unit = \"mm\" }",
        "cam_y = { from = \"ssl_y\", unit = \"mm\" }",
        "cam_theta = \"ssl_o\"",
        "# \"ssl_ball_x\"",
    ] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    let said = drafted("t,cmd_x [mm/s],cmd_y [m/s],cmd_w", ["0,0,0,0", "1,900,1,1", "2,0,0,0"]);
    assert!(said.contains("cmd_vy = \"cmd_y [m/s]\""), "a unit that is said stays\n{said}");
}
