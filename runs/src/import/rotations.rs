//! Rotations that motion capture writes as a vector, its axis by its angle: `RX`, `RY`, `RZ`.
//!
//! Of what stands upright `RZ` is the heading, until the angle comes to a turn: there the vector may as well lie along another
//! axis, and `RZ` is anything.

use super::{Table, heading, units};

/// Tilt up to which a body stands on a floor, rad: plates and rods of markers are not quite level.
const LEVEL: f64 = 0.3;

/// Headings, `.../yaw`, of bodies that by these vectors stay level throughout, though `RX` or `RY` by themselves say that
/// they fall over. As angles about three axes, one after the other, they would.
pub(super) fn headings(table: &mut Table) {
    let first = |name: &str| {
        let stem = units::without(name).strip_suffix("RX")?;
        Some((stem.to_owned(), name[stem.len() + 2..].to_owned()))
    };
    let stems: Vec<(String, String)> = table.series.iter().filter_map(|s| first(&s.name)).collect();
    for (stem, unit) in stems {
        let [Some(x), Some(y), Some(z)] = ["RX", "RY", "RZ"].map(|axis| table.find(&format!("{stem}{axis}{unit}")))
        else {
            continue;
        };
        let falls = [x, y].iter().any(|s| s.values.iter().any(|v| v.abs() * scale(&unit) > LEVEL));
        if !falls || x.t != z.t || y.t != z.t {
            continue;
        }
        let turns = (0..z.t.len()).map(|i| turned([x, y, z].map(|s| s.values[i] * scale(&unit))));
        let turns: Vec<[f64; 4]> = turns.collect();
        // Up in the body is 1 - 2 (x² + y²) up in the world.
        if turns.iter().any(|[x, y, ..]| 1.0 - 2.0 * (x * x + y * y) < LEVEL.cos()) {
            continue;
        }
        for (t, turn) in z.t.clone().into_iter().zip(turns) {
            table.push(&format!("{stem}yaw"), t, heading(turn));
        }
    }
}

/// Radians in the unit that stands after a name.
fn scale(unit: &str) -> f64 {
    units::in_name(&format!("R{unit}"))
        .filter(|unit| units::is_like(unit, "rad"))
        .and_then(units::factor)
        .unwrap_or(1.0)
}

/// The quaternion x, y, z, w of a rotation vector.
fn turned(vector: [f64; 3]) -> [f64; 4] {
    let angle = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
    let (sin, cos) = (0.5 * angle).sin_cos();
    let [x, y, z] = vector.map(|v| if angle > 0.0 { v / angle * sin } else { 0.0 });
    [x, y, z, cos]
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::{Clock, Table};

    fn read(rows: &[[f64; 4]]) -> Table {
        let rows: String = rows.iter().map(|[t, x, y, z]| format!("{t},{x},{y},{z}\n")).collect();
        let text = format!("t,car/RX [rad],car/RY [rad],car/RZ [rad]\n{rows}");
        Table::of_bytes(text.as_bytes(), Path::new("x.csv"), None, &Clock::default()).unwrap()
    }

    #[test]
    fn a_level_body_has_its_heading_whatever_axis_the_vector_takes() {
        // A body that leans by 0.01 turns past a whole turn, where its vector tips over.
        let vectors = |lean: f64| -> Vec<[f64; 4]> {
            let row = |k: i32| {
                let yaw = 5.8 + 0.05 * f64::from(k);
                let (half, tip) = (0.5 * yaw, 0.5 * lean);
                let q =
                    [tip.sin() * half.cos(), tip.sin() * half.sin(), tip.cos() * half.sin(), tip.cos() * half.cos()];
                let angle = 2.0 * q[3].clamp(-1.0, 1.0).acos();
                let length = q[..3].iter().map(|v| v * v).sum::<f64>().sqrt();
                [0.01 * f64::from(k), q[0] / length * angle, q[1] / length * angle, q[2] / length * angle]
            };
            (0..20).map(row).collect()
        };
        let rows = vectors(0.01);
        assert!(rows.iter().any(|row| row[1].abs() > 1.0 || row[2].abs() > 1.0), "{rows:?}");
        let yaw = read(&rows);
        let yaw = &yaw.find("car/yaw").unwrap().values;
        for (k, yaw) in yaw.iter().enumerate() {
            let off = yaw - (5.8 + 0.05 * k as f64);
            assert!((off / std::f64::consts::TAU - (off / std::f64::consts::TAU).round()).abs() < 1e-3, "{k}: {yaw}");
        }
        // What leans is no robot on a floor, and where RX and RY are small RZ is the heading.
        assert!(read(&vectors(0.8)).find("car/yaw").is_none());
        assert!(read(&[[0.0, 0.01, 0.0, 1.0], [0.1, 0.02, 0.0, 2.0]]).find("car/yaw").is_none());
    }
}
