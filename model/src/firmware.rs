//! What to type into one's own firmware: the kinematics of a robot with the effects that were found.

use crate::effects::Applied;
use runs::geometry::GeometryError;
use runs::robot::Robot;
use std::fmt::Write as _;

/// Both matrices of the kinematics and the radius of every wheel, skew, places and radii as found.
#[derive(Debug, Clone, PartialEq)]
pub struct Firmware {
    /// Radius of every wheel, m.
    pub radius_m: Vec<f64>,
    /// N × 3, a row a wheel: wheel speed (rad/s) of a velocity to the right, forward (m/s) and counter-clockwise (rad/s).
    pub inverse: Vec<[f64; 3]>,
    /// 3 × N, a row an axis: the velocity that fits the wheel speeds best.
    pub direct: [Vec<f64>; 3],
}

impl Firmware {
    /// Of a robot with its effects: skew, angle, body radius and wheel radii, common or each.
    ///
    /// # Errors
    /// [`GeometryError`] if the wheels drive no robot.
    pub fn of(robot: &Robot) -> Result<Self, GeometryError> {
        let placed = Applied::geometry_of(robot);
        let geometry = placed.geometry()?;
        let radii = placed.effects.iter().filter(|effect| effect.name == "wheel-radius");
        let mut scales = vec![1.0; geometry.wheel_count()];
        for effect in radii {
            for (i, scale) in scales.iter_mut().enumerate() {
                let own = effect.value(&format!("scale_{}", i + 1)).unwrap_or(0.0);
                *scale *= 1.0 + own + effect.value("scale").unwrap_or(0.0);
            }
        }
        let mut inverse = geometry.inverse().clone();
        inverse.row_iter_mut().zip(&scales).for_each(|(mut row, scale)| row /= *scale);
        let direct = geometry.direct_of(&inverse)?;
        Ok(Self {
            radius_m: scales.iter().map(|s| s * geometry.wheel_radius_m()).collect(),
            inverse: inverse.row_iter().map(|row| std::array::from_fn(|axis| row[axis])).collect(),
            direct: std::array::from_fn(|axis| direct.row(axis).iter().copied().collect()),
        })
    }

    /// That of `found`, where it is not that of `nominal`; `None` too where no wheels drive the robot over a floor, or where
    /// the file does not have their radius, as beside a robot's own odometry.
    #[must_use]
    pub fn corrected(nominal: &Robot, found: &Robot) -> Option<Self> {
        if !found.lacks(&["wheel_radius_m"]).is_empty() {
            return None;
        }
        let [before, after] = [nominal, found].map(|robot| Self::of(robot).ok());
        after.filter(|after| before.as_ref() != Some(after))
    }

    /// As constants in C, for a body frame with x forward and y to the left, as in ROS and the small-size league, or with
    /// x to the right and y forward, as here.
    #[must_use]
    pub fn c_arrays(&self) -> String {
        let wheels = self.inverse.len();
        let list = |row: &[f64]| row.iter().map(|x| format!("{:.6}f", tidy(*x))).collect::<Vec<_>>().join(", ");
        let rows =
            |rows: &[Vec<f64>]| rows.iter().fold(String::new(), |text, row| text + "    {" + &list(row) + "},\n");
        let right: Vec<Vec<f64>> = self.inverse.iter().map(|r| r.to_vec()).collect();
        let forward: Vec<Vec<f64>> = self.inverse.iter().map(|[x, y, w]| vec![*y, -x, *w]).collect();
        let [x, y, w] = &self.direct;
        let back = [y.clone(), x.iter().map(|x| -x).collect(), w.clone()];
        let mut out = format!("static const float wheel_radius_m[{wheels}] = {{{}}};\n", list(&self.radius_m));
        out += "/* rad/s of a wheel = row . (forward m/s, left m/s, counter-clockwise rad/s) */\n";
        let _ = writeln!(out, "static const float wheels_from_body[{wheels}][3] = {{\n{}}};", rows(&forward));
        out += "/* and back: forward, left, counter-clockwise = row . wheel speeds */\n";
        let _ = writeln!(out, "static const float body_from_wheels[3][{wheels}] = {{\n{}}};", rows(&back));
        out += "/* where x is to the right and y forward, as in racbot's own files */\n";
        let _ = writeln!(out, "static const float wheels_from_body_right[{wheels}][3] = {{\n{}}};", rows(&right));
        out
    }
}

