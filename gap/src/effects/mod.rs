//! The catalogue of effects on the motion and drive links, one file each.
//!
//! To add one: its file, a `mod` line and a line in [`catalogue`].

mod actuation_latency;
mod asymmetric_friction;
mod battery_sag;
mod body_radius;
mod camera_latency;
mod camera_scale;
mod carpet_grain;
mod centre_of_mass;
mod coulomb_friction;
mod dead_band;
mod drive_curve;
mod encoder_lag;
mod encoder_loss;
mod encoder_scale;
mod floor_tilt;
mod gear_backlash;
mod gear_efficiency;
mod heading_drag;
mod lens_distortion;
mod marker_heading;
mod marker_offset;
mod motor_heating;
mod probes;
mod robot_mass;
mod roller_friction;
mod roller_ripple;
mod rotor_inertia;
mod stribeck_friction;
mod torque_constant;
mod viscous_friction;
mod wheel_angle;
mod wheel_creep;
mod wheel_order;
mod wheel_radius;
mod wheel_radius_common;
mod wheel_skew;
mod wheel_slip;
mod yaw_inertia;

use crate::effect::Effect;

/// All effects fitted on the motion and drive links, in the order in which equals are named.
pub fn catalogue() -> Vec<Box<dyn Effect>> {
    let named: Vec<Box<dyn Effect>> = vec![
        Box::new(wheel_skew::WheelSkew),
        Box::new(wheel_radius::WheelRadius),
        Box::new(wheel_radius_common::WheelRadiusCommon),
        Box::new(body_radius::BodyRadius),
        Box::new(wheel_angle::WheelAngle),
        Box::new(encoder_scale::EncoderScale),
        Box::new(encoder_loss::EncoderLoss),
        Box::new(encoder_lag::EncoderLag),
        Box::new(wheel_creep::WheelCreep),
        Box::new(wheel_slip::WheelSlip),
        Box::new(roller_ripple::RollerRipple),
        Box::new(camera_latency::CameraLatency),
        Box::new(camera_scale::CameraScale),
        Box::new(marker_heading::MarkerHeading),
        Box::new(marker_offset::MarkerOffset),
        Box::new(lens_distortion::LensDistortion),
        Box::new(coulomb_friction::CoulombFriction),
        Box::new(viscous_friction::ViscousFriction),
        Box::new(stribeck_friction::StribeckFriction),
        Box::new(asymmetric_friction::AsymmetricFriction),
        Box::new(gear_efficiency::GearEfficiency),
        Box::new(gear_backlash::GearBacklash),
        Box::new(roller_friction::RollerFriction),
        Box::new(dead_band::DeadBand),
        Box::new(drive_curve::DriveCurve),
        Box::new(torque_constant::TorqueConstant),
        Box::new(battery_sag::BatterySag),
        Box::new(motor_heating::MotorHeating),
        Box::new(robot_mass::RobotMass),
        Box::new(yaw_inertia::YawInertia),
        Box::new(rotor_inertia::RotorInertia),
        Box::new(centre_of_mass::CentreOfMass),
        Box::new(floor_tilt::FloorTilt),
        Box::new(carpet_grain::CarpetGrain),
        Box::new(heading_drag::HeadingDrag),
        Box::new(actuation_latency::ActuationLatency),
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
        "integrator-windup" => "the integrator is not held at saturation but stops at limit_duty",
        "quantisation" => "duties are rounded to duty_quantum",
        "sample-order" => {
            "the loop uses counts (signal 0) or set points (signal 1) that are shift_ticks older than logged"
        }
        "camera-timing" => "stamps of the camera frames scatter about their capture times by jitter_s",
        _ => "",
    }
}

/// The effect of this name.
pub fn find(name: &str) -> Option<Box<dyn Effect>> {
    catalogue().into_iter().find(|e| e.name() == name)
}
