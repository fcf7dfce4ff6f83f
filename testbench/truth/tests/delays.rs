//! Delays and other layouts: what happens when, and with other wheels.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use truth::{Drive, Kind, Layout, Log, Machine, Mount, Plant, Robot, Shake, draw, simulate, simulate_run};

/// A step ahead after 0.1 s, without any noise.
fn step(change: impl Fn(&mut Machine)) -> Log {
    let robot = Robot::standard();
    let mut machine = Machine::ideal(&robot);
    change(&mut machine);
    let commands = (0..60).map(|k| if k < 20 { [0.0; 3] } else { [0.0, 0.4, 0.0] }).collect();
    let drive = Drive { name: "step".into(), commands, period_s: 0.005, start: [0.0; 3], hits: Vec::new() };
    simulate_run(&robot, &machine, &drive, 1, 0)
}

/// Ticks at which wheel 2 gets its first set point, duty and ten counts.
fn onsets(log: &Log) -> [usize; 3] {
    let first = |what: fn(&truth::Row) -> bool| log.rows.iter().position(what).unwrap_or(log.rows.len());
    [first(|row| row.refs[1] != 0.0), first(|row| row.duties[1] != 0.0), first(|row| row.counts[1].abs() >= 10)]
}

#[test]
fn every_delay_acts_where_it_belongs() {
    let [set_point, duty, counts] = onsets(&step(|_| {}));
    assert_eq!([set_point, duty], [100, 100]);
    assert!((105..125).contains(&counts), "{counts}");
    let late = onsets(&step(|m| m.controller.command_latency_s = 0.012));
    assert_eq!(late, [112, 112, counts + 12]);
    let late = onsets(&step(|m| m.controller.ref_age_ticks = 2));
    assert_eq!(late, [100, 102, counts + 2]);
    let late = onsets(&step(|m| m.power.actuation_latency_s = 0.006));
    assert_eq!([late[0], late[1]], [100, 100]);
    assert!((counts + 6).abs_diff(late[2]) <= 1, "{} after {counts}", late[2]);
    let late = onsets(&step(|m| m.power.encoder_lag_s = 0.006));
    assert!((counts + 6).abs_diff(late[2]) <= 1, "{} after {counts}", late[2]);
}

#[test]
fn commands_reach_set_points_late_by_the_hidden_latency() {
    let case = draw(6, &"single:command-latency:4".parse::<Kind>().unwrap()).unwrap();
    let ticks = (case.effects[0].parameters["latency_s"] * case.robot.control_rate_hz).round() as usize;
    let mounts = case.robot.mounts();
    for log in simulate(&case) {
        for (k, row) in log.rows.iter().enumerate().skip(ticks) {
            let sent = log.rows[k - ticks].command;
            for (mount, set_point) in mounts.iter().zip(&row.refs) {
                let ideal = mount.rim_speed(sent) / case.robot.wheel_radius_m;
                assert!((ideal - set_point).abs() <= 0.005 + 1e-9, "tick {k}");
            }
        }
    }
}

#[test]
fn a_mecanum_robot_moves_as_its_wheels_say() {
    let layout = [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)].map(|(side, end): (f64, f64)| Mount {
        x_m: 0.07 * side,
        y_m: 0.09 * end,
        drive_rad: -side * FRAC_PI_2,
        roller_rad: side * end * FRAC_PI_4,
    });
    let robot = Robot { layout: Layout::Listed(layout.to_vec()), ..Robot::standard() };
    let machine = Machine::ideal(&robot);
    for target in [[0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 2.0], [0.2, -0.2, 1.0]] {
        let mut plant = Plant::new(&machine, [0.0; 3], 5e-5, &[]);
        for tick in 0..1500 {
            let duty: Vec<f64> = layout
                .iter()
                .enumerate()
                .map(|(i, mount)| {
                    let wanted = mount.rim_speed(target) / robot.wheel_radius_m * (f64::from(tick) / 500.0).min(1.0);
                    (0.05 * (wanted - plant.rotor_speed(i)) + 0.004 * wanted).clamp(-1.0, 1.0)
                })
                .collect();
            for _ in 0..20 {
                plant.advance(&duty, &Shake::default());
            }
        }
        let [vx, vy, spin] = plant.twist();
        let (sin, cos) = plant.pose()[2].sin_cos();
        let body = [cos * vx + sin * vy, -sin * vx + cos * vy, spin];
        for (seen, wanted) in body.iter().zip(target) {
            assert!((seen - wanted).abs() < 0.03 + 0.1 * f64::abs(wanted), "{body:?} instead of {target:?}");
        }
        for (i, mount) in layout.iter().enumerate() {
            let ideal = mount.rim_speed(body) / robot.wheel_radius_m;
            assert!((plant.rotor_speed(i) - ideal).abs() < 0.02 * ideal.abs() + 0.05, "wheel {}", i + 1);
        }
    }
}
