//! Where the wheels are and what they measure: inverse and direct kinematics (paper, section 3).

use nalgebra::{DMatrix, Dyn, Matrix3, OMatrix, U3, Vector3};
use std::f64::consts::FRAC_PI_2;

use crate::frames::Twist;

/// N × 3 matrix, one row a wheel.
pub type InverseMatrix = OMatrix<f64, Dyn, U3>;
/// 3 × N matrix, one column a wheel.
pub type DirectMatrix = OMatrix<f64, U3, Dyn>;

/// One wheel on the base plate, in the body frame of [`Twist`] (x right, y forward).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wheel {
    /// Contact point, to the right of the chassis centre, m.
    pub x_m: f64,
    /// Contact point, in front of the chassis centre, m.
    pub y_m: f64,
    /// Direction in which positive wheel speed drives, from body x, counter-clockwise, rad.
    pub drive_rad: f64,
    /// Angle of the rollers: 0 for an omni wheel, ±π/4 for a mecanum wheel, rad.
    pub roller_rad: f64,
}

impl Wheel {
    /// The unit vector along which the rollers transmit force, at drive + roller angle.
    pub fn traction(&self) -> [f64; 2] {
        let (s, c) = (self.drive_rad + self.roller_rad).sin_cos();
        [c, s]
    }

    /// Coefficients of (vx, vy, ω) in the contact point's velocity along [`Self::traction`].
    pub fn traction_row(&self) -> [f64; 3] {
        let [ax, ay] = self.traction();
        [ax, ay, self.x_m * ay - self.y_m * ax]
    }

    /// The same across it, where the rollers run free.
    pub fn free_row(&self) -> [f64; 3] {
        let [ax, ay] = self.traction();
        [-ay, ax, self.x_m * ax + self.y_m * ay]
    }
}

/// Why wheels do not make a robot.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GeometryError {
    /// Fewer than two wheels drive no robot.
    #[error("{0} wheels cannot drive a robot; give at least 3, or 2 on one axle (differential drive)")]
    TooFewWheels(usize),
    /// Two wheels that do not stand on one axle.
    #[error(
        "two wheels drive a robot only where both stand on one axle and drive across it: \
         put them beside each other and give both the same drive_rad (or opposite ones)"
    )]
    NoAxle,
    /// A number is infinite, not a number, or the wheel radius is not positive.
    #[error("wheel {wheel}: {what}")]
    Invalid {
        /// Wheel, from 1; 0 for the radius all wheels share.
        wheel: usize,
        /// What is wrong.
        what: String,
    },
    /// The wheels leave a motion undriven, so that equation (5) has no inverse.
    #[error(
        "singular geometry: no wheel resists the motion vx {:.3}, vy {:.3}, omega {:.3} (1/m); \
         turn or move a wheel", free[0], free[1], free[2]
    )]
    Singular {
        /// The body twist all wheels let pass, normalised.
        free: [f64; 3],
    },
}

/// Wheels that can drive the platform, with both kinematic matrices.
///
/// Wheel speeds are in rad/s at the wheel. A wheel's row is
/// w = (v_contact · a) / (r cos roller) with a the unit vector at drive + roller angle.
///
/// Wheels without rollers that all drive one way make a **differential drive**: the middle between their contact points
/// has no sideways speed, so that (vx, vy, ω) has two degrees of freedom. Its direct kinematics keeps to that; inverse
/// kinematics of a twist with sideways speed drops it.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    wheels: Vec<Wheel>,
    wheel_radius_m: f64,
    inverse: InverseMatrix,
    direct: DirectMatrix,
    /// Twists that the wheels allow, one a column, of a differential drive; `None` where they allow every twist.
    allowed: Option<DMatrix<f64>>,
}

/// Wheels that differ less in direction (sine) and stand less in front of each other (share of their distance) make a
/// differential drive: a wheel turned by a quarter of a right angle scrubs, but drives.
const ONE_WAY: f64 = 0.4;

/// Ratio of singular values below which a geometry counts as singular: at 1e-6, a camera's
/// millimetres would have to become kilometres before the lost direction showed.
const SINGULAR_RATIO: f64 = 1e-6;

