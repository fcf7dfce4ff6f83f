//! The `drive` link: duty and supply to wheel motion.
//!
//! Newton's law in wheel coordinates, solved for wheel acceleration so that its coefficient is 1
//! (a free coefficient on both sides would let a fit shrink everything), multiplied by test functions of
//! about 120 ms and integrated twice by parts, so that nothing but counts enters. The result is an
//! unexplained torque per wheel and test function, Nm at the wheel shaft.

mod answers;
mod felt;
mod floor;
mod forces;
mod free_run;
mod instant;
mod kept;
mod laid;
mod linearise;
mod means;
mod play;
mod signals;
mod test_functions;
#[cfg(test)]
mod tests;

use std::hash::{DefaultHasher, Hash, Hasher};

use nalgebra::{DMatrix, Matrix3};
use runs::geometry::{Geometry, Wheel};
use runs::robot::{Robot, Support};

use crate::effect::{Effect, Form};
use crate::segment::Segment;
use crate::values::Values;

pub use crate::segment::smooth_sign;
pub(crate) use crate::thresholds::TEST_FUNCTION_S;
pub use answers::Answers;
pub use floor::{FEWEST_PER_COLUMN, Generic, Left, accounted, floor, of_a_count};
pub use forces::Forces;
pub use free_run::{further, in_own_torque, runaway};
pub use instant::{Instant, Loads};
pub use linearise::Side;
pub(crate) use play::{LOAD_FRICTION, RATIO};
pub use test_functions::{DriveLink, DriveResiduals};

/// Adds torques and forces at one instant.
pub type LoadTerm = Box<dyn Fn(&Instant<'_>, &mut Loads) + Send + Sync>;
/// Changes the duty that reaches a motor: (wheel, duty) → duty.
pub type DutyMap = Box<dyn Fn(usize, f64) -> f64 + Send + Sync>;
/// Changes the supply: (instant, currents of the motors in A) → V.
pub type SupplyMap = Box<dyn Fn(&Instant<'_>, f64, &[f64]) -> f64 + Send + Sync>;
/// Prepares per-tick values of a segment (`[wheel][tick]`) that a term needs, such as a motor's
/// temperature or the state of a gear's play.
pub type Prepare = Box<dyn Fn(&DriveModel, &Segment) -> Vec<Vec<f64>> + Send + Sync>;

/// What is ahead of a wheel where its encoder is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ahead {
    /// The rotor with the encoder, as in the play of a gear: its inertia moves along.
    Rotor,
    /// What is read, and nothing that moves.
    Reading,
}

/// Motor and gear of one wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisModel {
    /// Terminal resistance, Ω.
    pub resistance: f64,
    /// Torque per current, Nm/A, at the motor shaft.
    pub torque_constant: f64,
    /// Voltage per speed, V s/rad, at the motor shaft.
    pub back_emf: f64,
    /// Rotor inertia at the motor shaft, kg m².
    pub rotor_inertia: f64,
    /// Inertia at the wheel shaft beside the rotor, kg m².
    pub load_inertia: f64,
    /// Coulomb friction at the motor shaft, Nm.
    pub friction: f64,
    /// Share of the transmitted torque that is lost.
    pub gear_loss: f64,
    /// Wheel angle per angle by the encoder.
    pub encoder_scale: f64,
}

impl AxisModel {
    /// Torque by which the back-EMF brakes a wheel behind such a gear, Nm per rad/s.
    pub fn braking(&self, gear_ratio: f64) -> f64 {
        gear_ratio * self.torque_constant / self.resistance * self.back_emf * gear_ratio
    }

    /// Current that volts at its terminals drive while its wheel turns at a speed (rad/s) behind such a gear, A, if nothing
    /// limits it.
    fn asks_a(&self, volts: f64, gear_ratio: f64, speed: f64) -> f64 {
        (volts - self.back_emf * gear_ratio * speed) / self.resistance
    }
}

