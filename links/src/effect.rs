//! What an effect is: a name, parameters with physical bounds, and what it changes in the links.

use model::plant::GRAVITY;
use runs::geometry::Wheel;
use runs::robot::{Robot, Support};

use crate::drive::DriveModel;
use crate::motion::MotionModel;
use crate::thresholds;
pub use crate::values::{Values, wheel_name};

/// A piece of the chain from command to camera, cut at logged signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Link {
    /// The time stamps.
    Timing,
    /// Command → wheel set points.
    Command,
    /// Set points and encoders → duty.
    Controller,
    /// Duty and supply → encoders.
    Drive,
    /// Encoders → camera.
    Motion,
    /// Encoders → gyroscope.
    Gyroscope,
    /// Encoders → accelerometer.
    Accelerometer,
}

impl Link {
    /// Whether parameters are fitted on it; the others are replayed.
    pub fn is_fitted(self) -> bool {
        matches!(self, Self::Motion | Self::Drive) || self.is_inertial()
    }

    /// Whether it ends in the inertial sensor: fitted with the motion link, for the same wheels.
    pub fn is_inertial(self) -> bool {
        matches!(self, Self::Gyroscope | Self::Accelerometer)
    }

    /// Name in reports and in `gap.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Timing => "timing",
            Self::Command => "command",
            Self::Controller => "controller",
            Self::Drive => "drive",
            Self::Motion => "motion",
            Self::Gyroscope => "gyroscope",
            Self::Accelerometer => "accelerometer",
        }
    }
}

/// One number an effect has.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name, ending in its unit.
    pub name: String,
    /// A step that is small but shows: sets finite differences.
    pub scale: f64,
    /// Physical bounds.
    pub bounds: [f64; 2],
    /// Below this size (either sign) the effect is detectable but immaterial.
    pub material: f64,
    /// Value an otherwise absent effect is tried at, for parameters whose absence is not 0.
    pub start: Option<f64>,
    /// Material if below this, for parameters that are large in the nominal model.
    pub below: Option<f64>,
    /// Whether the lower bound is where it can no longer be told from what is there anyway.
    pub blurred: bool,
    /// Whether at its upper bound it is no more what it says, though it has no size by which it is named.
    pub closed: bool,
    /// By how much the log leaves it open at most, the same in every run.
    pub open: f64,
}

impl Parameter {
    /// A parameter that is 0 in the nominal model.
    pub fn new(name: impl Into<String>, scale: f64, bounds: [f64; 2], material: f64) -> Self {
        Self {
            name: name.into(),
            scale,
            bounds,
            material,
            start: None,
            below: None,
            blurred: false,
            closed: false,
            open: 0.0,
        }
    }

    /// A parameter that is material if it falls below `limit`.
    #[must_use]
    pub fn material_below(mut self, limit: f64) -> Self {
        self.below = Some(limit);
        self
    }

    /// A parameter that at its lower bound cannot be told from what is there anyway.
    #[must_use]
    pub fn blurred_below(mut self) -> Self {
        self.blurred = true;
        self
    }

    /// A parameter with which nothing is named at its upper bound.
    #[must_use]
    pub fn closed_above(mut self) -> Self {
        self.closed = true;
        self
    }

    /// Whether a value is worth naming.
    pub fn is_material(&self, value: f64) -> bool {
        match self.below {
            Some(limit) => value < limit,
            None => self.material.is_finite() && value.abs() >= self.material,
        }
    }

    /// A parameter that the log leaves open by as much either way.
    #[must_use]
    pub fn open_by(mut self, open: f64) -> Self {
        self.open = open;
        self
    }

    /// A parameter tried from `start`, its effect absent without it.
    #[must_use]
    pub fn from(mut self, start: f64) -> Self {
        self.start = Some(start);
        self
    }
}

/// One way to parametrise an effect: all wheels alike, one wheel, every wheel its own.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Form {
    /// Wheels it acts on, from 0; empty for the whole robot.
    pub wheels: Vec<usize>,
    /// Parameters that are estimated.
    pub free: Vec<Parameter>,
    /// Held at values that were not fitted.
    pub fixed: Vec<(String, f64)>,
}

impl Form {
    /// The whole robot, with these parameters.
    pub fn whole(free: Vec<Parameter>) -> Self {
        Self { free, ..Self::default() }
    }

    /// Whether it has the same parameters, of the same wheels.
    pub fn is(&self, other: &Self) -> bool {
        let names = |form: &Self| form.free.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
        self.wheels == other.wheels && self.fixed == other.fixed && names(self) == names(other)
    }

    /// The same with a constant.
    #[must_use]
    pub fn fixing(mut self, name: &str, value: f64) -> Self {
        self.fixed.push((name.to_owned(), value));
        self
    }

    /// One parameter for each of all wheels.
    pub fn each(robot: &Robot, parameter: impl Fn(usize) -> Parameter) -> Self {
        let wheels: Vec<usize> = (0..robot.wheel_count()).collect();
        Self { free: wheels.iter().map(|i| parameter(*i)).collect(), wheels, fixed: Vec::new() }
    }