impl Geometry {
    /// A platform on `wheels`, all of radius `wheel_radius_m`.
    ///
    /// # Errors
    /// [`GeometryError`] for fewer than two wheels, two that share no axle, numbers that make no wheel (roller angle
    /// ±π/2 included) and wheels that leave a motion undriven.
    pub fn new(wheels: Vec<Wheel>, wheel_radius_m: f64) -> Result<Self, GeometryError> {
        if wheels.len() < 2 {
            return Err(GeometryError::TooFewWheels(wheels.len()));
        }
        let inverse = inverse_of(&wheels, wheel_radius_m)?;
        let allowed = one_way(&wheels);
        if allowed.is_none() && wheels.len() == 2 {
            return Err(GeometryError::NoAxle);
        }
        let mut geometry = Self { direct: DirectMatrix::zeros(wheels.len()), wheels, wheel_radius_m, inverse, allowed };
        geometry.direct = geometry.direct_of(&geometry.inverse)?;
        Ok(geometry)
    }

    /// Direct kinematics of other rows in the place of [`Self::inverse`], such as those of wheels whose radii differ: least
    /// squares among the twists that the wheels allow.
    ///
    /// # Errors
    /// [`GeometryError::Singular`] where they leave a motion undriven.
    pub fn direct_of(&self, inverse: &InverseMatrix) -> Result<DirectMatrix, GeometryError> {
        match &self.allowed {
            Some(allowed) => differential(inverse, allowed),
            None => pseudo_inverse(inverse, &self.wheels),
        }
    }

    /// Axes on blocks, one or more: no turn of a wheel moves the body, so [`Self::twist`] is zero.
    ///
    /// # Errors
    /// [`GeometryError::Invalid`] for numbers that make no wheel, and no wheels at all.
    pub fn axes(wheels: Vec<Wheel>, wheel_radius_m: f64) -> Result<Self, GeometryError> {
        if wheels.is_empty() {
            return Err(GeometryError::TooFewWheels(0));
        }
        let inverse = inverse_of(&wheels, wheel_radius_m)?;
        let direct = DirectMatrix::zeros(wheels.len());
        Ok(Self { wheels, wheel_radius_m, inverse, direct, allowed: None })
    }

    /// The paper's robot, equation (6): wheel 1 in front (90°), 2 rear left (210°), 3 rear right
    /// (330°), each turned **clockwise** by its skew α; positive wheel speed turns the robot
    /// clockwise.
    ///
    /// Row i of M is (dᵢx, dᵢy, −cos αᵢ·R) with d₁ = (cos α₁, −sin α₁),
    /// d₂ = (−cos(π/3+α₂), sin(π/3+α₂)), d₃ = (−cos(π/3−α₃), −sin(π/3−α₃)).
    ///
    /// # Errors
    /// As [`Geometry::new`]; skews of ±π/2 are singular.
    pub fn rac(wheel_radius_m: f64, body_radius_m: f64, skew_rad: [f64; 3]) -> Result<Self, GeometryError> {
        Self::new(rac_wheels(body_radius_m, skew_rad), wheel_radius_m)
    }

    /// Whether the wheels keep the robot from moving sideways.
    pub fn is_differential(&self) -> bool {
        self.allowed.is_some()
    }

    /// The twists that the wheels allow, one a column, orthonormal for a differential drive; the identity for a robot
    /// that drives in any direction.
    pub fn allowed_twists(&self) -> DMatrix<f64> {
        self.allowed.clone().unwrap_or_else(|| DMatrix::identity(3, 3))
    }

    /// The inverse of a 3 × 3 inertia (or any symmetric form of the twist) among the twists that the wheels allow:
    /// what forbids the others takes their share of a push. `None` where it has none.
    pub fn invert_allowed(&self, form: &Matrix3<f64>) -> Option<Matrix3<f64>> {
        let Some(allowed) = &self.allowed else { return form.try_inverse() };
        let within = allowed.transpose() * form * allowed;
        let product = allowed * within.try_inverse()? * allowed.transpose();
        Some(Matrix3::from_fn(|i, j| product[(i, j)]))
    }

    /// Number of wheels; at least 2 unless they are [`Self::axes`].
    pub fn wheel_count(&self) -> usize {
        self.wheels.len()
    }

    /// The wheels, in the order of the motors.
    pub fn wheels(&self) -> &[Wheel] {
        &self.wheels
    }

    /// Radius of every wheel, m.
    pub fn wheel_radius_m(&self) -> f64 {
        self.wheel_radius_m
    }

