//! Poses, and what of a body is like one.

use super::*;

/// Of two poses in a bag that which comes with velocities is the robot's own, whatever its topic is called.
#[test]
fn a_pose_with_velocities_beside_another_is_the_robots_own() {
    let own = "/robot/pose.x,/robot/pose.y,/robot/pose.theta,/robot/pose.vx,/robot/pose.vy,/robot/pose.w";
    let rows = ["0,0.1,0,0.1,0.3,0,0.1", "1,0.4,0,0.2,0.3,0,0.1", "2,0.7,0.1,0.3,0.3,0,0.1"];
    let alone = drafted(&format!("t,{own}"), rows);
    assert!(alone.contains("cam_x = \"/robot/pose.x\""), "{alone}");
    let seen = rows.map(|row| format!("{row},2.1,3.0,1.2"));
    let header = format!("t,{own},/ground_pose.x,/ground_pose.y,/ground_pose.theta");
    let both = drafted(&header, seen.each_ref().map(String::as_str));
    for line in ["odom_x = \"/robot/pose.x\"", "odom_theta = ", "cam_x = \"/ground_pose.x\"", "cam_theta = \"/ground"] {
        assert!(both.contains(line), "{line}\n{both}");
    }
}

#[test]
fn odometry_and_ground_truth_are_known_by_what_their_axes_are_written_with() {
    let rows = ["0.0,0,0,0,0.1,0.2,0.3", "0.1,0,0,0,0.1,0.2,0.3", "0.2,0,0,0,0.1,0.2,0.3"];
    for (header, odometry, truth) in [
        ("t,ox,oy,oth,gtx,gty,gtth", "oth", "gtth"),
        ("t,odo_x,odo_y,odo_theta,gt_x,gt_y,gt_theta", "odo_theta", "gt_theta"),
        ("t,x_odom,y_odom,th_odom,x_true,y_true,th_true", "th_odom", "th_true"),
        ("time,o_x,o_y,o_yaw,viconX,viconY,viconYaw", "o_yaw", "viconYaw"),
        ("time,xodom,yodom,thodom,optitrack x,optitrack y,optitrack phi", "thodom", "optitrack phi"),
    ] {
        let map = drafted(header, rows);
        let lines = [format!("odom_theta = \"{odometry}\""), format!("cam_theta = \"{truth}\"")];
        assert!(lines.iter().all(|line| map.contains(line)), "{header}\n{map}");
    }
    // No axis of anything.
    let map = drafted("t,enc_1,both,other,oxy,max", ["0,7,1,2,3,4", "1,7,2,3,4,5", "3,7,3,4,5,6"]);
    assert!(!map.contains("\nodom_") && !map.contains("\ncam_"), "{map}");
}

/// A mower on a lawn of 70 m, whose file of poses has the same names as its odometry.
#[test]
fn poses_beside_a_file_with_the_pose_are_odometry_and_a_lawn_is_no_field_in_millimetres() {
    let log = |drift: f64| {
        let rows = (0..200).map(|k| 0.2 * f64::from(k)).map(|t| {
            format!("{:.1},{:.4},{:.4},{:.4}\n", 3000.0 + t, 2.0 * t - 10.0, 1.5 * t * (1.0 + drift), 0.64 + drift)
        });
        "Time,X_pose,Y_pose,Heading\n".to_owned() + &rows.collect::<String>()
    };
    let table = |text: &str| {
        Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock { rows: true, ..Clock::default() }).unwrap()
    };
    let (odometry, truth) = (table(&log(0.01)), table(&log(0.0)));
    let map = draft_two([(&odometry, Path::new("odom.csv")), (&truth, Path::new("gt.csv"))]);
    for line in ["odom_x = \"X_pose\"", "odom_theta = \"Heading\"", "cam_x = \"X_pose\"", "cam_theta = \"Heading\""] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    Map::parse(&map, Path::new("map.toml")).unwrap();
}

