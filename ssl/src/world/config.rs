//! Teleports, speeds, fields and robots by message.

use super::World;
use crate::Code;
use crate::ball::Ball;
use crate::field::Field;
use crate::front::{TEAM, Team, corners};
use crate::messages::{
    RobotId, RobotSpecs, RobotWheelAngles, SimulatorConfig, SimulatorControl, SimulatorError, TeamColor, TeleportBall,
    TeleportRobot,
};
use crate::pilot::Caps;
use crate::robot::{Kind, SimulatedRobot};
use runs::frames::Pose;
use runs::robot::{Layout, Robot};
use std::f64::consts::FRAC_PI_2;

/// Slowest and fastest simulated time, in seconds a second.
const SLOWEST: f32 = 0.01;
const FASTEST: f32 = 20.0;
/// Largest velocity of a teleport, m/s and rad/s: none of it makes an encoder faster than its filter.
const LARGEST: f32 = 100.0;
/// Messages that may change robots at once.
const SPECS: usize = 2 * TEAM;

type Refused = (Code, String);

fn number(name: &str, value: f32, least: f32, most: f32) -> Result<f64, Refused> {
    if (least..=most).contains(&value) {
        return Ok(f64::from(value));
    }
    Err((Code::Value, format!("{name}: {value} is not between {least} and {most}")))
}

fn name(id: &RobotId) -> Result<(Team, u32), Refused> {
    let team = match id.team() {
        TeamColor::Blue => Team::Blue,
        TeamColor::Yellow => Team::Yellow,
        TeamColor::Unknown => return Err((Code::RobotId, "a robot's id without its team".to_owned())),
    };
    match id.id {
        Some(id) if (id as usize) < TEAM => Ok((team, id)),
        Some(id) => Err((Code::RobotId, format!("robot {id}: numbers go from 0 to {}", TEAM - 1))),
        None => Err((Code::RobotId, "a robot's id without its number".to_owned())),
    }
}

impl World {
    pub(super) fn control(&mut self, control: &SimulatorControl, errors: &mut Vec<SimulatorError>) {
        let mut done = |result: Result<(), Refused>| {
            if let Err((code, what)) = result {
                errors.push(code.says(what));
            }
        };
        if let Some(ball) = &control.teleport_ball {
            done(self.teleport_ball(ball));
        }
        for robot in control.teleport_robot.iter().take(SPECS) {
            done(self.teleport_robot(robot));
        }
        match control.simulation_speed {
            Some(speed) if speed == 0.0 || (SLOWEST..=FASTEST).contains(&speed) => self.speed = f64::from(speed),
            Some(speed) => {
                let what =
                    format!("simulation_speed: {speed} is neither 0, a pause, nor between {SLOWEST} and {FASTEST}");
                done(Err((Code::SimulationSpeed, what)));
            }
            None => {}
        }
    }

    fn teleport_ball(&mut self, to: &TeleportBall) -> Result<(), Refused> {
        if to.by_force() {
            return Err((
                Code::TeleportByForce,
                "teleport_ball: by_force; leave it out to teleport at once".to_owned(),
            ));
        }
        let [half_x, half_y] = self.field.half().map(|half| half as f32);
        let mut ball = self.ball;
        let old = ball;
        for (axis, name, value, most) in [(0, "x", to.x, half_x), (1, "y", to.y, half_y)] {
            if let Some(value) = value {
                ball.position[axis] = number(&format!("teleport_ball.{name}"), value, -most, most)?;
            }
        }
        if let Some(z) = to.z {
            ball.position[2] = number("teleport_ball.z", z, 0.0, 5.0)?;
        }
        let velocity = [("vx", to.vx), ("vy", to.vy), ("vz", to.vz)];
        // A ball that is put somewhere lies still, unless a velocity is given.
        ball.velocity = [0.0; 3];
        for (axis, (name, value)) in velocity.into_iter().enumerate() {
            ball.velocity[axis] = number(&format!("teleport_ball.{name}"), value.unwrap_or(0.0), -LARGEST, LARGEST)?;
        }
        ball.roll = if to.roll() { [ball.velocity[0], ball.velocity[1]] } else { [0.0; 2] };
        ball.hops = 0;
        if to.teleport_safely() {
            let inside = |robot: &&SimulatedRobot| {
                let pose = robot.pose();
                let far = robot.kind().hull.radius + Ball::RADIUS;
                (ball.position[0] - pose.x).hypot(ball.position[1] - pose.y) < far
            };
            if self.robots.values().any(|robot| inside(&robot)) {
                let what = "teleport_ball: a robot stands there, and robots are not moved out of the way".to_owned();
                self.ball = old;
                return Err((Code::TeleportSafely, what));
            }
        }
        self.ball = ball;
        Ok(())
    }

