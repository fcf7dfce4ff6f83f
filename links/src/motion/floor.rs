//! What wheels roll on: contacts that creep by the force they pass on, up to what friction holds.

use std::sync::Arc;

use model::plant::{Creep, Weight};
use nalgebra::{DMatrix, Matrix3, Vector3};
use runs::frames::Twist;
use runs::geometry::{Geometry, Wheel};

use crate::drive::twist_per_wheel_speed;
use crate::memo::Answer;
use crate::segment::Segment;

/// Newton steps at most; two to four are the rule.
const STEPS: usize = 24;
/// Steps within a tick in which a wheel slips: their length at most, s, and their number at most. Of three wheels that slip by 76 rad
/// in 3 s, logged at 500 Hz, the simulator's robot keeps within 0.2 % of its way of the law's with these, and within 0.3 % with
/// steps twice as long, with which a four-wheeled robot that dashes lost the name of its skews.
const LONGEST_STEP_S: f64 = 0.000_5;
const MOST_STEPS: f64 = 8.0;
/// Change of a twist, m/s or rad/s, that no camera sees.
const EXACT: f64 = 1e-8;
/// Speed that a contact creeps by per impulse, beside the speed the impulse gives the robot there: more than three
/// wheels would otherwise push against each other without end.
const CREEPS: f64 = 0.05;

/// A floor, and what its wheels carry.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Floor {
    /// Slip speed of a contact per force below its limit.
    pub creep: Creep,
    /// Force that a wheel holds at most, per load; `None` where it holds any.
    pub friction_coefficient: Option<f64>,
    /// Wheels as they really are.
    pub wheels: Vec<Wheel>,
    /// Radius of every wheel, m.
    pub wheel_radius_m: f64,
    /// Mass, kg, and yaw inertia about the chassis centre, kg m².
    pub masses: [f64; 2],
    /// Place of the centre of mass in the body frame, and its height, m.
    pub centre_m: [f64; 3],
}

impl Floor {
    /// Whether wheels turn further than they roll on it.
    pub fn gives_way(&self) -> bool {
        self.creep.is_any() || self.friction_coefficient.is_some()
    }

    /// By how much each wheel has turned further than it rolled, rad, `[wheel][tick]`; nothing where none does, and of wheels
    /// that cannot drive the robot.
    pub(crate) fn lost(&self, segment: &Segment) -> Answer {
        if !self.gives_way() {
            return None;
        }
        segment.lost.get(self.numbers(), || {
            let body = Body::new(self)?;
            let lost = match self.friction_coefficient {
                None => body.crept(segment),
                Some(mu) => body.slipped(Grip::new(self, mu)?, segment),
            };
            lost.iter().flatten().any(|lost| *lost != 0.0).then(|| Arc::new(lost))
        })
    }

    /// All that it is told by.
    fn numbers(&self) -> Vec<f64> {
        let Self { creep, friction_coefficient, wheels, wheel_radius_m, masses, centre_m } = self;
        let wheel = |w: &Wheel| [w.x_m, w.y_m, w.drive_rad, w.roller_rad];
        let mut numbers: Vec<f64> = wheels.iter().flat_map(wheel).collect();
        // No floor holds less than nothing.
        numbers.extend([creep.s_per_kg, creep.per_n, friction_coefficient.unwrap_or(-1.0), *wheel_radius_m]);
        numbers.extend(masses);
        numbers.extend(centre_m);
        numbers
    }
}

/// A body that its wheels pull along through their contacts.
struct Body {
    geometry: Geometry,
    /// Mass twice and yaw inertia.
    inertia: Vector3<f64>,
    creep: Creep,
    /// Traction speed per wheel speed, one a wheel, m.
    levers: Vec<f64>,
    /// Coefficients of the twist in each wheel's rolling speed, and what a torque impulse at the wheel changes of that speed.
    rows: Vec<Vector3<f64>>,
    response: Vec<f64>,
}

