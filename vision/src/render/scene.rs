//! The hall: field, floor, walls, lamps, and bodies on the floor.

use super::light::{Finish, Lamp};
use super::noise::{cell, smooth};
use super::shape::{Hit, NEAREST, Shape};
use super::{BALL_RADIUS, Point};
use crate::camera::Camera;
use crate::field::{Field, Line, distance};
use rand_chacha::ChaCha8Rng;

/// What a body's surface looks like.
#[derive(Clone, Debug)]
pub(super) enum Surface {
    /// One colour.
    Plain(Finish),
    /// A golf ball: dimples, dirt, a print.
    Ball { finish: Finish, seed: u32 },
    /// One colour with patches of another, cells of this size, m.
    Patched { finish: Finish, other: [f64; 3], size: f64, seed: u32 },
    /// A robot: its sides, and on top a cover with one middle spot and four around it.
    Robot { side: Finish, cover: [f64; 3], spots: [[f64; 3]; 5], heading: f64, seed: u32 },
}

#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) shape: Shape,
    pub(super) surface: Surface,
    /// Its number where it is a ball.
    pub(super) ball: Option<usize>,
    /// A sphere around it: most rays miss even that.
    bound: (Point, f64),
}

/// The floor outside the carpet.
#[derive(Clone, Copy, Debug)]
pub(super) enum Ground {
    /// Boards of a width, m.
    Wood(f64),
    /// Tiles of a side, m.
    Tiles(f64),
    /// Concrete or carpet.
    Rough,
}

/// All that can be seen.
#[derive(Clone, Debug)]
pub struct World {
    pub(super) field: Field,
    pub(super) lines: Vec<Line>,
    /// Reflectance of the carpet, of its lines, of the floor around it and of the walls.
    pub(super) carpet: [f64; 3],
    pub(super) paint: [f64; 3],
    pub(super) floor: [f64; 3],
    pub(super) wall: [f64; 3],
    pub(super) ground: Ground,
    /// Contrast of the carpet's texture.
    pub(super) wear: f64,
    /// Contrast of light across the floor, and whether windows throw hard-edged patches of sun.
    pub(super) uneven: f64,
    pub(super) sun: f64,
    /// Share of the walls' cells with things of any colour in them.
    pub(super) clutter: f64,
    /// From the carpet's edge to the walls, m.
    pub(super) room: f64,
    pub(super) lamps: Vec<Lamp>,
    /// Light from everywhere.
    pub(super) ambient: f64,
    pub(super) bodies: Vec<Body>,
    pub(super) seed: u32,
}

/// What a ray meets: way, normal, finish, ball's number.
type Met = (f64, Point, Finish, Option<usize>);

impl World {
    /// A field in a plain grey hall under four lamps, nothing on it but its goals.
    #[must_use]
    pub fn plain(field: Field, seed: u32) -> Self {
        let lamp = |x: f64, y: f64| Lamp {
            at: Point::new(x * field.length / 4.0, y * field.width / 4.0, 4.0),
            size: 0.3,
            strength: 0.16,
            tint: [1.0; 3],
            reference: Point::zeros(),
        };
        let mut world = Self {
            field,
            lines: field.lines(),
            carpet: [0.03, 0.2, 0.05],
            paint: [0.75; 3],
            floor: [0.3; 3],
            wall: [0.35, 0.35, 0.4],
            ground: Ground::Rough,
            wear: 0.25,
            uneven: 0.2,
            sun: 0.0,
            clutter: 0.25,
            room: 2.0,
            lamps: vec![lamp(-1.0, -1.0), lamp(-1.0, 1.0), lamp(1.0, -1.0), lamp(1.0, 1.0)],
            ambient: 0.4,
            bodies: Vec::new(),
            seed,
        };
        world.goals(plain([0.7; 3]));
        world
    }

    /// With one more ball on the floor.
    #[must_use]
    pub fn with_ball(mut self, x: f64, y: f64) -> Self {
        let finish = Finish { albedo: [0.85, 0.2, 0.03], gloss: 0.05, sharpness: 40.0 };
        self.bodies.push(ball(self.balls(), x, y, 0.0, finish, self.seed));
        self
    }

