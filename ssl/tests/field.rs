//! What messages do to the field, in simulated time.

mod support;

use proptest::prelude::*;
use runs::robot::Robot;
use ssl::front::{self, Team};
use ssl::messages::{
    MoveCommand, MoveGlobalVelocity, MoveWheelVelocity, RobotCommand, RobotId, RobotLimits, RobotSpecs,
    RobotWheelAngles, SimulatorCommand, SimulatorConfig, SimulatorControl, TeamColor, TeleportBall, TeleportRobot,
};
use ssl::world::World;
use support::{ask, ball, field_of, four_wheels, local, moves, pass, teleport, tell};

fn blue(id: u32) -> RobotId {
    RobotId { id: Some(id), team: Some(TeamColor::Blue.into()) }
}

/// A robot at the origin that looks along x.
fn at_origin() -> World {
    let mut world = field_of(&[Robot::racbot()]);
    let to = TeleportRobot { id: blue(0), x: Some(0.0), y: Some(0.0), orientation: Some(0.0), ..Default::default() };
    assert_eq!(teleport(&mut world, to), [""; 0]);
    assert!(ball(&mut world, TeleportBall { x: Some(2.0), y: Some(2.0), ..Default::default() }).is_empty());
    world
}

fn codes(answer: &ssl::messages::RobotControlResponse) -> Vec<&str> {
    answer.errors.iter().filter_map(|error| error.code.as_deref()).collect()
}

/// Commands every 16 ms for a time.
fn drive(world: &mut World, command: RobotCommand, milliseconds: u32) {
    for _ in 0..milliseconds / 16 {
        assert!(codes(&tell(world, &[command])).is_empty());
        pass(world, 16);
    }
}

#[test]
fn a_local_velocity_moves_the_robot_along_its_nose_and_silence_stops_it() {
    let mut world = at_origin();
    drive(&mut world, local(0, 0.5, 0.0, 0.0), 1_600);
    let pose = world.robot_of(Team::Blue, 0).unwrap().pose();
    assert!((0.5..0.75).contains(&pose.x) && pose.y.abs() < 0.01, "{pose:?}");
    pass(&mut world, 90);
    assert!(world.robot_of(Team::Blue, 0).unwrap().twist().vy > 0.45, "it still drives");
    pass(&mut world, 1_500);
    let twist = world.robot_of(Team::Blue, 0).unwrap().twist();
    assert!(twist.speed() < 0.01, "{twist:?}");
    drive(&mut world, local(0, 0.0, 0.4, 0.0), 800);
    let moved = world.robot_of(Team::Blue, 0).unwrap().pose();
    assert!(moved.y > 0.1 && (moved.x - pose.x).abs() < 0.4, "left is +y: {moved:?}");
}

#[test]
fn a_global_velocity_is_along_the_field_while_the_robot_turns() {
    let mut world = at_origin();
    let command = MoveCommand::GlobalVelocity(MoveGlobalVelocity { x: 0.3, y: 0.0, angular: 1.0 });
    drive(&mut world, moves(0, command), 3_200);
    let pose = world.robot_of(Team::Blue, 0).unwrap().pose();
    assert!(pose.x > 0.7 && pose.y.abs() < 0.06 && pose.theta > 1.0, "{pose:?}");
}

#[test]
fn wheel_velocities_need_four_wheels_in_the_corners() {
    let turn = MoveWheelVelocity { front_right: 0.2, back_right: 0.2, back_left: 0.2, front_left: 0.2 };
    let mut world = field_of(&[Robot::racbot(), four_wheels()]);
    let answer = tell(&mut world, &[moves(0, MoveCommand::WheelVelocity(turn))]);
    assert_eq!(codes(&answer), ["VELOCITY_TYPE"]);
    let before = world.robot_of(Team::Blue, 1).unwrap().pose();
    drive(&mut world, moves(1, MoveCommand::WheelVelocity(turn)), 1_600);
    let after = world.robot_of(Team::Blue, 1).unwrap().pose();
    assert!(after.distance(before) < 0.01 && after.theta - before.theta > 2.0, "counter-clockwise: {after:?}");
    // Right wheels back, left wheels forward, seen from above: counter-clockwise is forward on the right side.
    let ahead = MoveWheelVelocity { front_right: 0.3, back_right: 0.3, back_left: -0.3, front_left: -0.3 };
    drive(&mut world, moves(1, MoveCommand::WheelVelocity(turn)), 32);
    pass(&mut world, 1_000);
    let before = world.robot_of(Team::Blue, 1).unwrap().pose();
    drive(&mut world, moves(1, MoveCommand::WheelVelocity(ahead)), 800);
    let moved = before.relative(world.robot_of(Team::Blue, 1).unwrap().pose());
    assert!(moved.y > 0.1 && moved.x.abs() < 0.02, "{moved:?}");
}