/// Everything between duty and wheel motion; effects change it.
pub struct DriveModel {
    /// Wheels as they really are.
    pub wheels: Vec<Wheel>,
    /// Nominal radius of every wheel, m.
    pub wheel_radius_m: f64,
    /// Radius of each wheel relative to that.
    pub radius_scale: Vec<f64>,
    /// Mass of the whole robot, kg.
    pub mass: f64,
    /// Yaw inertia about the chassis centre, kg m².
    pub yaw_inertia: f64,
    /// Centre of mass in the body frame, m.
    pub centre_of_mass: [f64; 2],
    /// Slope of the floor downhill in the world, rad.
    pub slope_rad: [f64; 2],
    /// Motor turns per wheel turn.
    pub gear_ratio: f64,
    /// Motors and gears.
    pub axes: Vec<AxisModel>,
    /// Age of the duty that acts, s.
    pub duty_delay_s: f64,
    /// Time constant of the low-pass between the wheels' angles and those of the log, s.
    pub reading_filter_s: f64,
    /// Current that each motor has at most, A; infinite where nothing limits it.
    pub current_limit_a: f64,
    /// Voltage that each bridge takes off against its current, V.
    pub bridge_drop_v: f64,
    /// Supply where none is logged, relative to the file's, and by how much it falls, V/s.
    pub supply_scale: f64,
    /// See `supply_scale`.
    pub supply_fall_v_per_s: f64,
    /// What the bridge makes of a duty.
    pub duty_maps: Vec<DutyMap>,
    /// What the load makes of the supply.
    pub supply_maps: Vec<SupplyMap>,
    /// Torques and forces beside those of the nominal model.
    pub loads: Vec<LoadTerm>,
    /// Further ones in proportion to a number.
    proportional: Vec<Proportional>,
    /// Per-tick values for terms with memory.
    pub prepare: Vec<Prepare>,
    /// Encoder angle minus wheel angle, `[wheel][tick]`, rad at the wheel, and what is ahead.
    pub offsets: Vec<(Ahead, Prepare)>,
    /// What carries the robot.
    pub support: Support,
    /// The effects that act on torques and forces by more than its numbers and the proportional loads.
    bending: Vec<(String, Values)>,
}

/// Loads of an effect in proportion to its parameters.
struct Proportional {
    /// As the effect has them.
    own: Vec<LoadTerm>,
    units: Vec<Unit>,
    /// Whether they depend on what the motors are.
    looks_at_motors: bool,
    /// Whether a gear carries them.
    is_carried: bool,
}

/// Loads in proportion to one number.
struct Unit {
    /// Of which effect, with what is fixed of it, and parameter.
    of: String,
    value: f64,
    /// At the value 1.
    loads: Vec<LoadTerm>,
}

impl DriveModel {
    /// The nominal robot.
    pub fn new(robot: &Robot) -> Self {
        let wheels = robot.layout.wheels();
        let n = wheels.len();
        let axis = AxisModel {
            resistance: robot.motor.resistance_ohm,
            torque_constant: robot.motor.torque_constant,
            back_emf: robot.motor.back_emf(),
            rotor_inertia: robot.motor.rotor_inertia,
            load_inertia: robot.wheel_inertia_kg_m2,
            friction: robot.motor.friction_torque,
            gear_loss: 1.0 - robot.gear_efficiency,
            encoder_scale: 1.0,
        };
        Self {
            wheels,
            wheel_radius_m: robot.wheel_radius_m,
            radius_scale: vec![1.0; n],
            mass: robot.mass_kg,
            yaw_inertia: robot.yaw_inertia_kg_m2,
            centre_of_mass: [0.0; 2],
            slope_rad: [0.0; 2],
            gear_ratio: robot.gear_ratio,
            axes: vec![axis; n],
            duty_delay_s: 0.0,
            reading_filter_s: 0.0,
            current_limit_a: f64::INFINITY,
            bridge_drop_v: 0.0,
            supply_scale: 1.0,
            supply_fall_v_per_s: 0.0,
            duty_maps: Vec::new(),
            supply_maps: Vec::new(),
            loads: Vec::new(),
            proportional: Vec::new(),
            prepare: Vec::new(),
            offsets: Vec::new(),
            support: robot.support,
            bending: Vec::new(),
        }
    }