impl Body {
    fn new(floor: &Floor) -> Option<Self> {
        let radius = floor.wheel_radius_m;
        let [mass, yaw] = floor.masses;
        let geometry = Geometry::new(floor.wheels.clone(), radius).ok()?;
        let levers = floor.wheels.iter().map(|w| radius * w.roller_rad.cos()).collect();
        let inertia = Vector3::new(mass, mass, yaw);
        let row = |i: usize| Vector3::from_fn(|a, _| geometry.inverse()[(i, a)]);
        let rows: Vec<Vector3<f64>> = (0..floor.wheels.len()).map(row).collect();
        let response = rows.iter().map(|row| row.dot(&row.component_div(&inertia))).collect();
        Some(Self { geometry, inertia, creep: floor.creep, levers, rows, response })
    }

    /// Torque at each shaft per speed that its contact lacks, Nm s/rad, for wheels that turn like this.
    fn stiffness(&self, speeds: impl Iterator<Item = f64>, out: &mut [f64]) {
        let radius = self.geometry.wheel_radius_m();
        for ((stiffness, lever), speed) in out.iter_mut().zip(&self.levers).zip(speeds) {
            *stiffness = lever * lever / self.creep.at(radius * speed);
        }
    }

    /// A twist as the turn of the body frame over some time leaves it. Of wheels without rollers the floor takes what would be
    /// sideways.
    fn turned(&self, twist: &Vector3<f64>, dt: f64) -> Vector3<f64> {
        if self.geometry.is_differential() {
            return *twist;
        }
        let (s, c) = (twist.z * dt).sin_cos();
        Vector3::new(c * twist.x + s * twist.y, c * twist.y - s * twist.x, twist.z)
    }

    fn start(&self, segment: &Segment) -> Vector3<f64> {
        let speeds: Vec<f64> = segment.speed.iter().map(|w| w[0]).collect();
        as_vector(self.geometry.twist(&speeds))
    }

    /// What contacts lose that creep alone.
    ///
    /// The equation of motion of the body, a step of implicit Euler a tick: creep may be as stiff as it likes,
    /// and counts enter as they are.
    fn crept(&self, segment: &Segment) -> Vec<Vec<f64>> {
        let (n, ticks) = (segment.angle.len(), segment.t.len());
        let mut lost = vec![vec![0.0; ticks]; n];
        let rows = &self.rows;
        let mut twist = self.start(segment);
        let mut stiffness = vec![0.0; n];
        self.stiffness(segment.speed.iter().map(|w| w[0]), &mut stiffness);
        let solver = |stiffness: &[f64], dt: f64| {
            let pull = rows.iter().zip(stiffness).map(|(row, s)| row * row.transpose() * (dt * s));
            let stiff = Matrix3::from_diagonal(&self.inertia) + pull.sum::<Matrix3<f64>>();
            self.geometry.invert_allowed(&stiff).unwrap_or_default()
        };
        let mut known = (0.0, Matrix3::zeros());
        for k in 1..ticks {
            let dt = segment.t[k] - segment.t[k - 1];
            if self.creep.per_n > 0.0 {
                self.stiffness(segment.speed.iter().map(|w| w[k]), &mut stiffness);
                known = (dt, solver(&stiffness, dt));
            } else if (dt - known.0).abs() > 1e-6 * dt {
                known = (dt, solver(&stiffness, dt));
            }
            let mut push = self.inertia.component_mul(&self.turned(&twist, dt));
            let moved = |i: usize| segment.angle[i][k] - segment.angle[i][k - 1];
            for i in 0..n {
                push += rows[i] * (stiffness[i] * moved(i));
            }
            twist = known.1 * push;
            for i in 0..n {
                lost[i][k] = lost[i][k - 1] + moved(i) - rows[i].dot(&twist) * dt;
            }
        }
        lost
    }

