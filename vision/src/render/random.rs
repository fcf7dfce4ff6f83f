//! Halls, robots, people and cameras at random: every picture is of another place.

use super::light::{Finish, Lamp};
use super::scene::{Body, Ground, Surface, World, ball, plain};
use super::shape::Shape;
use super::{BALL_RADIUS, Point, Rendered, Sensor, Shutter, expose};
use crate::camera::Camera;
use crate::field::Field;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{PI, TAU};

/// A random picture, and the camera it was taken with.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Picture and truth.
    pub rendered: Rendered,
    /// Lens and mount.
    pub camera: Camera,
    /// Place of the camera on the field, m, m, rad.
    pub pose: [f64; 3],
}

/// The picture of a seed, `width` by `height` pixels, of a camera whose own format may be another (4:3 or 16:9, squeezed).
#[must_use]
pub fn sample(seed: u64, width: usize, height: usize) -> Sample {
    samples(seed, width, height, 1).remove(0)
}

/// The picture of a seed as `count` cameras deliver it, behind one lens in one place; the first one is [`sample`]'s.
#[must_use]
pub fn samples(seed: u64, width: usize, height: usize, count: usize) -> Vec<Sample> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let rng = &mut rng;
    let camera = lens(width, height, rng);
    let field = if rng.random_bool(0.3) { Field::DIVISION_A } else { Field::DIVISION_B };
    let pose = [
        rng.random_range(-0.5..0.5) * field.length,
        rng.random_range(-0.5..0.5) * field.width,
        rng.random_range(-PI..PI),
    ];
    let mut world = hall(field, pose, rng);
    populate(&mut world, &camera, pose, rng);
    let shaky = rng.random_bool(0.35);
    let shake = |rng: &mut ChaCha8Rng| if shaky { rng.random_range(-0.03..0.03) } else { 0.0 };
    let (turn, nod) = (shake(rng), shake(rng) * 0.6);
    let rolling = rng.random_range(0.0..0.8);
    let shutter = Shutter { pose, moved: [0.0; 2], turn, nod, rolling };
    let mut sensor = self::sensor(rng);
    let exposure = expose(&world, &camera, shutter, 2, rng);
    let mut one = || {
        let rendered = exposure.developed(&sensor, rng);
        sensor = self::sensor(rng);
        Sample { rendered, camera, pose }
    };
    (0..count).map(|_| one()).collect()
}

fn lens(width: usize, height: usize, rng: &mut ChaCha8Rng) -> Camera {
    let view = rng.random_range(0.85..1.4);
    let format = [width as f64 / height as f64, 4.0 / 3.0, 16.0 / 9.0][rng.random_range(0..3)];
    let ideal = Camera::ideal(width, height, view, rng.random_range(0.06..0.24), rng.random_range(-0.05..0.5));
    // Squeezed to the asked format, pixels are not square any more.
    let squeeze = format / (width as f64 / height as f64);
    Camera {
        focal: [ideal.focal[0], ideal.focal[1] * squeeze],
        distortion: [rng.random_range(-0.25..0.1), 0.0],
        roll: rng.random_range(-0.05..0.05),
        ..ideal
    }
}

fn sensor(rng: &mut ChaCha8Rng) -> Sensor {
    let warm: f64 = rng.random_range(-0.28..0.28);
    let tint: f64 = rng.random_range(-0.1..0.1);
    Sensor {
        exposure: 2.0_f64.powf(rng.random_range(-1.0..2.0)),
        white_balance: [warm.exp(), tint.exp(), (-warm).exp()],
        grey_world: if rng.random_bool(0.4) { rng.random_range(0.0..0.8) } else { 0.0 },
        saturation: rng.random_range(0.65..1.35),
        gamma: 1.0 / rng.random_range(1.7..2.5),
        haze: rng.random_range(0.0..0.05),
        vignette: rng.random_range(0.0..0.7),
        blur: rng.random_range(0.2..1.3),
        sharpening: rng.random_range(0.0..0.8),
        noise: [rng.random_range(0.0..0.05), rng.random_range(0.0..0.015)],
        dirt: if rng.random_bool(0.25) { rng.random_range(1..5) } else { 0 },
        quality: (!rng.random_bool(0.1)).then(|| rng.random_range(25..97)),
        subsampled: rng.random_bool(0.7),
    }
}

