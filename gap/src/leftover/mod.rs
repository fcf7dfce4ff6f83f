//! Structure in what is left of the drive link, whatever its cause: lines of a spectrum, bursts, and
//! stretches of time. Effects of the catalogue are fitted before; what shows here is none of them.
//!
//! Every search is held against the data's own, coloured scatter, pays for the number of places it
//! looked at, and asks for a size that matters beside what the motors gave. The camera has two checks of
//! its own, which need no fit.

mod bursts;
mod camera;
mod orders;
mod rattle;
mod spectrum;

use std::collections::HashSet;

use crate::thresholds::Thresholds;
use links::drive::{DriveLink, DriveModel, Generic, Left};
use links::effect::Sizes;
use links::pieces::Pieces;
use runs::robot::{Robot, Support};

pub(crate) use camera::{frozen, torn};
pub(crate) use orders::Ripple;
pub(crate) use rattle::rattle;

/// Length of the test functions the torques are averaged over, s: a tenth of a second is over before the
/// loop has answered, and lines up to 15 Hz pass.
const TEST_FUNCTION_S: f64 = 0.05;
/// Torques this near a masked test function are left out, s.
const MASK_S: f64 = 0.06;

/// Something that no smooth law of the catalogue leaves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Structure {
    /// In words.
    pub text: String,
    /// Share of the squared torque left that it makes up.
    pub share: f64,
}

/// What is left of the drive.
pub(crate) struct Leftover {
    /// Structure outside the catalogue.
    pub structures: Vec<Structure>,
    /// A rolling radius that varies with the wheel's angle, by order analysis.
    pub ripple: Option<Ripple>,
}

/// Looks through what a model of the drive leaves.
///
/// `mask` holds segment and tick of what slips; `rolls` says of a run and a time whether the camera saw
/// the robot roll as its wheels turned.
pub(crate) fn drive(
    pieces: &Pieces,
    model: &DriveModel,
    mask: &[(usize, usize)],
    rolls: &dyn Fn(usize, f64) -> bool,
    sizes: Sizes,
    thresholds: &Thresholds,
) -> Leftover {
    let mut out = Leftover { structures: Vec::new(), ripple: None };
    let Some(link) = DriveLink::with_test_functions(pieces, model, TEST_FUNCTION_S) else { return out };
    let Some(residuals) = link.residuals(model) else { return out };
    let generic = Generic::new(&link);
    let near = link.tick_count(MASK_S).max(1);
    let slips: HashSet<(usize, usize)> = mask.iter().map(|m| (m.0, m.1 / near)).collect();
    let mut lefts: Vec<Option<Left>> = Vec::new();
    for wheel in 0..link.noise.len() {
        let left = generic.leaves(&link, &residuals, wheel).map(|l| {
            // What is masked as slip on the link itself is masked here.
            let rolls = |b: &usize| {
                let (segment, tick) = residuals.at[*b];
                let part = tick / near;
                (part.saturating_sub(1)..=part + 1).all(|p| !slips.contains(&(segment, p)))
            };
            let (test_functions, torque) =
                l.test_functions.iter().zip(&l.torque).filter(|(b, _)| rolls(b)).map(|(b, t)| (*b, *t)).unzip();
            Left { test_functions, torque, scatter: l.scatter }
        });
        lefts.push(left);
    }
    let series = Series::new(&link, model, &residuals.at, &lefts);
    out.structures.extend(spectrum::lines(&series, sizes.drive_nm, thresholds));
    out.structures.extend(bursts::bursts(&series, rolls, sizes.drive_nm, thresholds));
    out.structures.extend(bursts::stretches(&series, sizes.drive_nm, thresholds));
    let slips = |segment: usize, ticks: std::ops::Range<usize>| {
        let s = pieces.get(segment);
        let seen = [ticks.start, (ticks.start + ticks.end) / 2, ticks.end].map(|k| s.t[k.min(s.t.len() - 1)]);
        !seen.into_iter().all(|t| rolls(s.run, t))
            || (ticks.start / near..=ticks.end / near).any(|part| slips.contains(&(segment, part)))
    };
    let rollers = has_rollers(pieces.robot());
    let (ripple, structures) = orders::orders(&link, model, rollers, &slips, sizes.drive_nm, thresholds);
    out.ripple = ripple;
    out.structures.extend(structures);
    out
}

