#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""Compares the processor time of two builds of the program.

    compare_programs.py OLD NEW DATA [--take TAKE] [--rounds N]

Runs both programs in turn, each with the same commands: the sample session, one
retargeting, one adaptation and one fit of DATA (the folder of recordings with truth), and
the replay of TAKE. Prints for each command the median processor times and the median of
the ratios NEW / OLD of the rounds. Other work on the machine disturbs both alike.
"""
import argparse
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

SAMPLE = pathlib.Path(__file__).resolve().parents[2] / "recordings/samples/first-light"


def commands(data, take, out):
    trial = data / "mocap/c3d_org_samples/sample_26"
    walk = data / "mocap/bandai/dataset-1_walk_normal_001.bvh"
    feet = out / "feet.xml"
    avatar = data / "avatars/vrm/cryptovoxels.vrm"
    yield "process", ["process", SAMPLE, "--out", out / "sample"]
    yield "retarget", ["retarget", walk, avatar, "--formats", "glb,bvh", "--out",
                       out / "retarget", "--constraints-out", feet]
    yield "adapt", ["adapt", walk, "--constraints", feet, "--balance", "horizontal",
                    "--out", out / "adapted.bvh"]
    yield "fit", ["fit", trial / "Standing_Hybrid_2.c3d", trial / "Walking_Hybrid_2.c3d",
                  "--out", out / "fit"]
    if take:
        yield "replay", ["replay", take, "--fast"]


def processor_time_s(program, words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([program, "--progress", "none", *map(str, words)],
                          capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    # 3 and 4 are verdicts on the input and on the quality of results.
    if done.returncode not in (0, 3, 4):
        sys.exit(f"error: exit code {done.returncode} of {program} {words[0]}: "
                 f"{done.stderr}")
    return (after.ru_utime - before.ru_utime) + (after.ru_stime - before.ru_stime)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("old", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--take", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    programs = {"old": arguments.old.resolve(), "new": arguments.new.resolve()}
    times = {}
    with tempfile.TemporaryDirectory() as scratch:
        for number in range(arguments.rounds):
            # The two programs take turns in running first.
            order = ["old", "new"] if number % 2 == 0 else ["new", "old"]
            for which in order:
                out = pathlib.Path(scratch) / f"{number}-{which}"
                out.mkdir()
                for name, words in commands(arguments.data, arguments.take, out):
                    times.setdefault(name, {"old": [], "new": []})[which].append(
                        processor_time_s(programs[which], words))
    print(f"{'command':10} {'old':>8} {'new':>8} {'new / old':>10}")
    for name, both in times.items():
        ratios = [new / old for old, new in zip(both["old"], both["new"])]
        print(f"{name:10} {statistics.median(both['old']):7.2f}s "
              f"{statistics.median(both['new']):7.2f}s {statistics.median(ratios):10.3f}  "
              f"({min(ratios):.2f} to {max(ratios):.2f})")


if __name__ == "__main__":
    main()