fn between(low: [f64; 3], high: [f64; 3], rng: &mut ChaCha8Rng) -> [f64; 3] {
    [0, 1, 2].map(|i| rng.random_range(low[i]..high[i]))
}

/// Colours of clothes, boxes, shoes: dull as a rule, strong or of warm hue at times.
fn thing(rng: &mut ChaCha8Rng) -> [f64; 3] {
    match rng.random_range(0..10) {
        0..4 => [rng.random_range(0.02..0.7); 3].map(|c| c * rng.random_range(0.85..1.15)),
        4..6 => between([0.01; 3], [0.7; 3], rng),
        6 => between([0.3, 0.03, 0.01], [0.8, 0.3, 0.12], rng), // orange to brown
        7 => between([0.3, 0.01, 0.01], [0.8, 0.08, 0.1], rng), // red
        8 => between([0.35, 0.2, 0.1], [0.75, 0.5, 0.36], rng), // wood, cardboard
        _ => between([0.5, 0.35, 0.02], [0.9, 0.75, 0.2], rng), // yellow
    }
}

fn skin(rng: &mut ChaCha8Rng) -> [f64; 3] {
    let (dark, light) = ([0.16, 0.08, 0.05], [0.72, 0.47, 0.34]);
    let share: f64 = rng.random();
    [0, 1, 2].map(|i| dark[i] * (1.0 - share) + light[i] * share)
}

fn hall(field: Field, pose: [f64; 3], rng: &mut ChaCha8Rng) -> World {
    let mut carpet = between([0.008, 0.09, 0.01], [0.11, 0.34, 0.14], rng);
    carpet[0] = carpet[0].min(0.62 * carpet[1]);
    carpet[2] = carpet[2].min(0.7 * carpet[1]);
    let floor = match rng.random_range(0..3) {
        0 => between([0.3, 0.17, 0.07], [0.65, 0.42, 0.27], rng),
        1 => [rng.random_range(0.1..0.6); 3],
        _ => thing(rng),
    };
    let ground = match rng.random_range(0..3) {
        0 => Ground::Wood(rng.random_range(0.06..0.2)),
        1 => Ground::Tiles(rng.random_range(0.2..0.6)),
        _ => Ground::Rough,
    };
    let ambient = rng.random_range(0.15..0.6);
    let count = rng.random_range(1..4);
    let reference = Point::new(pose[0], pose[1], 0.0);
    let lamps = (0..count).map(|_| {
        let (far, angle) = (rng.random_range(0.0..4.0), rng.random_range(0.0..TAU));
        Lamp {
            at: Point::new(pose[0] + far * angle.cos(), pose[1] + far * angle.sin(), rng.random_range(2.3..5.0)),
            size: rng.random_range(0.02..0.5),
            strength: rng.random_range(0.4..1.0) * (1.0 - ambient) / f64::from(count),
            tint: between([0.9; 3], [1.1; 3], rng),
            reference,
        }
    });
    let lamps = lamps.collect();
    World {
        field,
        lines: field.lines(),
        carpet,
        paint: [rng.random_range(0.5..0.85); 3],
        floor,
        wall: if rng.random_bool(0.6) { [rng.random_range(0.05..0.8); 3] } else { thing(rng) },
        ground,
        wear: rng.random_range(0.05..0.6),
        uneven: rng.random_range(0.0..0.9),
        sun: if rng.random_bool(0.2) { rng.random_range(0.5..3.0) } else { 0.0 },
        clutter: rng.random_range(0.0..0.8),
        room: rng.random_range(0.3..4.0),
        lamps,
        ambient,
        bodies: Vec::new(),
        seed: rng.random(),
    }
}

/// Places tried for a ball until one is on the carpet; from a corner, looking out, none is.
const TRIES: usize = 12;

/// A place in front of the camera: distance by a power law, inside the field of view or near it.
fn place(camera: &Camera, pose: [f64; 3], near: f64, far: f64, rng: &mut ChaCha8Rng) -> [f64; 2] {
    let half = (camera.width as f64 / 2.0 / camera.focal[0]).atan() * 1.05;
    let way = near * (far / near).powf(rng.random());
    let angle = pose[2] + rng.random_range(-half..half);
    [pose[0] + way * angle.cos(), pose[1] + way * angle.sin()]
}

