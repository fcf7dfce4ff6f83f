use super::*;
use crate::pi::SpeedLoop;
use runs::frames::wrap_angle;
use runs::robot::Layout;

const GRIPPY: Contact = Contact::Friction { friction_coefficient: 0.6, creep: Creep::at_rest(0.001) };

/// A contact that creeps as it rolls gives way by nothing at rest, and by as much as another one at some speed.
#[test]
fn creep_goes_with_time_or_with_the_way() {
    let rolled = Creep { s_per_kg: 0.0, per_n: 0.01 };
    assert!(rolled.at(0.0) < 2e-5 && (rolled.at(-0.5) / 0.005 - 1.0).abs() < 0.01);
    assert_eq!(Creep::at_rest(0.004).at(3.0), 0.004);
    assert!(rolled.is_any() && !Creep::default().is_any());
}

fn lossless() -> Robot {
    let mut robot = Robot { gear_efficiency: 1.0, ..Robot::racbot() };
    robot.motor.friction_torque = 0.0;
    robot
}

fn plants(robot: &Robot) -> [Plant; 2] {
    let plant = Plant::new(robot).unwrap();
    [plant.clone(), plant.with_contact(GRIPPY)]
}

#[test]
fn forward_drive_follows_the_textbook_exponential() {
    // Equal and opposite duty on the rear wheels drives forward. By hand: w = c·v with
    // c = cos 30°/r on two wheels; m_eff = m + 2·J·c²; damping 2·b·c²; force 2·c·τ.
    let robot = lossless();
    let axis = Axis::of(&robot);
    let c = (3.0_f64.sqrt() / 2.0) / robot.wheel_radius_m;
    let mass = robot.mass_kg + 2.0 * axis.inertia() * c * c;
    let damping = 2.0 * axis.damping * c * c;
    let force = 2.0 * c * axis.winding_torque(0.5 * 7.2, 0.0);
    let mut plant = Plant::new(&robot).unwrap();
    for _ in 0..1000 {
        plant.step(&[0.0, 0.5, -0.5], 7.2, 0.001);
    }
    let v = force / damping * (1.0 - (-damping / mass).exp());
    assert!((plant.twist().vy - v).abs() < 1e-3 * v, "{} instead of {v}", plant.twist().vy);
    let path = force / damping * (1.0 - mass / damping * (1.0 - (-damping / mass).exp()));
    assert!((plant.pose().y - path).abs() < 1e-3 * path, "{} instead of {path}", plant.pose().y);
    let turns = path * c * robot.counts_per_wheel_rad();
    assert!((plant.encoder_after()[1] - turns).abs() < 1e-3 * turns);
}

#[test]
fn blocks_reach_the_no_load_speed_of_the_data_sheet() {
    let robot = Robot { support: Support::Blocks, ..Robot::racbot() };
    let mut plant = Plant::new(&robot).unwrap();
    for _ in 0..300 {
        plant.step(&[1.0, -0.5, 0.0], 7.2, 0.001);
    }
    let axis = Axis::of(&robot);
    let speeds: Vec<f64> = plant.wheel_speeds().collect();
    // Without a load beyond the gear only the motor's own friction is left.
    let expected = (axis.winding_torque(7.2, 0.0) - axis.coulomb) / axis.damping;
    assert!((speeds[0] - expected).abs() < 1e-6 * expected, "{} instead of {expected}", speeds[0]);
    assert!(speeds[1] < 0.0 && speeds[2] == 0.0);
    assert_eq!(plant.pose(), Pose::default());
    assert!(
        (plant.encoder_after()[0] - plant.encoder_before()[0] - expected * 0.001 * robot.counts_per_wheel_rad()).abs()
            < 1e-3
    );
}

