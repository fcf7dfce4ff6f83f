"""Judges every data set below a folder, on all cores or on a cluster, and prints a table.

    python judge_folder.py logs                               # this machine
    python judge_folder.py logs --scheduler tcp://host:8786   # a Dask cluster that sees the same folder

Every data set (a folder with robot.toml and runs) is one task; what comes back is a few lines of JSON.
"""
import argparse
import pathlib

import dask
import racbot


def judge(folder):
    """Verdict and effects of one data set; a data set that cannot be judged says why."""
    try:
        found = racbot.gap(folder)
    except racbot.RacbotError as error:
        return {"folder": str(folder), "verdict": "error", "effects": [str(error)]}
    return {"folder": str(folder), "verdict": found["verdict"], "effects": [e["name"] for e in found["effects"]]}


def judge_all(folder, scheduler=None):
    """The judgements of all data sets below a folder."""
    sets = sorted(path.parent for path in pathlib.Path(folder).rglob("robot.toml"))
    tasks = [dask.delayed(judge)(path) for path in sets]
    if scheduler is None:
        # The analysis uses all cores by itself and lets Python go meanwhile.
        return list(dask.compute(*tasks, scheduler="threads", num_workers=2))
    from dask.distributed import Client

    with Client(scheduler) as client:
        return client.gather(client.compute(tasks))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder")
    parser.add_argument("--scheduler", help="address of a Dask scheduler")
    options = parser.parse_args()
    for result in judge_all(options.folder, options.scheduler):
        print(f"{result['folder']}  {result['verdict']}  {', '.join(result['effects'])}")