#[test]
fn a_kick_goes_out_by_the_kickers_timing_and_the_next_waits_for_the_lock_out() {
    let mut world = at_origin();
    let kick = RobotCommand { kick_speed: Some(3.0), ..local(0, 0.0, 0.0, 0.0) };
    assert!(ball(&mut world, TeleportBall { x: Some(0.095), y: Some(0.0), ..Default::default() }).is_empty());
    pass(&mut world, 5);
    let answer = tell(&mut world, &[local(0, 0.0, 0.0, 0.0)]);
    assert_eq!(answer.feedback[0].dribbler_ball_contact, Some(true));
    tell(&mut world, &[kick]);
    let mut waited = 0;
    while world.ball().velocity[0] < 1.0 {
        world.step();
        waited += 1;
        assert!(waited < 50);
    }
    // The pulse of 3 m/s is 3 ms; before it come the command's tick and the charger's gap.
    assert!((4..=8).contains(&waited), "{waited} ms");
    assert!((world.ball().velocity[0] - 3.0).abs() < 0.05, "{:?}", world.ball());
    // The ball back at once: a kick within the lock-out of 100 ms does not happen, one after it does, weaker.
    assert!(ball(&mut world, TeleportBall { x: Some(0.095), y: Some(0.0), ..Default::default() }).is_empty());
    let mut waited = 0;
    while world.ball().velocity[0] < 0.5 {
        tell(&mut world, &[kick]);
        world.step();
        waited += 1;
        assert!(waited < 400, "{:?}", world.ball());
    }
    assert!((100..=130).contains(&waited), "{waited} ms");
    assert!(world.ball().velocity[0] < 1.5, "an eighth of a second of charging: {:?}", world.ball());
}

#[test]
fn a_chip_kick_flies_and_angles_out_of_range_have_a_code() {
    let mut world = at_origin();
    assert!(ball(&mut world, TeleportBall { x: Some(0.095), y: Some(0.0), ..Default::default() }).is_empty());
    pass(&mut world, 5);
    let chip = RobotCommand { kick_speed: Some(4.0), kick_angle: Some(45.0), ..local(0, 0.0, 0.0, 0.0) };
    tell(&mut world, &[chip]);
    pass(&mut world, 100);
    assert!(world.ball().position[2] > 0.1, "{:?}", world.ball());
    for (kick_speed, kick_angle, code) in
        [(1.0, -1.0, "ANGLE_VALUE"), (1.0, f32::NAN, "ANGLE_VALUE"), (-1.0, 0.0, "VALUE"), (11.0, 0.0, "KICK_SPEED")]
    {
        let kick =
            RobotCommand { kick_speed: Some(kick_speed), kick_angle: Some(kick_angle), ..local(0, 0.0, 0.0, 0.0) };
        assert_eq!(codes(&tell(&mut world, &[kick])), [code]);
    }
}

#[test]
fn the_dribbler_takes_the_ball_along() {
    let mut world = at_origin();
    assert!(ball(&mut world, TeleportBall { x: Some(0.095), y: Some(0.0), ..Default::default() }).is_empty());
    let back = RobotCommand { dribbler_speed: Some(1_000.0), ..local(0, -0.3, 0.0, 0.0) };
    drive(&mut world, back, 1_600);
    let (ball, pose) = (world.ball().position, world.robot_of(Team::Blue, 0).unwrap().pose());
    assert!(pose.x < -0.2 && (ball[0] - pose.x - 0.0945).abs() < 0.02, "{ball:?} {pose:?}");
}