    /// With other robots on the floor: black cylinders with a white cover, of the league's greatest size.
    #[must_use]
    pub fn with_robots(mut self, places: &[[f64; 2]]) -> Self {
        for [x, y] in places {
            let shape = Shape::Cylinder { base: Point::new(*x, *y, 0.0), radius: 0.09, height: 0.15 };
            self.bodies.push(Body::new(shape, Surface::Plain(plain([0.03; 3]))));
            let cover = Shape::Cylinder { base: Point::new(*x, *y, 0.1), radius: 0.091, height: 0.03 };
            self.bodies.push(Body::new(cover, Surface::Plain(plain([0.7; 3]))));
        }
        self
    }

    /// Walls of both goals.
    pub(super) fn goals(&mut self, white: Finish) {
        let field = self.field;
        let (half, height) = (field.goal_width / 2.0, field.goal_height / 2.0);
        for end in [-1.0, 1.0] {
            let line = end * field.length / 2.0;
            let middle = line + end * field.goal_depth / 2.0;
            let walls = [
                (Point::new(middle, half, height), Point::new(field.goal_depth / 2.0, 0.01, height)),
                (Point::new(middle, -half, height), Point::new(field.goal_depth / 2.0, 0.01, height)),
                (Point::new(line + end * field.goal_depth, 0.0, height), Point::new(0.01, half, height)),
            ];
            for (centre, half) in walls {
                self.bodies.push(Body::new(Shape::Box { centre, half, heading: 0.0 }, Surface::Plain(white)));
            }
        }
    }

    /// How many balls there are.
    #[must_use]
    pub fn balls(&self) -> usize {
        self.bodies.iter().filter(|body| body.ball.is_some()).count()
    }

    /// Light from where a ray goes, and the ball it meets.
    pub(super) fn look(&self, eye: Point, along: Point, rng: &mut ChaCha8Rng) -> ([f64; 3], Option<usize>) {
        let (way, normal, finish, ball) = self.meet(eye, along);
        let at = eye + way * along;
        let mut sum = self.around(at, normal, &finish, ball);
        for lamp in &self.lamps {
            let (amount, towards, far) = lamp.onto(at, normal, rng);
            if amount > 1e-4 && !self.shaded(at, towards, far) {
                let amount = amount * self.evenness(at);
                let lit = finish.lit(amount, lamp.tint, normal, towards, along);
                for (sum, c) in sum.iter_mut().zip(lit) {
                    *sum += c;
                }
            }
        }
        (sum, ball)
    }

    /// Light from the hall and from the floor below.
    fn around(&self, at: Point, normal: Point, finish: &Finish, ball: Option<usize>) -> [f64; 3] {
        let up = 0.5 + 0.5 * normal.z;
        let carpet = self.field.on_carpet(at.x, at.y);
        let below = if carpet { self.carpet } else { self.floor };
        let strength: f64 = self.ambient + self.lamps.iter().map(|lamp| lamp.strength).sum::<f64>() * 0.3;
        let open = if ball.is_none() { self.openness(at, normal) } else { 1.0 };
        [0, 1, 2].map(|i| {
            let from_below = below[i] * strength * (1.0 - up) * 1.2;
            finish.albedo[i] * open * (self.ambient * up + from_below)
        })
    }

    /// Less light reaches the floor beside a ball.
    fn openness(&self, at: Point, normal: Point) -> f64 {
        if normal.z < 0.9 || at.z > 0.01 {
            return 1.0;
        }
        let mut open = 1.0;
        for body in &self.bodies {
            if let Shape::Sphere { centre, radius } = &body.shape {
                let to = centre - at;
                let far = to.norm().max(*radius);
                open *= 1.0 - (radius / far).powi(2) * (to.z / far).max(0.0);
            }
        }
        open
    }

    fn shaded(&self, at: Point, towards: Point, far: f64) -> bool {
        let from = at + towards * 1e-4;
        self.bodies.iter().any(|body| body.meet(from, towards).is_some_and(|hit| hit.way < far))
    }

    /// Lamps leave bright and dark places on the floor.
    fn evenness(&self, at: Point) -> f64 {
        let soft = 1.0 + self.uneven * (smooth(at.x * 0.8, at.y * 0.8, self.seed ^ 11) - 0.5);
        let sunny = self.sun > 0.0 && smooth(at.x * 0.6, at.y * 0.35, self.seed ^ 12) > 0.62;
        if sunny { soft + self.sun } else { soft }
    }

    fn meet(&self, eye: Point, along: Point) -> Met {
        let mut nearest = self.hall(eye, along);
        for body in &self.bodies {
            if let Some(hit) = body.meet(eye, along).filter(|hit| hit.way < nearest.0) {
                let (normal, finish) = body.look(&hit, eye + hit.way * along);
                nearest = (hit.way, normal, finish, body.ball);
            }
        }
        nearest
    }

