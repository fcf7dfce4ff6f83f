"""Makes sets with hidden effects, lets `racbot gap` look, and scores what gap.json says.

    python3 score.py --racbot ../../target/release/racbot --seed 1 --controls 10 --singles 2 --pairs 1 --outside 2

Sets are kept in the folder of --work; a second call goes on where the first one stopped.
`--again` looks again at the sets that are there. The workflow is told a set's folder only; the truth lies elsewhere.
"""

import argparse
import json
import math
import resource
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import effects
from make import make

GRADES = ["right", "twin", "honest", "extra", "part", "below", "nothing", "wrong", "failed"]
BELOW = 1.5  # times the detection limit that the answer states: what is smaller need not be named


def stands_for(name, hidden, answer):
    """Whether a named effect is the hidden one or stands in a printed set of look-alikes with it."""
    return name == hidden["name"] or any(hidden["name"] in s and name in s for s in answer["alternatives"])


def on_the_wheel(effect, hidden):
    if not (hidden["wheels"] and effect["wheels"]) or effect["name"] != hidden["name"]:
        return True
    return bool(set(hidden["wheels"]) & set(effect["wheels"]))


def forgiven(name, truth):
    """A battery of 0.05 ohm is in every set; where the supply was not measured, it may be named."""
    return name == "battery-sag" and not truth["supply_measured"]


def grade(truth, answer):
    """One word, see GRADES, and the names that are too many."""
    hidden = truth["hidden"]
    named = answer["effects"]
    too_many = [
        e["name"]
        for e in named
        if not any(stands_for(e["name"], h, answer) and on_the_wheel(e, h) for h in hidden)
        and not forgiven(e["name"], truth)
    ]
    if any(h["outside"] for h in hidden):
        nearest = answer.get("nearest", [])
        if answer["verdict"] == "unexplained" and all(e["name"] in nearest for e in named):
            return "right", []
        return ("nothing" if not named else "extra" if answer["unexplained"] else "wrong"), [e["name"] for e in named]
    if not hidden:
        return ("wrong" if too_many else "right"), too_many
    found = [h for h in hidden if any(stands_for(e["name"], h, answer) and on_the_wheel(e, h) for e in named)]
    if not found and not too_many and answer["verdict"] == "unexplained":
        return "honest", []
    if not found and not too_many:
        return ("below" if all(below(h, answer) for h in hidden) else "nothing"), []
    if not found:
        return "wrong", too_many
    if too_many:
        return ("extra" if len(found) == len(hidden) else "wrong"), too_many
    if len(found) < len(hidden):
        return "part", []
    exact = all(any(e["name"] == h["name"] for e in named) for h in hidden)
    return ("right" if exact else "twin"), []


def below(hidden, answer):
    """Whether the answer says that something of this size would not be named."""
    sizes = hidden["parameters"]
    limits = [e for e in answer["detection_limits"] if e["name"] == hidden["name"] and e["parameter"] in sizes]
    return bool(limits) and all(abs(sizes[e["parameter"]]) < BELOW * e["limit"] for e in limits)


def parameters(truth, answer):
    """Rows: effect, parameter, true value, value found, interval."""
    rows = []
    for h in truth["hidden"]:
        for e in answer["effects"]:
            if e["name"] == h["name"]:
                for name, found in e["parameters"].items():
                    true = h["parameters"].get(name)
                    if name == "azimuth_rad" and true is not None:  # a grain has no front
                        true += math.pi * round((found["value"] - true) / math.pi)
                    if true is not None and "ci95" in found:  # a direction has none
                        rows.append([h["name"], name, true, found["value"], found["ci95"]])
    return rows


def one(job):
    """Makes a set unless it is there, runs the workflow, writes the score beside the truth."""
    work, racbot, seed, group, names, again, varied = job
    label = f"{seed:05}"
    folder, truth_file, score_file = (
        work / "sets" / label,
        work / "truth" / f"{label}.json",
        work / "score" / f"{label}.json",
    )
    if score_file.exists() and not again:
        return json.loads(score_file.read_text())
    if not truth_file.exists():
        make(folder, truth_file, seed, names, varied)
    out = work / "answers" / label
    out.mkdir(parents=True, exist_ok=True)
    begin, used = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    call = subprocess.run([racbot, "gap", folder, "--out", out], capture_output=True, text=True)
    seconds, ended = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = ended.ru_utime + ended.ru_stime - used.ru_utime - used.ru_stime
    truth = json.loads(truth_file.read_text())
    score = {"seed": seed, "group": group, "hidden": truth["hidden"], "seconds": seconds, "cpu_seconds": cpu}
    if call.returncode != 0:
        score |= {"grade": "failed", "too_many": [], "message": call.stderr.strip()}
    else:
        answer = json.loads((out / "gap.json").read_text())
        word, too_many = grade(truth, answer)
        score |= {
            "grade": word,
            "too_many": too_many,
            "verdict": answer["verdict"],
            "named": [[e["name"], e["wheels"]] for e in answer["effects"]],
            "alternatives": answer["alternatives"],
            "unexplained": answer["unexplained"],
            "parameters": parameters(truth, answer),
            "gap": {k: answer["gap"][k] for k in ("before", "after", "floor", "closed")},
        }
    score_file.parent.mkdir(parents=True, exist_ok=True)
    score_file.write_text(json.dumps(score, indent=1) + "\n")
    return score


