//! The true robot: every number the simulator uses, hidden effects included.

use crate::disturbance::Disturbance;
use crate::geometry::Mount;
use crate::robot::Robot;

/// One wheel with its shaft, motor, gear and encoder.
#[derive(Clone, Debug, PartialEq)]
pub struct Wheel {
    /// True place.
    pub mount: Mount,
    /// Mean rolling radius, m.
    pub radius_m: f64,
    /// Ripple of the rolling radius: `r(1 + amplitude·cos(count·φ + phase))`.
    pub ripple_amplitude: f64,
    /// Ripples per wheel turn (the number of rollers).
    pub ripple_count: f64,
    /// Phase of the ripple, rad.
    pub ripple_phase_rad: f64,
    /// Inertia about the wheel shaft without the rotor, kg m².
    pub inertia_kg_m2: f64,
    /// Dry friction at the wheel shaft while turning in the positive and in the negative sense, Nm.
    pub dry_nm: [f64; 2],
    /// Extra dry friction near standstill, Nm: `extra·exp(−(ω/speed)²)`.
    pub stribeck_nm: f64,
    /// Speed at which that extra has fallen to 1/e, rad/s.
    pub stribeck_speed_rad_s: f64,
    /// Friction per wheel speed, Nm s.
    pub viscous_nms: f64,
    /// Dry friction that depends on the robot's heading: peak (Nm), harmonic, phase (rad);
    /// `peak·(1 + cos(harmonic·θ − phase))/2`.
    pub heading_drag: [f64; 3],
    /// Drag of the roller bearings when the wheel moves along its free direction, N.
    pub roller_drag_n: f64,
    /// Lost motion of the gear, rad at the motor shaft.
    pub play_rad: f64,
    /// Counts per true count minus one.
    pub encoder_scale: f64,
    /// Part of the edges that is lost …
    pub encoder_loss: f64,
    /// … above this wheel speed, rad/s.
    pub loss_above_rad_s: f64,
}

/// The ground under a wheel.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// Stiffness of roller and carpet along the push direction, N/m.
    pub stiffness_n_m: f64,
    /// Damping of the same, N s/m.
    pub damping_ns_m: f64,
    /// Slip speed per force, m/s/N.
    pub creep_s_per_kg: f64,
    /// Slip ratio per force while rolling, 1/N.
    pub slip_ratio_per_n: f64,
    /// Friction limit over normal load at low slip.
    pub friction_static: f64,
    /// Friction limit over normal load at high slip.
    pub friction_sliding: f64,
    /// Slip speed between the two, m/s.
    pub friction_speed_m_s: f64,
    /// Slope of the floor along world x and y, rad, downhill positive.
    pub tilt_rad: [f64; 2],
    /// Drag of the carpet's pile against motion along one world axis, N.
    pub grain_n: f64,
    /// Direction of that axis, rad from world x.
    pub grain_azimuth_rad: f64,
}

/// Motor, bridge and battery.
#[derive(Clone, Debug, PartialEq)]
pub struct Power {
    /// Winding resistance when cold, Ω.
    pub resistance_ohm: f64,
    /// Winding inductance, H.
    pub inductance_h: f64,
    /// Nm/A and V s/rad.
    pub torque_constant: f64,
    /// kg m² at the motor shaft.
    pub rotor_inertia: f64,
    /// Dry friction at the motor shaft, Nm.
    pub motor_friction_nm: f64,
    /// Part of the transmitted torque that is not lost as friction.
    pub gear_efficiency: f64,
    /// Motor turns per wheel turn.
    pub gear_ratio: f64,
    /// Relative growth of the winding resistance per joule of heat in it.
    pub heating_per_j: f64,
    /// Time constant with which that heat leaves the winding, s.
    pub cooling_s: f64,
    /// Battery voltage without load, V.
    pub open_v: f64,
    /// Battery and wiring resistance, Ω.
    pub battery_ohm: f64,
    /// Whether `supply_v` in the log is measured; otherwise it stands at nominal.
    pub supply_measured: bool,
    /// Standard deviation of that measurement, V.
    pub supply_noise_v: f64,
    /// Duty that the bridge swallows.
    pub dead_band: f64,
    /// Bend of the duty-to-voltage curve: `u·(1 + c·(|u| − 1))`.
    pub curvature: f64,
    /// Delay from the tick to the voltage, s.
    pub actuation_latency_s: f64,
    /// Delay of all encoder counts, s.
    pub encoder_lag_s: f64,
}

