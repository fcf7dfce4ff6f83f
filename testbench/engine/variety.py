"""Other robots than the RacBot, and logs as other people record them, drawn."""

import math

from robot import RAC, Nominal

LONGEST_S = 60.0  # of all runs of a set together


def mounts(rng):
    """Azimuths of three or four wheels, mirrored about the forward axis."""
    kind = rng.choice(("three", "three, spread", "four", "four"))
    if kind == "three":
        return RAC
    if kind == "three, spread":
        front = rng.uniform(45.0, 75.0)
        return tuple(math.radians(a) for a in (90.0 + front, 270.0, 90.0 - front))
    front, rear = rng.uniform(45.0, 62.0), rng.uniform(35.0, 50.0)
    return tuple(math.radians(a) for a in (90.0 + front, 270.0 - rear, 270.0 + rear, 90.0 - front))


def robot(rng):
    """Its size, weight, motors, gears, encoders and loop."""
    body_radius = rng.uniform(0.075, 0.12)
    mass = rng.uniform(1.5, 4.0)
    wheel_radius = rng.uniform(0.022, 0.035)
    out = Nominal(
        mounts=mounts(rng),
        wheel_radius=round(wheel_radius, 4),
        body_radius=round(body_radius, 4),
        mass=round(mass, 2),
        yaw_inertia=round(mass * body_radius**2 * rng.uniform(0.45, 0.65), 5),
        gear_ratio=rng.choice((3.0, 3.71, 4.4, 5.0)),
        gear_efficiency=rng.choice((0.8, 0.85, 0.88, 0.92)),
        counts_per_motor_turn=rng.choice((1440, 2048, 2048, 4096)),
        supply=rng.choice((7.2, 9.6, 11.1, 14.8)),
        control_rate=rng.choice((100, 200, 250, 500, 1000, 1000)),
        camera_rate=rng.choice((30.0, 50.0, 60.0, 75.0, 100.0)),
        resistance=round(rng.uniform(1.5, 2.6), 2),
        torque_constant=round(rng.uniform(0.006, 0.012), 5),
        rotor_inertia=rng.choice((1.8e-7, 2.7e-7, 4.5e-7)),
        motor_friction=rng.choice((0.0001, 0.00015, 0.0003)),
    )
    # As strong as the floor holds with a margin, like the RacBot: what slips has an effect of its own.
    grip = rng.uniform(0.3, 0.5) * out.mass * 9.81 / out.wheels * out.wheel_radius
    out.resistance = round(out.resistance * max(out.stall() / grip, 0.7), 2)
    # The bandwidth of the RacBot's loop: torque per speed over the inertia at a wheel.
    usual = Nominal()
    stiffness = out.stall() / (out.mass / out.wheels * out.wheel_radius**2)
    share = usual.stall() / (usual.mass / usual.wheels * usual.wheel_radius**2) / stiffness
    out.kp, out.ki = round(usual.kp * share, 3), round(usual.ki * share, 2)
    return out


def log(rng, plant, names):
    """What is recorded of it, and the lengths of the runs, s."""
    noise = rng.uniform(0.0005, 0.003)
    plant.camera_noise = (noise, noise, math.radians(rng.uniform(0.2, 0.8)))
    plant.lost_frames = rng.choice((0.0, 0.0, rng.uniform(0.02, 0.2)))
    # Without duties nothing of drive and controller shows.
    plant.duty_logged = bool(names) or rng.random() < 0.8
    count = rng.randint(3, 8)
    return [round(rng.uniform(5.0, min(15.0, LONGEST_S / count)), 1) for _ in range(count)]
