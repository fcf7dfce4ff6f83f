//! The margins that unnamed effects have about zero, and what they must not swallow.

use std::sync::Arc;

use super::common::{RICH, cut_all, names, simulate, with};
use estimation::prior::{Penalised, Role};
use gap::problem::{Owner, Problem};
use gap::select::{Design, candidates};
use gap::state::{Active, State};
use gap::thresholds::Thresholds;
use gap::{Options, analyse};
use links::effect::{Effect, Link};
use links::motion::MotionLink;
use links::pieces::{PIECE, segments};
use runs::robot::Robot;
use runs::{DataSet, Logs};

fn short(truth: &Robot, seed: u64) -> DataSet {
    let mut set = simulate(truth, &RICH, seed);
    cut_all(&mut set, 6.0);
    set
}

/// Asks a design of wheels and camera in which counts may be lost, and nothing else.
fn of_lost_counts(set: &DataSet, ask: impl FnOnce(&Design, &[Active], &Thresholds)) {
    let state = State { robot: set.robot.clone(), active: Vec::new() };
    let logs = Logs::from(set);
    let pieces = segments(&set.robot, &set.robot.geometry().unwrap(), &logs.logs, PIECE);
    let link = MotionLink::new(&pieces, [1.5e-3, 1.5e-3, 9e-3], 1.0);
    let catalogue: Vec<Arc<dyn Effect>> = vec![links::effects::find("encoder-loss").unwrap().into()];
    let all = candidates(&state, &catalogue, Link::Motion);
    let thresholds = Thresholds::default();
    let design = Design::new(&Problem::Motion(&link), &state, &all, &thresholds);
    ask(&design, &all, &thresholds);
}

/// Margins so wide that adjustments could close a gap of centimetres without any of them being named.
#[test]
fn a_gap_that_matters_as_a_whole_gets_a_name() {
    let thresholds = Thresholds { held_share: 6.0, ..Thresholds::default() };
    let options = Options { thresholds, ..Options::default() };
    let a = analyse(&short(&with(&Robot::racbot(), "wheel-radius-common", &[("scale", 0.06)]), 71), &options).unwrap();
    let twins = a.alternatives.concat();
    let told = names(&a) == ["wheel-radius-common"] || twins.iter().any(|n| n == "wheel-radius-common");
    assert!(names(&a).len() == 1 && told, "{}", a.terminal_summary());
}

/// Wheels that are smaller than the file says seem to lose less than no counts: adjusted by that without a name, little would
/// be left of them.
#[test]
fn no_margin_goes_far_beyond_what_is_physical() {
    let set = short(&with(&Robot::racbot(), "wheel-radius-common", &[("scale", -0.15)]), 73);
    of_lost_counts(&set, |design, all, thresholds| {
        let roles = design.roles();
        let steps = [
            Penalised::new(&design.linear.equations, design.variance).fit(&roles),
            design.fit_roles(&roles),
            design.fit(&[]),
        ]
        .map(|fit| fit.step);
        // Standard deviations below the least that may be, of the margin that goes farthest.
        let farthest = steps.map(|step| {
            let below =
                roles.iter().zip(&design.linear.owners).zip(&step).map(|((role, owner), x)| match (role, owner) {
                    (Role::Held(sd, _), Owner::Candidate(c, j)) => (all[*c].form.free[*j].bounds[0] - x) / sd,
                    _ => f64::NEG_INFINITY,
                });
            below.fold(f64::NEG_INFINITY, f64::max)
        });
        let [unlimited, held, nothing_freed] = farthest;
        assert!(unlimited > 1.1 * thresholds.held_beyond, "{unlimited}");
        for limited in [held, nothing_freed] {
            assert!((limited - thresholds.held_beyond).abs() < 1e-6, "{limited}");
        }
    });
}

/// Counts may be lost from any of many speeds on, but the loss is one: its margin is not theirs added up.
#[test]
fn one_effect_at_many_thresholds_has_one_margin() {
    of_lost_counts(&short(&Robot::racbot(), 72), |design, all, thresholds| {
        let jj = design.linear.equations.information();
        let own = |c: &usize| match design.linear.owners[*c] {
            Owner::Candidate(k, 0) => all[k].form.wheels == [0] && jj[(*c, *c)] > 0.0,
            _ => false,
        };
        let columns: Vec<usize> = (0..design.linear.owners.len()).filter(own).collect();
        // What all thresholds together may do in place of the loss at the third of them, as a variance.
        let of = columns[2];
        let roles = design.roles();
        let together: f64 = columns
            .iter()
            .map(|c| match roles[*c] {
                Role::Held(sd, _) => (sd * jj[(*c, of)] / jj[(of, of)]).powi(2),
                _ => 0.0,
            })
            .sum();
        let alone = thresholds.held_share * 0.02;
        let like = columns.iter().filter(|c| jj[(**c, of)].powi(2) > 0.5 * jj[(**c, **c)] * jj[(of, of)]).count();
        assert!(like >= 4, "{like} of {} look like it", columns.len());
        assert!(together.sqrt() < 1.2 * alone, "{} instead of {alone}", together.sqrt());
    });
}
