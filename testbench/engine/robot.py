"""The robot as its designers know it, and as it really is (SI units, angles in rad)."""

import math
from dataclasses import dataclass

RAC = tuple(math.radians(a) for a in (90.0, 210.0, 330.0))


@dataclass
class Nominal:
    """What stands in robot.toml."""

    mounts: tuple = RAC  # azimuths of the wheels, each driving at right angles to its own, clockwise
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
        return [((math.sin(m) * vx - math.cos(m) * vy) - self.body_radius * w) / self.wheel_radius for m in self.mounts]

    @property
    def wheels(self):
        return len(self.mounts)

    def stall(self):
        """Torque at a wheel's shaft at full duty and no speed, Nm."""
        return self.supply * self.torque_constant / self.resistance * self.gear_ratio

    def rad_per_count(self):
        """Angle of a wheel per encoder count."""
        return 2.0 * math.pi / (self.counts_per_motor_turn * self.gear_ratio)

    def toml(self):
        """The file that the workflow reads."""
        return f"""# Nominal robot parameters (what the designers know). SI units.
wheel_radius_m = {self.wheel_radius}
{self.layout() if self.mounts == RAC else ""}mass_kg = {self.mass}
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
{"" if self.mounts == RAC else self.layout()}"""

    def layout(self):
        """Where the wheels are: short for the RacBot, tables for any other."""
        if self.mounts == RAC:
            return f"body_radius_m = {self.body_radius}\nskew_rad = [0.0, 0.0, 0.0]\n"
        return "".join(
            f"""
[[wheel]]
x_m = {self.body_radius * math.cos(m):.6f}
y_m = {self.body_radius * math.sin(m):.6f}
drive_rad = {math.remainder(m - math.pi / 2, 2.0 * math.pi):.6f}
"""
            for m in self.mounts
        )


class Plant:
    """The robot, floor, camera and electronics as they are: as nominal, with what is always there."""

    def __init__(self, nominal):
        self.wheels = wheels = nominal.wheels

        def each(value=0.0):
            return [value] * wheels

        # what sizes go with: the RacBot's are 1
        usual = Nominal()
        self.torque_unit = nominal.stall() / usual.stall()
        self.force_unit = self.torque_unit * usual.wheel_radius / nominal.wheel_radius
        self.thrust_unit = self.force_unit * usual.mass / nominal.mass
        self.power_unit = (nominal.supply**2 / nominal.resistance) / (usual.supply**2 / usual.resistance)
        # geometry
        self.skew, self.wheel_angle = each(), each()
        self.wheel_radius_scale, self.body_radius_scale = each(1.0), 1.0
        self.eccentricity, self.same_start = each(), False  # of each wheel's axle, as a share of the radius
        self.command_row = list(range(1, wheels + 1))  # row of the matrix that feeds axis i; negative: inverted
        self.axis_wheel = list(range(1, wheels + 1))  # wheel that axis i drives and counts
        # masses
        self.mass_scale = self.yaw_inertia_scale = self.rotor_inertia_scale = 1.0
        self.centre_of_mass = (0.0, 0.0)
        # motor, gear, battery
        self.torque_constant_scale = self.resistance_scale = 1.0
        self.heating_per_joule = 0.0  # relative growth of the winding's resistance per joule of its heat
        self.cooling_s = 60.0
        self.dead_band = self.drive_curve = 0.0
        self.battery_resistance, self.battery_drop, self.supply_measured = 0.05, 0.0, True
        self.coulomb, self.viscous = each(), each()  # Nm, Nms at the wheel shaft, beyond nominal
        self.stribeck, self.stribeck_speed = each(), 1.0  # Nm more at rest
        self.asymmetric, self.asymmetric_sense = each(), 1  # Nm in one sense only
        self.play = each()  # rad at the motor shaft
        self.gear_efficiency_more = 0.0
        self.actuation_latency = 0.0
        # rollers and floor
        self.roller_drag = each(0.075)  # N a wheel, along its axle
        self.friction = 0.9
        self.contact_time = 0.002  # s, the engine's measure of compliance: 30 um under the robot's weight at 0.002
        self.grip = 10.0  # the engine's ratio of friction to normal stiffness; creep goes with its inverse
        self.tilt = (0.0, 0.0)  # rad, world, downhill positive
        # counters
        self.encoder_scale, self.encoder_loss, self.encoder_loss_above = each(1.0), each(), 0.0  # above, rad/s
        self.encoder_lag = 0.0
        # camera
        self.camera_latency, self.camera_scale, self.lens_k1 = 0.0, 1.0, 0.0
        self.camera_latency_per_speed = 0.0  # s per m/s
        self.camera_drift = (0.0, 0.0)  # of its origin, m/s
        self.camera_noise = (0.0015, 0.0015, math.radians(0.5))
        self.marker_heading, self.marker_offset = 0.0, (0.0, 0.0)
        self.stamp_jitter = self.stamp_drift = 0.0
        self.lost_frames = 0.0  # share of the frames that are never logged
        # electronics
        self.command_latency = 0.0
        self.kp_scale = self.ki_scale = 1.0
        self.duty_quantum, self.windup_limit = 0.001, None
        self.count_age_ticks = 0
        self.duty_logged = True
        # what no catalogue has, see disturbances.py
        self.disturbance = None
        self.wall = False  # across the way of every run