    /// What contacts lose that hold no more than friction lets them. Speeds are smoothed: a count more or less in a tick
    /// would be a force beyond any friction.
    fn slipped(&self, mut grip: Grip, segment: &Segment) -> Vec<Vec<f64>> {
        let (n, ticks) = (segment.speed.len(), segment.t.len());
        let mut lost = vec![vec![0.0; ticks]; n];
        let mut twist = self.start(segment);
        let [mut held, mut speeds, mut missing] = [(); 3].map(|()| vec![0.0; n]);
        let mut contacts = Contacts::default();
        for k in 1..ticks {
            let dt = segment.t[k] - segment.t[k - 1];
            lost.iter_mut().for_each(|lost| lost[k] = lost[k - 1]);
            grip.hold(&mut held);
            speeds.iter_mut().zip(&segment.speed).for_each(|(to, of)| *to = of[k]);
            let free = self.turned(&twist, dt);
            for ((missing, row), speed) in missing.iter_mut().zip(&self.rows).zip(&speeds) {
                *missing = speed - row.dot(&free);
            }
            // Mostly friction can give what it takes to end every wheel's slip.
            if !self.creep.is_any() && grip.takes(&missing, &held, dt) {
                twist = as_vector(self.geometry.twist(&speeds));
                grip.moves(&twist, &free, dt);
                continue;
            }
            // Otherwise each wheel takes what it needs, or what friction can give.
            let steps = (dt / LONGEST_STEP_S).ceil().clamp(1.0, MOST_STEPS);
            let h = dt / steps;
            for step in 1..=steps as usize {
                let share = step as f64 / steps;
                for (to, of) in speeds.iter_mut().zip(&segment.speed) {
                    *to = of[k - 1] + share * (of[k] - of[k - 1]);
                }
                let free = self.turned(&twist, h);
                grip.hold(&mut held);
                contacts.over(self, h, &speeds);
                twist = contacts.pull(self, &speeds, &free, twist, &held);
                grip.moves(&twist, &free, h);
                for ((lost, row), speed) in lost.iter_mut().zip(&self.rows).zip(&speeds) {
                    lost[k] += (speed - row.dot(&twist)) * h;
                }
            }
        }
        lost
    }
}

/// The contacts of a body over a step of some length.
#[derive(Default)]
struct Contacts {
    h: f64,
    /// Torque at each shaft per speed that its contact lacks, Nm s/rad.
    stiffness: Vec<f64>,
    /// Speed that each contact lacks, rad/s, and how much of it a change of the twist gives.
    missing: Vec<f64>,
    gains: Vec<f64>,
    /// What a push changes of the twist where some wheels hold, by which do: mostly the same ones, step by step.
    known: Vec<(u64, Matrix3<f64>)>,
}

impl Contacts {
    /// For a step of a length, s, of wheels that turn at some speeds.
    fn over(&mut self, body: &Body, h: f64, speeds: &[f64]) {
        let creeps = body.creep.is_any();
        // A creep that grows with speed is another at each step.
        let same = h.to_bits() == self.h.to_bits() && body.creep.per_n == 0.0;
        if same {
            return;
        }
        self.h = h;
        self.known.clear();
        for of in [&mut self.stiffness, &mut self.missing, &mut self.gains] {
            of.resize(speeds.len(), 0.0);
        }
        if creeps {
            body.stiffness(speeds.iter().copied(), &mut self.stiffness);
        }
        for (stiffness, response) in self.stiffness.iter_mut().zip(&body.response) {
            let yields = if creeps { 1.0 / *stiffness } else { 0.0 };
            *stiffness = 1.0 / (yields + CREEPS * response * h);
        }
    }

