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
from robot import WHEELS

REST = (0.0, 0.0, 0.0)


def command_at(commands, t):
    """The command that holds at `t` s; rest before the first."""
    place = math.floor((t + 1e-9) / PERIOD_S)
    return commands[min(place, len(commands) - 1)] if place >= 0 else REST


def simulate(nominal, plant, commands, rng, wall=None):
    """The log of one drive, as text."""
    body = Body(nominal, plant, rng, wall)
    start = body.angles()
    drive, loops, counters = Drive(nominal, plant, start), SpeedLoops(nominal, plant), Counters(nominal, plant, rng)
    ticks = round(len(commands) * PERIOD_S * nominal.control_rate)
    camera = Camera(nominal, plant, ticks / nominal.control_rate, rng)
    steps_a_tick = round(1.0 / (nominal.control_rate * STEP_S))
    on_their_way = [[0.0] * WHEELS] * round(plant.actuation_latency / STEP_S)
    wheel = [abs(a) - 1 for a in plant.axis_wheel]
    sense = [math.copysign(1.0, a) for a in plant.axis_wheel]
    path, rows = [], []
    for tick in range(ticks):
        t = tick / nominal.control_rate
        shafts = drive.shafts(body.angles())
        counts = counters.read([sense[axis] * (shafts[w] - start[w]) for axis, w in enumerate(wheel)])
        speeds = nominal.wheel_speeds(*command_at(commands, t - plant.command_latency))
        references = [round(math.copysign(1.0, r) * speeds[abs(r) - 1], 2) + 0.0 for r in plant.command_row]
        duties = loops.step(references, counts)
        for step in range(steps_a_tick):
            path.append(body.pose())
            on_their_way.append(duties)
            acting = on_their_way.pop(0)
            at_wheels = [0.0] * WHEELS
            for axis, w in enumerate(wheel):
                at_wheels[w] = sense[axis] * acting[axis]
            torques, limits = drive.step(at_wheels, body.angles(), body.wheel_speeds(), body.accelerations())
            force = (0.0, 0.0)
            if plant.disturbance:
                more, drier, force = plant.disturbance(t + step * STEP_S, path[-1], body.data.qvel)
                torques = [a + b for a, b in zip(torques, more, strict=True)]
                limits = [a + b for a, b in zip(limits, drier, strict=True)]
            if step == 0:
                supply = drive.voltage + rng.gauss(0.0, 0.01) if plant.supply_measured else nominal.supply
            body.step(torques, limits, force)
        rows.append((t, command_at(commands, t), references, counts, duties, supply))
    path.append(body.pose())
    return log.text(rows, camera.poses(path, STEP_S))
