//! Effects that do the same to what is logged, so that no fit can tell them apart.

/// Effect, those that can do what it does in a square, a star, a chirp and hard stops together, and those that can in a
/// square alone besides. Worked out by the test below from the links' own derivatives for the paper's robot.
#[rustfmt::skip]
const TWINS: &[(&str, &[&str], &[&str])] = &[
    ("actuation-latency", &[], &["wheel-creep"]),
    ("body-drag", &[], &["roller-friction"]),
    ("camera-filter", &[], &["camera-latency", "encoder-lag", "wheel-creep"]),
    ("camera-latency", &["encoder-lag"], &["camera-filter", "wheel-creep"]),
    ("camera-scale", &[], &["encoder-scale", "wheel-radius", "wheel-radius-common"]),
    ("carpet-grain", &[], &["coulomb-friction"]),
    ("coulomb-friction", &["heading-drag"], &[]),
    ("current-limit", &["battery-sag", "motor-heating", "winding-resistance"], &[]),
    ("drive-curve", &[], &["battery-sag"]),
    ("encoder-lag", &["camera-latency"], &["camera-filter", "wheel-creep"]),
    ("encoder-loss", &["encoder-scale", "wheel-radius"], &[]),
    ("encoder-scale", &["encoder-loss", "wheel-radius", "wheel-radius-common"], &["camera-scale"]),
    ("heading-drag", &[], &["coulomb-friction"]),
    ("marker-heading", &["wheel-angle", "wheel-skew"], &[]),
    ("motor-heating", &["battery-sag", "current-limit", "robot-mass", "torque-constant", "winding-resistance"], &["rotor-inertia"]),
    ("robot-mass", &["motor-heating", "torque-constant", "winding-resistance"], &["rotor-inertia"]),
    ("roller-friction", &[], &["body-drag"]),
    ("rotor-inertia", &[], &["motor-heating", "robot-mass", "winding-resistance"]),
    ("torque-constant", &["motor-heating", "robot-mass", "winding-resistance"], &[]),
    ("wheel-angle", &["wheel-skew"], &[]),
    ("wheel-creep", &[], &["actuation-latency", "camera-filter", "camera-latency", "encoder-lag"]),
    ("wheel-radius", &["encoder-loss", "encoder-scale"], &[]),
    ("wheel-radius-common", &["encoder-scale", "wheel-radius"], &["camera-scale"]),
    ("wheel-skew", &["wheel-angle"], &[]),
    ("winding-resistance", &["battery-sag", "current-limit", "motor-heating", "robot-mass", "torque-constant"], &["rotor-inertia"]),
];

/// What cannot be told from an effect: by drives of many kinds, and besides by one without turns.
pub(super) fn of(name: &str) -> [&'static [&'static str]; 2] {
    TWINS.iter().find(|(n, ..)| *n == name).map_or([&[], &[]], |(_, always, square)| [always, square])
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use model::effects::Applied;
    use model::manoeuvre::{Manoeuvre, simulate};
    use nalgebra::{DMatrix, DVector};
    use runs::Log;
    use runs::frames::Pose;
    use runs::robot::Robot;

    use super::*;
    use crate::problem::Problem;
    use crate::state::{Active, State};
    use crate::thresholds::Thresholds;
    use links::drive::DriveLink;
    use links::effect::{Effect, Link};
    use links::effects::catalogue;
    use links::motion::{MotionLink, WINDOW_S};
    use links::pieces::{PIECE, segments};

    /// Which effects can do what an effect does in these drives: by one of its forms and one of theirs.
    fn alike(drives: &[Manoeuvre]) -> BTreeMap<String, Vec<String>> {
        let robot = Robot::racbot();
        let applied = Applied::of(&robot);
        let start = Pose::new(0.4, -0.3, 0.5);
        let logs: Vec<Log> = drives
            .iter()
            .map(|m| Log::from(std::borrow::Cow::Owned(simulate(*m, &applied, &robot, start, 1).unwrap())))
            .collect();
        let pieces = segments(&robot, &robot.geometry().unwrap(), &logs, PIECE);
        let state = State { robot: robot.clone(), active: Vec::new() };
        let effects: Vec<Arc<dyn Effect>> = catalogue().into_iter().map(Arc::from).collect();
        let mut found = BTreeMap::new();
        for link in [Link::Motion, Link::Drive] {
            let (motion, mut drive);
            let problem = if link == Link::Motion {
                motion = MotionLink::new(&pieces, [1.5e-3, 1.5e-3, 8.7e-3], WINDOW_S);
                Problem::Motion(&motion)
            } else {
                drive = DriveLink::new(&pieces, &state.drive(None)).unwrap();
                // All wheels alike: the size does not matter here.
                drive.noise = vec![1e-3; robot.wheel_count()];
                Problem::Drive(&drive)
            };
            let candidates: Vec<Active> =
                problem.candidates(&state, &effects).into_iter().filter(|c| !c.effect.probe()).collect();
            let linear = problem.linearise(&state, &candidates);
            let jj = linear.equations.information();
            let columns: Vec<Vec<usize>> = (0..candidates.len()).map(|c| linear.of_candidate(c)).collect();
            for (a, own) in columns.iter().enumerate() {
                for (b, theirs) in columns.iter().enumerate() {
                    let [name, other] = [a, b].map(|c| candidates[c].effect.name().to_owned());
                    let theirs: Vec<usize> = theirs.iter().copied().filter(|i| jj[(*i, *i)] > 0.0).collect();
                    if name == other || theirs.is_empty() || own.iter().any(|i| jj[(*i, *i)] <= 1e-9) {
                        continue;
                    }
                    let information = DMatrix::from_fn(theirs.len(), theirs.len(), |i, j| jj[(theirs[i], theirs[j])]);
                    let done = |column: &usize| {
                        let mixed = DVector::from_fn(theirs.len(), |i, _| jj[(theirs[i], *column)]);
                        mixed.dot(&estimation::normal_equations::solve(&information, &mixed)) / jj[(*column, *column)]
                    };
                    let names: &mut Vec<String> = found.entry(name).or_default();
                    if own.iter().all(|column| done(column) > Thresholds::default().alike) && !names.contains(&other) {
                        names.push(other);
                    }
                }
            }
        }
        found.values_mut().for_each(|names| names.sort());
        found
    }

    #[test]
    fn the_table_of_twins_is_what_the_links_derivatives_say() {
        let all = alike(&[Manoeuvre::Square, Manoeuvre::Star, Manoeuvre::Chirp, Manoeuvre::StopAndGo]);
        let square = alike(&[Manoeuvre::Square]);
        let mut lines = Vec::new();
        for (name, always) in &all {
            let besides: Vec<&String> = square[name].iter().filter(|other| !always.contains(other)).collect();
            if !always.is_empty() || !besides.is_empty() {
                lines.push(format!("    ({name:?}, &{always:?}, &{besides:?}),"));
            }
        }
        let kept: Vec<String> = TWINS.iter().map(|(n, a, s)| format!("    ({n:?}, &{a:?}, &{s:?}),")).collect();
        assert!(kept == lines, "the table is\n{}", lines.join("\n"));
    }
}
