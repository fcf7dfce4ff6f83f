//! Goals: white walls that stand on the far edge of the carpet.

use crate::ball::Region;
use crate::carpet::{Carpet, total};
use crate::picture::Raster;

/// Brightness of a goal's wall over the carpet's at least.
const BRIGHTER: f32 = 1.15;
/// Range of components over their sum: white under coloured light.
const COLOUR: f32 = 0.2;
/// Least height and width, as shares of the picture's.
const LEAST: [f32; 2] = [0.03, 0.05];
/// Width over height of what is seen of a goal: from the side, to straight in front with its walls 0.16 m high.
const ASPECT: [f32; 2] = [0.6, 14.0];
/// Share of a box that is white.
const FILLED: f32 = 0.45;
/// Columns without white that do not end a goal: a robot in front of it is wider, a post's shadow is not.
const GAP: usize = 4;

/// Boxes of what stands on the carpet's far edge and is white, pixels of a picture `by` times as large.
pub(crate) fn goals(picture: &Raster<[f32; 3]>, carpet: &Carpet, by: usize) -> Vec<Region> {
    let ground = total(carpet.colour);
    let white = |x: usize, y: usize| {
        let pixel = picture.at(x, y);
        let sum = total(pixel);
        let range = pixel.iter().fold(f32::MIN, |m, &c| m.max(c)) - pixel.iter().fold(f32::MAX, |m, &c| m.min(c));
        sum > BRIGHTER * ground && range < COLOUR * sum
    };
    let least = (LEAST[0] * picture.height as f32).max(3.0);
    // From the carpet's far edge up, in every column: how far it is white.
    let walls: Vec<Option<(f32, f32)>> = (0..picture.width)
        .map(|x| {
            let edge = carpet.boundary[x];
            if edge >= picture.height as f32 || edge < least {
                return None;
            }
            let base = (edge as usize).min(picture.height - 1);
            let start = (base.saturating_sub(4)..=base).rev().find(|&y| white(x, y))?;
            let top = (0..=start).rev().take_while(|&y| white(x, y)).last()?;
            ((start - top) as f32 >= least).then_some((top as f32, edge))
        })
        .collect();
    let mut goals = Vec::new();
    let mut x = 0;
    while x < walls.len() {
        if walls[x].is_none() {
            x += 1;
            continue;
        }
        let (from, mut last) = (x, x);
        while x < walls.len() && x - last <= GAP {
            if walls[x].is_some() {
                last = x;
            }
            x += 1;
        }
        goals.extend(goal(&walls[from..=last], from, picture.width, by));
    }
    goals
}

fn goal(walls: &[Option<(f32, f32)>], from: usize, width: usize, by: usize) -> Option<Region> {
    let mut tops: Vec<f32> = walls.iter().flatten().map(|wall| wall.0).collect();
    tops.sort_by(f32::total_cmp);
    let top = tops[tops.len() / 8];
    let bottom = walls.iter().flatten().map(|wall| wall.1).fold(0.0, f32::max);
    let (across, up) = (walls.len() as f32, bottom - top);
    let area: f32 = walls.iter().flatten().map(|(top, bottom)| bottom - top).sum();
    let fits = across >= LEAST[1] * width as f32
        && (ASPECT[0]..ASPECT[1]).contains(&(across / up))
        && top > 0.0
        && area >= FILLED * across * up;
    let scale = by as f64;
    fits.then(|| Region {
        x: (from as f64 + f64::from(across) / 2.0) * scale,
        y: f64::from(top + up / 2.0) * scale,
        width: f64::from(across) * scale,
        height: f64::from(up) * scale,
    })
}
