"""An overhead camera: frames on its own clock, late, scaled and noisy; stamps on the log's ticks."""

import math


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
            place = max(capture / step, 0.0)
            k = min(int(place), len(path) - 2)
            part = min(place - k, 1.0)
            x, y, heading = (a + part * (b - a) for a, b in zip(path[k], path[k + 1], strict=True))
            mx, my = p.marker_offset
            c, s = math.cos(heading), math.sin(heading)
            x, y = x + c * mx - s * my, y + s * mx + c * my
            scale = p.camera_scale * (1.0 + p.lens_k1 * (x * x + y * y))
            noise = [self.rng.gauss(0.0, sigma) for sigma in p.camera_noise]
            angle = heading + p.marker_heading + noise[2]
            rows[tick] = (scale * x + noise[0], scale * y + noise[1], math.remainder(angle, 2.0 * math.pi))
        return rows
