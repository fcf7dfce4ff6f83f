//! `motor-heating`: windings whose resistance grows as they warm up, or that are warm from the start.

use runs::robot::Robot;

use crate::drive::DriveModel;
use crate::effect::{Effect, Form, Link, Parameter, Values};

/// Windings whose resistance grows as they warm up, or that are warm from the start.
pub(super) struct MotorHeating;

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

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        let _ = robot;
        let mut forms: Vec<Form> = [8.0, 60.0]
            .into_iter()
            .map(|t| Form::whole(vec![Parameter::new("rise", 0.1, [0.0, 5.0], 0.3)]).fixing("time_s", t))
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