fn populate(world: &mut World, camera: &Camera, pose: [f64; 3], rng: &mut ChaCha8Rng) {
    for _ in 0..rng.random_range(0..5) {
        let at = place(camera, pose, 0.35, 5.0, rng);
        robot(world, at, rng);
    }
    world.goals(plain([rng.random_range(0.5..0.8); 3]));
    for _ in 0..rng.random_range(0..5) {
        let at = place(camera, pose, 1.0, 8.0, rng);
        if !world.field.on_carpet(at[0], at[1]) || rng.random_bool(0.2) {
            person(world, at, rng);
        }
    }
    for _ in 0..rng.random_range(0..8) {
        let at = place(camera, pose, 0.8, 9.0, rng);
        if !world.field.on_carpet(at[0], at[1]) {
            clutter(world, at, 1.0, rng);
        }
    }
    if rng.random_bool(0.25) {
        for _ in 0..rng.random_range(1..4) {
            let at = place(camera, pose, 0.25, 2.5, rng);
            clutter(world, at, 0.1, rng);
        }
    }
    let count = [0, 1, 1, 1, 1, 1, 1, 2, 2, 3][rng.random_range(0..10)];
    for number in 0..count {
        let mut at = place(camera, pose, 0.11, 3.0, rng);
        // Off the carpet a ball is rare: somebody takes it back.
        for _ in 0..TRIES {
            if world.field.on_carpet(at[0], at[1]) || rng.random_bool(0.02) {
                break;
            }
            at = place(camera, pose, 0.11, 3.0, rng);
        }
        let above = if rng.random_bool(0.07) { rng.random_range(0.0..0.08) } else { 0.0 };
        let held = rng.random_bool(HELD).then(|| holder(world, pose, rng)).flatten();
        let [x, y] = held.unwrap_or(at);
        world.bodies.push(ball(number, x, y, above, ball_finish(rng), rng.random()));
    }
    let eye = Point::new(pose[0], pose[1], camera.mount_height);
    world.bodies.retain(|body| body.ball.is_some() || clear(&body.shape, eye));
}

/// Share of balls that some robot has at its front or side, half hidden or with its colours beside it.
const HELD: f64 = 0.2;

/// A place at a robot, anywhere around it but where it hides the ball altogether.
fn holder(world: &World, pose: [f64; 3], rng: &mut ChaCha8Rng) -> Option<[f64; 2]> {
    let robots: Vec<(Point, f64)> = world.bodies.iter().filter_map(Body::robot).collect();
    let (base, radius) = *robots.get(rng.random_range(0..robots.len().max(1)))?;
    let towards = (pose[1] - base.y).atan2(pose[0] - base.x);
    let angle = towards + rng.random_range(-2.1..2.1);
    let far = radius + BALL_RADIUS * rng.random_range(0.6..1.6);
    Some([base.x + far * angle.cos(), base.y + far * angle.sin()])
}

/// Orange of a league ball, new to worn.
fn ball_finish(rng: &mut ChaCha8Rng) -> Finish {
    let red: f64 = rng.random_range(0.55..0.95);
    let albedo = [red, red * rng.random_range(0.14..0.42), red * rng.random_range(0.01..0.13)];
    // One in four is new and shines: its highlight burns out.
    let gloss = if rng.random_bool(0.25) { rng.random_range(0.1..0.4) } else { rng.random_range(0.0..0.12) };
    Finish { albedo, gloss, sharpness: rng.random_range(8.0..120.0) }
}

fn clear(shape: &Shape, eye: Point) -> bool {
    match shape {
        Shape::Sphere { centre, radius } => (centre - eye).norm() > radius + 0.05,
        Shape::Cylinder { base, radius, .. } => (base - eye).xy().norm() > radius + 0.1,
        Shape::Box { centre, half, .. } => (centre - eye).xy().norm() > half.xy().norm() + 0.1,
    }
}

