"""What no law of the plant has: functions of time, pose and velocity, called at every step of the engine.

Each returns torques {wheel: Nm}, limits of dry friction {wheel: Nm} and a force on the chassis (N, world).
"""

import math

NO_FORCE = (0.0, 0.0)


def sign(x, width=0.05):
    """A sign without a jump."""
    return math.tanh(x / width)


def periodic_torque(wheel, torque, frequency):
    """A torque at one shaft, periodic in time."""

    def act(t, _pose, _velocity):
        return {wheel: torque * math.sin(2.0 * math.pi * frequency * t)}, {}, NO_FORCE

    return act


def periodic_push(force, azimuth, frequency):
    """A push at the chassis along one direction of the field, periodic in time."""

    def act(t, _pose, _velocity):
        f = force * math.sin(2.0 * math.pi * frequency * t)
        return {}, {}, (f * math.cos(azimuth), f * math.sin(azimuth))

    return act


def heading_rub(wheels, torque, harmonic, phase):
    """Dry friction of some wheels that comes and goes with the heading."""

    def act(_t, pose, _velocity):
        limit = torque * 0.5 * (1.0 + math.cos(harmonic * pose[2] - phase))
        return {}, {wheel: limit for wheel in wheels}, NO_FORCE

    return act


def late_sticking(wheel, torque, onset):
    """Dry friction of one wheel from `onset` s on."""

    def act(t, _pose, _velocity):
        return {}, {wheel: torque if t >= onset else 0.0}, NO_FORCE

    return act


def pushes(times, forces, seconds=0.08):
    """Pushes at the chassis, half a sine each, from drawn sides."""

    def act(t, _pose, _velocity):
        for start, (fx, fy) in zip(times, forces, strict=True):
            if start <= t < start + seconds:
                part = math.sin(math.pi * (t - start) / seconds)
                return {}, {}, (part * fx, part * fy)
        return {}, {}, NO_FORCE

    return act


def cable(anchor, slack, stiffness, damping):
    """A cable from a point of the field that pulls where it is taut."""

    def act(_t, pose, velocity):
        dx, dy = anchor[0] - pose[0], anchor[1] - pose[1]
        length = math.hypot(dx, dy)
        if length <= slack:
            return {}, {}, NO_FORCE
        ux, uy = dx / length, dy / length
        pull = max(stiffness * (length - slack) - damping * (velocity[0] * ux + velocity[1] * uy), 0.0)
        return {}, {}, (pull * ux, pull * uy)

    return act


def rough_patch(centre, radius, force):
    """A patch of the field that drags against the motion."""

    def act(_t, pose, velocity):
        if math.hypot(pose[0] - centre[0], pose[1] - centre[1]) > radius:
            return {}, {}, NO_FORCE
        speed = math.hypot(velocity[0], velocity[1])
        drag = -force * sign(speed, 0.02) / max(speed, 1e-9)
        return {}, {}, (drag * velocity[0], drag * velocity[1])

    return act


def grain(force, azimuth):
    """A carpet that drags along one direction of the field only."""
    gx, gy = math.cos(azimuth), math.sin(azimuth)

    def act(_t, _pose, velocity):
        drag = -force * sign(velocity[0] * gx + velocity[1] * gy, 0.01)
        return {}, {}, (drag * gx, drag * gy)

    return act
