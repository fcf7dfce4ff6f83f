//! Pictures with known truth, by ray tracing: bodies, lights with shadows, textures, and a camera with all its faults.
//!
//! It is there to test the detector, so that it shares nothing with it but the camera's geometry and the field's map:
//! light is physical and linear, colours are reflectances, and what the camera makes of them comes last.

mod light;
mod noise;
mod random;
mod scene;
mod sensor;
mod shape;

pub use random::{Sample, sample, samples};
pub use scene::World;
pub use sensor::Sensor;

use crate::ball::Region;
use crate::camera::Camera;
use crate::picture::Picture;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

type Point = nalgebra::Vector3<f64>;

/// Radius of the ball that is rendered, m.
pub const BALL_RADIUS: f64 = crate::ball::RADIUS;

/// A ball in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Label {
    /// What of it can be seen.
    pub region: Region,
    /// Share of the ball's disc that is neither hidden nor cut off, 0 to 1.
    pub visible: f64,
}

/// A picture and what is in it.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// As the camera delivers it.
    pub picture: Picture,
    /// All balls of which anything can be seen.
    pub balls: Vec<Label>,
}

/// Where the camera's robot stands and how it moves while the shutter is open.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shutter {
    /// Place of the camera on the field, m, and direction of view from x to y, rad.
    pub pose: [f64; 3],
    /// Way of the camera over the field during the exposure, m.
    pub moved: [f64; 2],
    /// Turn during the exposure, rad.
    pub turn: f64,
    /// Change of tilt during the exposure, rad.
    pub nod: f64,
    /// Share of those that is between the first row and the last (rolling shutter); the rest blurs every row.
    pub rolling: f64,
}

/// Renders a world through a camera; `grid` times `grid` rays a pixel.
#[must_use]
pub fn render(
    world: &World,
    camera: &Camera,
    shutter: Shutter,
    sensor: &Sensor,
    grid: usize,
    rng: &mut ChaCha8Rng,
) -> Rendered {
    expose(world, camera, shutter, grid, rng).developed(sensor, rng)
}

/// The light behind a lens, and what is in it. Tracing rays takes ten times as long as what a sensor does with them.
#[derive(Clone, Debug)]
struct Exposure {
    width: usize,
    height: usize,
    light: Vec<[f64; 3]>,
    balls: Vec<Label>,
}

impl Exposure {
    fn developed(&self, sensor: &Sensor, rng: &mut ChaCha8Rng) -> Rendered {
        let picture = sensor.develop(self.width, self.height, self.light.clone(), rng);
        Rendered { picture, balls: self.balls.clone() }
    }
}

fn expose(world: &World, camera: &Camera, shutter: Shutter, grid: usize, rng: &mut ChaCha8Rng) -> Exposure {
    let (width, height) = (camera.width, camera.height);
    let mut light = Vec::with_capacity(width * height);
    let mut seen = vec![Seen::default(); world.balls()];
    let step = 1.0 / grid as f64;
    let eye = Point::new(shutter.pose[0], shutter.pose[1], camera.mount_height);
    let way = Point::new(shutter.moved[0], shutter.moved[1], 0.0);
    let still = shutter.turn == 0.0 && shutter.nod == 0.0 && shutter.moved == [0.0; 2];
    let at_rest = shutter.pose[2].sin_cos();
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0.0; 3];
            for k in 0..grid * grid {
                let px = x as f64 + (((k % grid) as f64) + rng.random::<f64>()) * step;
                let py = y as f64 + (((k / grid) as f64) + rng.random::<f64>()) * step;
                let open = if still { 0.0 } else { rng.random::<f64>() - 0.5 };
                let time = shutter.rolling * (py / height as f64 - 0.5) + (1.0 - shutter.rolling) * open;
                let lens = Camera { tilt: camera.tilt + time * shutter.nod, ..*camera };
                let (s, c) = if still { at_rest } else { (shutter.pose[2] + time * shutter.turn).sin_cos() };
                let ray = lens.ray([px, py]);
                let along = Point::new(c * ray.x - s * ray.y, s * ray.x + c * ray.y, ray.z);
                let (colour, ball) = world.look(eye + time * way, along, rng);
                if let Some(ball) = ball {
                    seen[ball].add(px, py);
                }
                for (sum, c) in sum.iter_mut().zip(colour) {
                    *sum += c / (grid * grid) as f64;
                }
            }
            light.push(sum);
        }
    }
    let balls = seen.iter().enumerate().filter_map(|(ball, seen)| {
        let whole = world.disc(ball, camera, eye, shutter.pose[2])? * (grid * grid) as f64;
        seen.label(whole, step)
    });
    let balls = balls.collect();
    Exposure { width, height, light, balls }
}

/// Rays that met a ball.
#[derive(Clone, Copy, Debug)]
struct Seen {
    rays: usize,
    low: [f64; 2],
    high: [f64; 2],
}

impl Default for Seen {
    fn default() -> Self {
        Self { rays: 0, low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] }
    }
}

impl Seen {
    fn add(&mut self, x: f64, y: f64) {
        self.rays += 1;
        self.low = [self.low[0].min(x), self.low[1].min(y)];
        self.high = [self.high[0].max(x), self.high[1].max(y)];
    }

    fn label(&self, whole: f64, step: f64) -> Option<Label> {
        let region = Region {
            x: (self.low[0] + self.high[0]) / 2.0,
            y: (self.low[1] + self.high[1]) / 2.0,
            width: self.high[0] - self.low[0] + step / 2.0,
            height: self.high[1] - self.low[1] + step / 2.0,
        };
        (self.rays > 2).then(|| Label { region, visible: (self.rays as f64 / whole).min(1.0) })
    }
}
