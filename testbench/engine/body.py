"""The engine's robot: settled on the floor, with its parts at hand."""

import math

import mechanics
import mujoco
import numpy as np
from mechanics import STEP_S

SETTLE_S = 0.3
HOLDING_TORQUE = 0.05  # of the wheels while the robot settles, Nm


class Body:
    """Chassis, wheels and rollers in the engine's arrays. Wheels count from 0."""

    def __init__(self, nominal, plant, rng, wall):
        self.model = m = mujoco.MjModel.from_xml_string(mechanics.xml(nominal, plant, wall))
        self.data = d = mujoco.MjData(m)
        wheels = [m.joint(f"wheel{i + 1}").id for i in range(plant.wheels)]
        roller = {m.body(f"wheel{i + 1}").id: i for i in range(plant.wheels)}
        owner = {g: roller.get(int(m.body_parentid[m.geom_bodyid[g]])) for g in range(m.ngeom)}
        self.wheel_of = {g: i for g, i in owner.items() if i is not None}
        self.drives = [a - math.pi / 2 for a in nominal.mounts]
        self.dof = [int(m.jnt_dofadr[j]) for j in wheels]
        self.place = [int(m.jnt_qposadr[j]) for j in wheels]
        touching = 0.9 + 250.0 * plant.contact_time  # rollers a wheel that drag at a time: measured, 1.3 to 1.5
        self.wheels = plant.wheels
        for i in range(plant.wheels):
            d.qpos[self.place[i]] = 0.0 if plant.same_start else rng.uniform(0.0, 2.0 * math.pi)
            for k in range(mechanics.ROLLERS):
                dof = m.jnt_dofadr[m.joint(f"roller{i + 1}_{k}").id]
                m.dof_frictionloss[dof] = plant.roller_drag[i] * mechanics.ROLLER_RADIUS_M / touching
        heading = 0.0 if wall else rng.uniform(-math.pi, math.pi)
        if not wall:
            d.qpos[0], d.qpos[1] = rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2)
        d.qpos[3], d.qpos[6] = math.cos(heading / 2.0), math.sin(heading / 2.0)
        m.dof_frictionloss[self.dof] = HOLDING_TORQUE
        for _ in range(round(SETTLE_S / STEP_S)):
            mujoco.mj_step(m, d)
        self.turns = 0
        self.last_heading = self.heading()
        self.speeds = self.wheel_speeds()

    def heading(self):
        """Of the body x axis, within half a turn."""
        a, b, c, e = self.data.qpos[3:7].tolist()
        return math.atan2(2.0 * (a * e + b * c), 1.0 - 2.0 * (c * c + e * e))

    def pose(self):
        """x, y and the heading without jumps."""
        heading = self.heading()
        self.turns -= round((heading - self.last_heading) / (2.0 * math.pi))
        self.last_heading = heading
        x, y = self.data.qpos[:2].tolist()
        return x, y, heading + 2.0 * math.pi * self.turns

    def angles(self):
        """Of the wheels against the chassis, rad."""
        return [float(self.data.qpos[i]) for i in self.place]

    def wheel_speeds(self):
        """Of the wheels against the chassis, rad/s."""
        return [float(self.data.qvel[i]) for i in self.dof]

    def step(self, torques, limits, force):
        """One step of the engine under torques and limits of dry friction at the shafts and a force on the chassis."""
        m, d = self.model, self.data
        self.speeds = self.wheel_speeds()
        for i in range(self.wheels):
            d.qfrc_applied[self.dof[i]] = torques[i]
            m.dof_frictionloss[self.dof[i]] = limits[i]
        d.qfrc_applied[0], d.qfrc_applied[1] = force
        mujoco.mj_step(m, d)

    def tractions(self):
        """Force of the floor along each wheel's drive direction, N."""
        m, d = self.model, self.data
        heading, force, out = self.heading(), np.zeros(6), [0.0] * self.wheels
        for k in range(d.ncon):
            contact = d.contact[k]
            wheel = self.wheel_of.get(int(contact.geom2), self.wheel_of.get(int(contact.geom1)))
            if wheel is None:
                continue
            mujoco.mj_contactForce(m, d, k, force)
            world = contact.frame.reshape(3, 3).T @ force[:3]
            a = heading + self.drives[wheel]
            out[wheel] += world[0] * math.cos(a) + world[1] * math.sin(a)
        return out

    def accelerations(self):
        """Of the wheels over the last step, rad/s²."""
        return [(now - before) / STEP_S for now, before in zip(self.wheel_speeds(), self.speeds, strict=True)]