    /// Inverse kinematics, M/r of equation (4): body twist → wheel speeds, N × 3.
    pub fn inverse(&self) -> &InverseMatrix {
        &self.inverse
    }

    /// Direct kinematics, r·M⁻¹ of equation (5): wheel speeds → body twist, 3 × N; the least
    /// squares solution for more than three wheels.
    pub fn direct(&self) -> &DirectMatrix {
        &self.direct
    }

    /// Wheel speeds (rad/s) for a body twist.
    pub fn wheel_speeds(&self, twist: Twist) -> Vec<f64> {
        (0..self.wheels.len()).map(|i| self.wheel_speed(i, twist)).collect()
    }

    /// Speed (rad/s) of one wheel, counted from 0, for a body twist.
    pub fn wheel_speed(&self, wheel: usize, twist: Twist) -> f64 {
        let m = &self.inverse;
        m[(wheel, 0)] * twist.vx + m[(wheel, 1)] * twist.vy + m[(wheel, 2)] * twist.omega
    }

    /// The body twist that fits the wheel speeds (rad/s, one a wheel) best.
    ///
    /// Also maps wheel angles to body displacements. Surplus entries are ignored, missing ones 0.
    pub fn twist(&self, wheel_speeds: &[f64]) -> Twist {
        let mut sum = [0.0; 3];
        for (i, w) in wheel_speeds.iter().enumerate().take(self.wheels.len()) {
            for (j, s) in sum.iter_mut().enumerate() {
                *s += self.direct[(j, i)] * w;
            }
        }
        Twist::new(sum[0], sum[1], sum[2])
    }
}

/// Three wheels at 90°, 210° and 330°, so far from the centre, each turned clockwise by its skew.
pub fn rac_wheels(body_radius_m: f64, skew_rad: [f64; 3]) -> Vec<Wheel> {
    [90.0_f64, 210.0, 330.0]
        .iter()
        .zip(skew_rad)
        .map(|(mount_deg, skew)| {
            let mount = mount_deg.to_radians();
            Wheel {
                x_m: body_radius_m * mount.cos(),
                y_m: body_radius_m * mount.sin(),
                drive_rad: mount - FRAC_PI_2 - skew,
                roller_rad: 0.0,
            }
        })
        .collect()
}

/// M/r, N × 3, of wheels that are fit to be ones.
fn inverse_of(wheels: &[Wheel], wheel_radius_m: f64) -> Result<InverseMatrix, GeometryError> {
    let invalid = |wheel, what: String| Err(GeometryError::Invalid { wheel, what });
    if !(wheel_radius_m.is_finite() && wheel_radius_m > 0.0) {
        return invalid(0, format!("radius {wheel_radius_m} m is not positive"));
    }
    for (i, w) in wheels.iter().enumerate() {
        if [w.x_m, w.y_m, w.drive_rad, w.roller_rad].iter().any(|v| !v.is_finite()) {
            return invalid(i + 1, "a number is not finite".to_owned());
        }
        if w.roller_rad.cos().abs() < 1e-6 {
            return invalid(i + 1, "rollers along the axle transmit no torque".to_owned());
        }
    }
    Ok(InverseMatrix::from_fn(wheels.len(), |i, j| {
        wheels[i].traction_row()[j] / (wheel_radius_m * wheels[i].roller_rad.cos())
    }))
}