/// The overhead camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Frames per second.
    pub rate_hz: f64,
    /// Age of the pose at its stamp, s.
    pub latency_s: f64,
    /// Further age per speed, s per m/s.
    pub latency_per_speed: f64,
    /// Standard deviation of x, y, m.
    pub noise_m: f64,
    /// Standard deviation of θ, rad.
    pub noise_rad: f64,
    /// Positions × (1 + scale).
    pub scale: f64,
    /// Positions × (1 + k·r²), 1/m².
    pub lens_per_m2: f64,
    /// Marker plate turned counter-clockwise, rad.
    pub marker_heading_rad: f64,
    /// Marker plate beside the chassis centre, body frame, m.
    pub marker_offset_m: [f64; 2],
    /// Scatter of the stamps about the true capture times, s.
    pub stamp_jitter_s: f64,
    /// Relative rate error of the clock that stamps.
    pub clock_drift: f64,
    /// Motion of the camera mount, m/s in world x, y.
    pub creep_m_s: [f64; 2],
    /// Part of the frames that never arrive.
    pub dropped: f64,
    /// Part of the frames that repeat the one before, noise and all: tracking was lost.
    pub frozen: f64,
}

/// What the controller does otherwise than `robot.toml` says.
#[derive(Clone, Debug, PartialEq)]
pub struct Controller {
    /// Proportional gain, duty per rad/s.
    pub kp: f64,
    /// Integral gain, duty per rad.
    pub ki: f64,
    /// Where the integrator stops when it is not held at saturation, duty; none = the rule of `robot.toml`.
    pub windup_limit: Option<f64>,
    /// Rounding of duty.
    pub duty_quantum: f64,
    /// Ticks by which the set point used is older than the logged one.
    pub ref_age_ticks: usize,
    /// Ticks by which the counts used are older than the logged ones.
    pub enc_age_ticks: usize,
    /// Delay from command to set point, s.
    pub command_latency_s: f64,
    /// Which matrix row (1-based, negative = inverted) makes set point i.
    pub row_of_ref: Vec<i32>,
    /// Which physical wheel (1-based, negative = inverted) axis i drives and counts.
    pub wheel_of_axis: Vec<i32>,
}

/// Coloured noise of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Roughness {
    /// Standard deviation of the force on the chassis, N.
    pub force_n: f64,
    /// Standard deviation of the turning moment, Nm.
    pub moment_nm: f64,
    /// Standard deviation of the torque at a wheel shaft, Nm.
    pub shaft_nm: f64,
    /// Correlation time, s.
    pub time_s: f64,
}

/// Everything true about the robot and its surroundings.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// Of the whole machine, kg.
    pub mass_kg: f64,
    /// kg m² about the centre of mass.
    pub yaw_inertia_kg_m2: f64,
    /// Centre of mass, body frame, m.
    pub centre_of_mass_m: [f64; 2],
    /// Height of the centre of mass over the floor, m.
    pub centre_height_m: f64,
    /// Wheels, in the order of the log's columns.
    pub wheels: Vec<Wheel>,
    /// Friction and tilt of the floor.
    pub ground: Ground,
    /// Motors and battery.
    pub power: Power,
    /// Noise, delay and place of its marker.
    pub camera: Camera,
    /// Gains and what it does wrong.
    pub controller: Controller,
    /// Ground noise.
    pub roughness: Roughness,
    /// Effects that no catalogue lists.
    pub disturbances: Vec<Disturbance>,
    /// Wheels off the floor.
    pub blocks: bool,
}