#[test]
fn a_load_beyond_the_gear_is_accelerated_with_the_gears_loss() {
    let robot = Robot { support: Support::Blocks, wheel_inertia_kg_m2: 1e-4, ..lossless() };
    let lossy = Robot { gear_efficiency: 0.8, ..robot.clone() };
    let speed = |robot: &Robot| {
        let mut plant = Plant::new(robot).unwrap();
        plant.step(&[1.0; 3], 7.2, 0.001);
        plant.wheel_speeds().next().unwrap()
    };
    // J_load ẇ = η (τ − J_rotor ẇ); the damping is negligible in the first millisecond.
    let axis = Axis::of(&robot);
    let torque = axis.winding_torque(7.2, 0.0);
    for (robot, eta) in [(&robot, 1.0), (&lossy, 0.8)] {
        let expected = 0.001 * eta * torque / (1e-4 + eta * axis.rotor_inertia);
        assert!((speed(robot) / expected - 1.0).abs() < 0.005, "{} instead of {expected}", speed(robot));
    }
}

#[test]
fn shorted_motors_only_ever_lose_energy() {
    let start = Twist::new(0.9, -0.6, 12.0);
    for robot in [Robot::racbot(), lossless()] {
        for plant in plants(&robot) {
            let mut plant = plant.moving(start);
            let mut energy = plant.kinetic_energy();
            for _ in 0..5000 {
                plant.step(&[0.0; 3], 7.2, 0.001);
                assert!(plant.kinetic_energy() <= energy * (1.0 + 1e-12));
                energy = plant.kinetic_energy();
            }
        }
    }
}

#[test]
fn a_thrown_robot_flies_straight_while_it_spins() {
    // Almost no damping and no wheel inertia: only Coriolis terms are left, and in the world frame
    // the velocity must not change.
    let mut robot = lossless();
    robot.motor.resistance_ohm = 1e4;
    robot.motor.rotor_inertia = 1e-12;
    let start = Twist::new(1.0, 0.5, 9.0);
    for plant in plants(&robot) {
        let mut plant = plant.moving(start);
        for _ in 0..2000 {
            plant.step(&[0.0; 3], 7.2, 0.001);
        }
        let p = plant.pose();
        assert!((p.theta - 18.0).abs() < 0.01, "{p:?}");
        assert!((p.x - 2.0).abs() < 2e-3 && (p.y - 1.0).abs() < 2e-3, "{p:?}");
    }
}

#[test]
fn friction_holds_without_chatter_and_stops_for_good() {
    let robot = Robot::racbot();
    let axis = Axis::of(&robot);
    // Just below what the motor's friction holds (the gear adds to it).
    let below = 0.99 * axis.coulomb / (axis.torque_per_volt * 7.2);
    for plant in plants(&robot) {
        let mut held = plant.clone();
        for k in 0..1000 {
            let sign = if k % 7 < 3 { 1.0 } else { -1.0 };
            held.step(&[below * sign, -below, below], 7.2, 0.001);
        }
        assert!(held.pose().distance(Pose::default()) < 1e-9 && held.twist().speed() < 1e-9, "{:?}", held.twist());
        let mut pushed = plant.moving(Twist::new(0.05, 0.02, 0.3));
        let mut stopped_at = None;
        for k in 0..5000 {
            pushed.step(&[0.0; 3], 7.2, 0.001);
            let speed = pushed.wheel_speeds().map(f64::abs).fold(0.0, f64::max);
            if speed < 1e-9 && stopped_at.is_none() {
                stopped_at = Some((k, pushed.pose()));
            }
        }
        let (k, pose) = stopped_at.expect("the robot stops");
        assert!(k > 100 && k < 4000, "{k}");
        assert!(pushed.pose().distance(pose) < 1e-6);
    }
}

#[test]
fn a_firm_contact_moves_like_rolling() {
    let [mut rolling, mut firm] = plants(&Robot::racbot());
    firm = firm.with_contact(Contact::Friction { friction_coefficient: 5.0, creep: Creep::at_rest(1e-5) });
    for k in 0..1500 {
        let a = f64::from(k) * 0.004;
        let duty = [0.3 * a.sin(), 0.35 * (a * 1.3).cos(), -0.2];
        rolling.step(&duty, 7.2, 0.001);
        firm.step(&duty, 7.2, 0.001);
    }
    assert!(rolling.pose().distance(Pose::default()) > 0.1);
    assert!(rolling.pose().distance(firm.pose()) < 1e-3, "{:?} {:?}", rolling.pose(), firm.pose());
}

