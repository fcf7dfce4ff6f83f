"""Encoders and their counters: whole counts since the start, some of them lost."""

import math


class Counters:
    """One counter a shaft, with a random place of its first edge."""

    def __init__(self, nominal, plant, rng):
        self.plant = plant
        self.counts_per_rad = [s / nominal.rad_per_count() for s in plant.encoder_scale]
        self.threshold = plant.encoder_loss_above / nominal.control_rate  # rad a tick
        self.angles = [0.0] * plant.wheels
        self.kept = [0.0] * plant.wheels
        self.phase = [rng.random() for _ in range(plant.wheels)]

    def read(self, angles):
        """Counts of this tick at shaft angles since the start, rad."""
        for i in range(len(angles)):
            moved = angles[i] - self.angles[i]
            share = 1.0 - self.plant.encoder_loss[i] if abs(moved) >= self.threshold else 1.0
            self.kept[i] += moved * share * self.counts_per_rad[i]
        self.angles = angles
        return [math.floor(k + p) for k, p in zip(self.kept, self.phase, strict=True)]