def jobs(arguments):
    """The sets of a series, each with a seed of its own."""
    only = [n for n in arguments.only.split(",") if n]
    wanted = [("control", [])] * arguments.controls
    singles = [n for n in effects.CATALOGUE if not only or n in only]
    wanted += [("single", [n]) for _ in range(arguments.singles) for n in singles]
    wanted += [("pair", list(p)) for _ in range(arguments.pairs) for p in effects.PAIRS]
    outside = [n for n in effects.OUTSIDE if not only or n in only]
    wanted += [("outside", [n]) for _ in range(arguments.outside) for n in outside]
    return [
        (arguments.work, arguments.racbot, arguments.seed * 1000 + k, group, names, arguments.again, arguments.varied)
        for k, (group, names) in enumerate(wanted)
    ]


def line(score):
    """One set in one line."""
    hidden = "+".join(h["name"] + "".join(map(str, h["wheels"])) for h in score["hidden"]) or "-"
    named = "+".join(n + "".join(map(str, w)) for n, w in score.get("named", [])) or "-"
    values = " ".join(
        f"{p}={t:.3g}:{v:.3g}{'' if lo <= t <= hi else '!'}" for _, p, t, v, (lo, hi) in score.get("parameters", [])
    )
    return f"{score['seed']:05} {score['grade']:8}{score['cpu_seconds']:5.1f}s  {hidden:32} {named} {values}"


def table(scores):
    """What the series comes to."""
    print(f"\n{'hidden':34}{'sets':>5}" + "".join(f"{g:>9}" for g in GRADES))
    groups = {}
    for s in scores:
        name = "+".join(h["name"] for h in s["hidden"]) if s["group"] != "control" else "nothing"
        for key in (f"all: {s['group']}", name):
            groups.setdefault((s["group"], key), []).append(s)
    order = {"control": 0, "single": 1, "pair": 2, "outside": 3}
    for (_, name), members in sorted(groups.items(), key=lambda g: (order[g[0][0]], g[0][1])):
        counts = [sum(s["grade"] == g for s in members) for g in GRADES]
        print(f"{name:34}{len(members):5}" + "".join(f"{c or '.':>9}" for c in counts))
    rows = [r for s in scores for r in s.get("parameters", []) if r[4][1] > r[4][0]]
    if rows:
        inside = sum(lo <= true <= hi for _, _, true, _, (lo, hi) in rows)
        print(f"\n95 % intervals that hold the truth: {inside} of {len(rows)}")
    closed = sorted(s["gap"]["closed"] for s in scores if s.get("gap", {}).get("closed") is not None)
    if closed:
        most = sum(c >= 0.9 for c in closed)
        print(f"gap closed: {closed[len(closed) // 2]:.0%} in the middle, 90 % or more in {most} of {len(closed)}")
    cpu, clock = (max(s[key] for s in scores) for key in ("cpu_seconds", "seconds"))
    print(f"slowest analysis: {cpu:.1f} s of CPU, {clock:.1f} s by the clock")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--racbot", type=Path, required=True, help="the binary to judge")
    parser.add_argument(
        "--work", type=Path, default=Path("target/engine-sets"), help="folder of sets, truths and scores"
    )
    parser.add_argument("--seed", type=int, default=1)
    for group, count in (("controls", 4), ("singles", 1), ("pairs", 0), ("outside", 0)):
        parser.add_argument(f"--{group}", type=int, default=count, help="how many (of every kind)")
    parser.add_argument("--only", default="", help="these effects only, comma-separated")
    parser.add_argument("--varied", action="store_true", help="another robot, other rates, another camera in every set")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--again", action="store_true", help="analyse the sets that are there again")
    arguments = parser.parse_args()
    scores = []
    with ProcessPoolExecutor(min(arguments.processes, 2)) as pool:
        for score in pool.map(one, jobs(arguments)):
            scores.append(score)
            print(line(score), flush=True)
    if not scores:
        sys.exit("nothing to do: all counts are zero")
    table(scores)


if __name__ == "__main__":
    main()
