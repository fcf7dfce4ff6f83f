//! Bodies that a ray can meet.

use super::Point;

/// A body's form; heights are above the floor.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// A ball.
    Sphere { centre: Point, radius: f64 },
    /// A cylinder on end.
    Cylinder { base: Point, radius: f64, height: f64 },
    /// A box on the floor or above it, turned about the vertical.
    Box { centre: Point, half: Point, heading: f64 },
}

/// Where a ray meets a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// Along the ray.
    pub(super) way: f64,
    /// Outward, of length one.
    pub(super) normal: Point,
}

/// Nearer hits are the body the ray comes from.
pub(super) const NEAREST: f64 = 1e-5;

impl Shape {
    /// Middle and radius of a sphere around it.
    pub(super) fn bound(&self) -> (Point, f64) {
        match self {
            Self::Sphere { centre, radius } => (*centre, *radius),
            Self::Cylinder { base, radius, height } => (base + Point::z() * (height / 2.0), radius.hypot(height / 2.0)),
            Self::Box { centre, half, .. } => (*centre, half.norm()),
        }
    }

    /// The first hit of a ray from `from` along `along` (of length one).
    pub(super) fn meet(&self, from: Point, along: Point) -> Option<Hit> {
        match self {
            Self::Sphere { centre, radius } => {
                let to = from - centre;
                let b = to.dot(&along);
                let root = (b * b - to.norm_squared() + radius * radius).max(-1.0);
                if root < 0.0 {
                    return None;
                }
                let way = -b - root.sqrt();
                (way > NEAREST).then(|| Hit { way, normal: (to + way * along) / *radius })
            }
            Self::Cylinder { base, radius, height } => cylinder(from - base, along, *radius, *height),
            Self::Box { centre, half, heading } => {
                let (s, c) = heading.sin_cos();
                let into = |v: Point| Point::new(c * v.x + s * v.y, c * v.y - s * v.x, v.z);
                let out = |v: Point| Point::new(c * v.x - s * v.y, c * v.y + s * v.x, v.z);
                cuboid(into(from - centre), into(along), *half).map(|hit| Hit { normal: out(hit.normal), ..hit })
            }
        }
    }
}

fn cylinder(from: Point, along: Point, radius: f64, height: f64) -> Option<Hit> {
    let top = (along.z < 0.0)
        .then(|| (height - from.z) / along.z)
        .filter(|way| *way > NEAREST && (from + *way * along).xy().norm() < radius)
        .map(|way| Hit { way, normal: Point::z() });
    let a = along.xy().norm_squared();
    let b = from.xy().dot(&along.xy());
    let root = b * b - a * (from.xy().norm_squared() - radius * radius);
    let side = (root >= 0.0 && a > 1e-12).then(|| (-b - root.sqrt()) / a).filter(|way| {
        let z = from.z + way * along.z;
        *way > NEAREST && (0.0..=height).contains(&z)
    });
    let side = side.map(|way| {
        let at = from + way * along;
        Hit { way, normal: Point::new(at.x / radius, at.y / radius, 0.0) }
    });
    [top, side].into_iter().flatten().min_by(|a, b| a.way.total_cmp(&b.way))
}

fn cuboid(from: Point, along: Point, half: Point) -> Option<Hit> {
    let (mut enter, mut leave, mut axis) = (f64::NEG_INFINITY, f64::INFINITY, 0);
    for i in 0..3 {
        if along[i].abs() < 1e-12 {
            if from[i].abs() > half[i] {
                return None;
            }
            continue;
        }
        let ways = [(-half[i] - from[i]) / along[i], (half[i] - from[i]) / along[i]];
        let (first, last) = (ways[0].min(ways[1]), ways[0].max(ways[1]));
        if first > enter {
            (enter, axis) = (first, i);
        }
        leave = leave.min(last);
    }
    if enter > leave || enter <= NEAREST {
        return None;
    }
    let mut normal = Point::zeros();
    normal[axis] = -along[axis].signum();
    Some(Hit { way: enter, normal })
}
