//! A robot's camera, frame by frame: what it sees, where that puts the robot, and why a frame is not used.
//!
//! ```text
//!  frame ─► usable? ─► detect ─► match around the prediction ─► sure? near the prediction? ─► pose
//!             no: Unusable                no: Refused, and the robot goes on by odometry
//!
//!  Refused again and again: the prediction is wrong ─► all lines of a turn on the spot ─► the pose instead
//! ```

mod search;

use crate::camera::Camera;
use crate::field::Field;
use crate::localise::{Estimate, Map, NoMatch, track};
use crate::picture::{Picture, Unusable};
use crate::{Scene, ball, detect};
use nalgebra::{Matrix3, Vector3};
use runs::frames::{Pose, wrap_angle};
use search::Search;

/// A match is believed where its standard deviations stay below these (m, rad): a robot's radius, and the turn that moves
/// what is 1 m ahead by as much.
const SURE: [f64; 2] = [0.08, 0.08];
/// Standard deviations that no prediction is better than (m, m, rad): what wheels lose between two frames of a robot that
/// slips, one of them missed.
const DRIFT: [f64; 3] = [0.02, 0.02, 0.02];
/// Squared distance of a match from its prediction, in standard deviations, beyond which one of the two is wrong: of
/// 10 000 right ones one is as far (chi-square, three degrees of freedom).
const FAR: f64 = 21.1;

/// Frames that contradict the prediction, less two for each that agrees, from which the prediction is taken for wrong, and
/// at most: half a second of a camera at 10 Hz, and as much agreement to have it back. One frame may see another robot.
const REFUTED: usize = 5;
const MOST_REFUTED: usize = 10;

/// Why a frame that could be used gives no pose.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Refused {
    /// The lines do not match the map.
    #[error(transparent)]
    Lines(#[from] NoMatch),
    /// The lines leave the place or the heading open.
    #[error("the lines tell the place to {:.0} mm and the heading to {:.1}°; {:.0} mm and {:.1}° are needed",
        1e3 * .0[0], .0[1].to_degrees(), 1e3 * SURE[0], SURE[1].to_degrees())]
    Unsure([f64; 2]),
    /// The match is not where the robot can be.
    #[error("the match is {0:.1} standard deviations from where the robot can be: wrong calibration, or lost")]
    Far(f64),
    /// A match, but the frames before it contradicted the prediction: near a line by chance.
    #[error("frame after frame contradicted where the robot is believed to be")]
    Doubted,
}

impl Refused {
    /// The reason without its figures, which differ from frame to frame.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Lines(NoMatch::TooFewPoints(_)) => "too few points on lines",
            Self::Lines(NoMatch::Contradiction(_)) => "most points on lines are not on the map",
            Self::Unsure(_) => "the lines leave place or heading open",
            Self::Doubted => "the robot is not where it is believed to be",
            Self::Far(_) => "the match of the lines is not where the robot can be: wrong calibration, or lost",
        }
    }
}

/// What a frame showed.
#[derive(Clone, Debug, PartialEq)]
pub struct Glance {
    /// All that was found.
    pub scene: Scene,
    /// The robot's pose by the lines, the prediction included.
    pub pose: Result<Estimate, Refused>,
    /// The pose by all lines that a robot saw while it looked round, where its prediction was wrong: in its place, and
    /// without it.
    pub instead: Option<Estimate>,
}

fn is_sure(found: &Estimate) -> bool {
    let [place, heading] = found.standard_deviations();
    place <= SURE[0] && heading <= SURE[1]
}

/// A camera on a robot on a field.
#[derive(Clone, Debug)]
pub struct OnBoard {
    camera: Camera,
    map: Map,
    before: Option<Picture>,
    contradictions: usize,
    search: Option<Search>,
}

impl OnBoard {
    /// A calibrated camera on a field.
    #[must_use]
    pub fn new(camera: Camera, field: Field) -> Self {
        Self { camera, map: Map::new(field), before: None, contradictions: 0, search: None }
    }

    /// How it looks at the world.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Where to stand for a look that should leave the place known to a standard deviation of `needed`, m, as
    /// [`Map::vantage`].
    #[must_use]
    pub fn vantage(&self, believed: &Estimate, needed: f64) -> Option<Pose> {
        self.map.vantage(&self.camera, believed, needed)
    }

    /// Looks at the next frame, taken where the robot is `predicted` to be.
    ///
    /// # Errors
    /// [`Unusable`] where the frame shows nothing: black, over-exposed, of one colour, frozen, or of another size than the
    /// camera was calibrated at.
    pub fn glance(&mut self, picture: &Picture, predicted: &Estimate) -> Result<Glance, Unusable> {
        self.camera.accepts(picture)?;
        picture.check()?;
        if self.before.as_ref() == Some(picture) {
            return Err(Unusable::Frozen);
        }
        self.before = Some(picture.clone());
        let mut scene = detect(picture, ball::DEFAULT_SCORE);
        scene.balls.retain(|ball| ball.fits(&self.camera, ball::RADIUS));
        let pose = self.pose(&scene, predicted);
        self.doubt(&pose);
        let instead = self.search.as_mut().and_then(|search| {
            search.see(&self.camera, &scene.lines, predicted.pose);
            search.place(&self.map).filter(is_sure)
        });
        if instead.is_some() {
            (self.contradictions, self.search) = (0, None);
        }
        if self.search.is_none() && self.refuted() {
            self.search = Some(Search::from(predicted.pose));
        }
        let pose = if self.refuted() { pose.and(Err(Refused::Doubted)) } else { pose };
        Ok(Glance { scene, pose, instead })
    }

    /// Whether frame after frame contradicts the predictions: the robot is not where it believes to be, or what it sees is
    /// not the field.
    #[must_use]
    pub fn refuted(&self) -> bool {
        self.search.is_some() || self.contradictions >= REFUTED
    }

    fn doubt(&mut self, pose: &Result<Estimate, Refused>) {
        match pose {
            Err(Refused::Far(_) | Refused::Lines(NoMatch::Contradiction(_))) => {
                self.contradictions = (self.contradictions + 1).min(MOST_REFUTED);
            }
            Ok(_) => self.contradictions = self.contradictions.saturating_sub(2),
            Err(_) => {}
        }
        if self.contradictions == 0 {
            self.search = None;
        }
    }

    fn pose(&self, scene: &Scene, predicted: &Estimate) -> Result<Estimate, Refused> {
        let found = track(&self.map, &self.camera, &scene.lines, predicted)?;
        if !is_sure(&found) {
            return Err(Refused::Unsure(found.standard_deviations()));
        }
        let (at, from) = (found.pose, predicted.pose);
        let off = Vector3::new(at.x - from.x, at.y - from.y, wrap_angle(at.theta - from.theta));
        // Only here: in the match it would add up from frame to frame along a line that is seen alone.
        let drift = Matrix3::from_diagonal(&Vector3::from(DRIFT.map(|sd| sd * sd)));
        let covariance = predicted.covariance + drift;
        let squared = covariance.try_inverse().map_or(f64::INFINITY, |inverse| off.dot(&(inverse * off)));
        if squared > FAR { Err(Refused::Far(squared.sqrt())) } else { Ok(found) }
    }
}