    fn teleport_robot(&mut self, to: &TeleportRobot) -> Result<(), Refused> {
        let key = name(&to.id)?;
        if to.by_force() {
            return Err((
                Code::TeleportByForce,
                "teleport_robot: by_force; leave it out to teleport at once".to_owned(),
            ));
        }
        if to.present == Some(false) {
            self.robots.remove(&key);
            self.cameras.remove(&Some(key));
            return Ok(());
        }
        let [half_x, half_y] = self.field.half().map(|half| half as f32);
        let old = self.robots.get(&key).map_or_else(Pose::default, SimulatedRobot::pose);
        let part = |name: &str, value: Option<f32>, most: f32, old: f64| {
            value.map_or(Ok(old), |value| number(&format!("teleport_robot.{name}"), value, -most, most))
        };
        let x = part("x", to.x, half_x, old.x)?;
        let y = part("y", to.y, half_y, old.y)?;
        let orientation = part("orientation", to.orientation, 1e3, old.league_theta())?;
        let velocity = [("v_x", to.v_x), ("v_y", to.v_y), ("v_angular", to.v_angular)];
        let mut world = [0.0; 3];
        for (slot, (name, value)) in world.iter_mut().zip(velocity) {
            *slot = part(name, value, LARGEST, 0.0)?;
        }
        let pose = Pose::from_league(x, y, orientation);
        if !self.robots.contains_key(&key) {
            if to.present != Some(true) {
                return Err((Code::UnknownRobot, format!("{} has no robot {}; present = true adds it", key.0, key.1)));
            }
            self.add(key, self.newcomer.clone(), pose)?;
        }
        if let Some(robot) = self.robots.get_mut(&key) {
            let limits = *robot.pilot().borrow().limits();
            let twist = pose.body_twist(world);
            let twist = limits.within_wheel_speed(twist, robot.pilot().borrow().geometry());
            robot.place(pose, twist);
        }
        Ok(())
    }

    fn add(&mut self, key: (Team, u32), kind: Kind, pose: Pose) -> Result<(), Refused> {
        let robot = SimulatedRobot::new(kind, pose, self.time).map_err(|e| (Code::RobotSpecs, e.to_string()))?;
        self.robots.insert(key, robot);
        self.cameras.remove(&Some(key));
        Ok(())
    }

    pub(super) fn configure(&mut self, config: &SimulatorConfig, errors: &mut Vec<SimulatorError>) {
        if let Some(geometry) = &config.geometry {
            match Field::of(&geometry.field) {
                Ok(field) => self.field = field,
                Err(what) => errors.push(Code::Geometry.says(what)),
            }
        }
        for specs in config.robot_specs.iter().take(SPECS) {
            if let Err((code, what)) = self.specify(specs, errors) {
                errors.push(code.says(what));
            }
        }
        if config.realism_config.is_some() {
            let what = "realism_config: what is real about a robot stands in its robot.toml, as effects";
            errors.push(Code::Custom.says(what));
        }
        match config.vision_port.map(u16::try_from) {
            None => {}
            Some(Ok(port)) if port > 0 => self.vision_port = Some(port),
            Some(_) => errors.push(Code::VisionPort.says("vision_port: not between 1 and 65535")),
        }
    }

