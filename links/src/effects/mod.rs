//! The catalogue of effects on the motion and drive links, one file each.
//!
//! To add one: its file, a `mod` line and a line in [`catalogue`].

mod actuation_latency;
mod asymmetric_friction;
mod battery_sag;
mod body_drag;
mod body_radius;
mod bridge_drop;
pub mod camera_clock;
mod camera_filter;
pub mod camera_latency;
mod camera_scale;
mod camera_timing;
mod carpet_grain;
mod centre_of_mass;
mod coasting_bridge;
mod coulomb_friction;
mod current_limit;
mod dead_band;
mod drive_curve;
mod encoder_eccentricity;
mod encoder_lag;
mod encoder_loss;
mod encoder_scale;
mod fits;
mod floor_tilt;
mod gear_backlash;
mod gear_efficiency;
mod gravity_load;
mod gyro_bias;
mod gyro_scale;
mod hanging_load;
mod heading_drag;
mod imu_latency;
mod imu_mount;
mod joint_spring;
mod lens_distortion;
mod marker_heading;
mod marker_offset;
mod motor_heating;
mod odometry_curl;
mod odometry_drift;
mod probes;
mod quadratic_drag;
mod robot_mass;
mod roller_friction;
mod roller_ripple;
mod rotor_inertia;
mod sideways_creep;
mod speed_filter;
mod stribeck_friction;
mod supply_voltage;
mod torque_constant;
mod turning_resistance;
mod viscous_friction;
mod wheel_angle;
mod wheel_creep;
mod wheel_order;
mod wheel_radius;
mod wheel_radius_common;
mod wheel_skew;
mod wheel_slip;
mod winding_resistance;
mod yaw_inertia;

use model::setup::TRUE_RATIO;

use crate::effect::{Effect, Link};

pub use fits::fits;

/// By how much a size of a robot may differ from its drawing: beyond that `check` takes the drawing for another robot's.
const SIZES: [f64; 2] = [1.0 / TRUE_RATIO - 1.0, TRUE_RATIO - 1.0];

/// All effects fitted on the motion and drive links, in the order in which equals are named.
pub fn catalogue() -> Vec<Box<dyn Effect>> {
    catalogue_for(0)
}

/// The same for a data set of this many runs: some effects have parameters of each run.
pub fn catalogue_for(runs: usize) -> Vec<Box<dyn Effect>> {
    let named: Vec<Box<dyn Effect>> = vec![
        Box::new(wheel_skew::WheelSkew),
        Box::new(wheel_radius::WheelRadius),
        Box::new(wheel_radius_common::WheelRadiusCommon),
        Box::new(body_radius::BodyRadius),
        Box::new(wheel_angle::WheelAngle),
        Box::new(encoder_scale::EncoderScale { on: Link::Motion }),
        Box::new(encoder_loss::EncoderLoss),
        Box::new(encoder_lag::EncoderLag),
        Box::new(wheel_creep::WheelCreep { rolled: false }),
        Box::new(wheel_slip::WheelSlip),
        Box::new(sideways_creep::SidewaysCreep),
        Box::new(odometry_curl::OdometryCurl),
        Box::new(odometry_drift::OdometryDrift),
        Box::new(roller_ripple::RollerRipple),
        Box::new(camera_latency::CameraLatency),
        Box::new(camera_filter::CameraFilter),
        Box::new(camera_scale::CameraScale),
        Box::new(camera_timing::CameraTiming),
        Box::new(camera_clock::CameraClock { runs }),
        Box::new(marker_heading::MarkerHeading),
        Box::new(marker_offset::MarkerOffset),
        Box::new(lens_distortion::LensDistortion),
        Box::new(gyro_scale::GyroScale),
        Box::new(gyro_bias::GyroBias),
        Box::new(imu_latency::ImuLatency),
        Box::new(imu_mount::ImuMount),
        Box::new(coulomb_friction::CoulombFriction),
        Box::new(viscous_friction::ViscousFriction),
        Box::new(quadratic_drag::QuadraticDrag),
        Box::new(stribeck_friction::StribeckFriction),
        Box::new(asymmetric_friction::AsymmetricFriction),
        Box::new(gravity_load::GravityLoad),
        Box::new(hanging_load::HangingLoad),
        Box::new(joint_spring::JointSpring),
        Box::new(encoder_eccentricity::EncoderEccentricity),
        Box::new(gear_efficiency::GearEfficiency),
        Box::new(gear_backlash::GearBacklash),
        Box::new(roller_friction::RollerFriction),
        Box::new(dead_band::DeadBand),
        Box::new(bridge_drop::BridgeDrop),
        Box::new(drive_curve::DriveCurve),
        Box::new(coasting_bridge::CoastingBridge),
        Box::new(torque_constant::TorqueConstant),
        Box::new(winding_resistance::WindingResistance),
        Box::new(battery_sag::BatterySag),
        Box::new(supply_voltage::SupplyVoltage),
        Box::new(motor_heating::MotorHeating),
        Box::new(current_limit::CurrentLimit),
        Box::new(robot_mass::RobotMass),
        Box::new(yaw_inertia::YawInertia),
        Box::new(rotor_inertia::RotorInertia),
        Box::new(centre_of_mass::CentreOfMass),
        Box::new(floor_tilt::FloorTilt),
        Box::new(body_drag::BodyDrag),
        Box::new(turning_resistance::TurningResistance),
        Box::new(carpet_grain::CarpetGrain),
        Box::new(heading_drag::HeadingDrag),
        Box::new(actuation_latency::ActuationLatency),
        Box::new(speed_filter::SpeedFilter { seen: false }),
        Box::new(wheel_order::WheelOrder),
    ];
    named.into_iter().chain(probes::all()).collect()
}

