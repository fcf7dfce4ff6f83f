"""One run: commands in, rows of the log out."""

import math

import mujoco
import mechanics
from camera import Camera
from controller import SpeedLoops
from drive import Drive
from mechanics import STEP_S
from robot import WHEELS

HEADER = (
    "t,cmd_vx,cmd_vy,cmd_w,ref_1,ref_2,ref_3,enc_1,enc_2,enc_3,duty_1,duty_2,duty_3,supply_v,cam_x,cam_y,cam_theta"
)
SETTLE_S = 0.3


def decimals(value, places):
    """As in the example logs: no trailing zeros, no negative zero."""
    text = f"{value:.{places}f}".rstrip("0").rstrip(".") if places else str(value)
    return "0" if text in ("-0", "") else text


class Body:
    """The engine's robot: where its parts stand in the engine's arrays."""

    def __init__(self, nominal, plant, rng, wall):
        self.model = m = mujoco.MjModel.from_xml_string(mechanics.xml(nominal, plant, wall))
        self.data = d = mujoco.MjData(m)
        wheels = [m.joint(f"wheel{i + 1}").id for i in range(WHEELS)]
        self.dof = [int(m.jnt_dofadr[j]) for j in wheels]
        self.place = [int(m.jnt_qposadr[j]) for j in wheels]
        self.sign = [1.0 if axis > 0 else -1.0 for axis in plant.axis_wheel]
        self.axis = [abs(axis) - 1 for axis in plant.axis_wheel]
        for i in range(WHEELS):
            d.qpos[self.place[i]] = rng.uniform(0.0, 2.0 * math.pi)
            for k in range(mechanics.ROLLERS):
                dof = m.jnt_dofadr[m.joint(f"roller{i + 1}_{k}").id]
                m.dof_frictionloss[dof] = plant.roller_drag[i] * mechanics.ROLLER_RADIUS_M
        heading = 0.0 if wall else rng.uniform(-math.pi, math.pi)
        if not wall:
            d.qpos[0], d.qpos[1] = rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2)
        d.qpos[3], d.qpos[6] = math.cos(heading / 2.0), math.sin(heading / 2.0)
        m.dof_frictionloss[self.dof] = 0.05
        for _ in range(round(SETTLE_S / STEP_S)):
            mujoco.mj_step(m, d)
        self.turns = 0.0
        self.last = self.heading()

    def heading(self):
        _, _, _, a, b, c, e = self.data.qpos[:7].tolist()
        return math.atan2(2.0 * (a * e + b * c), 1.0 - 2.0 * (c * c + e * e))

    def pose(self):
        """x, y and the heading without jumps."""
        heading = self.heading()
        self.turns -= round((heading - self.last) / (2.0 * math.pi))
        self.last = heading
        x, y = self.data.qpos[:2].tolist()
        return x, y, heading + 2.0 * math.pi * self.turns


def simulate(nominal, plant, commands, rng, wall=None):
    """The log of one drive, as text."""
    body = Body(nominal, plant, rng, wall)
    m, d = body.model, body.data
    drive, loops = Drive(nominal, plant), SpeedLoops(nominal, plant)
    ticks = len(commands) * nominal.control_rate // 100
    camera = Camera(nominal, plant, ticks / nominal.control_rate, rng)
    per_tick = round(1.0 / (nominal.control_rate * STEP_S))
    delay = round(plant.actuation_latency / STEP_S)
    late = [[0.0] * WHEELS] * (delay + 1)
    counts_per_rad = [s / nominal.rad_per_count() for s in plant.encoder_scale]
    zero = [drive.shaft(w, 0.0) if drive.rotors[w] else float(d.qpos[body.place[w]]) for w in range(WHEELS)]
    start = [float(d.qpos[body.place[w]]) for w in range(WHEELS)]
    for w in range(WHEELS):
        if drive.rotors[w]:
            zero[w] = drive.rotors[w].angle = start[w]
    kept = [0.0] * WHEELS  # counts that were not lost
    raw_before = [0.0] * WHEELS
    phase = [rng.random() for _ in range(WHEELS)]
    path, rows = [], []
    old_speeds = [0.0] * WHEELS
    for tick in range(ticks):
        t = tick / nominal.control_rate
        place = d.qpos
        counts = []
        for axis in range(WHEELS):
            w = body.axis[axis]
            angle = body.sign[axis] * (drive.shaft(w, float(place[body.place[w]])) - zero[w])
            raw = angle * counts_per_rad[axis]
            moved = raw - raw_before[axis]
            raw_before[axis] = raw
            fast = abs(moved) * nominal.rad_per_count() * nominal.control_rate >= plant.encoder_loss_above
            kept[axis] += moved * (1.0 - plant.encoder_loss[axis]) if fast else moved
            counts.append(math.floor(kept[axis] + phase[axis]))
        command = commands[min(int((t + 1e-9) * 100), len(commands) - 1)]
        early = t - plant.command_latency + 1e-9
        used = commands[min(int(early * 100), len(commands) - 1)] if early >= 0.0 else (0.0, 0.0, 0.0)
        speeds = nominal.wheel_speeds(*used)
        references = [round(math.copysign(1.0, r) * speeds[abs(r) - 1], 2) + 0.0 for r in plant.command_row]
        duties = loops.step(references, counts)
        for sub in range(per_tick):
            path.append(body.pose())
            late.append(duties)
            act = late.pop(0) if delay else (late.pop(0) and duties)
            v = d.qvel
            w_now = [float(v[i]) for i in body.dof]
            accelerations = [(a - b) / STEP_S for a, b in zip(w_now, old_speeds)]
            old_speeds = w_now
            at_wheel = [0.0] * WHEELS
            for axis in range(WHEELS):
                at_wheel[body.axis[axis]] = body.sign[axis] * act[axis]
            angles = [float(d.qpos[i]) for i in body.place]
            torques, limits = drive.step(at_wheel, angles, w_now, accelerations)
            if plant.disturbance:
                extra_torques, extra_limits, force = plant.disturbance(t + sub * STEP_S, path[-1], v, w_now)
                torques = [a + b for a, b in zip(torques, extra_torques)]
                limits = [a + b for a, b in zip(limits, extra_limits)]
                d.qfrc_applied[0], d.qfrc_applied[1] = force
            for i in range(WHEELS):
                d.qfrc_applied[body.dof[i]] = torques[i]
                m.dof_frictionloss[body.dof[i]] = limits[i]
            if sub == 0:
                supply = drive.voltage
            mujoco.mj_step(m, d)
        measured = supply + rng.gauss(0.0, 0.01) if plant.supply_measured else nominal.supply
        rows.append((t, command, references, counts, duties, measured))
    path.append(body.pose())
    frames = camera.poses(path, STEP_S)
    lines = [HEADER]
    for tick, (t, command, references, counts, duties, supply) in enumerate(rows):
        seen = frames.get(tick)
        lines.append(
            ",".join(
                [decimals(t, 3)]
                + [decimals(c, 3) for c in command]
                + [decimals(r, 2) for r in references]
                + [str(c) for c in counts]
                + [decimals(u, 3) for u in duties]
                + [decimals(supply, 2)]
                + ([decimals(c, 4) for c in seen] if seen else ["", "", ""])
            )
        )
    return "\n".join(lines) + "\n"
