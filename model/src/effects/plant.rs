//! Effects on motors, body and floor.

use super::{Applied, of_wheel};
use crate::motor::{COPPER_PER_K, MAGNET_PER_K};
use crate::plant::{Contact, Creep, WheelDeviation};
use runs::robot::{Effect, Support};

/// Coefficient of friction where only creep is given: more than any wheel uses.
const HELD: f64 = 10.0;
/// Creep where only the friction limit is given, s/kg: stiff against every force that occurs.
const STIFF: Creep = Creep::at_rest(2e-4);

/// Applies an effect if it is one of these.
pub(super) fn apply(effect: &Effect, applied: &mut Applied) -> bool {
    on_robot(effect, applied) || on_body(effect, applied) || on_wheels(effect, applied)
}

/// What other figures in the robot's file say.
fn on_robot(effect: &Effect, applied: &mut Applied) -> bool {
    let robot = &mut applied.robot;
    let value = |name: &str| effect.value(name).unwrap_or(0.0);
    let scale = 1.0 + value("scale");
    match effect.name.as_str() {
        "supply-voltage" => {
            robot.supply_v *= scale;
            // What falls under way is the bridge's.
            return value("fall_v_per_s") == 0.0;
        }
        "torque-constant" => {
            let back_emf = robot.motor.back_emf() * scale;
            robot.motor.torque_constant *= scale;
            robot.motor.back_emf_constant = Some(back_emf);
            of_one_motor(effect, applied, |w, x| w.torque_constant = x);
        }
        "winding-resistance" => {
            robot.motor.resistance_ohm *= scale;
            of_one_motor(effect, applied, |w, x| w.resistance = x);
        }
        "robot-mass" => robot.mass_kg *= scale,
        "yaw-inertia" => robot.yaw_inertia_kg_m2 *= scale,
        "rotor-inertia" => {
            robot.motor.rotor_inertia *= scale;
            robot.wheel_inertia_kg_m2 *= if robot.support == Support::Blocks { scale } else { 1.0 };
        }
        "motor-heating" => {
            let warmer = value("start_k");
            let magnets = 1.0 - MAGNET_PER_K * warmer;
            let back_emf = robot.motor.back_emf() * magnets;
            robot.motor.resistance_ohm *= 1.0 + COPPER_PER_K * warmer;
            robot.motor.torque_constant *= magnets;
            robot.motor.back_emf_constant = Some(back_emf);
            // Warming up under way is the bridge's.
            return value("rise") == 0.0;
        }
        "gear-efficiency" => robot.gear_efficiency = (robot.gear_efficiency + value("scale")).clamp(0.01, 1.0),
        _ => return false,
    }
    true
}

/// What the motor of one wheel has beyond what `scale` does to all of them.
fn of_one_motor(effect: &Effect, applied: &mut Applied, set: fn(&mut WheelDeviation, f64)) {
    let all = 1.0 + effect.value("scale").unwrap_or(0.0);
    let n = applied.robot.wheel_count();
    for i in 0..n {
        let together = 1.0 + of_wheel(effect, "scale", i, "");
        if together != all {
            set(&mut applied.deviations.wheels_mut(n)[i], together / all - 1.0);
        }
    }
}

/// What acts on the whole robot.
fn on_body(effect: &Effect, applied: &mut Applied) -> bool {
    let d = &mut applied.deviations;
    let value = |name: &str| effect.value(name).unwrap_or(0.0);
    match effect.name.as_str() {
        "wheel-creep" => {
            let creep = Creep { s_per_kg: value("creep_s_per_kg").max(0.0), per_n: value("creep_per_n").max(0.0) };
            applied.contact = friction(applied.contact, None, Some(creep));
        }
        "wheel-slip" => {
            d.centre_height_m = value("centre_height_m");
            applied.contact = friction(applied.contact, effect.value("friction_coefficient"), None);
        }
        "centre-of-mass" => d.centre_of_mass_m = [value("x_m"), value("y_m")],
        "floor-tilt" => d.tilt_rad = [value("x_rad"), value("y_rad")],
        "roller-friction" => d.roller_friction_n = value("force_n"),
        "body-drag" => d.drag_n = value("force_n"),
        "turning-resistance" => d.turning_nm = value("torque_nm"),
        "carpet-grain" => d.grain = [value("force_n"), value("azimuth_rad")],
        "heading-drag" => {
            d.heading_drag.harmonic = effect.value("harmonic").unwrap_or(1.0);
            d.heading_drag.mean_nm = value("mean_nm");
            (d.heading_drag.cos_nm, d.heading_drag.sin_nm) = (value("cos_nm"), value("sin_nm"));
        }
        "stribeck-friction" => d.stribeck = [value("torque_nm"), effect.value("speed_rad_s").unwrap_or(3.0)],
        "dead-band" => {
            d.dead_band = (0..applied.robot.wheel_count()).map(|i| of_wheel(effect, "duty", i, "")).collect();
            d.dead_band_passes = value("passes") != 0.0;
        }
        "drive-curve" => d.curvature = value("curvature"),
        "coasting-bridge" => d.coasting = value("share"),
        "current-limit" => d.current_limit_a = value("limit_a"),
        "bridge-drop" => d.bridge_drop_v = value("drop_v"),
        "actuation-latency" => d.duty_delay_s = value("latency_s"),
        "battery-sag" => d.battery = [value("drop_v"), value("resistance_ohm")],
        "supply-voltage" => d.supply_fall_v_per_s = value("fall_v_per_s"),
        "motor-heating" => d.heating = [value("rise"), effect.value("time_s").unwrap_or(30.0)],
        "speed-filter" => d.encoder_filter_s = value("time_s"),
        "encoder-lag" => d.encoder_delay_s = value("latency_s"),
        _ => return false,
    }
    true
}

