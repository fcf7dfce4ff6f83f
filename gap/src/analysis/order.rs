//! `wheel-order` as the camera sees it: cables of wheels crossed or inverted.

use std::sync::Arc;

use super::found::Named;
use crate::controller::ENCODER_SCALE;
use crate::evidence::{Evidence, Interval};
use crate::problem::Problem;
use crate::state::{Active, State};
use links::effect::{Effect, Link, Values};
use links::motion::MotionLink;

/// Cables on the motion link, set points on the command link.
pub(super) const ORDER: &str = "wheel-order";

/// Effects that one link shows a side of and another link the other, each by parameters of its own.
pub(super) const TWO_SIDED: [&str; 2] = [ORDER, ENCODER_SCALE];

/// Whether an effect says where the cables of the wheels are.
pub(super) fn cabled(active: &Active) -> bool {
    active.effect.name() == ORDER && active.values.find("cable_1").is_some()
}

/// Wheels that drive and count for each other: tried only where the motion is grossly wrong.
pub(super) fn wheel_order(link: &MotionLink, start: &State, catalogue: &[Arc<dyn Effect>]) -> Option<(Active, f64)> {
    let effect = catalogue.iter().find(|e| e.name() == ORDER)?;
    if link.is_empty() || start.active.iter().any(cabled) || !links::effects::fits(ORDER, &start.robot) {
        return None;
    }
    let problem = Problem::Motion(link);
    let plain = |s: &State| problem.linearise_nothing(s).plain();
    let (before, n) = plain(start);
    if before < 30.0 * n {
        return None;
    }
    let wheels = start.robot.wheel_count();
    let tried = crate::command::orders(wheels).into_iter().map(|order| {
        let values = Values(
            order.iter().enumerate().map(|(i, (w, s))| (format!("cable_{}", i + 1), s * (*w as f64 + 1.0))).collect(),
        );
        let form = links::effect::Form {
            wheels: (0..wheels).filter(|i| order[*i] != (*i, 1.0)).collect(),
            free: Vec::new(),
            fixed: values.0.clone(),
        };
        let active = Active {
            effect: effect.clone(),
            form,
            values,
            immaterial: false,
            link: Link::Motion,
            given: true,
            together: false,
        };
        let mut state = start.clone();
        state.active.push(active.clone());
        (plain(&state).0, active)
    });
    let (after, active) = tried.filter(|(l, _)| l.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0))?;
    (after < 0.1 * before && !active.form.wheels.is_empty()).then_some((active, 1.0 - after / before))
}

pub(super) fn order_named(active: &Active, gain: f64) -> Named {
    let what = format!(
        "of all orders and signs of the wheels, this one leaves {:.1} % of the squared residual",
        100.0 * (1.0 - gain)
    );
    let evidence = Evidence::Pattern { what, p: None };
    Named {
        name: ORDER.to_owned(),
        equation: active.effect.equation().to_owned(),
        link: Link::Motion,
        wheels: active.form.wheels.iter().map(|w| w + 1).collect(),
        parameters: active.values.0.iter().map(|(n, v)| (n.clone(), *v, Interval::Exact)).collect(),
        gain,
        evidence,
        conditional_on: Vec::new(),
    }
}