/// Whether the wheels of a machine have rollers: it stands on the floor, and can move sideways only on them.
pub(crate) fn has_rollers(robot: &Robot) -> bool {
    robot.support == Support::Floor && robot.wheel_count() > 2
}

/// One wheel's torque left, at the times of its test functions.
struct Wheel {
    /// Index of the log that holds each test function.
    run: Vec<usize>,
    /// Index of the segment that holds each.
    segment: Vec<usize>,
    /// Middle of each, s.
    t: Vec<f64>,
    /// Torque that nothing explains, Nm.
    torque: Vec<f64>,
    /// Direction of rotation.
    sign: Vec<f64>,
    /// Torque that the measured acceleration takes, Nm: what the drive did at all.
    done: Vec<f64>,
    /// Whether rows are missing within each.
    lacks_rows: Vec<bool>,
    /// Robust standard deviation, Nm.
    scatter: f64,
}

/// Rows, in those around, from which on a step of time lacks one.
const MISSING: f64 = 1.5;

/// Whether rows are missing within `half` s of tick `k`.
fn lacks_rows(t: &[f64], k: usize, half: f64) -> bool {
    let (first, last) = (t.partition_point(|x| *x < t[k] - half), t.partition_point(|x| *x <= t[k] + half));
    let steps: Vec<f64> = t[first.saturating_sub(1)..(last + 1).min(t.len())].windows(2).map(|t| t[1] - t[0]).collect();
    let usual = estimation::statistics::median(&mut steps.clone());
    steps.iter().any(|step| *step > MISSING * usual)
}

/// Torques left of the wheels that have enough test functions to say.
struct Series {
    wheels: Vec<Wheel>,
    /// Distance of two test functions, s.
    hop: f64,
    /// What a wheel turns as, kg m².
    inertia: f64,
    /// One count of an encoder at the wheel, rad.
    count_rad: f64,
}

impl Series {
    fn new(link: &DriveLink, model: &DriveModel, at: &[(usize, usize)], lefts: &[Option<Left>]) -> Self {
        let done = link.done(model);
        let places = link.at_middles(|s, k| {
            let signs = s.sign.iter().map(|sign| sign[k]).collect::<Vec<_>>();
            (s.run, s.t[k], signs, lacks_rows(&s.t, k, 0.5 * link.length()))
        });
        let wheels = lefts
            .iter()
            .enumerate()
            .filter_map(|(i, left)| {
                let left = left.as_ref()?;
                let mut sizes: Vec<f64> = left.torque.iter().map(|x| x.abs()).collect();
                Some(Wheel {
                    run: left.test_functions.iter().map(|b| places[*b].0).collect(),
                    segment: left.test_functions.iter().map(|b| at[*b].0).collect(),
                    t: left.test_functions.iter().map(|b| places[*b].1).collect(),
                    sign: left.test_functions.iter().map(|b| places[*b].2[i]).collect(),
                    lacks_rows: left.test_functions.iter().map(|b| places[*b].3).collect(),
                    done: left.test_functions.iter().map(|b| done[*b][i]).collect(),
                    scatter: 1.4826 * estimation::statistics::median(&mut sizes),
                    torque: left.torque.clone(),
                })
            })
            .collect::<Vec<_>>();
        let (inertia, count_rad) = (model.felt_inertia(), link.sizes.count_rad);
        Self { hop: 0.5 * link.length(), inertia, count_rad, wheels }
    }
}