    /// Floor and walls.
    fn hall(&self, eye: Point, along: Point) -> Met {
        let x = self.field.length / 2.0 + self.field.boundary + self.room;
        let y = self.field.width / 2.0 + self.field.boundary + self.room;
        let to = |place: f64, from: f64, step: f64| {
            let way = (place - from) / step;
            if way.is_finite() && way > NEAREST { way } else { f64::INFINITY }
        };
        let floor = to(0.0, eye.z, along.z);
        let wall_x = to(x.copysign(along.x), eye.x, along.x);
        let wall_y = to(y.copysign(along.y), eye.y, along.y);
        if floor <= wall_x.min(wall_y) {
            let at = eye + floor * along;
            return (floor, Point::z(), plain(self.ground_at(at)), None);
        }
        let (way, normal) = if wall_x < wall_y {
            (wall_x, Point::new(-along.x.signum(), 0.0, 0.0))
        } else {
            (wall_y, Point::new(0.0, -along.y.signum(), 0.0))
        };
        let at = eye + way * along;
        (way, normal, plain(self.wall_at(at, wall_x < wall_y)), None)
    }

    fn ground_at(&self, at: Point) -> [f64; 3] {
        if !self.field.on_carpet(at.x, at.y) {
            return self.floor_at(at);
        }
        let coarse = smooth(at.x * 3.0, at.y * 3.0, self.seed ^ 1) + 0.5 * smooth(at.x * 11.0, at.y * 11.0, self.seed);
        let fibre = cell((at.x * 900.0) as i64, (at.y * 900.0) as i64, self.seed ^ 2);
        let shade = 1.0 + self.wear * (0.6 * (coarse - 0.75) + 1.2 * (fibre - 0.5));
        let off = distance(&self.lines, [at.x, at.y]);
        let worn = smooth(at.x * 25.0, at.y * 25.0, self.seed ^ 3) * self.wear;
        if off < self.field.line_width / 2.0 {
            return [0, 1, 2].map(|i| self.paint[i] * (1.0 - 0.6 * worn) + self.carpet[i] * 0.6 * worn);
        }
        self.carpet.map(|c| c * shade.max(0.2))
    }

    fn floor_at(&self, at: Point) -> [f64; 3] {
        let seed = self.seed ^ 4;
        let shade = match self.ground {
            Ground::Wood(width) => {
                let board = (at.x / width).floor();
                let grain = smooth(at.x / width * 14.0, at.y * 2.0 + 31.0 * board, seed);
                0.7 + 0.3 * cell(board as i64, (at.y / (9.0 * width)).floor() as i64, seed) + 0.3 * (grain - 0.5)
            }
            Ground::Tiles(side) => {
                let joint = [at.x, at.y].iter().any(|c| (c / side).rem_euclid(1.0) < 0.02);
                if joint { 0.5 } else { 0.9 + 0.1 * cell((at.x / side) as i64, (at.y / side) as i64, seed) }
            }
            Ground::Rough => 0.8 + 0.4 * smooth(at.x * 60.0, at.y * 60.0, seed),
        };
        self.floor.map(|c| c * shade)
    }

    fn wall_at(&self, at: Point, across_x: bool) -> [f64; 3] {
        let along = if across_x { at.y } else { at.x };
        let (column, row) = ((along / 0.45).floor() as i64, (at.z / 0.6).floor() as i64);
        let seed = self.seed ^ if across_x { 5 } else { 6 };
        if at.z > 2.4 || cell(column, row, seed) > self.clutter {
            return self.wall.map(|c| c * (0.85 + 0.3 * smooth(along, at.z, seed)));
        }
        let part = |k: u32| cell(column, row, seed ^ (100 + k));
        // Posters, clothes, boxes: a third of them of strong colour.
        let bright = 0.05 + 0.7 * part(0) * part(0);
        let strength = if part(4) > 0.66 { 1.0 } else { 0.3 };
        [1, 2, 3].map(|k| bright * (1.0 - strength + strength * part(k) * part(k) * 1.6))
    }