    /// The twist after a step of implicit Euler from `free`, sought from `twist` on, of wheels that turn at some speeds and hold
    /// so much torque: where a convex function that is quadratic piece by piece is least. Newton steps, shortened where they
    /// would climb again, find it in a few.
    fn pull(
        &mut self,
        body: &Body,
        speeds: &[f64],
        free: &Vector3<f64>,
        mut twist: Vector3<f64>,
        held: &[f64],
    ) -> Vector3<f64> {
        let mut among = None;
        for _ in 0..STEPS {
            let mut left = body.inertia.component_mul(&(twist - free));
            let (mut rolls, mut ahead) = (0_u64, 0_u64);
            for (i, row) in body.rows.iter().enumerate() {
                let missing = speeds[i] - row.dot(&twist);
                let torque = self.stiffness[i] * missing;
                let bit = 1 << (i % 64);
                if torque.abs() <= held[i] {
                    rolls |= bit;
                } else if torque > 0.0 {
                    ahead |= bit;
                }
                self.missing[i] = missing;
                left -= row * (self.h * torque.clamp(-held[i], held[i]));
            }
            // A full step among the same wheels that hold was exact.
            if among == Some((rolls, ahead)) {
                break;
            }
            let Some(change) = self.yields(body, rolls).map(|per| per * -left) else { break };
            let share = self.descends(body, held, &left, &change);
            twist += share * change;
            if change.amax() < EXACT {
                break;
            }
            among = (share == 1.0).then_some((rolls, ahead));
        }
        twist
    }

    /// Share of a change of the twist, 1 at most, along which what is sought gets less.
    fn descends(&mut self, body: &Body, held: &[f64], left: &Vector3<f64>, change: &Vector3<f64>) -> f64 {
        for (gains, row) in self.gains.iter_mut().zip(&body.rows) {
            *gains = row.dot(change);
        }
        let (slope, bends) = (left.dot(change), body.inertia.component_mul(change).dot(change));
        let (h, stiffness, missing, gains) = (self.h, &self.stiffness, &self.missing, &self.gains);
        let torque = |i: usize, share: f64| (stiffness[i] * (missing[i] - share * gains[i])).clamp(-held[i], held[i]);
        let climbs = |share: f64| {
            let less = |i: usize| gains[i] * (torque(i, 0.0) - torque(i, share));
            slope + share * bends + h * (0..gains.len()).map(less).sum::<f64>()
        };
        let whole = climbs(1.0);
        if whole <= 0.0 {
            return 1.0;
        }
        // A straight line from kink to kink.
        let kinks = (0..gains.len()).flat_map(|i| {
            let slips = held[i] / stiffness[i];
            [missing[i] - slips, missing[i] + slips].map(|at| at / gains[i])
        });
        let (mut below, mut above) = ([0.0, slope], [1.0, whole]);
        for kink in kinks {
            if kink > below[0] && kink < above[0] {
                let here = climbs(kink);
                *(if here <= 0.0 { &mut below } else { &mut above }) = [kink, here];
            }
        }
        below[0] - below[1] * (above[0] - below[0]) / (above[1] - below[1])
    }

    /// What a push changes of the twist where some wheels hold.
    fn yields(&mut self, body: &Body, rolls: u64) -> Option<Matrix3<f64>> {
        if let Some((_, known)) = self.known.iter().find(|(of, _)| *of == rolls) {
            return Some(*known);
        }
        let held = (0..body.rows.len()).filter(|i| rolls >> (i % 64) & 1 == 1);
        let pull = held.map(|i| body.rows[i] * body.rows[i].transpose() * (self.h * self.stiffness[i]));
        let slope = Matrix3::from_diagonal(&body.inertia) + pull.sum::<Matrix3<f64>>();
        let yields = body.geometry.invert_allowed(&slope)?;
        self.known.push((rolls, yields));
        Some(yields)
    }
}

/// What friction holds.
struct Grip {
    /// Torque impulses at the wheels, kg m²/s, that take a change of wheel speeds: the least ones.
    inertia: Vec<Vec<f64>>,
    weight: Weight,
    /// Torque that friction holds per load of each wheel, m. A roller passes on what pushes along its own axis alone: its
    /// wheel's torque has that force's part across the axle.
    per_load: Vec<f64>,
}

