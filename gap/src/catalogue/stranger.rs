//! Effects of a `robot.toml`, and parameters of them, that nothing reads: names written wrong.

use std::sync::Arc;

use model::effects::Applied;
use runs::error::{nearest, slip};
use runs::robot::{Effect as Written, Robot};

use super::EXACT;
use links::effect::Effect;
use links::effects::catalogue_for;

/// Runs of which a file may hold something of each.
const RUNS: usize = 2;

/// What nothing reads of an effect in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stranger {
    /// Index of the effect, from 0.
    pub effect: usize,
    /// Its parameter; `None` for the effect itself.
    pub parameter: Option<String>,
    /// Whether it may be an effect of the user's own.
    pub own: bool,
    /// What is wrong.
    pub what: String,
    /// What to do about it.
    pub hint: String,
}

/// A name without its numbers, of however many digits.
fn numbered(name: &str) -> String {
    name.chars().filter(|c| !c.is_ascii_digit()).collect()
}

/// Effects of a robot's file that neither the catalogue nor `own` effects have, and of the others the first parameter
/// that its effect does not have.
pub fn strangers(robot: &Robot, own: &[Arc<dyn Effect>]) -> Vec<Stranger> {
    let catalogue = catalogue_for(RUNS);
    let all: Vec<&dyn Effect> = catalogue.iter().map(AsRef::as_ref).chain(own.iter().map(AsRef::as_ref)).collect();
    let unsimulated = Applied::of(robot).unsupported;
    let unread = Applied::unread(robot);
    let of = |(effect, written): (usize, &Written)| {
        let name = &written.name;
        let found: Vec<&&dyn Effect> = all.iter().filter(|e| e.name() == name).collect();
        let exact = EXACT.iter().find(|(n, ..)| n == name);
        let simulated = !unsimulated.contains(name);
        if found.is_empty() && exact.is_none() && !simulated {
            let names: Vec<&str> =
                all.iter().filter(|e| !e.probe()).map(|e| e.name()).chain(EXACT.iter().map(|(n, ..)| *n)).collect();
            let meant = slip(name, &names);
            return Some(Stranger {
                effect,
                parameter: None,
                own: meant.is_none(),
                what: format!("{name} is no effect of the catalogue"),
                hint: meant.map_or_else(
                    || "`racbot gap --list` has the catalogue; one of your own comes with --effect FILE".to_owned(),
                    |near| format!("did you mean {near}?"),
                ),
            });
        }
        let forms: Vec<_> = found.iter().flat_map(|e| e.forms(robot)).collect();
        let mut names: Vec<String> = forms
            .iter()
            .flat_map(|form| form.free.iter().map(|p| &p.name).chain(form.fixed.iter().map(|(n, _)| n)))
            .cloned()
            .collect();
        names.extend(exact.iter().flat_map(|(_, _, names)| names.iter().map(|n| (*n).to_owned())));
        // Of a recording's own there is one a run, however many runs the file was fitted to.
        let of_runs = found.iter().any(|e| e.nuisance());
        let known = |parameter: &String| {
            names.contains(parameter)
                || of_runs && names.iter().any(|n| numbered(n) == numbered(parameter))
                || simulated && !unread.contains(&(name.clone(), parameter.clone()))
        };
        let (parameter, _) = written.parameters.iter().find(|(parameter, _)| !known(parameter))?;
        let listed: Vec<&str> = names.iter().map(String::as_str).collect();
        Some(Stranger {
            effect,
            parameter: Some(parameter.clone()),
            own: false,
            what: format!("{name} has no parameter {parameter}"),
            hint: nearest(parameter, &listed).map_or_else(
                || format!("`racbot gap --list {name}` has its parameters"),
                |near| format!("did you mean {near}?"),
            ),
        })
    };
    robot.effects.iter().enumerate().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use runs::robot::EffectParameter;

    use super::*;

    fn with(name: &str, parameter: &str) -> Robot {
        let value = EffectParameter { value: 0.01, ..EffectParameter::default() };
        let parameters = vec![(parameter.to_owned(), value)];
        Robot { effects: vec![Written { name: name.to_owned(), parameters, ..Written::default() }], ..Robot::racbot() }
    }

    #[test]
    fn names_written_wrong_are_strangers() {
        let cases = [
            ("viscous-frictoin", "coefficient_nms", "viscous-frictoin is no effect", "viscous-friction?"),
            ("viscous-friction", "coeficient_nms", "no parameter coeficient_nms", "coefficient_nms?"),
            ("viscous-friction", "coefficient_9_nms", "no parameter coefficient_9_nms", "did you mean coefficient"),
            ("viscous-friction", "torque", "no parameter torque", "racbot gap --list viscous-friction"),
            ("air-drag", "b", "air-drag is no effect", "--effect FILE"),
            ("pi-gain", "kd_scale", "no parameter kd_scale", "did you mean k"),
        ];
        for (name, parameter, what, hint) in cases {
            let found = &strangers(&with(name, parameter), &[])[0];
            assert_eq!(found.own, name == "air-drag");
            assert!(found.what.contains(what) && found.hint.contains(hint), "{found:?}");
        }
    }

    #[test]
    fn every_parameter_of_the_catalogue_is_known() {
        for d in super::super::descriptions() {
            for p in &d.parameters {
                let robot = with(&d.name, &p.name.replace("_i_", "_1_").replace("_i", "_1"));
                assert_eq!(strangers(&robot, &[]), [], "{} {}", d.name, p.name);
            }
        }
        assert_eq!(strangers(&with("camera-clock", "offset_21_s"), &[]), []);
        assert_eq!(strangers(&with("wheel-order", "cable_3"), &[]), []);
    }
}