    /// Pixels of a ball's disc, nothing hidden or cut off.
    pub(super) fn disc(&self, ball: usize, camera: &Camera, eye: Point, heading: f64) -> Option<f64> {
        let body = self.bodies.iter().find(|body| body.ball == Some(ball))?;
        let Shape::Sphere { centre, radius } = &body.shape else { return None };
        let (s, c) = heading.sin_cos();
        let to = centre - eye;
        let seen = Point::new(c * to.x + s * to.y, c * to.y - s * to.x, centre.z);
        let right = Point::new(seen.y, -seen.x, 0.0).normalize() * *radius;
        let up = right.cross(&Point::new(seen.x, seen.y, seen.z - eye.z)).normalize() * *radius;
        let across = |side: Point| {
            let (a, b) = (camera.project(seen + side)?, camera.project(seen - side)?);
            Some((a[0] - b[0]).hypot(a[1] - b[1]) / 2.0)
        };
        Some(std::f64::consts::PI * across(right)? * across(up)?)
    }
}

impl Body {
    /// A body that is no ball.
    pub(super) fn new(shape: Shape, surface: Surface) -> Self {
        Self { bound: shape.bound(), shape, surface, ball: None }
    }

    /// Place and radius of a robot.
    pub(super) fn robot(&self) -> Option<(Point, f64)> {
        match (&self.surface, &self.shape) {
            (Surface::Robot { .. }, Shape::Cylinder { base, radius, .. }) => Some((*base, *radius)),
            _ => None,
        }
    }

    fn meet(&self, from: Point, along: Point) -> Option<Hit> {
        let to = self.bound.0 - from;
        let (ahead, far) = (to.dot(&along), to.norm_squared());
        let reach = self.bound.1 * self.bound.1;
        let missed = far > reach && (ahead < 0.0 || far - ahead * ahead > reach);
        if missed { None } else { self.shape.meet(from, along) }
    }

    /// Normal and finish where a ray met it.
    fn look(&self, hit: &Hit, at: Point) -> (Point, Finish) {
        match &self.surface {
            Surface::Plain(finish) => (hit.normal, *finish),
            Surface::Ball { finish, seed } => {
                let n = hit.normal;
                let (u, v) = (n.x.atan2(n.y) * 7.0, n.z.asin() * 14.0);
                let dimple = Point::new(smooth(u, v, *seed) - 0.5, smooth(u, v, seed ^ 1) - 0.5, 0.0) * 0.25;
                let dirt = 1.0 - 0.25 * smooth(u * 0.4, v * 0.4, seed ^ 2);
                ((n + dimple).normalize(), Finish { albedo: finish.albedo.map(|c| c * dirt), ..*finish })
            }
            Surface::Patched { finish, other, size, seed } => {
                let place = |c: f64| (c / size).floor() as i64;
                let share = cell(place(at.x + at.y), place(at.z + 0.3 * at.x), *seed);
                let albedo = [0, 1, 2].map(|i| finish.albedo[i] * (1.0 - share) + other[i] * share);
                (hit.normal, Finish { albedo, ..*finish })
            }
            Surface::Robot { side, cover, spots, heading, seed } => {
                let Shape::Cylinder { base, .. } = &self.shape else { return (hit.normal, *side) };
                if hit.normal.z < 0.5 {
                    let part = cell(((at.z) / 0.03) as i64, (hit.normal.x.atan2(hit.normal.y) * 3.0) as i64, *seed);
                    return (hit.normal, Finish { albedo: side.albedo.map(|c| c * (0.4 + 1.2 * part)), ..*side });
                }
                let from = at - base;
                let (s, c) = heading.sin_cos();
                let local = [c * from.x + s * from.y, c * from.y - s * from.x];
                let places = [[0.0, 0.0], [0.055, 0.035], [-0.055, 0.055], [0.055, -0.035], [-0.055, -0.055]];
                let spot = places.iter().position(|p| (p[0] - local[0]).hypot(p[1] - local[1]) < 0.022);
                (hit.normal, plain(spot.map_or(*cover, |spot| spots[spot])))
            }
        }
    }
}

/// A dull surface.
pub(super) fn plain(albedo: [f64; 3]) -> Finish {
    Finish { albedo, gloss: 0.0, sharpness: 1.0 }
}

/// A ball on the carpet, or `above` metres over it.
pub(super) fn ball(number: usize, x: f64, y: f64, above: f64, finish: Finish, seed: u32) -> Body {
    let centre = Point::new(x, y, BALL_RADIUS + above);
    let shape = Shape::Sphere { centre, radius: BALL_RADIUS };
    Body { ball: Some(number), ..Body::new(shape, Surface::Ball { finish, seed }) }
}