impl Grip {
    fn new(floor: &Floor, mu: f64) -> Option<Self> {
        let ([mass, _], [x, y, height]) = (floor.masses, floor.centre_m);
        let per_load = floor.wheels.iter().map(|w| mu * floor.wheel_radius_m * w.roller_rad.cos()).collect();
        let geometry = Geometry::new(floor.wheels.clone(), floor.wheel_radius_m).ok()?;
        let inertia = least_impulses(&geometry, floor.masses)?;
        let inertia = inertia.row_iter().map(|r| r.iter().copied().collect()).collect();
        Some(Self { inertia, weight: Weight::new(&floor.wheels, mass, [x, y], height), per_load })
    }

    /// Torque that each wheel holds, Nm.
    fn hold(&self, held: &mut [f64]) {
        for (i, (held, per_load)) in held.iter_mut().zip(&self.per_load).enumerate() {
            *held = per_load * self.weight.on(i);
        }
    }

    /// Whether wheels that hold so much pass on what ends what they miss within a tick.
    fn takes(&self, missing: &[f64], held: &[f64], dt: f64) -> bool {
        let needed = |row: &Vec<f64>| row.iter().zip(missing).map(|(m, x)| m * x).sum::<f64>();
        self.inertia.iter().zip(held).all(|(row, held)| needed(row).abs() <= held * dt)
    }

    /// Contacts took the body from one twist to another.
    fn moves(&mut self, twist: &Vector3<f64>, free: &Vector3<f64>, dt: f64) {
        self.weight.shift([(twist.x - free.x) / dt, (twist.y - free.y) / dt], dt);
    }
}

/// The least torque impulses at the wheels, kg m²/s, that take a change of wheel speeds: of a robot without its rotors, for
/// how those turn is measured. `None` for masses that no robot has.
fn least_impulses(geometry: &Geometry, [mass, yaw]: [f64; 2]) -> Option<DMatrix<f64>> {
    let rows = DMatrix::from_fn(geometry.inverse().nrows(), 3, |i, j| geometry.inverse()[(i, j)]);
    let body = [mass, mass, yaw];
    if body.iter().any(|m| m.is_nan() || *m <= 0.0) {
        return None;
    }
    // Nothing turns the wheels of a differential drive by a sideways motion but roundings.
    let twist = twist_per_wheel_speed(&rows, geometry)?;
    let n = rows.nrows();
    Some(DMatrix::from_fn(n, n, |i, j| (0..3).map(|a| twist[(a, i)] * body[a] * twist[(a, j)]).sum()))
}

fn as_vector(t: Twist) -> Vector3<f64> {
    Vector3::new(t.vx, t.vy, t.omega)
}

#[cfg(test)]
mod tests {
    use model::plant::{Contact, GRAVITY, Plant};
    use runs::frames::Walk;

    use super::*;

    fn wheel(x_m: f64) -> Wheel {
        Wheel { x_m, y_m: 0.0, drive_rad: 90_f64.to_radians(), roller_rad: 0.0 }
    }

    const RADIUS: f64 = 0.03;
    const MASS: f64 = 2.0;

    /// Two wheels ahead on a floor.
    fn axle(creep: Creep, friction_coefficient: Option<f64>) -> Floor {
        let wheels = vec![wheel(0.1), wheel(-0.1)];
        Floor { creep, friction_coefficient, wheels, wheel_radius_m: RADIUS, masses: [MASS, 0.01], centre_m: [0.0; 3] }
    }

    /// Two wheels that speed up evenly from rest, 2 s at 1 kHz.
    fn spun_up(rad_s2: f64) -> Segment {
        let ticks = |of: &dyn Fn(f64) -> f64| (0..2001).map(|k| of(0.001 * f64::from(k))).collect::<Vec<f64>>();
        Segment {
            t: ticks(&|t| t),
            angle: vec![ticks(&|t| 0.5 * rad_s2 * t * t); 2],
            speed: vec![ticks(&|t| rad_s2 * t); 2],
            ..Segment::default()
        }
    }