    /// What it does joins the model's terms; of a load also what each parameter does at 1.
    pub fn add(&mut self, effect: &dyn Effect, values: &Values, form: &Form) {
        let terms = |m: &Self| [m.loads.len(), m.duty_maps.len(), m.supply_maps.len(), m.prepare.len()];
        let before = terms(self);
        effect.drive(values, self);
        if effect.is_load() {
            let own = self.loads.split_off(before[0]);
            let offsets = self.offsets.len();
            let mut unit = |values: &Values| {
                effect.drive(values, self);
                self.offsets.truncate(offsets);
                self.loads.split_off(before[0])
            };
            let units = if form.free.is_empty() {
                // What is not fitted is in proportion to 1 alone.
                vec![Unit { of: format!("{} {:?}", effect.name(), values.0), value: 1.0, loads: unit(values) }]
            } else {
                let free = form.free.iter().map(|p| (&p.name, values.get(&p.name))).filter(|(_, value)| *value != 0.0);
                free.map(|(name, value)| {
                    let mut at = Values(form.fixed.clone());
                    at.set(name, 1.0);
                    Unit { of: format!("{} {:?} {name}", effect.name(), form.fixed), value, loads: unit(&at) }
                })
                .collect()
            };
            let (looks_at_motors, is_carried) = (effect.looks_at_motors(), effect.is_carried());
            self.proportional.push(Proportional { own, units, looks_at_motors, is_carried });
        } else if terms(self) != before {
            self.bending.push((effect.name().to_owned(), values.clone()));
        }
    }

    /// Whether a load adds to torques what it would add alone: a gear that loses does not lose the same of one that it carries.
    fn adds_up(&self, load: &Proportional) -> bool {
        !load.is_carried || self.torques_stand_alone()
    }

    /// What the torques and forces of models of one robot differ by, without the loads that add up: no inertia is among it, but
    /// the share of a rotor's torque that a gear that loses passes on.
    fn torques_identity(&self) -> u64 {
        // What one factor scales alike is alike but for the last digits.
        const DIGITS: f64 = 1e12;
        let axis =
            |a: &AxisModel| [a.resistance, a.torque_constant, a.back_emf, a.friction, a.gear_loss].map(f64::to_bits);
        let electrical = [
            self.duty_delay_s,
            self.reading_filter_s,
            self.current_limit_a,
            self.bridge_drop_v,
            self.supply_scale,
            self.supply_fall_v_per_s,
        ];
        let mut hasher = DefaultHasher::new();
        self.axes.iter().map(axis).for_each(|axis| axis.hash(&mut hasher));
        electrical.map(f64::to_bits).hash(&mut hasher);
        if !self.torques_stand_alone() {
            self.constants().iter().for_each(|axis| ((DIGITS * axis.passed).round() as i64).hash(&mut hasher));
        }
        let inside = self.proportional.iter().filter(|load| !self.adds_up(load));
        inside.flat_map(|load| &load.units).for_each(|unit| (&unit.of, unit.value.to_bits()).hash(&mut hasher));
        for (name, values) in &self.bending {
            name.hash(&mut hasher);
            values.0.iter().for_each(|(name, value)| (name, value.to_bits()).hash(&mut hasher));
        }
        if !self.prepare.is_empty() {
            // How fast a wheel coasts to rest in its gear's play.
            let turning = self.axes.iter().flat_map(|a| [a.rotor_inertia, a.load_inertia]);
            turning.chain([self.yaw_inertia]).for_each(|x| x.to_bits().hash(&mut hasher));
        }
        self.motion_identity().hash(&mut hasher);
        hasher.finish()
    }