/// Twists that wheels without rollers, all driving one way, allow: orthonormal columns; `None` for other wheels.
fn one_way(wheels: &[Wheel]) -> Option<DMatrix<f64>> {
    let n = wheels.len() as f64;
    // Wheels may be mounted to turn either way round.
    let [ax, ay] = wheels.first()?.traction();
    let sided = wheels.iter().map(|w| {
        let [x, y] = w.traction();
        if x * ax + y * ay < 0.0 { [-x, -y] } else { [x, y] }
    });
    let sum = sided.fold([0.0; 2], |s, a| [s[0] + a[0], s[1] + a[1]]);
    let length = sum[0].hypot(sum[1]);
    let (dx, dy) = (sum[0] / length, sum[1] / length);
    let (x, y) = (wheels.iter().map(|w| w.x_m).sum::<f64>() / n, wheels.iter().map(|w| w.y_m).sum::<f64>() / n);
    let across = |w: &Wheel| {
        let [ax, ay] = w.traction();
        w.roller_rad == 0.0 && (ax * dy - ay * dx).abs() < ONE_WAY
    };
    if !wheels.iter().all(across) {
        return None;
    }
    // Two wheels share one axle; of more, those in front and behind scrub about the middle.
    if let [a, b] = wheels {
        let (ex, ey) = (b.x_m - a.x_m, b.y_m - a.y_m);
        if (ex * dx + ey * dy).abs() > ONE_WAY * ex.hypot(ey) {
            return None;
        }
    }
    // Sideways is (dy, −dx): its speed at the middle is zero.
    let sideways = Vector3::new(dy, -dx, -(x * dx + y * dy));
    // Lengths count in units of the wheels' distance, so that the basis is well conditioned.
    let along = Vector3::new(dx, dy, 0.0).normalize();
    let turning = sideways.cross(&along).normalize();
    Some(DMatrix::from_fn(3, 2, |i, j| if j == 0 { along[i] } else { turning[i] }))
}

/// Direct kinematics among the twists that the wheels allow, least squares for more than two wheels.
fn differential(inverse: &InverseMatrix, allowed: &DMatrix<f64>) -> Result<DirectMatrix, GeometryError> {
    let rows: DMatrix<f64> = inverse * allowed;
    let normal = rows.transpose() * &rows;
    let (scale, determinant) = (normal[(0, 0)] * normal[(1, 1)], normal.determinant());
    // Wheels at one place cannot turn the robot.
    if determinant.is_nan() || determinant <= SINGULAR_RATIO.powi(2) * scale || scale <= 0.0 {
        let free = allowed.column(1);
        return Err(GeometryError::Singular { free: [free[0], free[1], free[2]] });
    }
    let inverted = normal.try_inverse().ok_or(GeometryError::Singular { free: [0.0; 3] })?;
    let direct = allowed * inverted * rows.transpose();
    Ok(DirectMatrix::from_fn(direct.ncols(), |i, j| direct[(i, j)]))
}