fn robot(world: &mut World, at: [f64; 2], rng: &mut ChaCha8Rng) {
    let pink = between([0.6, 0.05, 0.25], [0.9, 0.2, 0.6], rng);
    let green = between([0.05, 0.4, 0.05], [0.25, 0.8, 0.25], rng);
    let middle = if rng.random_bool(0.5) { [0.85, 0.7, 0.05] } else { [0.03, 0.12, 0.6] };
    let mut other = || if rng.random_bool(0.5) { pink } else { green };
    let spots = [middle, other(), other(), other(), other()];
    let body = match rng.random_range(0..8) {
        0..5 => [rng.random_range(0.01..0.1); 3],
        5 => [rng.random_range(0.2..0.7); 3],
        _ => thing(rng),
    };
    let side = Finish { albedo: body, gloss: rng.random_range(0.0..0.1), sharpness: 20.0 };
    let heading = rng.random_range(0.0..TAU);
    let (radius, height) = (rng.random_range(0.083..0.09), rng.random_range(0.12..0.15));
    let base = Point::new(at[0], at[1], 0.0);
    let cover = [rng.random_range(0.01..0.06); 3];
    let surface = Surface::Robot { side, cover, spots, heading, seed: rng.random() };
    world.bodies.push(Body::new(Shape::Cylinder { base, radius, height }, surface));
    // Connectors, coils, wires, indicator lights, printed parts.
    let marker = if rng.random_bool(0.5) { pink } else { between([0.6, 0.12, 0.02], [0.9, 0.35, 0.1], rng) };
    for _ in 0..rng.random_range(0..5) {
        let colour = if rng.random_bool(0.25) { marker } else { thing(rng) };
        let angle = rng.random_range(0.0..TAU);
        let part = Point::new(at[0] + radius * angle.cos(), at[1] + radius * angle.sin(), rng.random_range(0.01..0.13));
        let half =
            Point::new(rng.random_range(0.002..0.015), rng.random_range(0.004..0.03), rng.random_range(0.003..0.02));
        let shape = Shape::Box { centre: part, half, heading: angle };
        world.bodies.push(Body::new(shape, Surface::Plain(plain(colour))));
    }
}

fn person(world: &mut World, at: [f64; 2], rng: &mut ChaCha8Rng) {
    let heading = rng.random_range(0.0..TAU);
    let trousers = thing(rng);
    let leg = if rng.random_bool(0.3) { skin(rng) } else { trousers };
    let shoe = thing(rng);
    for side in [-0.11, 0.11] {
        let (x, y) = (at[0] - side * f64::sin(heading), at[1] + side * f64::cos(heading));
        let base = Point::new(x, y, 0.0);
        let patched = Surface::Patched { finish: plain(leg), other: trousers, size: 0.06, seed: rng.random() };
        let shape = Shape::Cylinder { base, radius: rng.random_range(0.045..0.08), height: 0.9 };
        world.bodies.push(Body::new(shape, patched));
        let centre = Point::new(x + 0.06 * heading.cos(), y + 0.06 * heading.sin(), 0.045);
        let shape = Shape::Box { centre, half: Point::new(0.14, 0.05, 0.045), heading };
        world.bodies.push(Body::new(shape, Surface::Plain(plain(shoe))));
    }
    let shirt = Surface::Patched { finish: plain(thing(rng)), other: thing(rng), size: 0.2, seed: rng.random() };
    let shape = Shape::Box { centre: Point::new(at[0], at[1], 1.2), half: Point::new(0.2, 0.12, 0.35), heading };
    world.bodies.push(Body::new(shape, shirt));
}

fn clutter(world: &mut World, at: [f64; 2], size: f64, rng: &mut ChaCha8Rng) {
    let half = between([0.04; 3], [0.4; 3], rng).map(|c| c * size);
    let finish = Finish { albedo: thing(rng), gloss: rng.random_range(0.0..0.08), sharpness: 30.0 };
    let surface = if rng.random_bool(0.5) {
        Surface::Plain(finish)
    } else {
        Surface::Patched { finish, other: thing(rng), size: 0.08 * size.max(0.2), seed: rng.random() }
    };
    let shape = if rng.random_bool(0.4) {
        Shape::Cylinder { base: Point::new(at[0], at[1], 0.0), radius: half[0], height: 2.0 * half[2] }
    } else {
        let centre = Point::new(at[0], at[1], half[2]);
        Shape::Box { centre, half: Point::from(half), heading: rng.random_range(0.0..TAU) }
    };
    world.bodies.push(Body::new(shape, surface));
}
