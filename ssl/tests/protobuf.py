"""Encodes messages of the league with Python's protobuf, from field tables written down here: name, number, type, where
"!" is required and "*" repeated. Reads lines `Message JSON` and prints the bytes of each in hexadecimal."""
import sys
import json
from google.protobuf import descriptor_pb2, descriptor_pool, json_format, message_factory

TABLES = """
RobotControl: robot_commands 1 *RobotCommand
RobotCommand: id 1 !uint32, move_command 2 RobotMoveCommand, kick_speed 3 float, kick_angle 4 float, dribbler_speed 5 float
RobotMoveCommand: wheel_velocity 1 MoveWheelVelocity, local_velocity 2 MoveLocalVelocity, global_velocity 3 MoveGlobalVelocity
MoveWheelVelocity: front_right 1 !float, back_right 2 !float, back_left 3 !float, front_left 4 !float
MoveLocalVelocity: forward 1 !float, left 2 !float, angular 3 !float
MoveGlobalVelocity: x 1 !float, y 2 !float, angular 3 !float
RobotControlResponse: errors 1 *SimulatorError, feedback 2 *RobotFeedback
RobotFeedback: id 1 !uint32, dribbler_ball_contact 2 bool
SimulatorError: code 1 string, message 2 string
SimulatorCommand: control 1 SimulatorControl, config 2 SimulatorConfig
SimulatorResponse: errors 1 *SimulatorError
SimulatorControl: teleport_ball 1 TeleportBall, teleport_robot 2 *TeleportRobot, simulation_speed 3 float
TeleportBall: x 1 float, y 2 float, z 3 float, vx 4 float, vy 5 float, vz 6 float, teleport_safely 7 bool, roll 8 bool, by_force 9 bool
TeleportRobot: id 1 !RobotId, x 2 float, y 3 float, orientation 4 float, v_x 5 float, v_y 6 float, v_angular 7 float, present 8 bool, by_force 9 bool
RobotId: id 1 uint32, team 2 int32
SimulatorConfig: geometry 1 SSL_GeometryData, robot_specs 2 *RobotSpecs, vision_port 4 uint32
RobotSpecs: id 1 !RobotId, radius 2 float, height 3 float, mass 4 float, max_linear_kick_speed 7 float, max_chip_kick_speed 8 float, center_to_dribbler 9 float, limits 10 RobotLimits, wheel_angles 13 RobotWheelAngles
RobotLimits: acc_speedup_absolute_max 1 float, acc_speedup_angular_max 2 float, acc_brake_absolute_max 3 float, acc_brake_angular_max 4 float, vel_absolute_max 5 float, vel_angular_max 6 float
RobotWheelAngles: front_right 1 !float, back_right 2 !float, back_left 3 !float, front_left 4 !float
SSL_WrapperPacket: detection 1 SSL_DetectionFrame, geometry 2 SSL_GeometryData, source 3 int32
SSL_DetectionFrame: frame_number 1 !uint32, t_capture 2 !double, t_sent 3 !double, camera_id 4 !uint32, balls 5 *SSL_DetectionBall, robots_yellow 6 *SSL_DetectionRobot, robots_blue 7 *SSL_DetectionRobot, t_capture_camera 8 double
SSL_DetectionBall: confidence 1 !float, area 2 uint32, x 3 !float, y 4 !float, z 5 float, pixel_x 6 !float, pixel_y 7 !float
SSL_DetectionRobot: confidence 1 !float, robot_id 2 uint32, x 3 !float, y 4 !float, orientation 5 float, pixel_x 6 !float, pixel_y 7 !float, height 8 float
SSL_GeometryData: field 1 !SSL_GeometryFieldSize, calib 2 *SSL_GeometryCameraCalibration, ball_models 3 SSL_GeometryBallModels
SSL_GeometryFieldSize: field_length 1 !int32, field_width 2 !int32, goal_width 3 !int32, goal_depth 4 !int32, boundary_width 5 !int32, field_lines 6 *SSL_FieldLineSegment, field_arcs 7 *SSL_FieldCircularArc, penalty_area_depth 8 int32, penalty_area_width 9 int32
Vector2f: x 1 !float, y 2 !float
SSL_FieldLineSegment: name 1 !string, p1 2 !Vector2f, p2 3 !Vector2f, thickness 4 !float, type 5 int32
SSL_FieldCircularArc: name 1 !string, center 2 !Vector2f, radius 3 !float, a1 4 !float, a2 5 !float, thickness 6 !float, type 7 int32
SSL_GeometryCameraCalibration: camera_id 1 !uint32, focal_length 2 !float, principal_point_x 3 !float, principal_point_y 4 !float, distortion 5 !float, q0 6 !float, q1 7 !float, q2 8 !float, q3 9 !float, tx 10 !float, ty 11 !float, tz 12 !float, derived_camera_world_tx 13 float, derived_camera_world_ty 14 float, derived_camera_world_tz 15 float, pixel_image_width 16 uint32, pixel_image_height 17 uint32
SSL_GeometryBallModels: straight_two_phase 1 SSL_BallModelStraightTwoPhase, chip_fixed_loss 2 SSL_BallModelChipFixedLoss
SSL_BallModelStraightTwoPhase: acc_slide 1 !double, acc_roll 2 !double, k_switch 3 !double
SSL_BallModelChipFixedLoss: damping_xy_first_hop 1 !double, damping_xy_other_hops 2 !double, damping_z 3 !double
"""

file = descriptor_pb2.FileDescriptorProto(name="league.proto", syntax="proto2")
Field = descriptor_pb2.FieldDescriptorProto
for line in TABLES.strip().splitlines():
    name, rest = line.split(": ")
    message = file.message_type.add(name=name)
    for entry in rest.split(", "):
        field, number, kind = entry.split()
        label = {"!": Field.LABEL_REQUIRED, "*": Field.LABEL_REPEATED}.get(kind[0], Field.LABEL_OPTIONAL)
        kind = kind.lstrip("!*")
        added = message.field.add(name=field, number=int(number), label=label, json_name=field)
        if hasattr(Field, "TYPE_" + kind.upper()):
            added.type = getattr(Field, "TYPE_" + kind.upper())
        else:
            added.type, added.type_name = Field.TYPE_MESSAGE, "." + kind
pool = descriptor_pool.DescriptorPool()
pool.Add(file)
for line in sys.stdin:
    name, values = line.split(" ", 1)
    message = message_factory.GetMessageClass(pool.FindMessageTypeByName(name))()
    json_format.ParseDict(json.loads(values), message)
    print(message.SerializeToString(deterministic=True).hex())