    /// Every wheel alone, one form a wheel.
    pub fn alone(robot: &Robot, parameter: impl Fn(usize) -> Parameter) -> Vec<Self> {
        (0..robot.wheel_count())
            .map(|i| Self { wheels: vec![i], free: vec![parameter(i)], fixed: Vec::new() })
            .collect()
    }

    /// All motors alike by one `stem`, and where there are several, each alone by a `stem` of its own.
    pub fn all_or_one(robot: &Robot, stem: &str, parameter: impl Fn(String) -> Parameter) -> Vec<Self> {
        let mut forms = vec![Self::whole(vec![parameter(stem.to_owned())])];
        if robot.wheel_count() > 1 {
            forms.extend(Self::alone(robot, |i| parameter(wheel_name(stem, i, ""))));
        }
        forms
    }

    /// Every wheel alone, with two parameters of its own, and all together if there are several.
    pub fn axes(robot: &Robot, parameters: impl Fn(usize) -> [Parameter; 2]) -> Vec<Self> {
        let of = |wheels: Vec<usize>| {
            let free = wheels.iter().flat_map(|i| parameters(*i)).collect();
            Self { wheels, free, fixed: Vec::new() }
        };
        let n = robot.wheel_count();
        let mut forms: Vec<Self> = (0..n).map(|i| of(vec![i])).collect();
        if n > 1 {
            forms.push(of((0..n).collect()));
        }
        forms
    }
}

/// A physical effect that the nominal model leaves out.
pub trait Effect: Send + Sync {
    /// Name, kebab-case, stable.
    fn name(&self) -> &str;
    /// What it is, in one sentence with its equation.
    fn equation(&self) -> &str;
    /// Where it is described.
    fn reference(&self) -> &str {
        ""
    }
    /// The link in which its parameters are fitted.
    fn link(&self) -> Link;
    /// A second link in which it can be found.
    fn also(&self) -> Option<Link> {
        None
    }
    /// Its parametrisations for a robot, simplest first.
    fn forms(&self, robot: &Robot) -> Vec<Form>;
    /// The same for logs in which the robot did no more than `sizes`.
    fn forms_in(&self, robot: &Robot, _sizes: &Sizes) -> Vec<Form> {
        self.forms(robot)
    }
    /// Acts on the motion link.
    fn motion(&self, _values: &Values, _model: &mut MotionModel) {}
    /// Acts on the drive link.
    fn drive(&self, _values: &Values, _model: &mut DriveModel) {}
    /// Whether it adds loads to the drive in proportion to the parameters of its forms, and does nothing else there but by
    /// what the encoders are ahead.
    fn is_load(&self) -> bool {
        false
    }
    /// Whether a load that it adds depends on what the motors are.
    fn looks_at_motors(&self) -> bool {
        false
    }
    /// Whether a gear carries the load that it adds, and on blocks loses its share of it.
    fn is_carried(&self) -> bool {
        false
    }
    /// Whether it acts before the current of a motor and changes that alone: where currents are logged, nothing is left of
    /// it.
    fn before_current(&self) -> bool {
        false
    }
    /// Whether it is looked for only in place of several others that do the same together.
    fn stands_for_several(&self) -> bool {
        false
    }
    /// Whether every robot may have a little of a form without a name; else it is there or it is not.
    fn may_be_little(&self, _form: &Form) -> bool {
        true
    }
    /// Whether it takes away what an encoder's noise makes, too.
    fn takes_noise(&self) -> bool {
        false
    }
    /// Whether it only probes for structure and is never named.
    fn probe(&self) -> bool {
        false
    }
    /// What a probe found, in words.
    fn describe(&self, _values: &Values) -> String {
        self.equation().to_owned()
    }
    /// Period of an angle after which the effect is the same again: values are given in [0, period).
    fn period(&self, _parameter: &str) -> Option<f64> {
        None
    }
    /// Relative standard deviation of its parameters from what its law leaves out.
    fn law_uncertainty(&self) -> f64 {
        // Geometry holds to the width of a contact, laws of friction and motors less well.
        if matches!(self.link(), Link::Drive) { 0.015 } else { 0.005 }
    }
    /// Whether its parameters are the recording's, not the robot's: a file that carries it declares that they are fitted
    /// anew for the runs at hand.
    fn nuisance(&self) -> bool {
        false
    }
    /// A measurement without driving that settles it, and the minutes it takes.
    fn measurement(&self) -> Option<(&str, f64)> {
        None
    }
}

