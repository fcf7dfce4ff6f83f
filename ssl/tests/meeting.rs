//! Robots, ball and boards that meet: none goes through another, and every robot can go on.

mod support;

use runs::robot::Robot;
use ssl::front::Team;
use ssl::messages::{RobotCommand, RobotId, TeamColor, TeleportBall, TeleportRobot};
use ssl::robot::SimulatedRobot;
use ssl::world::World;
use support::{ball, field_of, local, teleport, tell};

/// By how much anything may overlap at the end of a step, m.
const TOLERANCE: f64 = 1e-4;

/// A robot whose motors are stronger than the carpet: six times the paper's current.
fn strong() -> Robot {
    let mut robot = Robot::racbot();
    robot.motor.resistance_ohm /= 6.0;
    robot
}

/// Blue robots at these places: x, y, m, and orientation, rad.
fn placed(robots: &[Robot], places: &[[f32; 3]]) -> World {
    let mut world = field_of(robots);
    for (id, [x, y, orientation]) in (0..).zip(places) {
        let to = TeleportRobot {
            id: RobotId { id: Some(id), team: Some(TeamColor::Blue.into()) },
            x: Some(*x),
            y: Some(*y),
            orientation: Some(*orientation),
            ..Default::default()
        };
        assert_eq!(teleport(&mut world, to), [""; 0]);
    }
    assert!(ball(&mut world, TeleportBall { x: Some(3.0), y: Some(2.0), ..Default::default() }).is_empty());
    world
}

fn robots(world: &World) -> Vec<&SimulatedRobot> {
    (0..).map_while(|id| world.robot_of(Team::Blue, id)).collect()
}

fn distance(world: &World, a: u32, b: u32) -> f64 {
    let [a, b] = [a, b].map(|id| world.robot_of(Team::Blue, id).unwrap().pose());
    a.distance(b)
}

