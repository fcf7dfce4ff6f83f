//! Our messages are, byte for byte, those that another encoder makes of the same values: Python's protobuf.

use prost::Message;
use runs::vision::{DetectionBall, DetectionFrame, DetectionRobot, WrapperPacket};
use serde_json::{Value, json};
use ssl::Code;
use ssl::field::Field;
use ssl::messages::{
    MoveCommand, MoveGlobalVelocity, MoveLocalVelocity, MoveWheelVelocity, RobotCommand, RobotControl,
    RobotControlResponse, RobotFeedback, RobotId, RobotLimits, RobotMoveCommand, RobotSpecs, RobotWheelAngles,
    SimulatorCommand, SimulatorConfig, SimulatorControl, SimulatorResponse, TeleportBall, TeleportRobot,
};
use std::fmt::Debug;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// A message by its name in the protocol, its values, our bytes, and whether ours reads those of the other to the same.
struct Case {
    name: &'static str,
    values: Value,
    bytes: Vec<u8>,
    same: Box<dyn Fn(&[u8]) -> bool>,
}

fn case<M: Message + Default + PartialEq + Debug + 'static>(name: &'static str, message: M, values: Value) -> Case {
    let bytes = message.encode_to_vec();
    Case { name, values, bytes, same: Box::new(move |other| M::decode(other).unwrap() == message) }
}

fn command(id: u32, command: MoveCommand) -> RobotCommand {
    RobotCommand { id, move_command: Some(RobotMoveCommand { command: Some(command) }), ..Default::default() }
}

fn control_cases() -> Vec<Case> {
    let local = MoveLocalVelocity { forward: 1.5, left: -0.25, angular: 0.0 };
    let global = MoveGlobalVelocity { x: -2.0, y: 0.5, angular: 3.25 };
    let wheels = MoveWheelVelocity { front_right: 1.0, back_right: -1.0, back_left: 0.5, front_left: 0.0 };
    let control = RobotControl {
        robot_commands: vec![
            RobotCommand {
                kick_speed: Some(6.5),
                kick_angle: Some(45.0),
                dribbler_speed: Some(1000.0),
                ..command(0, MoveCommand::LocalVelocity(local))
            },
            command(11, MoveCommand::GlobalVelocity(global)),
            command(300, MoveCommand::WheelVelocity(wheels)),
            RobotCommand { id: 2, kick_speed: Some(0.0), ..Default::default() },
        ],
    };
    let values = json!({ "robot_commands": [
        { "id": 0, "move_command": { "local_velocity": { "forward": 1.5, "left": -0.25, "angular": 0 } },
          "kick_speed": 6.5, "kick_angle": 45, "dribbler_speed": 1000 },
        { "id": 11, "move_command": { "global_velocity": { "x": -2, "y": 0.5, "angular": 3.25 } } },
        { "id": 300, "move_command": { "wheel_velocity":
            { "front_right": 1, "back_right": -1, "back_left": 0.5, "front_left": 0 } } },
        { "id": 2, "kick_speed": 0 },
    ] });
    let answer = RobotControlResponse {
        errors: vec![Code::VelocityType.says("three wheels")],
        feedback: vec![
            RobotFeedback { id: 3, dribbler_ball_contact: Some(true) },
            RobotFeedback { id: 4, dribbler_ball_contact: Some(false) },
        ],
    };
    let answer_values = json!({
        "errors": [{ "code": "VELOCITY_TYPE", "message": "three wheels" }],
        "feedback": [{ "id": 3, "dribbler_ball_contact": true }, { "id": 4, "dribbler_ball_contact": false }],
    });
    vec![
        case("RobotControl", control, values),
        case("RobotControl", RobotControl::default(), json!({})),
        case("RobotControlResponse", answer, answer_values),
        case(
            "SimulatorResponse",
            SimulatorResponse { errors: vec![Code::Value.says("é")] },
            json!({ "errors": [{ "code": "VALUE", "message": "é" }] }),
        ),
    ]
}

fn simulator_case() -> Case {
    let id = RobotId { id: Some(5), team: Some(2) };
    let message = SimulatorCommand {
        control: Some(SimulatorControl {
            teleport_ball: Some(TeleportBall {
                x: Some(1.0),
                y: Some(-2.0),
                z: Some(0.5),
                vx: Some(0.0),
                vy: Some(3.0),
                vz: Some(-1.0),
                teleport_safely: Some(false),
                roll: Some(true),
                by_force: Some(false),
            }),
            teleport_robot: vec![TeleportRobot {
                id,
                x: Some(0.5),
                y: None,
                orientation: Some(-1.5),
                v_x: Some(0.0),
                v_y: None,
                v_angular: Some(2.0),
                present: Some(true),
                by_force: None,
            }],
            simulation_speed: Some(0.5),
        }),
        config: Some(SimulatorConfig {
            geometry: None,
            robot_specs: vec![RobotSpecs {
                id,
                radius: Some(0.09),
                height: Some(0.15),
                mass: Some(2.5),
                max_linear_kick_speed: Some(6.5),
                max_chip_kick_speed: Some(5.0),
                center_to_dribbler: Some(0.073),
                limits: Some(RobotLimits {
                    acc_speedup_absolute_max: Some(3.0),
                    acc_brake_angular_max: Some(40.0),
                    vel_angular_max: Some(20.0),
                    ..Default::default()
                }),
                wheel_angles: Some(RobotWheelAngles {
                    front_right: 1.0,
                    back_right: 2.25,
                    back_left: 4.0,
                    front_left: 5.25,
                }),
                custom: vec![],
            }],
            realism_config: None,
            vision_port: Some(10_020),
        }),
    };
    let id = json!({ "id": 5, "team": 2 });
    case(
        "SimulatorCommand",
        message,
        json!({
            "control": {
                "teleport_ball": { "x": 1, "y": -2, "z": 0.5, "vx": 0, "vy": 3, "vz": -1, "teleport_safely": false,
                    "roll": true, "by_force": false },
                "teleport_robot": [{ "id": id, "x": 0.5, "orientation": -1.5, "v_x": 0, "v_angular": 2, "present": true }],
                "simulation_speed": 0.5,
            },
            "config": {
                "robot_specs": [{ "id": id, "radius": 0.09, "height": 0.15, "mass": 2.5, "max_linear_kick_speed": 6.5,
                    "max_chip_kick_speed": 5, "center_to_dribbler": 0.073,
                    "limits": { "acc_speedup_absolute_max": 3, "acc_brake_angular_max": 40, "vel_angular_max": 20 },
                    "wheel_angles": { "front_right": 1, "back_right": 2.25, "back_left": 4, "front_left": 5.25 } }],
                "vision_port": 10020,
            },
        }),
    )
}

