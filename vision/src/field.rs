//! The field's lines: divisions A and B of the RoboCup small-size league, or other sizes.
//!
//! Field frame: origin at the centre mark, x towards one goal, y to the left of it, m.

mod file;

/// Sizes of a field, m (rules of the small-size league, section "The field"; the league's geometry message has the same
/// fields in millimetres).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field {
    /// Between the goal lines.
    pub length: f64,
    /// Between the touch lines.
    pub width: f64,
    /// Carpet outside the lines.
    pub boundary: f64,
    /// Between the posts of a goal.
    pub goal_width: f64,
    /// From the goal line to the back of a goal.
    pub goal_depth: f64,
    /// Top of a goal's walls.
    pub goal_height: f64,
    /// Of a defence area, into the field.
    pub defence_depth: f64,
    /// Of a defence area, along the goal line.
    pub defence_width: f64,
    /// Of the centre circle.
    pub circle_radius: f64,
    /// Across the paint of a line.
    pub line_width: f64,
}

/// A piece of a line's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Line {
    /// From one point to another.
    Straight([f64; 2], [f64; 2]),
    /// A full circle about the origin, by its radius.
    Circle(f64),
}

/// Half of a small robot's diameter of 180 mm by the league's rules, m: what no camera of its own has to beat.
const LEAST_SURE_M: f64 = 0.09;

impl Field {
    /// Division A: 12 m by 9 m.
    pub const DIVISION_A: Self = Self {
        length: 12.0,
        width: 9.0,
        boundary: 0.3,
        goal_width: 1.8,
        goal_depth: 0.18,
        goal_height: 0.16,
        defence_depth: 1.8,
        defence_width: 3.6,
        circle_radius: 0.5,
        line_width: 0.01,
    };

    /// Division B: 9 m by 6 m.
    pub const DIVISION_B: Self = Self {
        length: 9.0,
        width: 6.0,
        boundary: 0.3,
        goal_width: 1.0,
        goal_depth: 0.18,
        goal_height: 0.16,
        defence_depth: 1.0,
        defence_width: 2.0,
        circle_radius: 0.5,
        line_width: 0.01,
    };

    /// The middles of all lines: touch, goal, halfway and centre line, the defence areas and the centre circle.
    #[must_use]
    pub fn lines(&self) -> Vec<Line> {
        let (x, y) = (self.length / 2.0, self.width / 2.0);
        let straight = |ax, ay, bx, by| Line::Straight([ax, ay], [bx, by]);
        let mut lines = vec![
            straight(-x, -y, x, -y),
            straight(-x, y, x, y),
            straight(-x, -y, -x, y),
            straight(x, -y, x, y),
            straight(0.0, -y, 0.0, y),
            straight(-x, 0.0, x, 0.0),
            Line::Circle(self.circle_radius),
        ];
        let half = self.defence_width / 2.0;
        for end in [-1.0, 1.0] {
            let inner = end * (x - self.defence_depth);
            lines.push(straight(end * x, -half, inner, -half));
            lines.push(straight(end * x, half, inner, half));
            lines.push(straight(inner, -half, inner, half));
        }
        lines
    }

    /// Standard deviation of the place, m, with which a robot that keeps to the lines stays on the carpet: 19 times of 20.
    #[must_use]
    pub fn sure_m(&self) -> f64 {
        // A field without a rim: the robot's own size.
        (0.5 * self.boundary).max(LEAST_SURE_M)
    }

    /// Whether a point is on the carpet, lines and boundary included.
    #[must_use]
    pub fn on_carpet(&self, x: f64, y: f64) -> bool {
        x.abs() <= self.length / 2.0 + self.boundary && y.abs() <= self.width / 2.0 + self.boundary
    }
}

impl Line {
    /// The nearest point of the line's middle to a point.
    #[must_use]
    pub fn nearest(&self, p: [f64; 2]) -> [f64; 2] {
        match *self {
            Self::Straight(a, b) => {
                let d = [b[0] - a[0], b[1] - a[1]];
                let share = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] * d[0] + d[1] * d[1]);
                let share = share.clamp(0.0, 1.0);
                [a[0] + share * d[0], a[1] + share * d[1]]
            }
            Self::Circle(radius) => {
                let from_centre = (p[0] * p[0] + p[1] * p[1]).sqrt();
                if from_centre < 1e-9 {
                    return [radius, 0.0];
                }
                [p[0] * radius / from_centre, p[1] * radius / from_centre]
            }
        }
    }
}

/// Distance from a point to the nearest line's middle, m.
#[must_use]
pub fn distance(lines: &[Line], p: [f64; 2]) -> f64 {
    let squared = |line: &Line| {
        let near = line.nearest(p);
        (near[0] - p[0]).powi(2) + (near[1] - p[1]).powi(2)
    };
    lines.iter().map(squared).fold(f64::INFINITY, f64::min).sqrt()
}