    /// What proportional loads that do not look at motors differ by.
    fn motion_identity(&self) -> u64 {
        let ([cx, cy], [sx, sy]) = (self.centre_of_mass, self.slope_rad);
        let numbers = [self.mass, cx, cy, sx, sy, self.wheel_radius_m, self.gear_ratio];
        let wheels = self.wheels.iter().flat_map(|w| [w.x_m, w.y_m, w.drive_rad, w.roller_rad]);
        let scales = self.radius_scale.iter().copied().chain(self.axes.iter().map(|a| a.encoder_scale));
        let mut hasher = DefaultHasher::new();
        numbers.into_iter().chain(wheels).chain(scales).for_each(|x| x.to_bits().hash(&mut hasher));
        hasher.finish()
    }

    /// Whether no torque depends on an inertia, or a motor's on a load: on blocks a gear that loses passes on what does not turn
    /// its rotor.
    pub fn torques_stand_alone(&self) -> bool {
        self.support == Support::Floor || self.axes.iter().all(|a| a.gear_loss == 0.0)
    }

    /// Mean inertia a wheel feels while the others are free to follow, kg m² at its shaft.
    pub fn felt_inertia(&self) -> f64 {
        self.mechanics().map_or(f64::NAN, |m| m.inertia.trace() / m.inertia.nrows() as f64)
    }

    /// Inertia of a rotor at its wheel's shaft, kg m².
    fn rotor_at_wheel(&self, wheel: usize) -> f64 {
        self.gear_ratio.powi(2) * self.axes[wheel].rotor_inertia
    }

    /// Inertia that a wheel moves without its rotor, kg m² at the wheel's shaft.
    pub fn beyond_the_gear(&self, wheel: usize) -> f64 {
        match self.support {
            Support::Blocks => self.axes[wheel].load_inertia,
            Support::Floor => self.felt_inertia() - self.rotor_at_wheel(wheel),
        }
    }

    /// Inertia of a wheel with its rotor, kg m² at the wheel's shaft.
    fn spinning_inertia(&self, wheel: usize) -> f64 {
        self.rotor_at_wheel(wheel) + self.axes[wheel].load_inertia
    }

    /// Inertia that `rotor-inertia` scales at a wheel's shaft, kg m²: on blocks all that turns.
    pub fn inertia_of_scale(&self, wheel: usize) -> f64 {
        match self.support {
            Support::Blocks => self.spinning_inertia(wheel),
            Support::Floor => self.rotor_at_wheel(wheel),
        }
    }

    /// Inertia that moves in the play of a gear, at the wheel's shaft, kg m²: the rotor's, or none where the file gives
    /// all that turns as one.
    pub fn moves_in_play(&self, wheel: usize) -> f64 {
        let all_in_one = self.support == Support::Blocks && self.axes[wheel].load_inertia == 0.0;
        if all_in_one { 0.0 } else { self.rotor_at_wheel(wheel) }
    }

    /// The kinematics; `None` where the wheels cannot drive the robot.
    fn geometry(&self) -> Option<Geometry> {
        let alone = self.support == Support::Blocks && self.wheels.len() < 3;
        let geometry = if alone { Geometry::axes } else { Geometry::new };
        geometry(self.wheels.clone(), self.wheel_radius_m).ok()
    }

    /// Wheel speed per body twist, N × 3.
    fn wheel_speed_per_twist(&self, geometry: &Geometry) -> DMatrix<f64> {
        DMatrix::from_fn(self.wheels.len(), 3, |i, j| geometry.inverse()[(i, j)] / self.radius_scale[i])
    }

    /// Body twist per wheel speed, 3 × N, least squares; none where the wheels cannot drive the robot.
    fn twist_per_wheel_speed(&self) -> Option<DMatrix<f64>> {
        let geometry = self.geometry()?;
        twist_per_wheel_speed(&self.wheel_speed_per_twist(&geometry), &geometry)
    }

