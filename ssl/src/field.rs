//! The field and what the geometry message says of it.

use crate::ball::Ball;
use runs::vision::{
    BallModels, CameraCalibration, ChipFixedLoss, CircularArc, FieldSize, GeometryData, LineSegment, Point, Shape,
    StraightTwoPhase,
};

/// Height of the camera over the middle of the field, m, its focal length, pixels, and its image, pixels: a ceiling camera
/// that sees a field of 12 m by 9 m and its border.
const CAMERA_M: f64 = 6.0;
const FOCAL: f64 = 700.0;
const IMAGE: [u32; 2] = [1640, 1240];
/// Longest and shortest field that is taken from a message, mm.
const SIZES: [i32; 2] = [1_000, 100_000];

/// Sizes, mm, as in the geometry message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Between the goal lines.
    pub length: i32,
    /// Between the touch lines.
    pub width: i32,
    /// Between the posts.
    pub goal_width: i32,
    /// Behind the goal line.
    pub goal_depth: i32,
    /// Between a line and the boards.
    pub border: i32,
    /// Of a penalty area, from the goal line.
    pub penalty_depth: i32,
    /// Of a penalty area, along it.
    pub penalty_width: i32,
}

impl Field {
    /// The field of division A, 12 m by 9 m.
    pub const A: Self = Self {
        length: 12_000,
        width: 9_000,
        goal_width: 1_800,
        goal_depth: 180,
        border: 300,
        penalty_depth: 1_800,
        penalty_width: 3_600,
    };
    /// The field of division B, 9 m by 6 m.
    pub const B: Self = Self {
        length: 9_000,
        width: 6_000,
        goal_width: 1_000,
        goal_depth: 180,
        border: 300,
        penalty_depth: 1_000,
        penalty_width: 2_000,
    };

    /// Takes the sizes of a message, where it has sizes of a field.
    ///
    /// # Errors
    /// Which size cannot be.
    pub fn of(size: &FieldSize) -> Result<Self, String> {
        for (name, value) in [("field_length", size.field_length), ("field_width", size.field_width)] {
            if !(SIZES[0]..=SIZES[1]).contains(&value) {
                return Err(format!("{name}: {value} mm is not between {} and {} mm", SIZES[0], SIZES[1]));
            }
        }
        for (name, value) in
            [("goal_width", size.goal_width), ("goal_depth", size.goal_depth), ("boundary_width", size.boundary_width)]
        {
            if !(0..=size.field_width).contains(&value) {
                return Err(format!("{name}: {value} mm is not between 0 and field_width"));
            }
        }
        Ok(Self {
            length: size.field_length,
            width: size.field_width,
            goal_width: size.goal_width,
            goal_depth: size.goal_depth,
            border: size.boundary_width,
            penalty_depth: size.penalty_area_depth.unwrap_or(size.goal_width).clamp(0, size.field_length / 2),
            penalty_width: size.penalty_area_width.unwrap_or(2 * size.goal_width).clamp(0, size.field_width),
        })
    }

    /// Half the length and the width between the boards, m.
    #[must_use]
    pub fn half(&self) -> [f64; 2] {
        [self.length, self.width].map(|size| 0.5e-3 * f64::from(size) + 1e-3 * f64::from(self.border))
    }