/// Pseudo-inverse, or the motion that nothing resists.
fn pseudo_inverse(inverse: &InverseMatrix, wheels: &[Wheel]) -> Result<DirectMatrix, GeometryError> {
    // Rotation counts at the rim, so that the rank does not depend on the unit of length.
    let rim = wheels.iter().map(|w| w.x_m.hypot(w.y_m)).fold(0.0, f64::max).max(1e-9);
    let mut scaled = inverse.clone();
    scaled.column_mut(2).scale_mut(1.0 / rim);
    let normal = scaled.transpose() * &scaled;
    let eigen = normal.symmetric_eigen();
    let (least, value) = eigen.eigenvalues.argmin();
    if value < SINGULAR_RATIO.powi(2) * eigen.eigenvalues.max() {
        let free = eigen.eigenvectors.column(least);
        return Err(GeometryError::Singular { free: [free[0], free[1], free[2] / rim] });
    }
    let singular = GeometryError::Singular { free: [0.0; 3] };
    let inverted = normal.try_inverse().ok_or(singular)?;
    let mut direct = inverted * scaled.transpose();
    direct.row_mut(2).scale_mut(1.0 / rim);
    Ok(direct)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_3, FRAC_PI_4};

    const R_WHEEL: f64 = 0.0275;
    const R_BODY: f64 = 0.085;

    #[test]
    fn zero_skew_gives_the_papers_equation_1() {
        let g = Geometry::rac(R_WHEEL, R_BODY, [0.0; 3]).unwrap();
        let (vx, vy, w) = (0.7, -0.3, 1.9);
        let h = 3.0_f64.sqrt() / 2.0;
        let v = [vx - w * R_BODY, -0.5 * vx + h * vy - w * R_BODY, -0.5 * vx - h * vy - w * R_BODY];
        for (speed, v) in g.wheel_speeds(Twist::new(vx, vy, w)).iter().zip(v) {
            assert!((speed - v / R_WHEEL).abs() < 1e-12);
        }
    }

    #[test]
    fn skew_gives_the_papers_equations_2_and_6_as_printed() {
        let [a1, a2, a3] = [0.1, -0.2, 0.15_f64];
        let g = Geometry::rac(R_WHEEL, R_BODY, [a1, a2, a3]).unwrap();
        let (beta, gamma) = (FRAC_PI_3 + a2, FRAC_PI_3 - a3);
        let printed = Matrix3::new(
            a1.cos(),
            -a1.sin(),
            -a1.cos() * R_BODY,
            -beta.cos(),
            beta.sin(),
            -a2.cos() * R_BODY,
            -gamma.cos(),
            -gamma.sin(),
            -a3.cos() * R_BODY,
        );
        for i in 0..3 {
            for j in 0..3 {
                assert!((g.inverse()[(i, j)] * R_WHEEL - printed[(i, j)]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn direct_inverts_inverse_for_three_and_four_wheels() {
        let four: Vec<Wheel> = [60.0_f64, 135.0, 225.0, 300.0]
            .iter()
            .map(|deg| {
                let m = deg.to_radians();
                let (y_m, x_m) = (R_BODY * m.sin(), R_BODY * m.cos());
                Wheel { x_m, y_m, drive_rad: m - FRAC_PI_2, roller_rad: 0.0 }
            })
            .collect();
        for g in [Geometry::rac(R_WHEEL, R_BODY, [0.07, -0.05, 0.03]).unwrap(), Geometry::new(four, R_WHEEL).unwrap()] {
            let product = g.direct() * g.inverse();
            assert!((product - Matrix3::identity()).amax() < 1e-12);
            let t = Twist::new(0.4, -1.1, 2.0);
            let back = g.twist(&g.wheel_speeds(t));
            assert!((back.vx - t.vx).abs() < 1e-12 && (back.omega - t.omega).abs() < 1e-12);
        }
    }

    #[test]
    fn least_squares_with_four_wheels_splits_a_contradiction() {
        let wheels: Vec<Wheel> = (0..4)
            .map(|k| {
                let m = f64::from(k) * FRAC_PI_2;
                let (y_m, x_m) = (R_BODY * m.sin(), R_BODY * m.cos());
                Wheel { x_m, y_m, drive_rad: m - FRAC_PI_2, roller_rad: 0.0 }
            })
            .collect();
        let g = Geometry::new(wheels, R_WHEEL).unwrap();
        // One wheel alone: a quarter of the rotation four would give.
        let t = g.twist(&[1.0, 0.0, 0.0, 0.0]);
        assert!((t.omega + R_WHEEL / R_BODY / 4.0).abs() < 1e-15);
    }

    #[test]
    fn mecanum_drives_forward_sideways_and_turns() {
        // Front left, front right, rear left, rear right; all drive forward; X pattern of rollers.
        let wheel =
            |x: f64, y: f64, sign: f64| Wheel { x_m: x, y_m: y, drive_rad: FRAC_PI_2, roller_rad: sign * FRAC_PI_4 };
        let (a, b, r) = (0.1, 0.15, 0.05);
        let g = Geometry::new(vec![wheel(-a, b, -1.0), wheel(a, b, 1.0), wheel(-a, -b, 1.0), wheel(a, -b, -1.0)], r)
            .unwrap();
        // Textbook: w = (vy ± vx ± (a+b)ω)/r.
        let expect = |t: Twist| {
            let k = (a + b) * t.omega;
            [t.vy + t.vx - k, t.vy - t.vx + k, t.vy - t.vx - k, t.vy + t.vx + k].map(|v| v / r)
        };
        for t in [Twist::new(0.0, 1.0, 0.0), Twist::new(1.0, 0.0, 0.0), Twist::new(0.3, 0.2, 1.0)] {
            for (w, e) in g.wheel_speeds(t).iter().zip(expect(t)) {
                assert!((w - e).abs() < 1e-12, "{t:?}: {w} instead of {e}");
            }
        }
    }

    fn wheel(x_m: f64, y_m: f64, drive_rad: f64) -> Wheel {
        Wheel { x_m, y_m, drive_rad, roller_rad: 0.0 }
    }

    #[test]
    fn two_wheels_on_one_axle_drive_and_turn_but_never_sideways() {
        let (half, r) = (0.1, 0.042);
        let g = Geometry::new(vec![wheel(half, 0.0, FRAC_PI_2), wheel(-half, 0.0, FRAC_PI_2)], r).unwrap();
        assert!(g.is_differential());
        // Textbook: v = r (wr + wl) / 2, omega = r (wr - wl) / (2 half).
        let t = g.twist(&[3.0, 1.0]);
        assert!(t.vx.abs() < 1e-15 && (t.vy - r * 2.0).abs() < 1e-15 && (t.omega - r / half).abs() < 1e-14, "{t:?}");
        let back = g.wheel_speeds(t);
        assert!((back[0] - 3.0).abs() < 1e-12 && (back[1] - 1.0).abs() < 1e-12);
        // Mounted the other way round, and the axle half a metre behind the body's origin: it swings sideways in turns.
        let g = Geometry::new(vec![wheel(half, -0.5, FRAC_PI_2), wheel(-half, -0.5, -FRAC_PI_2)], r).unwrap();
        let t = g.twist(&[1.0, 1.0]);
        assert!(t.vy.abs() < 1e-14 && (t.omega - r / half).abs() < 1e-14, "{t:?}");
        assert!((t.vx + 0.5 * t.omega).abs() < 1e-14, "the axle's middle stays: {t:?}");
        // Driving along x: sideways is y.
        let g = Geometry::new(vec![wheel(0.0, half, 0.0), wheel(0.0, -half, 0.0)], r).unwrap();
        let t = g.twist(&[1.0, 1.0]);
        assert!((t.vx - r).abs() < 1e-15 && t.vy.abs() < 1e-15 && t.omega.abs() < 1e-14);
        // Four wheels that drive one way skid about their middle.
        let four = [[half, 0.2], [-half, 0.2], [half, -0.2], [-half, -0.2]];
        let g = Geometry::new(four.map(|[x, y]| wheel(x, y, FRAC_PI_2)).to_vec(), r).unwrap();
        let t = g.twist(&[3.0, 1.0, 3.0, 1.0]);
        assert!(t.vx.abs() < 1e-14 && (t.vy - r * 2.0).abs() < 1e-14 && (t.omega - r / half).abs() < 1e-13, "{t:?}");
        assert!(!Geometry::rac(r, half, [0.0; 3]).unwrap().is_differential());
    }

    #[test]
    fn what_wheels_forbid_takes_its_share_of_a_push() {
        let g = Geometry::new(vec![wheel(0.1, 0.0, FRAC_PI_2), wheel(-0.1, 0.0, FRAC_PI_2)], 0.042).unwrap();
        let inertia = Matrix3::from_diagonal(&Vector3::new(2.0, 4.0, 0.5));
        let inverse = g.invert_allowed(&inertia).unwrap();
        assert!((inverse - Matrix3::from_diagonal(&Vector3::new(0.0, 0.25, 2.0))).amax() < 1e-12, "{inverse}");
        let free = Geometry::rac(0.02, 0.1, [0.0; 3]).unwrap().invert_allowed(&inertia).unwrap();
        assert!((free * inertia - Matrix3::identity()).amax() < 1e-12);
    }

    #[test]
    fn singular_and_senseless_geometry_is_an_error() {
        // All three wheels along their own radius: nothing resists rotation.
        match Geometry::rac(R_WHEEL, R_BODY, [FRAC_PI_2; 3]) {
            Err(GeometryError::Singular { free }) => {
                assert!(free[0].abs() < 1e-9 && free[1].abs() < 1e-9 && free[2].abs() > 1.0);
            }
            other => panic!("{other:?}"),
        }
        assert_eq!(Geometry::new(vec![], 0.1).unwrap_err(), GeometryError::TooFewWheels(0));
        let two = |a: Wheel, b: Wheel| Geometry::new(vec![a, b], 0.1);
        let one = wheel(-0.1, 0.0, FRAC_PI_2);
        assert_eq!(two(one, wheel(0.1, 0.0, 0.0)).unwrap_err(), GeometryError::NoAxle);
        assert_eq!(two(one, wheel(-0.1, 0.2, FRAC_PI_2)).unwrap_err(), GeometryError::NoAxle);
        assert!(matches!(two(one, one), Err(GeometryError::Singular { .. })));
        assert!(Geometry::rac(0.0, R_BODY, [0.0; 3]).is_err());
        assert!(Geometry::rac(R_WHEEL, f64::NAN, [0.0; 3]).is_err());
        let mut wheels = rac_wheels(R_BODY, [0.0; 3]);
        wheels[1].roller_rad = FRAC_PI_2;
        assert!(matches!(Geometry::new(wheels, R_WHEEL), Err(GeometryError::Invalid { wheel: 2, .. })));
    }
}
