"""An overhead camera: frames on its own clock, late, scaled and noisy; stamps on the log's ticks."""

import math


def at(path, t, step):
    """Pose at `t` s, between samples."""
    place = max(t / step, 0.0)
    k = min(int(place), len(path) - 2)
    part = min(place - k, 1.0)
    return [a + part * (b - a) for a, b in zip(path[k], path[k + 1], strict=True)]


def speed(path, t, step):
    """Of the robot over 20 ms about `t` s, m/s."""
    a, b = at(path, t - 0.01, step), at(path, t + 0.01, step)
    return math.hypot(b[0] - a[0], b[1] - a[1]) / 0.02


class Camera:
    """Takes frames of a pose (x, y, heading) that it is told of at every step of the engine."""

    def __init__(self, nominal, plant, seconds, rng):
        self.plant = plant
        first = rng.uniform(0.001, 1.0 / nominal.camera_rate)
        self.frames = []  # (capture time, tick that it is logged at)
        seen = set()
        k = 0
        while True:
            stamp = first + k / nominal.camera_rate
            k += 1
            if stamp >= seconds - 0.001:
                break
            if plant.lost_frames and rng.random() < plant.lost_frames:
                continue
            capture = stamp - plant.camera_latency
            logged = stamp * (1.0 + plant.stamp_drift) + (
                rng.gauss(0.0, plant.stamp_jitter) if plant.stamp_jitter else 0.0
            )
            tick = round(logged * nominal.control_rate)
            if 0 <= tick < round(seconds * nominal.control_rate) and tick not in seen:
                seen.add(tick)
                self.frames.append((capture, tick))
        self.rng = rng

    def poses(self, path, step):
        """Logged rows {tick: (x, y, heading)} from a path sampled every `step` s."""
        p, rows = self.plant, {}
        for capture, tick in self.frames:
            if p.camera_latency_per_speed:
                capture -= p.camera_latency_per_speed * speed(path, capture, step)
            x, y, heading = at(path, capture, step)
            x, y = x + p.camera_drift[0] * capture, y + p.camera_drift[1] * capture
            mx, my = p.marker_offset
            c, s = math.cos(heading), math.sin(heading)
            x, y = x + c * mx - s * my, y + s * mx + c * my
            scale = p.camera_scale * (1.0 + p.lens_k1 * (x * x + y * y))
            noise = [self.rng.gauss(0.0, sigma) for sigma in p.camera_noise]
            angle = heading + p.marker_heading + noise[2]
            rows[tick] = (scale * x + noise[0], scale * y + noise[1], math.remainder(angle, 2.0 * math.pi))
        return rows
