//! Friction between the motor and the ground.

use super::{Entry, Found, Hand, Link};
use rand::RngExt;

const fn entry(name: &'static str, sizes: [f64; 5], meaning: &'static str, hide: fn(&mut Hand<'_>) -> Found) -> Entry {
    Entry { name, link: Link::Drive, sizes, meaning, hide }
}

pub(super) const FRICTION: &[Entry] = &[
    entry(
        "coulomb-friction",
        [0.002, 0.004, 0.008, 0.02, 0.04],
        "torque_nm of all wheels or torque_i_nm of one, at the wheel shaft, beyond nominal",
        |hand| {
            let wheels = hand.one_or_all();
            for &i in &wheels {
                hand.machine.wheels[i].dry_nm.iter_mut().for_each(|limit| *limit += hand.value);
            }
            match wheels[..] {
                [only] => Found::on([only], []).with(format!("torque_{}_nm", only + 1), hand.value),
                _ => Found::whole([("torque_nm", hand.value)]),
            }
        },
    ),
    entry(
        "viscous-friction",
        [5.0e-5, 1.2e-4, 3.0e-4, 8.0e-4, 2.0e-3],
        "coefficient_nms, all wheels, at the wheel shaft",
        |hand| {
            hand.machine.wheels.iter_mut().for_each(|wheel| wheel.viscous_nms += hand.value);
            Found::whole([("coefficient_nms", hand.value)])
        },
    ),
    entry(
        "stribeck-friction",
        [0.002, 0.005, 0.012, 0.025, 0.045],
        "torque_nm: extra dry friction at rest, exp(−(ω/speed_rad_s)²), all wheels",
        |hand| {
            let speed = hand.rng.random_range(2.0..4.0);
            for wheel in &mut hand.machine.wheels {
                wheel.stribeck_nm = hand.value;
                wheel.stribeck_speed_rad_s = speed;
            }
            Found::whole([("torque_nm", hand.value), ("speed_rad_s", speed)])
        },
    ),
    entry(
        "asymmetric-friction",
        [0.0015, 0.004, 0.01, 0.02, 0.035],
        "torque_nm: dry friction that acts in one sense of rotation only (sense = +1 or -1), one wheel or all",
        |hand| {
            let wheels = hand.one_or_all();
            let sense = hand.sign();
            for &i in &wheels {
                hand.machine.wheels[i].dry_nm[usize::from(sense < 0.0)] += hand.value;
            }
            Found::on(wheels, [("torque_nm", hand.value), ("sense", sense)])
        },
    ),
    entry(
        "gear-efficiency",
        [0.03, 0.06, 0.12, 0.20, 0.30],
        "efficiency (absolute): this much below nominal; small sizes also above",
        |hand| {
            let up = hand.level <= 2 && hand.rng.random_bool(0.3);
            let change = if up { hand.value } else { -hand.value };
            hand.machine.power.gear_efficiency += change;
            Found::whole([("efficiency", hand.machine.power.gear_efficiency)])
        },
    ),
    entry(
        "roller-friction",
        [0.14, 0.22, 0.4, 0.8, 1.4],
        "force_n per wheel along its free direction (in place of the usual 0.05 to 0.07)",
        |hand| {
            hand.machine.wheels.iter_mut().for_each(|wheel| wheel.roller_drag_n = hand.value);
            Found::whole([("force_n", hand.value)])
        },
    ),
    entry("carpet-grain", [0.12, 0.25, 0.5, 0.9, 1.6], "force_n against motion along azimuth_rad (world)", |hand| {
        let azimuth = 0.5 * hand.angle();
        hand.machine.ground.grain_n = hand.value;
        hand.machine.ground.grain_azimuth_rad = azimuth;
        Found::whole([("force_n", hand.value), ("azimuth_rad", azimuth)])
    }),
    entry(
        "heading-drag",
        [0.002, 0.005, 0.01, 0.02, 0.035],
        "torque_nm: dry friction torque·(1 + cos(harmonic·θ − phase_rad))/2 on every wheel",
        |hand| {
            let harmonic = f64::from(hand.rng.random_range(1..=2_u8));
            let phase = hand.angle();
            hand.machine.wheels.iter_mut().for_each(|wheel| wheel.heading_drag = [hand.value, harmonic, phase]);
            Found::whole([("torque_nm", hand.value), ("harmonic", harmonic), ("phase_rad", phase)])
        },
    ),
];