    fn specify(&mut self, specs: &RobotSpecs, errors: &mut Vec<SimulatorError>) -> Result<(), Refused> {
        let key = name(&specs.id)?;
        let robot = self.robots.get(&key);
        let robot = robot.ok_or_else(|| (Code::UnknownRobot, format!("{} has no robot {}", key.0, key.1)))?;
        let of = |what: &str| format!("robot_specs of {} {}: {what}", key.0, key.1);
        let mut kind = robot.kind().clone();
        let mut caps = robot.pilot().borrow().caps;
        let refused = |(_, what): Refused| (Code::RobotSpecs, what);
        let size = |name: &str, value: Option<f32>, least: f32, most: f32, old: f64| {
            value.map_or(Ok(old), |value| number(&of(name), value, least, most).map_err(refused))
        };
        kind.hull.radius = size("radius", specs.radius, 0.03, 0.5, kind.hull.radius)?;
        kind.hull.height = size("height", specs.height, 0.01, 1.0, kind.hull.height)?;
        kind.hull.front = size("center_to_dribbler", specs.center_to_dribbler, 0.01, 0.5, kind.hull.front)?;
        kind.hull.front = kind.hull.front.min(kind.hull.radius);
        let fastest = crate::trigger::fastest() as f32;
        for (slot, (name, value)) in kind.fastest_kick.iter_mut().zip([
            ("max_linear_kick_speed", specs.max_linear_kick_speed),
            ("max_chip_kick_speed", specs.max_chip_kick_speed),
        ]) {
            *slot = size(name, value.map(|v| v.min(fastest)), 0.0, fastest, *slot)?;
        }
        if let Some(mass) = specs.mass {
            let mass = number(&of("mass"), mass, 0.1, 50.0).map_err(refused)?;
            (kind.believed.mass_kg, kind.actual.mass_kg) = (mass, mass);
        }
        if let Some(angles) = &specs.wheel_angles {
            for robot in [&mut kind.believed, &mut kind.actual] {
                turn_wheels(robot, angles).map_err(|what| (Code::RobotSpecs, of(&what)))?;
            }
        }
        if !specs.custom.is_empty() {
            errors.push(Code::Custom.says(of("custom: not known here")));
        }
        let most = Caps::of(robot.pilot().borrow().limits());
        if let Some(limits) = &specs.limits {
            // Motors do no more than they can.
            let cap = |value: Option<f32>, most: f64, old: f64| match value {
                None => Ok(old),
                Some(value) => number(&of("limits"), value, 1e-3, f32::MAX).map(|v| v.min(most)).map_err(refused),
            };
            let angular = limits.acc_speedup_angular_max;
            caps.speed_up = [
                cap(limits.acc_speedup_absolute_max, most.speed_up[0], caps.speed_up[0])?,
                cap(angular, most.speed_up[1], caps.speed_up[1])?,
            ];
            caps.brake = [
                cap(limits.acc_brake_absolute_max, most.brake[0], caps.brake[0])?,
                cap(limits.acc_brake_angular_max, most.brake[1], caps.brake[1])?,
            ];
            caps.velocity = [
                cap(limits.vel_absolute_max, most.velocity[0], caps.velocity[0])?,
                cap(limits.vel_angular_max, most.velocity[1], caps.velocity[1])?,
            ];
        }
        let (pose, twist) = (robot.pose(), robot.twist());
        if kind != *robot.kind() {
            self.add(key, kind, pose)?;
            if let Some(robot) = self.robots.get_mut(&key) {
                robot.place(pose, twist);
            }
        }
        if let Some(robot) = self.robots.get(&key) {
            robot.pilot().borrow_mut().caps = caps;
        }
        Ok(())
    }
}

/// Moves the four wheels of a robot to these angles, each as it stands to its place.
fn turn_wheels(robot: &mut Robot, angles: &RobotWheelAngles) -> Result<(), String> {
    let geometry = robot.geometry().map_err(|error| error.to_string())?;
    let corners = corners(&geometry).ok_or_else(|| {
        format!("wheel_angles are for four wheels, one in each corner; this robot has {}", geometry.wheel_count())
    })?;
    let mut wheels = geometry.wheels().to_vec();
    for (corner, angle) in
        corners.into_iter().zip([angles.front_right, angles.back_right, angles.back_left, angles.front_left])
    {
        if !angle.is_finite() {
            return Err(format!("wheel_angles: {angle} is no angle"));
        }
        let wheel = &mut wheels[corner];
        // Clockwise from forward, which is the body's y axis.
        let to = FRAC_PI_2 - f64::from(angle);
        let turn = to - wheel.y_m.atan2(wheel.x_m);
        let radius = wheel.x_m.hypot(wheel.y_m);
        (wheel.x_m, wheel.y_m) = (radius * to.cos(), radius * to.sin());
        wheel.drive_rad += turn;
    }
    robot.layout = Layout::Wheels(wheels);
    robot.geometry().map(drop).map_err(|error| format!("wheel_angles: {error}"))
}