    /// Each wheel moves half of the mass, and the slip ratio grows by its force alone.
    #[test]
    fn creep_of_a_rolling_wheel_is_a_part_of_its_way() {
        let (per_n, segment) = (0.01, spun_up(20.0));
        let lost = axle(Creep { s_per_kg: 0.0, per_n }, None).lost(&segment).unwrap();
        // Of its way each loses the slip ratio, which the force of the slower body is less by itself.
        let ratio = per_n * 0.5 * MASS * RADIUS * 20.0;
        let expected = ratio / (1.0 + ratio) * segment.angle[0][2000];
        assert!((lost[0][2000] / expected - 1.0).abs() < 0.01, "{} {expected}", lost[0][2000]);
    }

    /// Below what friction holds contacts creep as on any floor; beyond, the body moves as friction lets it.
    #[test]
    fn a_contact_creeps_up_to_what_friction_holds_and_no_further() {
        let creep = Creep::at_rest(0.004);
        let (slow, mu) = (spun_up(100.0), 0.5);
        let free = axle(creep, None).lost(&slow).unwrap()[0][2000];
        let held = axle(creep, Some(mu)).lost(&slow).unwrap()[0][2000];
        // By half a tick, as speeds are smoothed and angles are not.
        assert!(free > 0.1 && (held / free - 1.0).abs() < 0.03, "{held} {free}");
        let fast = spun_up(300.0);
        for creep in [creep, Creep::default()] {
            let lost = axle(creep, Some(mu)).lost(&fast).unwrap()[0][2000];
            let rolled = RADIUS * (fast.angle[0][2000] - lost);
            assert!((rolled / (0.5 * mu * GRAVITY * 4.0) - 1.0).abs() < 0.01, "{rolled}");
        }
    }

    #[test]
    fn two_wheels_on_an_axle_creep_by_no_force_on_a_circle() {
        let turned = |speed: f64| (0..400).map(|k| 0.01 * speed * f64::from(k)).collect::<Vec<f64>>();
        let speeds = [10.0, 6.0];
        let segment = Segment {
            t: turned(1.0),
            angle: speeds.map(turned).to_vec(),
            speed: speeds.map(|speed| vec![speed; 400]).to_vec(),
            ..Segment::default()
        };
        // What the floor gives across the axle holds it there.
        let lost = axle(Creep::at_rest(0.01), None).lost(&segment).unwrap().concat();
        let most = lost.into_iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(most < 1e-6, "{most} rad");
    }

    /// What the least impulses that take a change of wheel speeds change of them.
    fn changed(geometry: &Geometry, masses: [f64; 2]) -> DMatrix<f64> {
        let rows = DMatrix::from_fn(geometry.wheel_count(), 3, |i, a| geometry.inverse()[(i, a)]);
        let body = DMatrix::from_diagonal(&nalgebra::dvector![masses[0], masses[0], masses[1]].map(|m: f64| 1.0 / m));
        &rows * body * rows.transpose() * least_impulses(geometry, masses).unwrap()
    }

    #[test]
    fn a_push_moves_the_body_as_newton_says() {
        let geometry = runs::robot::Robot::racbot().geometry().unwrap();
        // What impulses give is the change of speed they were asked for.
        let both = changed(&geometry, [2.0, 0.01]);
        assert!((&both - DMatrix::identity(3, 3)).abs().max() < 1e-12, "{both}");
    }

