//! Effects between duty and counts that are not friction: electrics, inertia, gear play, the slope of the floor.

use super::{Entry, Found, Hand, Link};
use rand::RngExt;

const fn entry(name: &'static str, sizes: [f64; 5], meaning: &'static str, hide: fn(&mut Hand<'_>) -> Found) -> Entry {
    Entry { name, link: Link::Drive, sizes, meaning, hide }
}

pub(super) const DRIVE: &[Entry] = &[
    entry(
        "gear-backlash",
        [0.01, 0.02, 0.04, 0.08, 0.15],
        "play_rad at the motor shaft, one wheel or all; the nominal gain is then 0.3 of the usual one",
        |hand| {
            let wheels = hand.one_or_all();
            for &i in &wheels {
                hand.machine.wheels[i].play_rad = hand.value;
            }
            // With the usual gain a rotor that is free inside its play swings from rail to rail; nobody leaves it so.
            hand.robot.soften();
            hand.machine.controller.kp = hand.robot.kp;
            Found::on(wheels, [("play_rad", hand.value)])
        },
    ),
    entry("dead-band", [0.01, 0.02, 0.04, 0.08, 0.15], "duty that the bridge swallows", |hand| {
        hand.machine.power.dead_band = hand.value;
        Found::whole([("duty", hand.value)])
    }),
    entry("drive-curve", [0.05, 0.10, 0.20, 0.35, 0.50], "curvature c of u·(1 + c·(|u| − 1))", |hand| {
        let sign = if hand.rng.random_bool(0.7) { 1.0 } else { -1.0 };
        hand.machine.power.curvature = sign * hand.value;
        Found::whole([("curvature", hand.machine.power.curvature)])
    }),
    entry("torque-constant", [0.03, 0.06, 0.10, 0.18, 0.30], "scale (relative), back-EMF with it", |hand| {
        let scale = hand.signed();
        hand.machine.power.torque_constant *= 1.0 + scale;
        Found::whole([("scale", scale)])
    }),
    entry("winding-resistance", [0.05, 0.10, 0.18, 0.30, 0.60], "scale (relative), windings and cables", |hand| {
        let scale = hand.signed();
        hand.machine.power.resistance_ohm *= 1.0 + scale;
        Found::whole([("scale", scale)])
    }),
    entry(
        "battery-sag",
        [0.09, 0.15, 0.30, 0.55, 1.00],
        "resistance_ohm in all (the usual 0.05 included) and drop_v at rest; supply_v is then not measured",
        |hand| {
            let drop = if hand.rng.random_bool(0.4) { hand.rng.random_range(0.1..0.5) } else { 0.0 };
            hand.machine.power.battery_ohm = hand.value;
            hand.machine.power.open_v -= drop;
            hand.machine.power.supply_measured = false;
            Found::whole([("resistance_ohm", hand.value), ("drop_v", drop)])
        },
    ),
    entry(
        "motor-heating",
        [0.0008, 0.0025, 0.008, 0.025, 0.07],
        "rise_per_j: relative growth of the winding resistance per joule of its heat; cooling_s",
        |hand| {
            let cooling = hand.rng.random_range(15.0..40.0);
            hand.machine.power.heating_per_j = hand.value;
            hand.machine.power.cooling_s = cooling;
            Found::whole([("rise_per_j", hand.value), ("cooling_s", cooling)])
        },
    ),
    entry("robot-mass", [0.03, 0.06, 0.10, 0.20, 0.35], "scale (relative)", |hand| {
        let scale = hand.signed();
        hand.machine.mass_kg *= 1.0 + scale;
        Found::whole([("scale", scale)])
    }),
    entry("yaw-inertia", [0.08, 0.15, 0.25, 0.40, 0.60], "scale (relative)", |hand| {
        let scale = hand.signed();
        hand.machine.yaw_inertia_kg_m2 *= 1.0 + scale;
        Found::whole([("scale", scale)])
    }),
    entry(
        "rotor-inertia",
        [0.6, 1.2, 2.5, 5.0, 10.0],
        "scale (relative); small against the robot's mass, so below detection on the floor up to size 2 or 3; \
         a tenth of it on blocks",
        |hand| {
            let scale = hand.value * if hand.robot.blocks { 0.1 } else { 1.0 };
            hand.machine.power.rotor_inertia *= 1.0 + scale;
            Found::whole([("scale", scale)])
        },
    ),
    entry("centre-of-mass", [0.001, 0.003, 0.007, 0.015, 0.03], "length of (x_m, y_m), body frame", |hand| {
        let (sin, cos) = hand.angle().sin_cos();
        let offset = [hand.value * cos, hand.value * sin];
        hand.machine.centre_of_mass_m = offset;
        Found::whole([("x_m", offset[0]), ("y_m", offset[1])])
    }),
    entry(
        "floor-tilt",
        [0.002, 0.005, 0.012, 0.03, 0.05],
        "length of (x_rad, y_rad), world, downhill positive",
        |hand| {
            let (sin, cos) = hand.angle().sin_cos();
            let slope = [hand.value * cos, hand.value * sin];
            hand.machine.ground.tilt_rad = slope;
            Found::whole([("x_rad", slope[0]), ("y_rad", slope[1])])
        },
    ),
    entry("actuation-latency", [0.001, 0.002, 0.004, 0.008, 0.015], "latency_s from the tick to the voltage", |hand| {
        hand.machine.power.actuation_latency_s = hand.value;
        Found::whole([("latency_s", hand.value)])
    }),
];
