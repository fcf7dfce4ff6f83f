//! `motor-heating`: windings whose resistance grows as they warm up, or that are warm from the start.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values};

/// Windings whose resistance grows as they warm up, or that are warm from the start.
pub(super) struct MotorHeating;

/// Rise that matters: 5 % less torque, as a winding warmer by 10 K, after some seconds at a duty of 0.45. From 0.3 on 0.34
/// was named on one of 60 simulated robots whose motors stayed cold, for one fast run of three.
const RISE: f64 = 0.5;
/// Time constants of a winding and of a housing, s.
const TIMES_S: [f64; 2] = [8.0, 60.0];

impl Effect for MotorHeating {
    fn name(&self) -> &str {
        "motor-heating"
    }

    fn equation(&self) -> &str {
        "resistance times (1 + rise e_i), e_i the loss u_i^2 through a first-order lag of time_s; or, start_k above the \
         data sheet's temperature all the time, resistance times (1 + 0.0039 start_k), torque and back-EMF constant \
         times (1 - 0.0011 start_k)"
    }

    fn reference(&self) -> &str {
        "motor data sheet; copper 0.39 %/K, NdFeB magnets -0.11 %/K"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn before_current(&self) -> bool {
        true
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, _robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        // What warms up slowly hardly does in a short run: material is what weakens a motor there as much. Beside a skew
        // and a latency, whose laws are not exact, 0.39 and 1.43 with 60 s were named in runs of some seconds of robots
        // whose motors stayed cold (blind bench).
        let warm = |time: f64| 1.0 - (-sizes.run_s / time).exp();
        let material = |time: f64| RISE * warm(TIMES_S[0]) / warm(time).max(f64::MIN_POSITIVE);
        let mut forms: Vec<Form> = TIMES_S
            .into_iter()
            .map(|t| Form::whole(vec![Parameter::new("rise", 0.1, [0.0, 5.0], material(t))]).fixing("time_s", t))
            .collect();
        // Material is what weakens a stalled motor as much as a material torque constant; beyond 130 K windings char.
        forms.push(Form::whole(vec![Parameter::new("start_k", 4.0, [0.0, 130.0], 10.0)]));
        forms
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let warmer = values.get("start_k");
        for a in &mut model.axes {
            a.resistance *= 1.0 + model::motor::COPPER_PER_K * warmer;
            a.torque_constant *= 1.0 - model::motor::MAGNET_PER_K * warmer;
            a.back_emf *= 1.0 - model::motor::MAGNET_PER_K * warmer;
        }
        let (rise, time) = (values.get("rise"), values.find("time_s").unwrap_or(30.0));
        if rise == 0.0 {
            return;
        }
        let index = model.prepare.len();
        model.prepare.push(Box::new(move |m, s| {
            (0..m.wheels.len())
                .map(|i| {
                    let mut state = s.before.iter().fold(0.0, |state: f64, (seconds, squares)| {
                        squares[i] + (state - squares[i]) * (-seconds / time).exp()
                    });
                    (0..s.t.len())
                        .map(|k| {
                            let dt = if k > 0 { s.t[k] - s.t[k - 1] } else { 0.0 };
                            state += dt / time * (s.duty[i][k] * s.duty[i][k] - state);
                            state
                        })
                        .collect()
                })
                .collect()
        }));
        model.loads.push(Box::new(move |now, loads| {
            for i in 0..now.winding.len() {
                let hot = 1.0 + rise * now.prepared[index][i][now.tick];
                loads.wheel[i] += now.winding[i] * (1.0 / hot - 1.0);
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("measure the winding resistance cold and hot", 5.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_warms_up_slowly_must_be_more_in_short_runs() {
        let robot = Robot::racbot();
        let material = |run_s: f64| {
            let forms = MotorHeating.forms_in(&robot, &Sizes { run_s, ..Sizes::of(&robot) });
            [forms[0].free[0].material, forms[1].free[0].material]
        };
        assert_eq!(material(f64::INFINITY), [RISE; 2]);
        let [fast, slow] = material(7.0);
        assert!(fast == RISE && slow > 5.0 * RISE && slow < 6.0 * RISE, "{slow}");
        assert!(material(600.0)[1] < 1.01 * RISE);
    }
}