    #[test]
    fn four_wheels_have_no_stiffness_where_no_body_moves() {
        let wheel = |k: usize| {
            let at = std::f64::consts::FRAC_PI_4 * (2 * k + 1) as f64;
            let drive_rad = at + std::f64::consts::FRAC_PI_2;
            Wheel { x_m: 0.08 * at.cos(), y_m: 0.08 * at.sin(), drive_rad, roller_rad: 0.0 }
        };
        let geometry = Geometry::new((0..4).map(wheel).collect(), RADIUS).unwrap();
        let both = changed(&geometry, [2.0, 0.01]);
        // A projection of rank 3, and nothing blown up beside it.
        assert!((&both * &both - &both).abs().max() < 1e-9 && (both.trace() - 3.0).abs() < 1e-9, "{both}");
        assert!(least_impulses(&geometry, [2.0, 0.01]).unwrap().amax() < 1e-2);
    }

    #[test]
    fn two_wheels_on_an_axle_share_what_moves_them() {
        let geometry = Geometry::new(vec![wheel(0.045), wheel(-0.045)], RADIUS).unwrap();
        let both = changed(&geometry, [MASS, 0.01]);
        assert!((&both - DMatrix::identity(2, 2)).abs().max() < 1e-9, "{both}");
        let inertia = least_impulses(&geometry, [MASS, 0.01]).unwrap();
        // Ahead each moves a half of the mass.
        let half = 0.5 * MASS * RADIUS.powi(2);
        assert!((inertia.row(0).sum() / half - 1.0).abs() < 1e-9, "{inertia} {half}");
        assert!(least_impulses(&geometry, [0.0, 0.01]).is_none());
    }

    /// Three wheels of the simulated robot that spin and brake beyond what the floor holds, by their true angles.
    #[test]
    fn slip_is_that_of_the_simulator() {
        let robot = runs::robot::Robot::racbot();
        let creep = Creep::at_rest(1e-4);
        let contact = Contact::Friction { friction_coefficient: 0.2, creep };
        let mut plant = Plant::new(&robot).unwrap().with_contact(contact);
        let (dt, ticks) = (0.002, 1500);
        let mut segment = Segment { angle: vec![Vec::new(); 3], speed: vec![Vec::new(); 3], ..Segment::default() };
        let mut poses = Vec::new();
        for k in 0..ticks {
            segment.t.push(dt * f64::from(k));
            for (i, (speed, counts)) in plant.wheel_speeds().zip(plant.encoder_after()).enumerate() {
                segment.angle[i].push(counts / robot.counts_per_wheel_rad());
                segment.speed[i].push(speed);
            }
            poses.push(plant.pose());
            let phase = f64::from(k / 250);
            let duty = [0, 1, 2].map(|i| 0.9 * (2.0 * phase + 1.3 * f64::from(i) + 0.5).sin());
            plant.step(&duty, robot.supply_v, dt);
        }
        let wheels = robot.layout.wheels();
        let masses = [robot.mass_kg, robot.yaw_inertia_kg_m2];
        let (wheel_radius_m, centre_m) = (robot.wheel_radius_m, [0.0; 3]);
        let floor = Floor {
            creep: Creep::default(),
            friction_coefficient: Some(0.2),
            wheels,
            wheel_radius_m,
            masses,
            centre_m,
        };
        let lost = floor.lost(&segment).unwrap();
        let geometry = robot.geometry().unwrap();
        let mut walk = Walk::from(poses[0]);
        let mut worst: f64 = 0.0;
        for k in 1..poses.len() {
            let rolled: Vec<f64> =
                (0..3).map(|i| segment.angle[i][k] - segment.angle[i][k - 1] - (lost[i][k] - lost[i][k - 1])).collect();
            walk.step(geometry.twist(&rolled));
            let (p, q) = (walk.pose(), poses[k]);
            worst = worst.max((p.x - q.x).hypot(p.y - q.y));
        }
        let way: f64 = poses.windows(2).map(|p| (p[1].x - p[0].x).hypot(p[1].y - p[0].y)).sum();
        let slipped = lost.iter().map(|l| l[l.len() - 1].abs()).fold(0.0, f64::max);
        assert!(slipped > 5.0 && worst < 0.01 * way, "{slipped} rad, {worst} of {way} m");
    }
}