#[test]
fn grip_limits_the_acceleration() {
    let mu = 0.1;
    let contact = Contact::Friction { friction_coefficient: mu, creep: Creep::at_rest(0.001) };
    let mut plant = Plant::new(&Robot::racbot()).unwrap().with_contact(contact);
    for _ in 0..100 {
        plant.step(&[0.0, 1.0, -1.0], 7.2, 0.001);
    }
    // Two wheels at 30° from forward carry a third of the weight each.
    let limit = 2.0 / 3.0 * mu * GRAVITY * 3.0_f64.sqrt() / 2.0;
    assert!((plant.twist().vy / (limit * 0.1) - 1.0).abs() < 0.02, "{}", plant.twist().vy);
    let surface = plant.wheel_speeds().nth(1).unwrap() * 0.0275;
    assert!(surface > 2.0 * plant.twist().vy, "the wheel spins: {surface}");
}

#[test]
fn creep_is_slip_in_proportion_to_force() {
    let mut robot = lossless();
    robot.motor.rotor_inertia = 1e-12;
    let creep = 0.01;
    let contact = Contact::Friction { friction_coefficient: 5.0, creep: Creep::at_rest(creep) };
    let mut plant = Plant::new(&robot).unwrap().with_contact(contact);
    for _ in 0..50 {
        plant.step(&[0.0, 0.3, -0.3], 7.2, 0.001);
    }
    let axis = Axis::of(&robot);
    let speed = plant.wheel_speeds().nth(1).unwrap();
    let force = axis.winding_torque(0.3 * 7.2, speed) / robot.wheel_radius_m;
    let slip = robot.wheel_radius_m * speed - plant.geometry().wheel_speed(1, plant.twist()) * robot.wheel_radius_m;
    assert!((slip / (creep * force) - 1.0).abs() < 0.02, "{slip} instead of {}", creep * force);
}

#[test]
fn the_internal_step_is_fine_enough() {
    let drive = |dt: f64| {
        let mut plant = Plant::new(&Robot::racbot()).unwrap();
        let steps = (1.0 / dt).round() as usize;
        for k in 0..steps {
            let a = 3.0 * k as f64 * dt;
            // The duty is held over a millisecond in either case.
            let a = (a * 1000.0 / 3.0).floor() * 3.0 / 1000.0;
            plant.step(&[0.4 * a.sin(), 0.5, -0.4 * a.cos()], 7.2, dt);
        }
        plant.pose()
    };
    let (usual, fine) = (drive(1e-3), drive(1e-5));
    assert!(usual.distance(fine) < 1e-4 && wrap_angle(usual.theta - fine.theta).abs() < 3e-3, "{usual:?} {fine:?}");
}

/// Duties that push and brake, at a tick.
fn shove(tick: usize) -> [f64; 3] {
    let a = 0.004 * tick as f64;
    [0.6 + 0.3 * (3.0 * a).sin(), -0.5 + 0.4 * (2.0 * a).cos(), if tick % 200 < 100 { 0.7 } else { 0.1 }]
}

/// The equations of motion of a plant without deviations whose wheels turn: change of its twist a second, at a twist.
fn accelerations(plant: &Plant, twist: Vector3<f64>) -> Vector3<f64> {
    let rows: Vec<_> = plant.contacts.iter().map(|contact| contact.row / contact.lever).collect();
    let spin: nalgebra::Matrix3<f64> = rows.iter().zip(&plant.axes).map(|(r, a)| r * r.transpose() * a.inertia()).sum();
    let inverse = (plant.platform() + spin).try_inverse().unwrap();
    let frame = plant.platform() * Vector3::new(twist.z * twist.y, -twist.z * twist.x, 0.0);
    let mut rates = Vector3::zeros();
    // The gear's loss depends on the acceleration; every round is nearer by the gear's loss.
    for _ in 0..20 {
        let mut force = frame;
        for ((row, axis), wheel) in rows.iter().zip(&plant.axes).zip(&plant.wheels) {
            let speed = row.dot(&twist);
            let (winding, dry) = (wheel.drive - axis.damping * speed, axis.coulomb.copysign(speed));
            let transmitted = winding - axis.rotor_inertia * row.dot(&rates) - dry;
            force += row * (winding - axis.friction_limit(transmitted).copysign(speed));
        }
        rates = inverse * force;
    }
    rates
}