/// Sizes of a robot and its logs that materiality is measured in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// Torque of a stalled motor at the wheel shaft, Nm.
    pub stall_nm: f64,
    /// No-load speed, rad/s at the wheel.
    pub no_load: f64,
    /// Weight of the whole robot, N.
    pub weight_n: f64,
    /// Largest distance of a contact point from the centre, m.
    pub rim_m: f64,
    /// Stall current, A.
    pub stall_a: f64,
    /// Torque at the wheel shaft beside which torques are large or small, Nm: what the motors gave in the logs, or what
    /// the floor can take.
    pub drive_nm: f64,
    /// Torque that the accelerations of the logs took of an axis on blocks, Nm at the output shaft: what a weight or a spring
    /// gives may be more than its motor's.
    pub moved_nm: f64,
    /// Speed of the wheels while they turned, rad/s.
    pub speed: f64,
    /// Count of the encoders, rad at the wheel shaft.
    pub count_rad: f64,
    /// Time within which a step of an angle shows as a torque, s: the length of a test function.
    pub test_function_s: f64,
    /// Longest run without a gap, s.
    pub run_s: f64,
    /// Half of what the wheel that turned most turned through, rad.
    pub reach_rad: f64,
    /// How far from the camera's origin the robot was seen, m, at least as far as a usual field goes: where the cube of the
    /// distance is to the distance as it was over all frames, each root mean square.
    pub seen_m: f64,
    /// Play of a gear that leaves least of the drive; `None` where nobody looked.
    pub play: Option<Play>,
}

/// A gear's play by which a search for it begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Play {
    /// Rad at the motor shaft; 0 where none leaves less.
    pub rad: f64,
    /// Dry friction of the wheel beyond it, Nm; 0 where one that coasts leaves less.
    pub load_friction_nm: f64,
    /// All dry friction that there is, Nm.
    pub friction_nm: f64,
}

impl Sizes {
    /// The sizes of a robot that was driven as hard as it can be.
    pub fn of(robot: &Robot) -> Self {
        let m = &robot.motor;
        let stall_a = robot.supply_v / m.resistance_ohm;
        let rim = |w: &Wheel| w.x_m.hypot(w.y_m);
        let stall_nm = robot.gear_ratio * m.torque_constant * stall_a;
        let no_load = robot.no_load_wheel_speed(robot.supply_v);
        let rim_m = robot.layout.wheels().iter().map(rim).fold(0.0, f64::max);
        Self {
            stall_nm,
            no_load,
            weight_n: GRAVITY * robot.mass_kg,
            rim_m,
            stall_a,
            drive_nm: stall_nm,
            moved_nm: stall_nm,
            speed: thresholds::USUAL_SPEED * no_load,
            count_rad: 1.0 / robot.counts_per_wheel_rad(),
            test_function_s: crate::drive::TEST_FUNCTION_S,
            run_s: f64::INFINITY,
            reach_rad: 1.0,
            seen_m: thresholds::FIELD_OF_RIM * rim_m,
            play: None,
        }
    }

    /// The sizes of a robot whose motors gave this torque (RMS, Nm at the wheel shaft) at this speed (rad/s).
    pub fn driven(robot: &Robot, torque_nm: f64, speed: f64) -> Self {
        let sizes = Self::of(robot);
        let load = match robot.support {
            Support::Floor => sizes.weight_n * robot.wheel_radius_m / robot.wheel_count() as f64,
            Support::Blocks => 0.0,
        };
        let drive_nm = (thresholds::PEAK_OF_RMS * torque_nm).max(thresholds::GRIP * load);
        Self { drive_nm: if drive_nm > 0.0 { drive_nm } else { sizes.drive_nm }, ..sizes }.at_speed(speed)
    }

    /// Force on the body beside which forces of the floor are large or small, N: its weight, or what its drive gives.
    pub fn body_n(&self, robot: &Robot) -> f64 {
        self.weight_n.max(2.2 * robot.wheel_count() as f64 * self.drive_nm / robot.wheel_radius_m)
    }

    /// Torque at most that a weight or a spring gives at the output shaft of an axis, Nm.
    pub fn carried_nm(&self) -> f64 {
        thresholds::CARRIED * self.drive_nm.max(self.stall_nm).max(self.moved_nm)
    }

    /// Speed about 0 within which the direction of a wheel is not known, rad/s, where rows are not far apart.
    pub fn turns_round(&self) -> f64 {
        crate::segment::turns_round(self.count_rad, 0.0, self.speed)
    }

    /// The same for frames that saw the robot this far from the camera's origin, m: a usual field, or beyond.
    #[must_use]
    pub fn seen(self, seen_m: f64) -> Self {
        Self { seen_m: self.seen_m.max(seen_m), ..self }
    }

    /// The same for wheels that turned at this speed, rad/s, if they did.
    #[must_use]
    pub fn at_speed(self, speed: f64) -> Self {
        Self { speed: if speed > 0.0 { speed } else { self.speed }, ..self }
    }
}

/// Applies one change to the wheels of both links' models.
pub fn turn_wheels(wheels: &mut [Wheel], change: impl Fn(usize, &mut Wheel)) {
    for (i, w) in wheels.iter_mut().enumerate() {
        change(i, w);
    }
}