fn vision_case() -> Case {
    let robot = DetectionRobot {
        confidence: 1.0,
        robot_id: Some(7),
        x: -1234.5,
        y: 0.0,
        orientation: Some(-0.5),
        pixel_x: 1.0,
        pixel_y: 2.0,
        height: Some(150.0),
    };
    let ball =
        DetectionBall { confidence: 0.5, area: Some(60), x: 10.0, y: -20.0, z: None, pixel_x: 0.0, pixel_y: 5.0 };
    let geometry = Field::A.geometry();
    let lines: Vec<Value> = geometry
        .field
        .field_lines
        .iter()
        .map(|line| {
            json!({
                "name": line.name, "p1": { "x": line.p1.x, "y": line.p1.y }, "p2": { "x": line.p2.x, "y": line.p2.y },
                "thickness": line.thickness, "type": line.r#type,
            })
        })
        .collect();
    let arcs: Vec<Value> = geometry
        .field
        .field_arcs
        .iter()
        .map(|arc| {
            json!({
                "name": arc.name, "center": { "x": 0, "y": 0 }, "radius": arc.radius, "a1": arc.a1, "a2": arc.a2,
                "thickness": arc.thickness, "type": arc.r#type,
            })
        })
        .collect();
    let camera = geometry.calib[0];
    let values = json!({
        "detection": {
            "frame_number": 42, "t_capture": 1.5, "t_sent": 1.75, "camera_id": 0,
            "balls": [{ "confidence": 0.5, "area": 60, "x": 10, "y": -20, "pixel_x": 0, "pixel_y": 5 }],
            "robots_yellow": [{ "confidence": 1, "robot_id": 7, "x": -1234.5, "y": 0, "orientation": -0.5, "pixel_x": 1,
                "pixel_y": 2, "height": 150 }],
        },
        "geometry": {
            "field": { "field_length": 12000, "field_width": 9000, "goal_width": 1800, "goal_depth": 180,
                "boundary_width": 300, "field_lines": lines, "field_arcs": arcs, "penalty_area_depth": 1800,
                "penalty_area_width": 3600 },
            "calib": [{ "camera_id": 0, "focal_length": camera.focal_length,
                "principal_point_x": camera.principal_point_x, "principal_point_y": camera.principal_point_y,
                "distortion": 0, "q0": 1, "q1": 0, "q2": 0, "q3": 0, "tx": 0, "ty": 0, "tz": camera.tz,
                "derived_camera_world_tx": 0, "derived_camera_world_ty": 0, "derived_camera_world_tz": camera.tz,
                "pixel_image_width": camera.pixel_image_width, "pixel_image_height": camera.pixel_image_height }],
            "ball_models": {
                "straight_two_phase": { "acc_slide": -3.0, "acc_roll": -0.26, "k_switch": 5.0 / 7.0 },
                "chip_fixed_loss": { "damping_xy_first_hop": 0.75, "damping_xy_other_hops": 0.95, "damping_z": 0.5 },
            },
        },
        "source": 1,
    });
    let detection = DetectionFrame {
        frame_number: 42,
        t_capture: 1.5,
        t_sent: 1.75,
        camera_id: 0,
        balls: vec![ball],
        robots_yellow: vec![robot],
        robots_blue: vec![],
        t_capture_camera: None,
    };
    let packet = WrapperPacket { detection: Some(detection), geometry: Some(geometry), source: Some(1) };
    case("SSL_WrapperPacket", packet, values)
}

#[test]
fn python_protobuf_makes_the_same_bytes() {
    let python = |arguments: &[&str]| Command::new("python3").args(arguments).output();
    if !python(&["-c", "import google.protobuf"]).is_ok_and(|output| output.status.success()) {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "pip install protobuf");
        eprintln!("NOT RUN: pip install protobuf");
        return;
    }
    let mut cases = control_cases();
    cases.extend([simulator_case(), vision_case()]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/protobuf.py");
    let mut child = Command::new("python3").arg(script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let lines: String = cases.iter().map(|case| format!("{} {}\n", case.name, case.values)).collect();
    child.stdin.take().unwrap().write_all(lines.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    let theirs = String::from_utf8(output.stdout).unwrap();
    assert_eq!(theirs.lines().count(), cases.len());
    for (case, theirs) in cases.iter().zip(theirs.lines()) {
        let ours: String = case.bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(ours, theirs, "{}", case.name);
        assert!((case.same)(&case.bytes), "{}", case.name);
    }
}
