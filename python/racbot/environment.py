"""A Gymnasium environment over the bit-true robot: drive it to a place by body velocities.

    import gymnasium, racbot.environment
    env = gymnasium.make("racbot/Reach-v0", robot="robot.toml")

Needs `pip install 'racbot[gym]'`.
"""
import gymnasium
import numpy as np

from . import BitTrueRobot

#: Control ticks (1 ms each, by default) between two actions: the rate of a camera.
TICKS = 16
#: Largest action: m/s, m/s, rad/s.
LARGEST = np.array([1.0, 1.0, 6.0], dtype=np.float32)
#: Change of the command per action: what the robot's motors can follow, m/s² and rad/s² times the time of an action.
SLEW = np.array([1.0, 1.0, 30.0])
#: Size of the square that targets are drawn from, m.
SIDE = 2.0
#: Distance and heading at which the target is reached, m and rad.
NEAR = (0.02, 0.1)


class Reach(gymnasium.Env):
    """Observation: target in the robot's frame (right, forward, sine and cosine of the turn left), then the body velocity
    (right, forward, turn). Action: body velocity, as shares of `LARGEST`; it is slewed by `SLEW`. Reward:
    metres (and radians, a tenth each) come nearer; 1 for being there."""

    metadata = {"render_modes": []}

    def __init__(self, robot=None, limit=600):
        self._file, self._limit = robot, limit
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (3,), np.float32)
        # A robot that drives off for the whole of an episode stays within these.
        far = np.array([20.0, 20.0, 1.0, 1.0, 10.0, 10.0, 100.0], dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-far, far, dtype=np.float32)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self._robot = BitTrueRobot(self._file)
        self._target = self.np_random.uniform([-SIDE / 2, -SIDE / 2, -np.pi], [SIDE / 2, SIDE / 2, np.pi])
        self._command, self._steps = np.zeros(3), 0
        self._left = self._distance()
        return self._observe(), {}

    def step(self, action):
        wanted = np.clip(np.asarray(action, dtype=float), -1, 1) * LARGEST
        most = SLEW * TICKS * self._robot.tick_s
        self._command = self._command + np.clip(wanted - self._command, -most, most)
        self._robot.step(*self._command, TICKS)
        self._steps += 1
        left = self._distance()
        x, y, turn = self._error()
        there = bool(np.hypot(x, y) < NEAR[0] and abs(turn) < NEAR[1])
        reward = float(self._left - left) + (1.0 if there else 0.0)
        self._left = left
        return self._observe(), reward, there, self._steps >= self._limit, {"pose": self._robot.pose}

    def _error(self):
        x, y, theta = self._robot.pose
        dx, dy = self._target[0] - x, self._target[1] - y
        turn = np.arctan2(np.sin(self._target[2] - theta), np.cos(self._target[2] - theta))
        return np.cos(theta) * dx + np.sin(theta) * dy, np.cos(theta) * dy - np.sin(theta) * dx, turn

    def _distance(self):
        x, y, turn = self._error()
        return np.hypot(x, y) + 0.1 * abs(turn)

    def _observe(self):
        x, y, turn = self._error()
        return np.array([x, y, np.sin(turn), np.cos(turn), *self._robot.twist], dtype=np.float32)


gymnasium.register("racbot/Reach-v0", entry_point=Reach)