impl Machine {
    /// The robot exactly as its designers describe it, on an ideal floor: stiff, grippy contact, no roller drag, no
    /// battery resistance, no noise.
    #[must_use]
    pub fn ideal(robot: &Robot) -> Self {
        let mounts = robot.mounts();
        let axes: Vec<i32> = (1..).take(mounts.len()).collect();
        let [noise_m, _, noise_rad] = robot.camera_noise.unwrap_or([0.0; 3]);
        Self {
            mass_kg: robot.mass_kg,
            yaw_inertia_kg_m2: robot.yaw_inertia_kg_m2,
            centre_of_mass_m: [0.0; 2],
            centre_height_m: 0.035,
            wheels: mounts.iter().map(|&mount| Wheel::ideal(robot, mount)).collect(),
            ground: Ground {
                stiffness_n_m: 3.5e4,
                damping_ns_m: 22.0,
                creep_s_per_kg: 0.0,
                slip_ratio_per_n: 0.0,
                friction_static: 1.0,
                friction_sliding: 0.9,
                friction_speed_m_s: 0.1,
                tilt_rad: [0.0; 2],
                grain_n: 0.0,
                grain_azimuth_rad: 0.0,
            },
            power: Power {
                resistance_ohm: robot.resistance_ohm,
                inductance_h: 7.0e-5,
                torque_constant: robot.torque_constant,
                rotor_inertia: robot.rotor_inertia,
                motor_friction_nm: robot.friction_torque,
                gear_efficiency: robot.gear_efficiency,
                gear_ratio: robot.gear_ratio,
                heating_per_j: 0.0,
                cooling_s: 30.0,
                open_v: robot.supply_v,
                battery_ohm: 0.0,
                supply_measured: false,
                supply_noise_v: 0.0,
                dead_band: 0.0,
                curvature: 0.0,
                actuation_latency_s: 0.0,
                encoder_lag_s: 0.0,
            },
            camera: Camera {
                rate_hz: robot.camera_rate_hz,
                latency_s: robot.camera_latency_s.unwrap_or(0.0),
                latency_per_speed: 0.0,
                noise_m,
                noise_rad,
                scale: 0.0,
                lens_per_m2: 0.0,
                marker_heading_rad: 0.0,
                marker_offset_m: [0.0; 2],
                stamp_jitter_s: 0.0,
                clock_drift: 0.0,
                creep_m_s: [0.0; 2],
                dropped: 0.0,
                frozen: 0.0,
            },
            controller: Controller {
                kp: robot.kp,
                ki: robot.ki,
                windup_limit: None,
                duty_quantum: robot.duty_quantum,
                ref_age_ticks: 0,
                enc_age_ticks: 0,
                command_latency_s: 0.0,
                row_of_ref: axes.clone(),
                wheel_of_axis: axes,
            },
            roughness: Roughness { force_n: 0.0, moment_nm: 0.0, shaft_nm: 0.0, time_s: 0.05 },
            disturbances: Vec::new(),
            blocks: robot.blocks,
        }
    }
}

impl Wheel {
    fn ideal(robot: &Robot, mount: Mount) -> Self {
        Self {
            mount,
            radius_m: robot.wheel_radius_m,
            ripple_amplitude: 0.0,
            ripple_count: 15.0,
            ripple_phase_rad: 0.0,
            inertia_kg_m2: robot.wheel_inertia_kg_m2.unwrap_or(6.0e-6),
            dry_nm: [0.0; 2],
            stribeck_nm: 0.0,
            stribeck_speed_rad_s: 3.0,
            viscous_nms: 0.0,
            heading_drag: [0.0; 3],
            roller_drag_n: 0.0,
            play_rad: 0.0,
            encoder_scale: 0.0,
            encoder_loss: 0.0,
            loss_above_rad_s: 0.0,
        }
    }
}