/// No minus before a zero.
fn tidy(x: f64) -> f64 {
    if x.abs() < 5e-7 { 0.0 } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use runs::frames::Twist;
    use std::path::Path;

    fn with(effects: &str) -> Robot {
        Robot::parse(&(Robot::racbot().to_toml() + effects), Path::new("robot.toml")).unwrap()
    }

    #[test]
    fn skews_and_radii_change_what_is_typed_in() {
        let nominal = with("");
        assert_eq!(Firmware::corrected(&nominal, &nominal), None);
        let friction = "\n[[effect]]\nname = \"coulomb-friction\"\n[effect.parameters]\ntorque_nm = 0.01\n";
        assert_eq!(Firmware::corrected(&nominal, &with(friction)), None);
        let text = "\n[[effect]]\nname = \"wheel-skew\"\nwheels = [1]\n[effect.parameters]\nskew_1_rad = 0.05\n\
                    \n[[effect]]\nname = \"wheel-radius\"\nwheels = [2]\n[effect.parameters]\nscale_2 = -0.03\n";
        let found = Firmware::corrected(&nominal, &with(text)).unwrap();
        let (r, body) = (nominal.wheel_radius_m, 0.085);
        assert!((found.radius_m[1] / r - 0.97).abs() < 1e-12 && found.radius_m[0] == r);
        // Equation (2) of the paper, wheel 1: cos a, -sin a, -R cos a over the radius.
        let row = [0.05_f64.cos() / r, -0.05_f64.sin() / r, -body * 0.05_f64.cos() / r];
        assert!(row.iter().zip(found.inverse[0]).all(|(a, b)| (a - b).abs() < 1e-9), "{:?}", found.inverse[0]);
        // A wheel smaller than thought must turn faster.
        let plain = nominal.geometry().unwrap().wheel_speed(1, Twist::new(0.3, -0.7, 1.1));
        let typed: f64 = found.inverse[1].iter().zip([0.3, -0.7, 1.1]).map(|(m, v)| m * v).sum();
        assert!((typed * 0.97 - plain).abs() < 1e-9);
        let twist = [0.4, 0.2, -1.5];
        let speeds: Vec<f64> =
            found.inverse.iter().map(|row| row.iter().zip(twist).map(|(m, v)| m * v).sum()).collect();
        for (axis, v) in twist.iter().enumerate() {
            let back: f64 = found.direct[axis].iter().zip(&speeds).map(|(m, w)| m * w).sum();
            assert!((back - v).abs() < 1e-9);
        }
    }

    #[test]
    fn wheels_of_unknown_radius_have_none_to_type_in() {
        let of = |radius: &str, effect: &str| {
            let wheel = |x: f64| format!("[[wheel]]\nx_m = {x}\ny_m = 0\ndrive_deg = 90\nroller_deg = 0\n");
            Robot::parse_partial(&(radius.to_owned() + &wheel(0.28) + &wheel(-0.28) + effect), Path::new("robot.toml"))
                .unwrap()
        };
        let scaled = "[[effect]]\nname = \"wheel-radius-common\"\n[effect.parameters]\nscale = -0.05\n";
        assert_eq!(Firmware::corrected(&of("", ""), &of("", scaled)), None);
        let [plain, found] = ["", scaled].map(|effect| of("wheel_radius_m = 0.1651\n", effect));
        assert!(Firmware::corrected(&plain, &found).is_some());
    }

    #[test]
    fn c_has_the_frame_of_ros_and_ours() {
        let robot = with("\n[[effect]]\nname = \"body-radius\"\n[effect.parameters]\nscale = 0.1\n");
        let text = Firmware::of(&robot).unwrap().c_arrays();
        // Wheel 1, in front, drives to the right, and clockwise.
        let r = robot.wheel_radius_m;
        let forward = format!("{{0.000000f, {:.6}f, {:.6}f}}", -1.0 / r, -0.085 * 1.1 / r);
        let right = format!("{{{:.6}f, 0.000000f, {:.6}f}}", 1.0 / r, -0.085 * 1.1 / r);
        let (first, last) = (text.find(&forward), text.find(&right));
        assert!(first.is_some() && last > first, "{forward} {right}\n{text}");
    }
}