/// The equation of an effect on a deterministic link.
pub fn exact_equation(name: &str) -> &'static str {
    match name {
        "command-latency" => "set point at t follows the command at t - latency_s",
        "wheel-order" => "set point i follows row |axis_i| of the inverse kinematics, inverted where negative",
        "pi-gain" => "gains of the speed loop are kp (1 + kp_scale), ki (1 + ki_scale)",
        "encoder-scale" => "the controller reckons with (1 + loop_scale) times the counts stated",
        "integrator-windup" => "the integrator is not held at saturation but stops at limit_duty",
        "quantisation" => "duties are rounded to duty_quantum",
        "sample-order" => {
            "the loop uses counts (signal 0), set points (signal 1) or both (signal 2) that are shift_ticks older than logged"
        }
        "camera-timing" => "stamps of the camera frames scatter about their capture times by jitter_s",
        _ => "",
    }
}

/// The effect called `name` in the catalogue.
pub fn find(name: &str) -> Option<Box<dyn Effect>> {
    catalogue().into_iter().find(|e| e.name() == name)
}

/// The low-pass on logged speeds, to be found between wheels and a camera, where the catalogue looks for late encoders.
pub fn filter_seen() -> Box<dyn Effect> {
    Box::new(speed_filter::SpeedFilter { seen: true })
}

/// Creep that goes with the way a wheel rolls, where the catalogue looks for one that goes with time.
pub fn rolled_creep() -> Box<dyn Effect> {
    Box::new(wheel_creep::WheelCreep { rolled: true })
}

/// Wrong counts a turn, to be found by what drives an axis alone, which no camera sees.
pub fn counts_driven() -> Box<dyn Effect> {
    Box::new(encoder_scale::EncoderScale { on: Link::Drive })
}

#[cfg(test)]
mod tests {
    use runs::robot::Robot;

    use super::*;