    /// The matrices that turn mean torques and forces into wheel accelerations; `None` where the
    /// wheels cannot drive the robot.
    pub fn mechanics(&self) -> Option<Mechanics> {
        let geometry = self.geometry()?;
        let rows = self.wheel_speed_per_twist(&geometry);
        let spin: Vec<f64> = (0..self.axes.len()).map(|i| self.spinning_inertia(i)).collect();
        if self.support == Support::Blocks {
            let inertia = DMatrix::from_diagonal(&nalgebra::DVector::from_column_slice(&spin));
            let inverse = inertia.clone().try_inverse()?;
            return Some(Mechanics { rows, body: None, response: inverse, inertia });
        }
        let [cx, cy] = self.centre_of_mass;
        let (m, i) = (self.mass, self.yaw_inertia);
        let platform = Matrix3::new(m, 0.0, -m * cy, 0.0, m, m * cx, -m * cy, m * cx, i);
        let mut total = platform;
        for (w, j) in spin.iter().enumerate() {
            for a in 0..3 {
                for b in 0..3 {
                    total[(a, b)] += j * rows[(w, a)] * rows[(w, b)];
                }
            }
        }
        // A differential drive cannot be pushed sideways.
        let inverse = geometry.invert_allowed(&total)?;
        let twist = twist_per_wheel_speed(&rows, &geometry)?;
        let inverse = DMatrix::from_fn(3, 3, |a, b| inverse[(a, b)]);
        let total = DMatrix::from_fn(3, 3, |a, b| total[(a, b)]);
        let body = &rows * inverse;
        Some(Mechanics {
            response: &body * rows.transpose(),
            inertia: twist.transpose() * total * &twist,
            body: Some(body),
            rows,
        })
    }
}

/// The twist, of those that the wheels allow, that fits wheel speeds best; 3 × N.
pub(crate) fn twist_per_wheel_speed(rows: &DMatrix<f64>, geometry: &Geometry) -> Option<DMatrix<f64>> {
    let allowed = geometry.allowed_twists();
    let within = rows * &allowed;
    Some(allowed * (within.transpose() * &within).try_inverse()? * within.transpose())
}

/// Mean torques to wheel accelerations and back.
pub struct Mechanics {
    /// Wheel speed per twist, N × 3.
    pub rows: DMatrix<f64>,
    /// Wheel acceleration per generalised body force, N × 3; none on blocks.
    pub body: Option<DMatrix<f64>>,
    /// Wheel acceleration per wheel torque, N × N.
    pub response: DMatrix<f64>,
    /// Wheel torque per wheel acceleration, N × N.
    pub inertia: DMatrix<f64>,
}

impl Mechanics {
    /// The same for mean torques that were worked out as if speeds went straight from row to row.
    ///
    /// Under a held duty a motor's speed bends towards its end: of y time constants in a row its mean is ahead of the straight
    /// line by coth(y/2)/2 - 1/y of the change, so that the back-EMF took more than the line says. That is in proportion to the
    /// acceleration, as an inertia is: it is larger by y/2 coth(y/2), here to a hundredth up to four time constants.
    pub(crate) fn between_rows(self, model: &DriveModel, row_s: f64) -> Option<Self> {
        let n = model.axes.len();
        let damping = model.axes.iter().map(|a| a.braking(model.gear_ratio) * a.encoder_scale);
        let per_s = &self.response * DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(n, damping));
        let (one, square) = (DMatrix::identity(n, n), &per_s * &per_s * row_s.powi(2));
        // Behind a filter speeds bend by the slower of the two.
        let behind = (&one + &per_s * model.reading_filter_s).try_inverse()?;
        let heavier = &one + (&one + &square / 60.0).try_inverse()? * behind * &square / 12.0;
        let lighter = heavier.clone().try_inverse()?;
        Some(Self {
            body: self.body.map(|body| &lighter * body),
            response: lighter * self.response,
            inertia: self.inertia * heavier,
            rows: self.rows,
        })
    }

    /// Acceleration that the encoders see per torque of each wheel and force on the body, N × (N + 3).
    pub(crate) fn encoders_per_torque(&self, model: &DriveModel) -> DMatrix<f64> {
        let n = model.wheels.len();
        DMatrix::from_fn(n, n + 3, |i, of| {
            let wheel =
                if of < n { self.response[(i, of)] } else { self.body.as_ref().map_or(0.0, |b| b[(i, of - n)]) };
            wheel / model.axes[i].encoder_scale
        })
    }
}