/// What each wheel has its own of.
fn on_wheels(effect: &Effect, applied: &mut Applied) -> bool {
    let n = applied.robot.wheel_count();
    let value = |name: &str| effect.value(name).unwrap_or(0.0);
    let each = |stem: &str, unit: &str| (0..n).map(|i| of_wheel(effect, stem, i, unit)).collect::<Vec<_>>();
    let set: (Vec<f64>, fn(&mut WheelDeviation, f64)) = match effect.name.as_str() {
        "wheel-radius" => (each("scale", ""), |w, x| w.radius = x),
        "encoder-scale" => (each("scale", ""), |w, x| w.encoder = x),
        "coulomb-friction" => (each("torque", "nm"), |w, x| w.dry_nm = x),
        "viscous-friction" => (each("coefficient", "nms"), |w, x| w.viscous_nms = x),
        "quadratic-drag" => (each("coefficient", "nms2"), |w, x| w.quadratic_nms2 = x),
        "gravity-load" => {
            let wheels = applied.deviations.wheels_mut(n);
            wheels.iter_mut().zip(each("sin", "nm")).for_each(|(w, x)| w.gravity_nm[0] = x);
            (each("cos", "nm"), |w, x| w.gravity_nm[1] = x)
        }
        "encoder-eccentricity" => {
            let wheels = applied.deviations.wheels_mut(n);
            wheels.iter_mut().for_each(|w| w.eccentric_order = effect.value("order").unwrap_or(1.0));
            wheels.iter_mut().zip(each("sin", "rad")).for_each(|(w, x)| w.eccentric_rad[0] = x);
            (each("cos", "rad"), |w, x| w.eccentric_rad[1] = x)
        }
        "joint-spring" => {
            let wheels = applied.deviations.wheels_mut(n);
            wheels.iter_mut().zip(each("stiffness", "nm_per_rad")).for_each(|(w, x)| w.spring_nm_per_rad = x);
            (each("preload", "nm"), |w, x| w.preload_nm = x)
        }
        "hanging-load" => (each("torque", "nm"), |w, x| w.preload_nm = x),
        "gear-backlash" => {
            let held = value("load_friction_nm");
            applied.deviations.wheels_mut(n).iter_mut().for_each(|w| w.load_friction_nm = held);
            (each("play", "rad"), |w, x| w.play_rad = x)
        }
        "asymmetric-friction" if value("sense") < 0.0 => (each("torque", "nm"), |w, x| w.one_way_nm[0] = x),
        "asymmetric-friction" => (each("torque", "nm"), |w, x| w.one_way_nm[1] = x),
        "encoder-loss" => {
            applied.deviations.loss_threshold = value("threshold_rad_s");
            (each("loss", ""), |w, x| w.loss = x)
        }
        "roller-ripple" => {
            // By cosine and sine of an order, or by the amplitude and count of an order analysis, which knows no phase.
            applied.deviations.ripple_order = value("order").max(value("count")).max(1.0);
            let on = |i: usize| effect.wheels.is_empty() || effect.wheels.contains(&(i + 1));
            let amplitude = |i: usize| if on(i) { value("amplitude") } else { 0.0 };
            let wheels = applied.deviations.wheels_mut(n);
            wheels.iter_mut().zip(each("sin", "")).for_each(|(w, x)| w.ripple[1] = x);
            (each("cos", "").into_iter().enumerate().map(|(i, x)| x + amplitude(i)).collect(), |w, x| w.ripple[0] = x)
        }
        _ => return false,
    };
    applied.deviations.wheels_mut(n).iter_mut().zip(set.0).for_each(|(w, x)| set.1(w, x));
    true
}

fn friction(contact: Contact, limit: Option<f64>, creep: Option<Creep>) -> Contact {
    let (old_limit, old_creep) = match contact {
        Contact::Rolling => (HELD, STIFF),
        Contact::Friction { friction_coefficient, creep } => (friction_coefficient, creep),
    };
    Contact::Friction {
        friction_coefficient: limit.unwrap_or(old_limit),
        creep: creep.filter(|c| c.is_any()).unwrap_or(old_creep),
    }
}
