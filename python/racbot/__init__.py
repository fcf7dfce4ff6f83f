"""racbot for Python.

- `read_run(path)`: a recorded run, CSV or MCAP, as numpy arrays by the names of its columns.
- `simulate(robot, set_points, ...)`: a drive over the bit-true FPGA.
- `gap(folder)`, `calibrate(folder)`, `check(folder)`: the analyses of the command of the same name, as dictionaries. A
  data set that is set up wrong is a `RacbotError`, as it is refused there; `despite_mistakes=True` goes on.
- `wheel_words(robot, twists)`: the FPGA's inverse kinematics, bit for bit.
- `BitTrueRobot`: a robot on the bit-true FPGA, tick by tick; `racbot.environment` makes a Gymnasium environment of it.

Units, columns and frames are those of `docs/book/src/log-format.md`: metres, radians, x to the right, y forward.
"""
import json

import numpy as np

from . import _racbot
from ._racbot import RacbotError

__all__ = ["BitTrueRobot", "RacbotError", "calibrate", "check", "gap", "read_run", "simulate", "wheel_words"]


def _columns(parts):
    """Arrays of what Rust hands over: (name, little-endian doubles)."""
    return {name: np.frombuffer(data, dtype="<f8") for name, data in parts}


def read_run(path):
    """A run as `{column: array}`; NaN where a tick has no sample. Counts are whole numbers in doubles."""
    return _columns(_racbot.read_run(str(path)))


def simulate(robot=None, set_points=None, *, hidden=None, limit_s=60.0, seed=1, camera=True):
    """Drives along set points over the bit-true FPGA: `(columns, robot.toml of the log, true poses)`.

    `robot` and `hidden` are paths of robot.toml files: as the controller believes it to be [the paper's], and as it is.
    `set_points` are rows (x, y, v, omega); the paper's Fig. 6 where none are given. True poses are rows (t, x, y, theta).
    """
    points = None if set_points is None else [tuple(map(float, row)) for row in set_points]
    columns, toml, track = _racbot.simulate(_path(robot), points, _path(hidden), limit_s, seed, camera)
    return _columns(columns), toml, np.frombuffer(track, dtype="<f8").reshape(-1, 4)


def gap(folder, robot=None, out=None, *, despite_mistakes=False):
    """What `racbot gap` finds in a data set, as it stands in gap.json; with `out` its report is written there."""
    return json.loads(_racbot.gap(str(folder), _path(robot), _path(out), despite_mistakes))


def calibrate(folder, robot=None, *, despite_mistakes=False):
    """Skews of the wheels as `racbot calibrate` estimates them."""
    return json.loads(_racbot.calibrate(str(folder), _path(robot), despite_mistakes))


def check(folder, robot=None):
    """Mistakes in how a data set is set up: a list of sentences, empty where there are none."""
    return _racbot.check(str(folder), _path(robot))


def wheel_words(robot, twists):
    """Speed set points of the wheels, as words of the FPGA, for rows (vx, vy, omega): an array of integers, a row each."""
    rows = [tuple(map(float, row)) for row in np.atleast_2d(twists)]
    return np.array(_racbot.wheel_words(_path(robot), rows), dtype=np.int64)


class BitTrueRobot(_racbot.BitTrueRobot):
    """A robot on the bit-true FPGA in simulated time. `robot` is the path of a robot.toml, whose effects are what the
    robot does beyond what its own controller knows; the paper's robot where none is given."""

    def __new__(cls, robot=None):
        return super().__new__(cls, _path(robot))


def _path(path):
    return None if path is None else str(path)