#[test]
fn teleports_configure_and_speeds_answer_by_code() {
    let mut world = at_origin();
    let robot = |id, change: fn(&mut TeleportRobot)| {
        let mut to = TeleportRobot { id, ..TeleportRobot::default() };
        change(&mut to);
        to
    };
    assert_eq!(teleport(&mut world, robot(blue(7), |_| {})), ["UNKNOWN_ROBOT"]);
    assert_eq!(teleport(&mut world, robot(blue(99), |to| to.present = Some(true))), ["ROBOT_ID"]);
    assert_eq!(teleport(&mut world, robot(RobotId::default(), |_| {})), ["ROBOT_ID"]);
    assert_eq!(teleport(&mut world, robot(blue(0), |to| to.by_force = Some(true))), ["TELEPORT_BY_FORCE"]);
    assert_eq!(teleport(&mut world, robot(blue(0), |to| to.x = Some(f32::INFINITY))), ["VALUE"]);
    assert!(teleport(&mut world, robot(blue(7), |to| to.present = Some(true))).is_empty());
    assert_eq!(world.robot_count(), 2);
    assert!(teleport(&mut world, robot(blue(7), |to| to.present = Some(false))).is_empty());
    assert_eq!(world.robot_count(), 1);
    assert_eq!(ball(&mut world, TeleportBall { by_force: Some(true), ..Default::default() }), ["TELEPORT_BY_FORCE"]);
    let onto = TeleportBall { x: Some(0.0), y: Some(0.0), teleport_safely: Some(true), ..Default::default() };
    assert_eq!(ball(&mut world, onto), ["TELEPORT_SAFELY"]);
    for (speed, code) in [(0.5, None), (0.0, None), (-1.0, Some("SIMULATION_SPEED")), (1e-30, Some("SIMULATION_SPEED"))]
    {
        let control = SimulatorControl { simulation_speed: Some(speed), ..Default::default() };
        let answer = ask(&mut world, &SimulatorCommand { control: Some(control), config: None });
        assert_eq!(answer.first().map(String::as_str), code, "{speed}");
    }
    let config = |config| SimulatorCommand { control: None, config: Some(config) };
    let realism = SimulatorConfig { realism_config: Some(vec![]), vision_port: Some(70_000), ..Default::default() };
    assert_eq!(ask(&mut world, &config(realism)), ["CUSTOM", "VISION_PORT"]);
    let geometry = SimulatorConfig { geometry: Some(Default::default()), ..Default::default() };
    assert_eq!(ask(&mut world, &config(geometry)), ["GEOMETRY"]);
}

#[test]
fn specs_change_mass_limits_and_wheels() {
    let mut world = field_of(&[Robot::racbot(), four_wheels()]);
    let config = |specs: RobotSpecs| SimulatorCommand {
        control: None,
        config: Some(SimulatorConfig { robot_specs: vec![specs], ..Default::default() }),
    };
    let angles = RobotWheelAngles { front_right: 0.6, back_right: 2.3, back_left: 4.0, front_left: 5.7 };
    let specs = |id| RobotSpecs { id: blue(id), wheel_angles: Some(angles), mass: Some(3.0), ..Default::default() };
    assert_eq!(ask(&mut world, &config(specs(0))), ["ROBOT_SPECS"]);
    assert_eq!(ask(&mut world, &config(specs(1))), [""; 0]);
    let believed = &world.robot_of(Team::Blue, 1).unwrap().kind().believed;
    assert!((believed.mass_kg - 3.0).abs() < 1e-9);
    let wheels = believed.layout.wheels();
    let clockwise = wheels[0].x_m.atan2(wheels[0].y_m);
    assert!((clockwise - 0.6).abs() < 1e-6, "{wheels:?}");
    let slow = RobotLimits { vel_absolute_max: Some(0.1), ..Default::default() };
    assert!(ask(&mut world, &config(RobotSpecs { id: blue(1), limits: Some(slow), ..Default::default() })).is_empty());
    drive(&mut world, local(1, 1.0, 0.0, 0.0), 800);
    let speed = world.robot_of(Team::Blue, 1).unwrap().twist().speed();
    assert!((speed - 0.1).abs() < 0.02, "{speed}");
    let heavy = RobotSpecs { id: blue(1), mass: Some(f32::NAN), ..Default::default() };
    assert_eq!(ask(&mut world, &config(heavy)), ["ROBOT_SPECS"]);
}

#[test]
fn vision_has_the_field_every_second_and_robots_in_millimetres() {
    let mut world = at_origin();
    let packets: Vec<_> = (0..121).map(|_| world.next_frame()).collect();
    assert_eq!(packets.iter().filter(|packet| packet.geometry.is_some()).count(), 3);
    let frame = packets[120].detection.as_ref().unwrap();
    assert!((frame.t_capture - 1_700_000_002.0).abs() < 2e-3);
    assert_eq!((frame.robots_blue.len(), frame.robots_yellow.len(), frame.balls.len()), (1, 0, 1));
    let robot = frame.robots_blue[0];
    assert!(robot.x.abs() < 10.0 && robot.orientation.unwrap().abs() < 0.05 && robot.robot_id == Some(0));
    assert!((frame.balls[0].x - 2_000.0).abs() < 10.0);
    let numbers: Vec<u32> = packets.iter().map(|packet| packet.detection.as_ref().unwrap().frame_number).collect();
    assert!(numbers.windows(2).all(|pair| pair[1] == pair[0] + 1));
}