    /// The contract: names of parameters, `#` for a wheel's number.
    const NAMES: [(&str, &[&str]); 46] = [
        ("wheel-skew", &["skew_#_rad"]),
        ("wheel-radius", &["scale_#"]),
        ("wheel-radius-common", &["scale"]),
        ("body-radius", &["scale"]),
        ("sideways-creep", &["scale"]),
        ("odometry-curl", &["forward_rad_per_m", "sideways_rad_per_m"]),
        ("odometry-drift", &["rate_rad_s"]),
        ("encoder-scale", &["scale", "scale_#"]),
        ("camera-scale", &["scale"]),
        ("torque-constant", &["scale", "scale_#"]),
        ("winding-resistance", &["scale", "scale_#"]),
        ("robot-mass", &["scale"]),
        ("yaw-inertia", &["scale"]),
        ("rotor-inertia", &["scale"]),
        ("wheel-angle", &["angle_#_rad"]),
        ("encoder-loss", &["loss_#"]),
        ("gyro-scale", &["scale"]),
        ("gyro-bias", &["x_rad_s", "y_rad_s", "z_rad_s"]),
        ("imu-latency", &["latency_s"]),
        ("imu-mount", &["x_rad", "y_rad", "z_rad", "x_m", "y_m"]),
        ("camera-latency", &["latency_s"]),
        ("camera-filter", &["time_s"]),
        ("actuation-latency", &["latency_s"]),
        ("speed-filter", &["time_s"]),
        ("marker-heading", &["angle_rad"]),
        ("marker-offset", &["x_m", "y_m"]),
        ("centre-of-mass", &["x_m", "y_m"]),
        ("coulomb-friction", &["torque_nm", "torque_#_nm"]),
        ("gravity-load", &["sin_#_nm", "cos_#_nm"]),
        ("hanging-load", &["torque_#_nm"]),
        ("encoder-eccentricity", &["sin_#_rad", "cos_#_rad"]),
        ("joint-spring", &["stiffness_#_nm_per_rad", "preload_#_nm"]),
        ("viscous-friction", &["coefficient_nms", "coefficient_#_nms"]),
        ("quadratic-drag", &["coefficient_#_nms2"]),
        ("roller-friction", &["force_n"]),
        ("dead-band", &["duty", "duty_#"]),
        ("bridge-drop", &["drop_v"]),
        ("gear-backlash", &["play_rad", "play_#_rad", "load_friction_nm"]),
        ("battery-sag", &["resistance_ohm", "drop_v"]),
        ("supply-voltage", &["scale", "fall_v_per_s"]),
        ("current-limit", &["limit_a"]),
        ("floor-tilt", &["x_rad", "y_rad"]),
        ("body-drag", &["force_n"]),
        ("turning-resistance", &["torque_nm"]),
        ("carpet-grain", &["force_n", "azimuth_rad"]),
        ("wheel-slip", &["friction_coefficient", "centre_height_m"]),
    ];

    #[test]
    fn parameters_are_named_as_agreed() {
        let robot = Robot::racbot();
        for (name, allowed) in NAMES {
            let effect = find(name).unwrap_or_else(|| panic!("{name} is not in the catalogue"));
            for form in effect.forms(&robot) {
                for p in &form.free {
                    let part = |part| if str::parse::<usize>(part).is_ok() { "#" } else { part };
                    let plain = p.name.split('_').map(part).collect::<Vec<_>>().join("_");
                    assert!(allowed.contains(&plain.as_str()), "{name}: {}", p.name);
                }
            }
        }
        assert_eq!(find("wheel-creep").unwrap().forms(&robot)[0].free[0].name, "creep_s_per_kg");
    }

    /// A supply that sags, and one that is low as well.
    #[test]
    fn forms_of_an_effect_are_told_apart_by_their_parameters() {
        let forms = battery_sag::BatterySag.forms(&Robot::racbot());
        assert_eq!(forms.len(), 2);
        for (i, form) in forms.iter().enumerate() {
            assert_eq!(forms.iter().position(|f| f.is(form)), Some(i));
        }
    }

    #[test]
    fn names_are_unique_and_bounds_hold_every_start() {
        let robot = Robot::racbot();
        let mut names: Vec<String> = catalogue().iter().map(|e| e.name().to_owned()).collect();
        names.sort();
        let all = names.len();
        names.dedup();
        assert_eq!(names.len(), all);
        for effect in catalogue() {
            for p in effect.forms(&robot).iter().flat_map(|f| &f.free) {
                let start = p.start.unwrap_or(0.0);
                assert!(
                    p.scale > 0.0 && p.material >= 0.0 && p.bounds[0] <= start && start <= p.bounds[1]
                        || p.below.is_some(),
                    "{} {}",
                    effect.name(),
                    p.name
                );
            }
        }
    }
}
