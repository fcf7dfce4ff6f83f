"""What no catalogue of effects has: functions of time and state, called at every step of the engine."""

import math


def sign(x, width=0.05):
    """A sign without a jump."""
    return math.tanh(x / width)


def still(n=3):
    return [0.0] * n


def periodic_torque(wheel, torque, frequency):
    """A torque at one shaft, periodic in time."""

    def act(t, _pose, _velocity):
        torques = still()
        torques[wheel] = torque * math.sin(2.0 * math.pi * frequency * t)
        return torques, still(), (0.0, 0.0)

    return act


def heading_rub(wheel, torque, harmonic, phase):
    """Dry friction of one wheel that comes and goes with the heading."""

    def act(_t, pose, _velocity):
        limits = still()
        limits[wheel] = torque * 0.5 * (1.0 + math.cos(harmonic * pose[2] - phase))
        return still(), limits, (0.0, 0.0)

    return act


def late_sticking(wheel, torque, onset):
    """Dry friction of one wheel from `onset` s on."""

    def act(t, _pose, _velocity):
        limits = still()
        limits[wheel] = torque if t >= onset else 0.0
        return still(), limits, (0.0, 0.0)

    return act


def pushes(times, forces, seconds=0.08):
    """Pushes at the chassis, half a sine each, from drawn sides."""

    def act(t, _pose, _velocity):
        for start, (fx, fy) in zip(times, forces, strict=True):
            if start <= t < start + seconds:
                part = math.sin(math.pi * (t - start) / seconds)
                return still(), still(), (part * fx, part * fy)
        return still(), still(), (0.0, 0.0)

    return act


def grain(force, azimuth):
    """A carpet that drags along one direction of the field only."""
    gx, gy = math.cos(azimuth), math.sin(azimuth)

    def act(_t, _pose, velocity):
        drag = -force * sign(velocity[0] * gx + velocity[1] * gy, 0.01)
        return still(), still(), (drag * gx, drag * gy)

    return act