/// A step by the fourth-order Runge-Kutta method.
fn runge_kutta(plant: &mut Plant, h: f64) {
    let twist = plant.twist_vector();
    let a = accelerations(plant, twist);
    let b = accelerations(plant, twist + a * (0.5 * h));
    let c = accelerations(plant, twist + b * (0.5 * h));
    let d = accelerations(plant, twist + c * h);
    plant.move_body(twist + (a + 2.0 * b + 2.0 * c + d) * (h / 6.0), h);
}

#[test]
fn a_whole_tick_of_wheels_that_turn_on_is_nearer_than_small_steps() {
    let start = || Plant::new(&Robot::racbot()).unwrap().moving(Twist::new(-0.2, 0.9, -12.0));
    let drive = |way: &dyn Fn(&mut Plant)| {
        let mut plant = start();
        for tick in 0..500 {
            plant.energise(&shove(tick), 7.2, 1e-3);
            way(&mut plant);
        }
        plant
    };
    let fine = drive(&|plant| (0..50).for_each(|_| runge_kutta(plant, 2e-5)));
    let whole = drive(&|plant| assert!(plant.turn_on(1e-3), "a wheel stood"));
    let usual = drive(&|plant| plant.step_finely(1e-3));
    let off = |plant: &Plant| (plant.pose().distance(fine.pose()), (plant.twist().omega - fine.twist().omega).abs());
    let ((whole_m, whole_rad_s), (usual_m, usual_rad_s)) = (off(&whole), off(&usual));
    println!("{whole_m:.1e} m, {whole_rad_s:.1e} rad/s; in small steps {usual_m:.1e} m, {usual_rad_s:.1e} rad/s");
    assert!(whole_m < usual_m && whole_rad_s < usual_rad_s / 100.0);
}

#[test]
fn a_deviation_of_nothing_moves_nothing() {
    let nominal = Plant::new(&Robot::racbot()).unwrap();
    let wheels = vec![WheelDeviation { dry_nm: 1e-12, viscous_nms: -1e-14, ..WheelDeviation::default() }; 3];
    let almost = nominal.clone().with_deviations(&Deviations { wheels, ..Deviations::default() });
    let end = |mut plant: Plant| {
        (0..1000).for_each(|tick| plant.step(&shove(tick), 7.2, 1e-3));
        plant.pose()
    };
    let (nominal, almost) = (end(nominal), end(almost));
    assert!(nominal.distance(almost) < 5e-5 && (nominal.theta - almost.theta).abs() < 1e-3, "{nominal:?} {almost:?}");
}

#[test]
fn a_speed_loop_drives_the_plant_to_its_set_points() {
    let robot = Robot::racbot();
    for mut plant in plants(&robot) {
        let wanted = plant.geometry().wheel_speeds(Twist::new(0.3, 0.4, 1.0));
        let mut loops = [SpeedLoop::new(&robot); 3];
        for _ in 0..1500 {
            let counts = plant.counts();
            let duty: Vec<f64> = (0..3).map(|i| loops[i].step(wanted[i], counts[i])).collect();
            plant.step(&duty, robot.supply_v, robot.tick_s());
        }
        let t = plant.twist();
        assert!((t.vx - 0.3).abs() < 0.01 && (t.vy - 0.4).abs() < 0.01 && (t.omega - 1.0).abs() < 0.05, "{t:?}");
    }
}

#[test]
fn four_wheels_roll_and_odometry_closes() {
    let wheels = [45.0_f64, 135.0, 225.0, 315.0].map(|deg| {
        let m = deg.to_radians();
        runs::geometry::Wheel {
            x_m: 0.08 * m.cos(),
            y_m: 0.08 * m.sin(),
            drive_rad: m - std::f64::consts::FRAC_PI_2,
            roller_rad: 0.0,
        }
    });
    let robot = Robot { layout: Layout::Wheels(wheels.to_vec()), ..Robot::racbot() };
    let mut plant = Plant::new(&robot).unwrap();
    let mut odometry = Pose::default();
    for k in 0..1000 {
        let d = 0.3 + 0.2 * (f64::from(k) * 0.01).sin();
        plant.step(&[d, -0.1, -d, 0.2], 7.2, 0.001);
        let turned: Vec<f64> = plant
            .encoder_after()
            .iter()
            .zip(plant.encoder_before())
            .map(|(a, b)| (a - b) / robot.counts_per_wheel_rad())
            .collect();
        odometry = odometry.advance(plant.geometry().twist(&turned), 1.0);
    }
    assert!(plant.pose().distance(Pose::default()) > 0.1);
    assert!(plant.pose().distance(odometry) < 1e-5, "{:?} {odometry:?}", plant.pose());
}

