"""Makes a data set with something hidden in it: robot.toml, four runs and, elsewhere, the truth.

python3 make.py --out sets --truth sealed --seed 7 --hide wheel-skew,coulomb-friction
"""

import argparse
import json
import math
import random
from pathlib import Path

import run
import effects
import excitation
import variety
from robot import Nominal, Plant


def usual(rng, nominal):
    """What is in every set, drawn."""
    plant = Plant(nominal)
    weight = nominal.mass / 2.4
    plant.roller_drag = [weight * rng.uniform(0.06, 0.09) for _ in range(nominal.wheels)]
    plant.friction = rng.uniform(0.75, 1.0)
    plant.contact_time = rng.uniform(0.0016, 0.0024)
    plant.grip = effects.between(rng, 4.0, 20.0)
    plant.supply_measured = rng.random() < 0.75
    return plant


def wall_across(commands, rng):
    """A wall that a robot that follows its commands from near the origin would run into: (azimuth, distance)."""
    x = y = heading = 0.0
    path = [(0.0, 0.0)]
    for vx, vy, w in commands:
        c, s = math.cos(heading), math.sin(heading)
        x += (c * vx - s * vy) * excitation.PERIOD_S
        y += (s * vx + c * vy) * excitation.PERIOD_S
        heading += w * excitation.PERIOD_S
        path.append((x, y))
    far = max(path, key=lambda p: p[0] ** 2 + p[1] ** 2)
    reach = math.hypot(*far)
    return math.atan2(far[1], far[0]), 0.085 + rng.uniform(0.5, 0.8) * reach


def make(folder, truth, seed, names, varied=False):
    """Writes the set; the same arguments give the same bytes. `varied`: another robot, other rates, another camera."""
    rng = random.Random(f"{seed} {' '.join(names)}{' varied' if varied else ''}")
    nominal = variety.robot(rng) if varied else Nominal()
    plant = usual(rng, nominal)
    seconds = variety.log(rng, plant, names) if varied else [round(rng.uniform(6.0, 8.0), 1) for _ in range(4)]
    if "gear-backlash" in names:
        nominal.kp *= 0.3  # with the usual gain a rotor rattles in its play
    hidden = [effects.hide(name, rng, plant) for name in names]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "robot.toml").write_text(nominal.toml())
    runs = []
    meter = run.CreepMeter() if "wheel-creep" in names else None
    for number, length in enumerate(seconds, 1):
        pattern = rng.choice(excitation.FAMILIES[(number - 1) % len(excitation.FAMILIES)])
        commands = excitation.commands(pattern, length, rng)
        wall = wall_across(commands, rng) if plant.wall else None
        name = f"run_{number:02}.csv"
        (folder / name).write_text(run.simulate(nominal, plant, commands, rng, wall, meter))
        runs.append({"file": name, "excitation": pattern, "seconds": length})
    for effect in hidden:
        if effect["name"] == "wheel-creep":
            effect["parameters"]["creep_s_per_kg"] = meter.creep()
    answer = {
        "seed": seed,
        "hidden": hidden,
        "supply_measured": plant.supply_measured,
        "duty_logged": plant.duty_logged,
        "camera": {"rate": nominal.camera_rate, "noise": plant.camera_noise, "lost": plant.lost_frames},
        "runs": runs,
    }
    truth.parent.mkdir(parents=True, exist_ok=True)
    truth.write_text(json.dumps(answer, indent=1) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True, help="folder of the data set")
    parser.add_argument("--truth", type=Path, required=True, help="file that gets the truth")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--hide", default="", help=f"comma-separated: {', '.join([*effects.CATALOGUE, *effects.OUTSIDE])}"
    )
    parser.add_argument("--varied", action="store_true", help="another robot, other rates, another camera")
    arguments = parser.parse_args()
    names = [n for n in arguments.hide.split(",") if n]
    for name in names:
        if name not in effects.CATALOGUE and name not in effects.OUTSIDE:
            parser.error(f"{name}: no such effect; --help lists them")
    make(arguments.out, arguments.truth, arguments.seed, names, arguments.varied)


if __name__ == "__main__":
    main()
