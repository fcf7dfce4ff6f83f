"""Batteries, bridges, motors and gears: from duties to torques at the wheel shafts."""

import math

from mechanics import STEP_S

MESH_STIFFNESS = 60.0  # Nm/rad at the wheel shaft, where there is play
MESH_DAMPING = 0.004  # Nm s/rad
PARTS = 10  # steps of the rotor per step of the engine, where there is play


class Rotor:
    """A rotor behind play: a body of its own, in wheel-shaft quantities."""

    def __init__(self, inertia, half_play, friction, angle):
        self.inertia, self.half_play, self.friction = inertia, half_play, friction
        self.angle, self.speed = angle, 0.0

    def step(self, torque, angle, speed):
        """Moves on under `torque` against a wheel at `angle` with `speed`; mean torque that the teeth pass on."""
        h = STEP_S / PARTS
        passed = 0.0
        for part in range(PARTS):
            lead = self.angle - (angle + speed * h * part)
            mesh = 0.0
            if abs(lead) > self.half_play:
                side = math.copysign(1.0, lead)
                push = MESH_STIFFNESS * (abs(lead) - self.half_play) + MESH_DAMPING * side * (self.speed - speed)
                mesh = side * max(push, 0.0)
            self.speed += h * (torque - mesh) / self.inertia
            most = h * self.friction / self.inertia
            self.speed -= min(max(self.speed, -most), most)
            self.angle += h * self.speed
            passed += mesh
        return passed / PARTS


class Drive:
    """All drives on one battery."""

    def __init__(self, nominal, plant, angles):
        self.plant = plant
        g = nominal.gear_ratio
        self.constant = nominal.torque_constant * plant.torque_constant_scale * g
        self.resistance = nominal.resistance * plant.resistance_scale
        self.heat = [0.0] * plant.wheels
        self.motor_friction = nominal.motor_friction * g
        self.loss = 1.0 - nominal.gear_efficiency - plant.gear_efficiency_more
        self.rotor_inertia = nominal.rotor_inertia * plant.rotor_inertia_scale * g * g
        self.open_voltage = nominal.supply - plant.battery_drop
        self.voltage = self.open_voltage
        self.rotors = [
            Rotor(self.rotor_inertia, 0.5 * p / g, self.motor_friction, a) if p > 0.0 else None
            for p, a in zip(plant.play, angles, strict=True)
        ]

    def shafts(self, angles):
        """Angles that the encoders see, at the wheel shaft, with the wheels at `angles`."""
        return [r.angle if r else a for r, a in zip(self.rotors, angles, strict=True)]

    def step(self, duties, angles, speeds, accelerations):
        """Torques at the wheel shafts and the limits of dry friction there, Nm."""
        p = self.plant
        torques, limits = [0.0] * p.wheels, [0.0] * p.wheels
        load = 0.0
        for i in range(p.wheels):
            u, w = duties[i], speeds[i]
            if p.dead_band > 0.0:
                u = math.copysign(max(abs(u) - p.dead_band, 0.0), u)
            u *= 1.0 + p.drive_curve * (abs(u) - 1.0)
            rotor = self.rotors[i]
            resistance = self.resistance * (1.0 + p.heating_per_joule * self.heat[i])
            current = (u * self.voltage - self.constant * (rotor.speed if rotor else w)) / resistance
            if p.heating_per_joule > 0.0:
                self.heat[i] += STEP_S * (current * current * resistance - self.heat[i] / p.cooling_s)
            load += u * current
            winding = self.constant * current
            if rotor:
                torques[i] = transmitted = rotor.step(winding, angles[i], w)
                dry = 1e-6
            else:
                torques[i] = winding
                transmitted = winding - self.rotor_inertia * accelerations[i]
                dry = self.motor_friction
            torques[i] -= p.viscous[i] * w
            dry += self.loss * abs(transmitted) + p.coulomb[i]
            if p.stribeck[i] > 0.0:
                dry += p.stribeck[i] * math.exp(-((w / p.stribeck_speed) ** 2))
            if p.asymmetric[i] > 0.0 and w * p.asymmetric_sense > 0.0:
                dry += p.asymmetric[i]
            limits[i] = dry
        self.voltage = self.open_voltage - p.battery_resistance * load
        return torques, limits