#[test]
fn the_height_of_a_message_is_no_heading() {
    let header = "%time,field.pose.pose.position.x,field.pose.pose.position.y,field.pose.pose.position.z,\
                  field.pose.pose.orientation.x,field.pose.pose.orientation.y,field.pose.pose.orientation.z,\
                  field.pose.pose.orientation.w,field.twist.twist.linear.x,field.twist.twist.linear.y,\
                  field.twist.twist.linear.z,field.twist.twist.angular.z";
    let map = drafted(
        header,
        ["1,0,0,0,0,0,0,1,0.1,0,0,0.2", "2,1,2,0,0,0,0.6,0.8,0.1,0,0,0.2", "3,1,2,0,0,0,0.6,0.8,1,0,0,0"],
    );
    assert!(map.contains("odom_theta = \"field.pose.pose.orientation.yaw\"") && !map.contains("cmd_"), "{map}");
    let header = "time,field.linear.x,field.linear.y,field.linear.z,field.angular.x,field.angular.y,field.angular.z";
    let twist = header.replace("field.", "/cmd_vel/");
    let map = drafted(&twist, ["1,0.1,0,0,0,0,0.2", "2,0.2,0,0,0,0,0.3", "3,0,0,0,0,0,0.1"]);
    assert!(map.contains("cmd_vx = \"/cmd_vel/linear.x\"") && map.contains("cmd_w = \"/cmd_vel/angular.z\""), "{map}");
}

/// An odometry of velocities alone, beside the file with the pose.
#[test]
fn velocities_beside_a_file_with_the_pose_are_odometry() {
    let table = |text: &str| {
        Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock { rows: true, ..Clock::default() }).unwrap()
    };
    let truth = table("time,x,y\n0.1,0,0\n0.2,0,0.1\n0.35,0,0.2\n");
    let of = |text: &str| draft_two([(&table(text), Path::new("odom.csv")), (&truth, Path::new("gt.csv"))]);
    let map = of("time,v,w\n0.1,0.5,0.1\n0.2,0.5,0.1\n0.35,0.5,0.1\n");
    for line in ["\nodom_vx = \"v\" # ", "\nodom_w = \"w\" # "] {
        assert!(map.contains(line), "{line}\n{map}");
    }
    Map::parse(&map, Path::new("map.toml")).unwrap();
    let map = of("time,vx,vy,w,enc_1,enc_2\n0.1,0.5,0,0.1,1,2\n0.2,0.5,0,0.1,3,4\n0.35,0.5,0,0.1,5,6\n");
    assert!(!map.contains("\nodom_"), "{map}");
}

/// What a draft cannot know it asks for where it stands.
#[test]
fn pixels_headings_and_what_drives_are_asked_for() {
    let rows = |row: &str| [0, 1, 2].map(|i| format!("{i}.5,{}", row.replace('i', &i.to_string())));
    let map = |names: &str, row: &str| {
        let rows = rows(row);
        drafted(names, [&rows[0], &rows[1], &rows[2]])
    };
    let robot = map("t,left velocity (),right velocity (),x (cm),y (cm),theta (deg)", "1i,2i,3i,4i,5i");
    for line in [
        "speed_2 = \"left velocity ()\"",
        "cam_x = { from = \"x (cm)\", unit = \"cm\" }",
        "cam_theta = { from = \"theta (deg)\"",
    ] {
        assert!(robot.contains(line), "{line}\n{robot}");
    }
    let image = map("t,enc_1,enc_2,cam_x_px,cam_y_px,cam_theta", "1i,2i,30i,40i,0.i");
    assert!(image.contains("# cam_x = { from = \"cam_x_px\", scale = ... } # pixels"), "{image}");
    let place = map("t,enc_1,odom_x,odom_y,cmd_left", "3i,1i,2i,20i");
    assert!(place.contains("# odom_x = \"odom_x\" # the robot's own odometry needs its heading"), "{place}");
    assert!(place.contains("\"cmd_left\", 200 to 202; steps of a PWM? duty_2 with scale = 0.003922"), "{place}");
    let whole = map("t,odom_x,odom_y,yaw", "1i,2i,0.i");
    assert!(whole.contains("\nodom_x = \"odom_x\"\n") && whole.contains("odom_theta = \"yaw\""), "{whole}");
    let seen = map("t,enc_1,enc_2,mocap_x,mocap_y", "1i,2i,0.i,0.4");
    assert!(seen.contains("\ncam_x = \"mocap_x\"") && !seen.contains("cam_theta"), "{seen}");
    let plant = map("t,r,y,u,enc_1", "9i,8i,4i,i");
    for line in
        ["\"y\", 80 to 82; what it measures? speed_1", "\"u\", 40 to 42; what drives it? duty_1", "; set points? ref_1"]
    {
        assert!(plant.contains(line), "{line}\n{plant}");
    }
    // Channels of a recorder without a unit.
    let recorder = map("t,Input,Velo,enc_1", "1i,2i,i");
    for line in ["\"Input\", 10 to 12; what drives it? duty_1", "\"Velo\", 20 to 22; of a shaft? speed_1"] {
        assert!(recorder.contains(line), "{line}\n{recorder}");
    }
}
