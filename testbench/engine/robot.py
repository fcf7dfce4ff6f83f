"""The robot as its designers know it, and as it really is (SI units, angles in rad)."""

import math
from dataclasses import dataclass, field

WHEELS = 3
MOUNTS = [math.radians(a) for a in (90.0, 210.0, 330.0)]


@dataclass
class Nominal:
    """What stands in robot.toml."""

    wheel_radius: float = 0.0275
    body_radius: float = 0.085
    mass: float = 2.4
    yaw_inertia: float = 0.0095
    gear_ratio: float = 3.71
    gear_efficiency: float = 0.88
    counts_per_motor_turn: int = 2048
    supply: float = 7.2
    control_rate: int = 1000
    camera_rate: float = 60.0
    resistance: float = 1.94
    torque_constant: float = 0.00692
    rotor_inertia: float = 2.7e-7
    motor_friction: float = 0.00015
    kp: float = 0.15
    ki: float = 0.8

    def wheel_speeds(self, vx, vy, w):
        """Set points of the wheels (rad/s) for a velocity of the body: x right, y forward, w counter-clockwise."""
        return [((math.sin(m) * vx - math.cos(m) * vy) - self.body_radius * w) / self.wheel_radius for m in MOUNTS]

    def rad_per_count(self):
        """Angle of a wheel per encoder count."""
        return 2.0 * math.pi / (self.counts_per_motor_turn * self.gear_ratio)

    def toml(self):
        """The file that the workflow reads."""
        return f"""# Nominal robot parameters (what the designers know). SI units.
wheel_radius_m = {self.wheel_radius}
body_radius_m = {self.body_radius}
skew_rad = [0.0, 0.0, 0.0]
mass_kg = {self.mass}
yaw_inertia_kg_m2 = {self.yaw_inertia}
gear_ratio = {self.gear_ratio}
gear_efficiency = {self.gear_efficiency}
encoder_counts_per_motor_rev = {self.counts_per_motor_turn}
supply_v = {self.supply}
control_rate_hz = {self.control_rate}
camera_rate_hz = {self.camera_rate:g}

[motor]
resistance_ohm = {self.resistance}
torque_constant = {self.torque_constant}
rotor_inertia = {self.rotor_inertia}
friction_torque = {self.motor_friction}

[pi]
kp = {self.kp}
ki = {self.ki}
"""


def three(value=0.0):
    """One value a wheel."""
    return field(default_factory=lambda: [value] * WHEELS)


@dataclass
class Plant:
    """The robot, floor, camera and electronics as they are. Defaults: as nominal, with what is always there."""

    # geometry
    skew: list = three()
    wheel_angle: list = three()
    wheel_radius_scale: list = three(1.0)
    body_radius_scale: float = 1.0
    command_row: list = field(
        default_factory=lambda: [1, 2, 3]
    )  # row of the matrix that feeds axis i; negative: inverted
    axis_wheel: list = field(default_factory=lambda: [1, 2, 3])  # wheel that axis i drives and counts
    # masses
    mass_scale: float = 1.0
    yaw_inertia_scale: float = 1.0
    rotor_inertia_scale: float = 1.0
    centre_of_mass: tuple = (0.0, 0.0)
    # motor, gear, battery
    torque_constant_scale: float = 1.0
    resistance_scale: float = 1.0
    heating_per_joule: float = 0.0  # relative growth of the winding's resistance per joule of its heat
    cooling_s: float = 60.0
    dead_band: float = 0.0
    battery_resistance: float = 0.05
    battery_drop: float = 0.0
    supply_measured: bool = True
    coulomb: list = three()  # Nm at the wheel shaft, beyond nominal
    viscous: list = three()
    stribeck: list = three()  # Nm more at rest
    stribeck_speed: float = 1.0
    asymmetric: list = three()  # Nm in one sense only
    asymmetric_sense: int = 1
    play: list = three()  # rad at the motor shaft
    actuation_latency: float = 0.0
    # rollers and floor
    roller_drag: list = field(default_factory=lambda: [0.075] * WHEELS)  # N a wheel, along its axle
    friction: float = 0.9
    contact_time: float = 0.002  # s, the engine's measure of compliance: 30 um under the robot's weight at 0.002
    grip: float = 10.0  # the engine's ratio of friction to normal stiffness; creep is about 0.006/grip s/kg
    tilt: tuple = (0.0, 0.0)  # rad, world, downhill positive
    grain: tuple = (0.0, 0.0)  # N, azimuth
    # counters
    encoder_scale: list = three(1.0)
    encoder_loss: list = three()
    encoder_loss_above: float = 0.0  # rad/s at the wheel
    # camera
    camera_latency: float = 0.0
    camera_scale: float = 1.0
    camera_noise: tuple = (0.0015, 0.0015, math.radians(0.5))
    marker_heading: float = 0.0
    marker_offset: tuple = (0.0, 0.0)
    lens_k1: float = 0.0
    stamp_jitter: float = 0.0
    stamp_drift: float = 0.0
    # electronics
    command_latency: float = 0.0
    kp_scale: float = 1.0
    ki_scale: float = 1.0
    count_age_ticks: int = 0
    # what no catalogue has, see disturbances.py
    disturbance: object = None
    wall: bool = False  # across the way of every run
