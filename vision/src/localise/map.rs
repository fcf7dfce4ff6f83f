//! The field's map, with the nearest line of every place worked out beforehand.

use super::FloorPoint;
use crate::field::{Field, Line};
use runs::frames::Pose;
use std::f64::consts::TAU;

/// Side of a cell, m.
const CELL: f64 = 0.05;
/// Beyond the carpet's edge, m: points that a wrong pose puts there have a distance, too.
const MARGIN: f64 = 1.0;
/// Distance of poses tried when lost, m, and headings.
const STEP: f64 = 0.25;
const HEADINGS: usize = 48;
/// Distance at which a point's cost has levelled off half-way when lost, m.
const LOST_LEVEL: f64 = 0.12;

/// Lines and, for every cell, the one that is nearest.
#[derive(Clone, Debug)]
pub struct Map {
    field: Field,
    lines: Vec<Line>,
    columns: usize,
    rows: usize,
    nearest: Vec<u8>,
    distance: Vec<f32>,
}

impl Map {
    /// Works out the nearest line of every cell, up to 1 m beyond the carpet's edge.
    #[must_use]
    pub fn new(field: Field) -> Self {
        let lines = field.lines();
        let cells = |length: f64| ((length + 2.0 * (field.boundary + MARGIN)) / CELL).ceil() as usize;
        let (columns, rows) = (cells(field.length), cells(field.width));
        let mut map = Self { field, lines, columns, rows, nearest: Vec::new(), distance: Vec::new() };
        for cell in 0..columns * rows {
            let at = map.centre(cell % columns, cell / columns);
            let far = |line: &Line| {
                let near = line.nearest(at);
                (near[0] - at[0]).hypot(near[1] - at[1])
            };
            let (number, distance) =
                (map.lines.iter().map(far).enumerate()).min_by(|a, b| a.1.total_cmp(&b.1)).expect("a field has lines");
            map.nearest.push(number as u8);
            map.distance.push(distance as f32);
        }
        map
    }

    fn centre(&self, column: usize, row: usize) -> [f64; 2] {
        let from_middle = |i: usize, n: usize| (i as f64 + 0.5 - n as f64 / 2.0) * CELL;
        [from_middle(column, self.columns), from_middle(row, self.rows)]
    }

    fn cell(&self, at: [f64; 2]) -> usize {
        let place = |c: f64, n: usize| ((c / CELL + n as f64 / 2.0).max(0.0) as usize).min(n - 1);
        place(at[1], self.rows) * self.columns + place(at[0], self.columns)
    }

    pub(super) fn lines(&self) -> &[Line] {
        &self.lines
    }

    pub(super) fn line_width(&self) -> f64 {
        self.field.line_width
    }

    /// Whether a place is within the outer lines.
    pub(super) fn is_inside(&self, [x, y]: [f64; 2]) -> bool {
        x.abs() <= self.field.length / 2.0 && y.abs() <= self.field.width / 2.0
    }

    /// The line nearest to a place and its nearest point.
    pub(super) fn nearest(&self, at: [f64; 2]) -> (&Line, [f64; 2]) {
        let line = &self.lines[usize::from(self.nearest[self.cell(at)])];
        (line, line.nearest(at))
    }

    /// How badly points fit at a pose, 0 to 1 a point.
    pub(super) fn cost(&self, floor: &[FloorPoint], pose: Pose) -> f64 {
        let (s, c) = pose.theta.sin_cos();
        let cost = |point: &FloorPoint| {
            let [x, y] = point.at;
            let at = [pose.x + c * x - s * y, pose.y + s * x + c * y];
            let e2 = f64::from(self.distance[self.cell(at)]).powi(2);
            e2 / (e2 + LOST_LEVEL * LOST_LEVEL)
        };
        floor.iter().map(cost).sum::<f64>() / floor.len() as f64
    }

    /// Poses all over the carpet.
    pub(super) fn grid(&self) -> impl Iterator<Item = Pose> + '_ {
        let (x, y) = (self.field.length / 2.0 + self.field.boundary, self.field.width / 2.0 + self.field.boundary);
        let steps = |half: f64| (2.0 * half / STEP) as usize;
        (0..=steps(x)).flat_map(move |i| {
            (0..=steps(y)).flat_map(move |j| {
                (0..HEADINGS).map(move |k| {
                    let theta = TAU * k as f64 / HEADINGS as f64;
                    Pose::new(i as f64 * STEP - x, j as f64 * STEP - y, theta)
                })
            })
        })
    }
}
