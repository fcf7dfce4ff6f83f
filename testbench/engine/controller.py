"""The speed loops of the robot, as robot.toml's comments and the design state them."""


class SpeedLoops:
    """One PI law an axis, on the difference of two counts."""

    def __init__(self, nominal, plant):
        self.rate = nominal.control_rate
        self.kp, self.ki = nominal.kp * plant.kp_scale, nominal.ki * plant.ki_scale
        self.speed_per_count = nominal.rad_per_count() * nominal.control_rate
        self.integral = [0.0] * plant.wheels
        self.quantum, self.windup_limit = plant.duty_quantum, plant.windup_limit
        self.history = [[0] * plant.wheels] * (plant.count_age_ticks + 1)

    def step(self, references, counts):
        """Duties for this tick, rounded to 0.001."""
        self.history.append(counts)
        now, before = self.history[1], self.history[0]
        self.history.pop(0)
        duties = []
        for i in range(len(counts)):
            error = references[i] - (now[i] - before[i]) * self.speed_per_count
            moved = self.integral[i] + self.ki * error / self.rate
            raw = self.kp * error + moved
            if self.windup_limit is not None:
                self.integral[i] = min(max(moved, -self.windup_limit), self.windup_limit)
            elif not (abs(raw) > 1.0 and error * raw > 0.0):
                self.integral[i] = moved
            duty = min(max(self.kp * error + self.integral[i], -1.0), 1.0)
            duties.append(round(round(duty / self.quantum) * self.quantum, 3))
        return duties