/// By how much the worst two things overlap, m.
fn overlap(world: &World) -> f64 {
    let robots = robots(world);
    let radius = |robot: &SimulatedRobot| robot.kind().hull.radius;
    let pairs = (1..robots.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let hulls = pairs.map(|(i, j)| radius(robots[i]) + radius(robots[j]) - robots[i].pose().distance(robots[j].pose()));
    let balls = robots.iter().filter_map(|robot| {
        robot.kind().hull.touch([0, 1], robot.pose(), robot.twist(), world.ball()).map(|touch| touch.depth)
    });
    hulls.chain(balls).fold(0.0, f64::max)
}

/// Commands every 16 ms; how often a robot answered that it is switched off.
fn drive(world: &mut World, commands: &[RobotCommand], milliseconds: u32) -> usize {
    let mut faults = 0;
    for _ in 0..milliseconds / 16 {
        let answer = tell(world, commands);
        faults += answer.errors.len();
        assert!(answer.errors.iter().all(|error| error.code() == "ROBOT_FAULT"), "{answer:?}");
        for _ in 0..16 {
            world.step();
            assert!(overlap(world) < TOLERANCE, "{} m at {:?}", overlap(world), world.time());
        }
    }
    faults
}

const PI: f32 = std::f32::consts::PI;

#[test]
fn strong_robots_push_head_on_with_slipping_wheels_and_part_at_once() {
    let mut world = placed(&[strong(), strong()], &[[-0.2, 0.0, 0.0], [0.2, 0.0, PI]]);
    assert_eq!(drive(&mut world, &[local(0, 0.8, 0.0, 0.0), local(1, 0.8, 0.0, 0.0)], 5_000), 0, "no fault");
    assert!((distance(&world, 0, 1) - 0.18).abs() < 2e-3, "they still lean on each other");
    let slower = robots(&world).iter().map(|robot| robot.twist().speed()).fold(0.0, f64::max);
    assert!(slower < 0.1, "and stand: {slower}");
    assert_eq!(drive(&mut world, &[local(0, -0.8, 0.0, 0.0), local(1, -0.8, 0.0, 0.0)], 1_000), 0);
    assert!(distance(&world, 0, 1) > 1.0, "{}", distance(&world, 0, 1));
}

#[test]
fn weak_robots_that_push_head_on_stall_say_so_and_part_when_they_are_told() {
    let mut world = placed(&[Robot::racbot(), Robot::racbot()], &[[-0.2, 0.0, 0.0], [0.2, 0.0, PI]]);
    let faults = drive(&mut world, &[local(0, 0.8, 0.0, 0.0), local(1, 0.8, 0.0, 0.0)], 5_000);
    assert!(faults > 0, "motors of 2005 are weaker than the carpet");
    let answer = tell(&mut world, &[local(0, -0.8, 0.0, 0.0), local(1, -0.8, 0.0, 0.0)]);
    assert!(answer.errors.iter().all(|error| error.message().ends_with("after half a second")), "{answer:?}");
    drive(&mut world, &[local(0, -0.8, 0.0, 0.0), local(1, -0.8, 0.0, 0.0)], 2_000);
    assert!(distance(&world, 0, 1) > 0.8, "{}", distance(&world, 0, 1));
    assert!(robots(&world).iter().all(|robot| robot.fault().is_none()));
}

#[test]
fn one_that_pushes_moves_one_that_is_weaker_and_goes_on() {
    // Beside the middle: head on it is left to the last digits to which side they roll off each other.
    let mut world = placed(&[strong(), Robot::racbot()], &[[-0.3, 0.008, 0.0], [0.0, 0.0, 0.0]]);
    drive(&mut world, &[local(0, 0.5, 0.0, 0.0), local(1, 0.0, 0.0, 0.0)], 3_000);
    let [pusher, pushed] = [0, 1].map(|id| world.robot_of(Team::Blue, id).unwrap());
    assert!(pusher.fault().is_none() && pushed.pose().x > 0.1, "{:?} {:?}", pusher.fault(), pushed.pose());
    drive(&mut world, &[local(0, -0.5, 0.0, 0.0), local(1, 0.4, 0.0, 0.0)], 2_000);
    assert!(distance(&world, 0, 1) > 0.8 && robots(&world)[1].fault().is_none(), "{}", distance(&world, 0, 1));
}

#[test]
fn five_in_a_heap_come_apart_again() {
    let angles = [0.0, 1.0, 2.0, 3.0, 4.0].map(|k| k * 2.0 * PI / 5.0);
    let places = angles.map(|angle: f32| [0.5 * angle.cos(), 0.5 * angle.sin(), angle + PI]);
    for robot in [Robot::racbot(), strong()] {
        let mut world = placed(&[0; 5].map(|_| robot.clone()), &places);
        drive(&mut world, &[0, 1, 2, 3, 4].map(|id| local(id, 0.7, 0.0, 0.0)), 3_000);
        assert!((0..5).all(|id| distance(&world, id, (id + 1) % 5) < 0.3), "a heap");
        // Each on its own way home, whatever it looks at now.
        drive(&mut world, &[0, 1, 2, 3, 4].map(|id| local(id, -0.7, 0.0, 0.0)), 2_500);
        let nearest = (1..5).flat_map(|j| (0..j).map(move |i| (i, j))).map(|(i, j)| distance(&world, i, j));
        assert!(nearest.fold(f64::INFINITY, f64::min) > 0.25);
        assert!(robots(&world).iter().all(|robot| robot.fault().is_none() && robot.twist().speed() > 0.2));
    }
}

#[test]
fn a_ball_between_two_robots_holds_them_apart() {
    for offset in [0.0, 0.01] {
        let mut world = placed(&[strong(), Robot::racbot()], &[[-0.4, 0.0, 0.0], [0.4, offset, PI]]);
        assert!(ball(&mut world, TeleportBall { x: Some(0.0), y: Some(0.0), ..Default::default() }).is_empty());
        drive(&mut world, &[local(0, 0.6, 0.0, 0.0), local(1, 0.6, 0.0, 0.0)], 3_000);
        let between = 2.0 * (0.073 + 0.0215);
        let ball = world.ball().position;
        let held = ball[1].abs() < 0.05 && ball[0].abs() < 0.6;
        assert!(!held || distance(&world, 0, 1) > between - 2.0 * TOLERANCE, "{ball:?} {}", distance(&world, 0, 1));
        assert!(ball.iter().all(|x| x.abs() < 5.0));
    }
}

#[test]
fn a_ball_that_rolls_past_many_is_inside_none() {
    let places: Vec<[f32; 3]> =
        (0..10).map(|k| [0.4 * k as f32 - 1.8, if k % 2 == 0 { 0.1 } else { -0.1 }, k as f32]).collect();
    let robots: Vec<Robot> = places.iter().map(|_| Robot::racbot()).collect();
    for speed in [1.0, 8.0] {
        for y in [0.0, 0.02, 0.15] {
            let mut world = placed(&robots, &places);
            let to = TeleportBall { x: Some(-2.5), y: Some(y), vx: Some(speed), ..Default::default() };
            assert!(ball(&mut world, to).is_empty());
            let mut fastest = 0.0_f64;
            for _ in 0..3_000 {
                world.step();
                assert!(overlap(&world) < TOLERANCE, "{} m", overlap(&world));
                fastest = fastest.max(world.ball().velocity[0].hypot(world.ball().velocity[1]));
            }
            assert!(fastest <= f64::from(speed) + 1e-9, "nothing makes it faster: {fastest}");
            assert!(self::robots(&world).iter().all(|robot| robot.fault().is_none()));
        }
    }
}

#[test]
fn boards_stop_robots_and_hold_the_ball_before_them() {
    let mut world = placed(&[strong()], &[[4.3, 0.0, 0.0]]);
    assert!(ball(&mut world, TeleportBall { x: Some(4.6), y: Some(0.0), ..Default::default() }).is_empty());
    drive(&mut world, &[local(0, 0.8, 0.0, 0.0)], 3_000);
    let (pose, ball) = (world.robot_of(Team::Blue, 0).unwrap().pose(), world.ball().position);
    assert!(ball[0] < 4.8 - 0.0215 + TOLERANCE && pose.x < 4.8 - 0.09 + TOLERANCE, "{ball:?} {pose:?}");
    assert!(pose.x > 4.5, "{pose:?}");
}

#[test]
fn a_heap_is_the_same_every_time() {
    let frames = || {
        let mut world = placed(
            &[strong(), Robot::racbot(), Robot::racbot()],
            &[[-0.3, 0.0, 0.0], [0.3, 0.02, PI], [0.0, 0.4, -0.5 * PI]],
        );
        assert!(ball(&mut world, TeleportBall { x: Some(0.0), y: Some(0.0), ..Default::default() }).is_empty());
        (0..120)
            .map(|_| {
                tell(&mut world, &[0, 1, 2].map(|id| local(id, 0.6, 0.0, 0.3)));
                world.next_frame()
            })
            .collect::<Vec<_>>()
    };
    assert_eq!(frames(), frames());
}
