"""One drive: commands in, log out."""

import math

import log
from body import Body
from camera import Camera
from controller import SpeedLoops
from counters import Counters
from drive import Drive
from excitation import PERIOD_S
from mechanics import STEP_S

REST = (0.0, 0.0, 0.0)
CREEP_STEPS = 10  # steps of the engine between two looks at creep


class CreepMeter:
    """How much faster wheels turn than they roll, m/s, for a traction force, N: the slope of all looks."""

    def __init__(self):
        self.both = self.square = 0.0

    def look(self, nominal, body):
        vx, vy = body.data.qvel[0], body.data.qvel[1]
        c, s = math.cos(body.heading()), math.sin(body.heading())
        rolled = nominal.wheel_speeds(c * vx + s * vy, c * vy - s * vx, body.data.qvel[5])
        for turned, straight, force in zip(body.wheel_speeds(), rolled, body.tractions(), strict=True):
            self.both += nominal.wheel_radius * (turned - straight) * force
            self.square += force * force

    def creep(self):
        return abs(self.both) / self.square


def command_at(commands, t):
    """The command that holds at `t` s; rest before the first."""
    place = math.floor((t + 1e-9) / PERIOD_S)
    return commands[min(place, len(commands) - 1)] if place >= 0 else REST


def simulate(nominal, plant, commands, rng, wall=None, creep=None):
    """The log of one drive, as text; `creep`: a meter that looks on."""
    body = Body(nominal, plant, rng, wall)
    start = body.angles()
    drive, loops, counters = Drive(nominal, plant, start), SpeedLoops(nominal, plant), Counters(nominal, plant, rng)
    ticks = round(len(commands) * PERIOD_S * nominal.control_rate)
    camera = Camera(nominal, plant, ticks / nominal.control_rate, rng)
    steps_a_tick = round(1.0 / (nominal.control_rate * STEP_S))
    on_their_way = [[0.0] * plant.wheels] * round(plant.actuation_latency / STEP_S)
    wheel = [abs(a) - 1 for a in plant.axis_wheel]
    sense = [math.copysign(1.0, a) for a in plant.axis_wheel]
    path, rows = [], []
    shafts_before = [list(start)] * (round(plant.encoder_lag / STEP_S) // steps_a_tick + 1)
    for tick in range(ticks):
        t = tick / nominal.control_rate
        shafts_before.append(drive.shafts(body.angles()))
        shafts_before.pop(0)
        shafts = shafts_before[0]
        counts = counters.read([sense[axis] * (shafts[w] - start[w]) for axis, w in enumerate(wheel)])
        speeds = nominal.wheel_speeds(*command_at(commands, t - plant.command_latency))
        references = [round(math.copysign(1.0, r) * speeds[abs(r) - 1], 2) + 0.0 for r in plant.command_row]
        duties = loops.step(references, counts)
        for step in range(steps_a_tick):
            path.append(body.pose())
            on_their_way.append(duties)
            acting = on_their_way.pop(0)
            at_wheels = [0.0] * plant.wheels
            for axis, w in enumerate(wheel):
                at_wheels[w] = sense[axis] * acting[axis]
            torques, limits = drive.step(at_wheels, body.angles(), body.wheel_speeds(), body.accelerations())
            force = (0.0, 0.0)
            if plant.disturbance:
                more, drier, force = plant.disturbance(t + step * STEP_S, path[-1], body.data.qvel)
                for w, torque in more.items():
                    torques[w] += torque
                for w, limit in drier.items():
                    limits[w] += limit
            if step == 0:
                supply = drive.voltage + rng.gauss(0.0, 0.01) if plant.supply_measured else nominal.supply
            body.step(torques, limits, force)
            if creep and len(path) % CREEP_STEPS == 0:
                creep.look(nominal, body)
        rows.append((t, command_at(commands, t), references, counts, duties, supply))
    path.append(body.pose())
    return log.text(rows, camera.poses(path, STEP_S), plant.duty_logged)