    /// The message: sizes, lines, the camera, the ball.
    #[must_use]
    pub fn geometry(&self) -> GeometryData {
        let (x, y) = (0.5 * self.length as f32, 0.5 * self.width as f32);
        let (depth, half) = (x - self.penalty_depth as f32, 0.5 * self.penalty_width as f32);
        let line = |name: &str, shape: Shape, [x1, y1, x2, y2]: [f32; 4]| LineSegment {
            name: name.to_owned(),
            p1: Point { x: x1, y: y1 },
            p2: Point { x: x2, y: y2 },
            thickness: 10.0,
            r#type: Some(shape.into()),
        };
        GeometryData {
            field: FieldSize {
                field_length: self.length,
                field_width: self.width,
                goal_width: self.goal_width,
                goal_depth: self.goal_depth,
                boundary_width: self.border,
                field_lines: vec![
                    line("TopTouchLine", Shape::TopTouchLine, [-x, y, x, y]),
                    line("BottomTouchLine", Shape::BottomTouchLine, [-x, -y, x, -y]),
                    line("LeftGoalLine", Shape::LeftGoalLine, [-x, -y, -x, y]),
                    line("RightGoalLine", Shape::RightGoalLine, [x, -y, x, y]),
                    line("HalfwayLine", Shape::HalfwayLine, [0.0, -y, 0.0, y]),
                    line("CenterLine", Shape::CenterLine, [-x, 0.0, x, 0.0]),
                    line("LeftPenaltyStretch", Shape::LeftPenaltyStretch, [-depth, -half, -depth, half]),
                    line("RightPenaltyStretch", Shape::RightPenaltyStretch, [depth, -half, depth, half]),
                    line("LeftFieldLeftPenaltyStretch", Shape::LeftFieldLeftPenaltyStretch, [-x, -half, -depth, -half]),
                    line("LeftFieldRightPenaltyStretch", Shape::LeftFieldRightPenaltyStretch, [-x, half, -depth, half]),
                    line(
                        "RightFieldRightPenaltyStretch",
                        Shape::RightFieldRightPenaltyStretch,
                        [x, -half, depth, -half],
                    ),
                    line("RightFieldLeftPenaltyStretch", Shape::RightFieldLeftPenaltyStretch, [x, half, depth, half]),
                ],
                field_arcs: vec![CircularArc {
                    name: "CenterCircle".to_owned(),
                    center: Point::default(),
                    radius: 500.0,
                    a1: 0.0,
                    a2: std::f32::consts::TAU,
                    thickness: 10.0,
                    r#type: Some(Shape::CenterCircle.into()),
                }],
                penalty_area_depth: Some(self.penalty_depth),
                penalty_area_width: Some(self.penalty_width),
            },
            calib: vec![calibration()],
            ball_models: Some(BallModels {
                straight_two_phase: Some(StraightTwoPhase {
                    acc_slide: -Ball::SLIDING,
                    acc_roll: -Ball::ROLLING,
                    k_switch: Ball::SWITCH,
                }),
                chip_fixed_loss: Some(ChipFixedLoss {
                    damping_xy_first_hop: Ball::HOP[0],
                    damping_xy_other_hops: Ball::HOP[1],
                    damping_z: Ball::HOP[2],
                }),
            }),
        }
    }
}

/// The camera, which looks straight down: half a turn about the field's x axis, so that z in its frame is depth.
fn calibration() -> CameraCalibration {
    let height = (1e3 * CAMERA_M) as f32;
    CameraCalibration {
        camera_id: 0,
        focal_length: FOCAL as f32,
        principal_point_x: 0.5 * IMAGE[0] as f32,
        principal_point_y: 0.5 * IMAGE[1] as f32,
        q0: 1.0,
        tz: height,
        derived_camera_world_tx: Some(0.0),
        derived_camera_world_ty: Some(0.0),
        derived_camera_world_tz: Some(height),
        pixel_image_width: Some(IMAGE[0]),
        pixel_image_height: Some(IMAGE[1]),
        ..CameraCalibration::default()
    }
}

/// Where a point at a height seems to lie on the floor, m, as the camera sees it.
#[must_use]
pub(crate) fn on_floor([x, y, height]: [f64; 3]) -> [f64; 2] {
    let share = CAMERA_M / (CAMERA_M - height.min(0.9 * CAMERA_M));
    [share * x, share * y]
}

/// Pixels of a point on the floor, m.
#[must_use]
pub(crate) fn pixels([x, y]: [f64; 2]) -> [f32; 2] {
    let at = |half: f64, v: f64| (half + FOCAL / CAMERA_M * v) as f32;
    [at(0.5 * f64::from(IMAGE[0]), x), at(0.5 * f64::from(IMAGE[1]), -y)]
}
