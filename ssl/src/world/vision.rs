//! What the camera sees of it.

use super::World;
use crate::ball::Ball;
use crate::field::{on_floor, pixels};
use crate::front::Team;
use model::camera::{Camera, CameraModel};
use runs::frames::Pose;
use runs::vision::{DetectionBall, DetectionFrame, DetectionRobot, Source, WrapperPacket};

/// The field keeps the time of the frames; a camera sees whenever it is asked.
const EVERY_HZ: f64 = 1e9;
/// Area of a ball in the image, pixels.
const AREA: u32 = 60;

impl World {
    pub(super) fn frame_due(&self) -> bool {
        self.vision_hz > 0.0 && self.time.as_secs_f64() >= self.frames as f64 / self.vision_hz - 1e-9
    }

    /// The frame that is due now. Geometry is in every frame of a whole second.
    pub(super) fn see(&mut self) -> WrapperPacket {
        let each = self.vision_hz.round().max(1.0) as u64;
        let geometry = self.frames.is_multiple_of(each).then(|| self.field.geometry());
        self.frames += 1;
        let now = self.time.as_secs_f64();
        let latency = self.newcomer.believed.camera_latency_s;
        let sent = self.epoch_s + now;
        let detection = DetectionFrame {
            frame_number: self.frames as u32,
            t_capture: sent - latency,
            t_sent: sent,
            camera_id: 0,
            balls: self.see_ball(now).into_iter().collect(),
            robots_yellow: self.see_team(Team::Yellow, now),
            robots_blue: self.see_team(Team::Blue, now),
            t_capture_camera: None,
        };
        WrapperPacket { detection: Some(detection), geometry, source: Some(Source::Other.into()) }
    }

    fn see_team(&mut self, team: Team, now: f64) -> Vec<DetectionRobot> {
        let mut seen = Vec::new();
        for ((_, id), robot) in self.robots.iter().filter(|((of, _), _)| *of == team) {
            let seed = self.seed;
            let camera = self.cameras.entry(Some((team, *id))).or_insert_with(|| {
                let model = CameraModel { rate_hz: EVERY_HZ, ..robot.camera() };
                Camera::new(model, seed ^ (u64::from(*id) << 8 | team as u64 + 1))
            });
            let Some(pose) = camera.observe(now, robot.pose()) else { continue };
            let [pixel_x, pixel_y] = pixels([pose.x, pose.y]);
            seen.push(DetectionRobot {
                confidence: 1.0,
                robot_id: Some(*id),
                x: (1e3 * pose.x) as f32,
                y: (1e3 * pose.y) as f32,
                orientation: Some(pose.league_theta() as f32),
                pixel_x,
                pixel_y,
                height: Some((1e3 * robot.kind().hull.height) as f32),
            });
        }
        seen
    }

    fn see_ball(&mut self, now: f64) -> Option<DetectionBall> {
        let model = CameraModel { rate_hz: EVERY_HZ, ..CameraModel::of(&self.newcomer.believed) };
        let camera = self.cameras.entry(None).or_insert_with(|| Camera::new(model, self.seed));
        let [x, y, z] = self.ball.position;
        let [x, y] = on_floor([x, y, z + if z > 0.0 { Ball::RADIUS } else { 0.0 }]);
        let seen = camera.observe(now, Pose::new(x, y, 0.0))?;
        let [pixel_x, pixel_y] = pixels([seen.x, seen.y]);
        Some(DetectionBall {
            confidence: 1.0,
            area: Some(AREA),
            x: (1e3 * seen.x) as f32,
            y: (1e3 * seen.y) as f32,
            z: None,
            pixel_x,
            pixel_y,
        })
    }
}
