//! `encoder-eccentricity`: an encoder that sits beside the middle of its shaft and reads ahead once a turn.

use runs::robot::Robot;

use crate::drive::{Ahead, DriveModel};
use crate::effect::{Effect, Form, Link, Parameter, Sizes, Values, wheel_name};
use crate::segment::Segment;

/// An encoder that sits beside the middle of its shaft, or whose magnet does: of the output shaft, or of the motor.
pub(super) struct EncoderEccentricity;

/// An encoder that sits beside the middle by a quarter of the radius at which it is read, rad: beyond, it reads no track any
/// more. The blind bench hides up to 0.09; with 1, joints of an arm and a heavy pendulum had encoders that read 24 to 57
/// degrees ahead.
const MOST: f64 = 0.25;
/// Turns of the encoder's shaft for one of the output shaft.
const ORDER: &str = "order";

impl Effect for EncoderEccentricity {
    fn name(&self) -> &str {
        "encoder-eccentricity"
    }

    fn equation(&self) -> &str {
        "an axis on blocks counts sin_i_rad sin(order theta_i) + cos_i_rad cos(order theta_i) more than theta_i, its angle by \
         the log's counts, whose zero the two parameters hold"
    }

    fn reference(&self) -> &str {
        "Slocum 1992, Precision Machine Design (eccentricity of encoders)"
    }

    fn link(&self) -> Link {
        Link::Drive
    }

    fn forms(&self, robot: &Robot) -> Vec<Form> {
        self.forms_in(robot, &Sizes::of(robot))
    }

    fn forms_in(&self, robot: &Robot, sizes: &Sizes) -> Vec<Form> {
        let model = DriveModel::new(robot);
        let inertia = model.felt_inertia();
        let gear = robot.gear_ratio;
        let orders = [1.0, gear].into_iter().take(if (gear - 1.0).abs() < 0.01 { 1 } else { 2 });
        let form = |(order, i): (f64, usize)| {
            // What it seems to take of torque at the speed of the log, to accelerate and by how the motor brakes, beside what the
            // motors gave.
            let turns = order * sizes.speed;
            let braking = model.axes[i].braking(robot.gear_ratio);
            let unit = sizes.drive_nm / (inertia * turns * turns).hypot(braking * turns);
            let most = MOST / order;
            let p = |stem| {
                let material = (0.03 * unit).min(0.5 * most);
                Parameter::new(wheel_name(stem, i, "rad"), 0.3 * material, [-most, most], material)
            };
            (unit > 0.0 && unit.is_finite()).then(|| {
                Form { wheels: vec![i], free: vec![p("sin"), p("cos")], fixed: Vec::new() }.fixing(ORDER, order)
            })
        };
        orders.flat_map(|order| (0..robot.wheel_count()).map(move |i| (order, i))).filter_map(form).collect()
    }

    fn is_load(&self) -> bool {
        true
    }

    fn looks_at_motors(&self) -> bool {
        true
    }

    fn drive(&self, values: &Values, model: &mut DriveModel) {
        let order = values.find(ORDER).unwrap_or(1.0);
        let ahead = values.with_angle(model.wheels.len(), "rad");
        let more = move |s: &Segment, i: usize, k: usize| {
            let [of_sin, of_cos] = ahead[i];
            if of_sin == 0.0 && of_cos == 0.0 {
                return 0.0;
            }
            let (sin, cos) = (order * (s.zero[i] + s.angle[i][k])).sin_cos();
            of_sin * sin + of_cos * cos
        };
        let read = more.clone();
        let read = move |model: &DriveModel, s: &Segment| {
            (0..model.wheels.len()).map(|i| (0..s.t.len()).map(|k| read(s, i, k)).collect()).collect()
        };
        model.offsets.push((Ahead::Reading, Box::new(read)));
        // The motors brake by how fast the shafts turn, and not by what is read.
        model.loads.push(Box::new(move |now, loads| {
            let (s, k) = (now.segment, now.tick);
            for (i, braking) in now.braking.iter().enumerate() {
                loads.wheel[i] += braking * (more(s, i, k + 1) - more(s, i, k)) / (s.t[k + 1] - s.t[k]);
            }
        }));
    }

    fn measurement(&self) -> Option<(&str, f64)> {
        Some(("turn the shaft by hand beside a protractor of the same counts", 10.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motor_that_brakes_tells_a_smaller_eccentricity() {
        let mut robot = Robot { support: runs::robot::Support::Blocks, gear_ratio: 80.0, ..Robot::racbot() };
        robot.motor.rotor_inertia = 1e-9;
        let sizes = Sizes::of(&robot);
        let sizes = sizes.at_speed(0.3 * sizes.no_load);
        let form = &EncoderEccentricity.forms_in(&robot, &sizes)[0];
        let taken = DriveModel::new(&robot).axes[0].braking(80.0) * sizes.speed * form.free[0].material;
        assert!(taken < 0.031 * sizes.drive_nm, "{taken} of {} Nm", sizes.drive_nm);
    }
}
