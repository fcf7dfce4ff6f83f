//! What a gyroscope buys: heading and place after 5 s and 10 m without the overhead camera, and slip noticed, against
//! the wheels alone. Writes `docs/measured/inertial.md`.

use measured::Table;
use model::camera::{Camera, CameraModel};
use model::fusion::{Fusion, FusionOptions};
use model::imu::{Chassis, Imu, ImuModel};
use model::inertial::Inertial;
use model::odometry::Estimate;
use model::pi::SpeedLoop;
use model::plant::{Contact, Creep, Plant};
use runs::frames::{Pose, Twist, wrap_angle};
use runs::robot::{Layout, Robot};

const TABLE: Table<'_> = Table {
    name: "inertial",
    title: "Errors after 5 s and about 10 m without the overhead camera, 20 seeds each: root mean square and worst",
    command: "cargo test --release -p model --test inertial",
    columns: &[
        "robot and floor",
        "heading, wheels, °",
        "heading, gyroscope, °",
        "worst, wheels, °",
        "worst, gyroscope, °",
        "place, wheels, mm",
        "place, gyroscope, mm",
        "slip noticed after, ms (median)",
        "slip said without slip, % of time",
    ],
};
const SEEDS: u64 = 20;
const TICK: f64 = 0.001;
/// At rest, then with the camera, then blind for 5 s, s.
const REST_S: f64 = 1.0;
const SEEN_S: f64 = 4.0;
const END_S: f64 = 9.0;
/// A wheel slips when its contact point moves this fast against the floor, m/s.
const SLIP: f64 = 0.15;

/// What a drive came to.
struct Outcome {
    wheels: [f64; 2],
    inertial: [f64; 2],
    noticed_ms: Vec<f64>,
    /// Time in which slip was said though no wheel had slipped for a tenth of a second, and time without slip, s.
    alarm: [f64; 2],
    way: f64,
    /// Error of the gyroscope's scale, in the standard deviations that the filter states, and plainly.
    scale: [f64; 2],
}

/// Set speeds, m/s and rad/s: starts, stops and turns at 2 m/s.
fn command(t: f64, hard: bool) -> Twist {
    if t < REST_S {
        return Twist::default();
    }
    let t = t - REST_S;
    let square = |period: f64| if (t / period).fract() < 0.5 { 1.0 } else { -1.0 };
    let soft = |period: f64| (std::f64::consts::TAU * t / period).sin();
    if hard {
        Twist::new(1.0 * square(1.7), 2.0 * square(2.3), 2.5 * square(1.3))
    } else {
        Twist::new(1.0 * soft(3.1), 2.0 * soft(4.3), 1.5 * soft(2.7))
    }
}

fn drive(skew: f64, contact: Contact, hard: bool, seed: u64) -> Outcome {
    let believed = Robot::racbot();
    let sign = |k: u64| if (seed >> k) & 1 == 0 { 1.0 } else { -1.0 };
    let mut actual = believed.clone();
    let skew_rad = [0, 1, 2].map(|k| sign(k) * skew);
    actual.layout = Layout::Rac { body_radius_m: 0.085, skew_rad };
    let geometry = believed.geometry().expect("a robot that drives");
    let start = Pose::new(-1.0, -1.0, 0.3);
    let mut plant = Plant::new(&actual).expect("a robot that drives").with_contact(contact).at(start);
    let mut loops: Vec<SpeedLoop> = (0..3).map(|_| SpeedLoop::new(&believed)).collect();
    let mut camera = Camera::new(CameraModel::of(&believed), seed + 50);
    let model = ImuModel::icm_42688_p(1.0 / TICK);
    let mut imu = Imu::new(model, seed + 90);
    let options = FusionOptions::of(&believed).uncalibrated();
    let counts_per_rad = believed.counts_per_wheel_rad();
    let told = Estimate::new(start, options.camera_noise);
    let mut wheels = Fusion::new(&geometry, counts_per_rad, options, told);
    let mut inertial = Inertial::new(&geometry, counts_per_rad, options, &model, told);
    let mut chassis = Chassis::default();
    let (mut way, mut noticed_ms, mut since, mut free, mut alarm) = (0.0, Vec::new(), None, 0.0, [0.0; 2]);
    for k in 0..(END_S / TICK) as usize {
        let t = k as f64 * TICK;
        let now = plant.twist();
        let motion = chassis.motion(&plant, TICK);
        let counts = plant.counts();
        wheels.predict(t, &counts);
        inertial.predict(t, &counts, &imu.read(&motion));
        if let Some(seen) = camera.observe(t, plant.pose()).filter(|_| t < SEEN_S) {
            wheels.correct(t, seen);
            inertial.correct(t, seen);
        }
        // True slip: a contact point against the floor.
        let rolling = plant.geometry().wheel_speeds(now);
        let slip = plant
            .wheel_speeds()
            .zip(&rolling)
            .map(|(w, r)| (w - r).abs() * believed.wheel_radius_m)
            .fold(0.0, f64::max);
        free = if slip > SLIP { 0.0 } else { free + TICK };
        since = match since {
            None if slip > SLIP => Some((t, false)),
            // One slip ends when the wheels have held for a tenth of a second.
            Some(_) if free > 0.1 => None,
            other => other,
        };
        if let Some((from, false)) = since
            && inertial.slipping()
        {
            noticed_ms.push((t - from) * 1e3);
            since = Some((from, true));
        }
        if free > 0.1 {
            alarm[0] += if inertial.slipping() { TICK } else { 0.0 };
            alarm[1] += TICK;
        }
        way += if t >= SEEN_S { now.speed() * TICK } else { 0.0 };
        let speeds = geometry.wheel_speeds(command(t, hard));
        let duty: Vec<f64> = loops.iter_mut().zip(&speeds).zip(&counts).map(|((l, s), c)| l.step(*s, *c)).collect();
        plant.step(&duty, believed.supply_v, TICK);
    }
    let error = |pose: Pose| {
        let truth = plant.pose();
        [wrap_angle(pose.theta - truth.theta).to_degrees(), 1e3 * pose.distance(truth)]
    };
    let [[.., true_scale], ..] = imu.gyro_errors();
    let [scale, sd] = inertial.gyro_scale();
    let off = scale - true_scale;
    let scale = [off / sd, off];
    Outcome { wheels: error(wheels.pose()), inertial: error(inertial.pose()), noticed_ms, alarm, way, scale }
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0);
    values.for_each(|v| {
        sum += v * v;
        n += 1.0;
    });
    (sum / f64::max(n, 1.0)).sqrt()
}

