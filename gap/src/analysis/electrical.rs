//! Motors of which duties and currents are both logged: volts and amperes tell their winding, whatever it moves.
//!
//! By the motion alone a motor of more resistance is one that moves more, or is rubbed more; by its current it is not.

use links::effect::Link;
use links::thresholds::SIGNIFICANT;
use model::setup::Winding;

use super::found::Named;
use super::look_alikes::Against;
use super::ratios::{TORQUE_CONSTANT, WINDING};
use super::study::Outcome;
use super::workflow::Workflow;
use crate::evidence::{Evidence, Interval};
use crate::state::Active;

/// What a winding shows in volts and amperes.
const OF_A_WINDING: [&str; 4] = [WINDING, TORQUE_CONSTANT, "motor-heating", "supply-voltage"];

impl Workflow<'_> {
    /// Names a winding that is not the file's where currents beside the duties tell it; what it moves is looked for beside it.
    pub(super) fn electrical(&mut self) {
        self.winding = Winding::of(&self.question.robot, &self.question.set.logs);
        let Some(winding) = &self.winding else { return };
        let found = self.another_motors(winding);
        if found.is_empty() {
            return;
        }
        let said = format!("Told by volts and amperes, whatever the motors move: {}.", winding.said());
        self.findings.remarks.push(said);
        for (active, named) in found {
            self.findings.named.push(named);
            self.findings.found.push(active.clone());
            self.start.active.push(active);
        }
    }

    /// What of a winding is not the file's, unless the file has it as an effect.
    fn another_motors(&self, winding: &Winding) -> Vec<(Active, Named)> {
        let robot = &self.question.robot;
        let known = |name: &str| self.start.active.iter().any(|a| a.effect.name() == name);
        let filed = [robot.motor.resistance_ohm, robot.motor.back_emf()];
        let p = winding.differs(filed[0], filed[1]);
        if known(WINDING) || known(TORQUE_CONSTANT) || p > SIGNIFICANT {
            return Vec::new();
        }
        let told = [(WINDING, winding.resistance_ohm), (TORQUE_CONSTANT, winding.back_emf)];
        let named = |((name, value), (half, filed)): ((&str, f64), (f64, f64))| {
            let effect = self.data.catalogue.iter().find(|e| e.name() == name)?;
            let mut forms = effect.forms(robot).into_iter();
            let form = forms.find(|form| form.wheels.is_empty() && form.free.len() == 1)?;
            let (size, half) = (value / filed - 1.0, half / filed);
            let parameter = form.free[0].clone();
            if size.abs() <= half || !parameter.is_material(size) {
                return None;
            }
            let mut active = Active { link: Link::Drive, given: true, ..Active::new(effect.clone(), form) };
            active.values.set(&parameter.name, size);
            let named = Named {
                name: name.to_owned(),
                equation: effect.equation().to_owned(),
                link: Link::Drive,
                wheels: Vec::new(),
                parameters: vec![(parameter.name, size, Interval::Ci95([size - half, size + half]))],
                gain: 0.0,
                evidence: Evidence::Test { method: "volts of the duties against currents and speeds", p },
                conditional_on: Vec::new(),
            };
            Some((active, named))
        };
        told.into_iter().zip(winding.half.into_iter().zip(filed)).filter_map(named).collect()
    }

    /// Whether volts and amperes told what an effect would say of the one motor that there is.
    pub(super) fn is_told_by_currents(&self, name: &str) -> bool {
        self.winding.is_some() && self.question.robot.wheel_count() == 1 && OF_A_WINDING.contains(&name)
    }

    /// What is named of all motors that the currents speak against.
    pub(super) fn against_currents(&self, outcome: &Outcome) -> Option<Against> {
        let winding = self.winding.as_ref()?;
        let motor = &self.question.robot.motor;
        let told = [
            (TORQUE_CONSTANT, winding.back_emf / motor.back_emf() - 1.0),
            (WINDING, winding.resistance_ohm / motor.resistance_ohm - 1.0),
        ];
        let off = self.thresholds.against_currents;
        let speaks_against = |n: &&Named| {
            let told = told.iter().find(|(name, _)| *name == n.name && n.wheels.len() != 1);
            let ends = n.parameters.first().and_then(|(_, _, interval)| interval.ends());
            told.zip(ends).is_some_and(|((_, size), [low, high])| *size < low - off || *size > high + off)
        };
        let names: Vec<String> = outcome.named.iter().filter(speaks_against).map(|n| n.name.clone()).collect();
        (!names.is_empty()).then(|| {
            let said = format!(
                "Fitted on the drive link, and not named: {}; the currents speak against it: {}.",
                names.join(", "),
                winding.said()
            );
            Against { names, said }
        })
    }
}
