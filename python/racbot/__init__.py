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
import os
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _racbot
from ._racbot import RacbotError

#: A file or a folder.
Path = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]

__all__ = ["BitTrueRobot", "RacbotError", "calibrate", "check", "gap", "read_run", "simulate", "wheel_words"]


def _columns(parts):
    """Arrays of what Rust hands over: (name, little-endian doubles). They are their reader's, to write to as well."""
    return {name: np.frombuffer(data, dtype="<f8") for name, data in parts}


def read_run(path: Path) -> Dict[str, np.ndarray]:
    """A run as `{column: array}`; NaN where a tick has no sample. Counts are whole numbers in doubles."""
    return _columns(_racbot.read_run(os.fsdecode(path)))


def simulate(
    robot: Optional[Path] = None,
    set_points: Optional[Sequence[Sequence[float]]] = None,
    *,
    hidden: Optional[Path] = None,
    limit_s: float = 60.0,
    seed: int = 1,
    camera: bool = True,
) -> Tuple[Dict[str, np.ndarray], str, np.ndarray]:
    """Drives along set points over the bit-true FPGA: `(columns, robot.toml of the log, true poses)`.

    `robot` and `hidden` are paths of robot.toml files: as the controller believes it to be [the paper's], and as it is.
    `set_points` are rows (x, y, v, omega); the paper's Fig. 6 where none are given. True poses are rows (t, x, y, theta).
    """
    points = None if set_points is None else _rows("set_points", set_points, ("x", "y", "v", "omega"))
    columns, toml, track = _racbot.simulate(_path(robot), points, _path(hidden), limit_s, seed, camera)
    return _columns(columns), toml, np.frombuffer(track, dtype="<f8").reshape(-1, 4)


def gap(
    folder: Path, robot: Optional[Path] = None, out: Optional[Path] = None, *, despite_mistakes: bool = False
) -> Dict[str, Any]:
    """What `racbot gap` finds in a data set, as it stands in gap.json; with `out` its report is written there."""
    return json.loads(_racbot.gap(os.fsdecode(folder), _path(robot), _path(out), despite_mistakes))


def calibrate(folder: Path, robot: Optional[Path] = None, *, despite_mistakes: bool = False) -> Dict[str, Any]:
    """Skews of the wheels as `racbot calibrate` estimates them."""
    return json.loads(_racbot.calibrate(os.fsdecode(folder), _path(robot), despite_mistakes))


def check(folder: Path, robot: Optional[Path] = None) -> List[str]:
    """Mistakes in how a data set is set up: a list of sentences, empty where there are none."""
    return _racbot.check(os.fsdecode(folder), _path(robot))


def wheel_words(robot: Optional[Path], twists: Sequence[Sequence[float]]) -> np.ndarray:
    """Speed set points of the wheels, as words of the FPGA, for rows (vx, vy, omega): an array of integers, a row each."""
    rows = _rows("twists", np.atleast_2d(twists), ("vx", "vy", "omega"))
    return np.array(_racbot.wheel_words(_path(robot), rows), dtype=np.int64)


class BitTrueRobot(_racbot.BitTrueRobot):
    """A robot on the bit-true FPGA in simulated time. `robot` is the path of a robot.toml, whose effects are what the
    robot does beyond what its own controller knows; the paper's robot where none is given."""

    def __new__(cls, robot: Optional[Path] = None) -> "BitTrueRobot":
        return super().__new__(cls, _path(robot))


def _path(path):
    return None if path is None else os.fsdecode(path)


def _rows(name, rows, columns):
    """Rows of numbers as tuples, one number a column."""
    out = [tuple(map(float, np.atleast_1d(row))) for row in rows]
    for number, row in enumerate(out, 1):
        if len(row) != len(columns):
            what = f"{name}: row {number} has {len(row)} numbers; give ({', '.join(columns)})"
            raise RacbotError(what)
    return out