#[test]
fn a_skew_in_the_file_leads_the_robot_astray() {
    let text = format!(
        "{}\n[[effect]]\nname = \"wheel-skew\"\nwheels = [1]\n[effect.parameters]\nskew_1_rad = {{ value = 0.12 }}\n",
        Robot::racbot().to_toml()
    );
    let skewed = Robot::parse(&text, std::path::Path::new("robot.toml")).unwrap();
    let ends = [Robot::racbot(), skewed].map(|robot| {
        let mut world = field_of(&[robot]);
        let to =
            TeleportRobot { id: blue(0), x: Some(0.0), y: Some(0.0), orientation: Some(0.0), ..Default::default() };
        assert!(teleport(&mut world, to).is_empty());
        drive(&mut world, local(0, 0.4, 0.0, 0.0), 1_600);
        world.robot_of(Team::Blue, 0).unwrap().pose()
    });
    assert!(ends[0].distance(ends[1]) > 0.01 || (ends[0].theta - ends[1].theta).abs() > 0.05, "{ends:?}");
}

#[test]
fn the_same_messages_make_the_same_frames() {
    let frames = || {
        let mut world = field_of(&[Robot::racbot(), four_wheels()]);
        (0..30)
            .map(|_| {
                tell(&mut world, &[local(0, 0.5, 0.1, 1.0), local(1, -0.4, 0.0, 0.0)]);
                world.next_frame()
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(frames(), frames());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever comes is answered, with an answer that fits a datagram, and the field goes on.
    #[test]
    fn no_datagram_stops_the_field(bytes in prop::collection::vec(any::<u8>(), 0..200), head in 0_usize..4) {
        // Some of them begin like messages.
        let heads: [&[u8]; 4] = [&[], &[0x0a, 0x16, 0x08, 0x00, 0x12], &[0x0a, 0x20, 0x0a], &[0x12, 0x40, 0x12]];
        let datagram = [heads[head], &bytes].concat();
        FIELD.with_borrow_mut(|world| {
            for answer in [
                front::control(world, Team::Blue, &datagram),
                front::control(world, Team::Yellow, &datagram),
                front::simulator(world, &datagram),
            ] {
                assert!(answer.len() < 20_000);
            }
            world.step();
            let ball = world.ball();
            assert!(ball.position.iter().chain(&ball.velocity).all(|x| x.is_finite()));
        });
    }

    /// Numbers of all kinds in well-formed messages.
    #[test]
    fn no_number_stops_the_field(values in prop::array::uniform8(any::<f32>()), present in any::<bool>()) {
        let [a, b, c, d, e, f, g, h] = values;
        FIELD.with_borrow_mut(|world| {
            let kick = RobotCommand {
                kick_speed: Some(d), kick_angle: Some(e), dribbler_speed: Some(f), ..local(0, a, b, c)
            };
            tell(world, &[kick, RobotCommand { id: 3, ..kick }]);
            let wheels = MoveWheelVelocity { front_right: a, back_right: b, back_left: c, front_left: d };
            tell(world, &[moves(1, MoveCommand::WheelVelocity(wheels))]);
            let to = TeleportRobot {
                id: blue(0), x: Some(a), y: Some(b), orientation: Some(c), v_x: Some(d), v_y: Some(e),
                v_angular: Some(f), present: Some(present || !g.is_nan()), by_force: None,
            };
            teleport(world, to);
            let ball_to = TeleportBall {
                x: Some(a), y: Some(b), z: Some(c), vx: Some(d), vy: Some(e), vz: Some(f), ..Default::default()
            };
            ball(world, ball_to);
            let limits = RobotLimits { acc_speedup_absolute_max: Some(g), vel_angular_max: Some(h), ..Default::default() };
            let angles = RobotWheelAngles { front_right: a, back_right: b, back_left: c, front_left: d };
            let specs = RobotSpecs {
                id: blue(1), mass: Some(e), radius: Some(f), limits: Some(limits), wheel_angles: Some(angles),
                ..Default::default()
            };
            let config = SimulatorConfig { robot_specs: vec![specs], ..Default::default() };
            ask(world, &SimulatorCommand { control: None, config: Some(config) });
            for _ in 0..3 { world.step(); }
            for id in 0..2 {
                if let Some(robot) = world.robot_of(Team::Blue, id) {
                    let pose = robot.pose();
                    assert!(pose.x.is_finite() && pose.y.is_finite() && pose.theta.is_finite());
                }
            }
            let _ = ask(world, &SimulatorCommand {
                control: Some(SimulatorControl { simulation_speed: Some(g), ..Default::default() }), config: None,
            });
        });
    }
}

thread_local! {
    static FIELD: std::cell::RefCell<World> = std::cell::RefCell::new(field_of(&[Robot::racbot(), four_wheels()]));
}