#[test]
fn a_differential_drive_never_slides_sideways() {
    use runs::geometry::Wheel;
    let wheel = |x_m: f64| Wheel { x_m, y_m: 0.0, drive_rad: std::f64::consts::FRAC_PI_2, roller_rad: 0.0 };
    let robot = Robot { layout: Layout::Wheels(vec![wheel(0.08), wheel(-0.08)]), ..Robot::racbot() };
    for mut plant in plants(&robot) {
        for _ in 0..1500 {
            plant.step(&[0.5, 0.35], 7.2, 0.001);
            assert!(plant.twist().vx.abs() < 1e-9, "{:?}", plant.twist());
        }
        // The wheels turn by the textbook: the body drives a circle to the left.
        let speeds: Vec<f64> = plant.wheel_speeds().collect();
        let twist = plant.geometry().twist(&speeds);
        assert!(twist.omega > 0.5 && twist.vy > 0.2, "{twist:?}");
        assert!((twist.omega - plant.twist().omega).abs() < 0.02 * twist.omega, "{twist:?} {:?}", plant.twist());
    }
}

#[test]
fn a_robot_that_is_stopped_slips_until_the_floor_holds_it_again() {
    let robot = Robot::racbot();
    let grip = 0.5;
    let mut plant = Plant::new(&robot).unwrap().moving(Twist::new(0.0, 1.0, 0.0));
    plant.strike([0.01, -0.02], [0.0, -1.0], grip);
    assert_eq!((plant.pose(), plant.twist()), (Pose::new(0.01, -0.02, 0.0), Twist::default()));
    let turning = plant.wheel_speeds().fold(0.0, |most: f64, w| most.max(w.abs()));
    assert!(turning > 30.0, "the wheels are not stopped with it: {turning}");
    // A millisecond of two wheels that slip, 30 degrees from forward, with a third of the weight each.
    plant.step(&[0.0; 3], robot.supply_v, 1e-3);
    let most = grip * GRAVITY * 2.0 * (std::f64::consts::PI / 6.0).cos() / 3.0 * 1e-3;
    assert!(plant.twist().vy > 0.0 && plant.twist().vy <= most * (1.0 + 1e-9), "{:?} {most}", plant.twist());
    for _ in 0..20 {
        plant.step(&[0.0; 3], robot.supply_v, 1e-3);
    }
    let held = |plant: &Plant| {
        plant.geometry().wheel_speeds(plant.twist()).iter().zip(plant.wheel_speeds()).all(|(a, b)| (a - b).abs() < 1e-9)
    };
    assert!(held(&plant) && plant.twist().vy < 0.1, "{:?}", plant.twist());
    // Held where it is, motors that are stronger than the floor spin the wheels, and weaker ones stall.
    for (grip, spins) in [(0.1, true), (0.5, false)] {
        let mut plant = Plant::new(&robot).unwrap();
        for _ in 0..500 {
            plant.step(&[0.0, 1.0, -1.0], robot.supply_v, 1e-3);
            let [x, y] = plant.pose().rotate_to_world([plant.twist().vx, plant.twist().vy]);
            plant.strike([0.0; 2], [-x, -y], grip);
        }
        let fastest = plant.wheel_speeds().fold(0.0, |most: f64, w| most.max(w.abs()));
        assert_eq!(fastest > 50.0, spins, "{grip}: {fastest}");
        assert!(spins || fastest < 1.0, "{fastest}");
    }
    // On blocks nothing moves it.
    let mut blocks = Plant::new(&Robot { support: Support::Blocks, ..robot }).unwrap();
    blocks.strike([1.0; 2], [1.0; 2], grip);
    assert_eq!((blocks.pose(), blocks.twist()), (Pose::default(), Twist::default()));
}