/// Runs a row of the table; root mean square heading errors by wheels and gyroscope, °, and how late slip was noticed.
fn row(name: &str, skew_deg: f64, contact: Contact, hard: bool) -> ([f64; 2], Option<f64>) {
    let outcomes: Vec<Outcome> = (0..SEEDS).map(|seed| drive(skew_deg.to_radians(), contact, hard, seed)).collect();
    let of = |part: fn(&Outcome) -> f64| rms(outcomes.iter().map(part));
    let worst = |part: fn(&Outcome) -> f64| outcomes.iter().map(part).fold(0.0, |m: f64, v| m.max(v.abs()));
    let mut late: Vec<f64> = outcomes.iter().flat_map(|o| o.noticed_ms.iter().copied()).collect();
    late.sort_by(f64::total_cmp);
    let median = late.get(late.len() / 2).copied();
    let total = |i: usize| outcomes.iter().map(|o| o.alarm[i]).sum::<f64>();
    let alarm = total(0) / total(1).max(TICK);
    assert!(alarm < 0.2, "{name}: slip is said {:.0} % of the time without slip", 100.0 * alarm);
    let heading = [of(|o| o.wheels[0]), of(|o| o.inertial[0])];
    // Parts differ by 0.5 %, in turns of four seconds, and the filter knows how well it knows what is left.
    let [sds, scale] = [of(|o| o.scale[0]), of(|o| o.scale[1])];
    eprintln!("{name}: scale {scale:.5}, {sds:.2} standard deviations");
    assert!(scale < 0.001, "{name}: {scale}");
    // Twenty squares of normal numbers have this mean or less in 999 of 1000 cases (chi-square).
    assert!(sds < 1.51, "{name}: {sds}");
    let way = outcomes.iter().map(|o| o.way).sum::<f64>() / outcomes.len() as f64;
    assert!(way > 4.0, "{name}: only {way:.1} m");
    let cell = |v: f64, digits: usize| format!("{v:.digits$}");
    TABLE.check_row_within(
        &[
            name.to_owned(),
            cell(heading[0], 2),
            cell(heading[1], 2),
            cell(worst(|o| o.wheels[0]), 2),
            cell(worst(|o| o.inertial[0]), 2),
            cell(of(|o| o.wheels[1]), 0),
            cell(of(|o| o.inertial[1]), 0),
            median.map_or("no slip".to_owned(), |late| cell(late, 0)),
            cell(100.0 * alarm, 1),
        ],
        0.1,
    );
    (heading, median)
}

#[test]
fn the_gyroscope_keeps_the_heading_where_wheels_lose_it() {
    let grip = Contact::Friction { friction_coefficient: 0.6, creep: Creep::at_rest(0.000_5) };
    let ice = Contact::Friction { friction_coefficient: 0.15, creep: Creep::at_rest(0.002) };
    let rows = [
        ("calibrated, grip", 0.0, grip, false),
        ("2° of skew, grip", 2.0, grip, false),
        ("calibrated, slippery, hard starts", 0.0, ice, true),
        ("2° of skew, slippery, hard starts", 2.0, ice, true),
    ];
    for (name, skew, contact, hard) in rows {
        let ([wheels, gyroscope], late) = row(name, skew, contact, hard);
        eprintln!("{name}: {wheels:.2}° {gyroscope:.2}° slip {late:?}");
        assert!(gyroscope < 2.0, "{name}: {gyroscope:.2}°");
        if skew > 0.0 || hard {
            assert!(gyroscope < 0.5 * wheels, "{name}: {gyroscope:.2}° against {wheels:.2}°");
        }
        if hard {
            assert!(late.is_some_and(|late| late <= 50.0), "{name}: slip noticed after {late:?} ms");
        }
    }
}
