#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""slowest_files.py BUILD_DIR [--rows N] [--measure PATTERN] [--limit SECONDS]

Prints the translation units that take longest to compile, from ninja's log of a build
folder, and the total time of all compilations. Only objects that the build still makes
count. The log has wall-clock times: with several jobs, or on a busy machine, they are
longer than the CPU time, and a compiler cache makes them shorter.

--measure compiles the units whose object matches the regular expression once more, one
at a time, without compiler cache and without writing objects, and prints their user CPU
times instead. "." measures all of them, the slowest of the log first. --limit fails when a
printed unit takes longer.
"""
import argparse
import json
import os
import re
import resource
import shlex
import subprocess
import sys
from pathlib import Path


def compile_commands(build):
    """Returns the compile command of each object, by the object's name in ninja's log."""
    entries = json.loads((build / "compile_commands.json").read_text())
    commands = {}
    for entry in entries:
        words = shlex.split(entry["command"])
        name = entry.get("output") or words[words.index("-o") + 1]
        commands[name] = words
    return commands


def logged_seconds(build):
    """Returns the seconds of the last run of each output in ninja's log."""
    seconds = {}
    for line in (build / ".ninja_log").read_text().splitlines()[1:]:
        start_ms, end_ms, _, output, _ = line.split("\t")
        seconds[output] = (int(end_ms) - int(start_ms)) / 1000
    return seconds


def measured_seconds(build, words):
    """Compiles one unit and returns the user CPU seconds of the compiler."""
    words = [word for word in words if Path(word).name != "ccache"]
    words[words.index("-o") + 1] = os.devnull
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(words, cwd=build, check=True, env={**os.environ, "CCACHE_DISABLE": "1"})
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[2])
    parser.add_argument("build", type=Path)
    parser.add_argument("--rows", type=int, default=10)
    parser.add_argument("--measure", metavar="PATTERN")
    parser.add_argument("--limit", type=float, metavar="SECONDS")
    arguments = parser.parse_args()

    commands = compile_commands(arguments.build)
    logged = logged_seconds(arguments.build)
    seconds = {name: logged[name] for name in commands if name in logged}
    if arguments.measure:
        names = [name for name in commands if re.search(arguments.measure, name)
                 and "_verify_interface_header_sets" not in name]
        names.sort(key=lambda name: -seconds.get(name, 0.0))
        seconds = {}
        for name in names:
            seconds[name] = measured_seconds(arguments.build, commands[name])
            print(f"{seconds[name]:8.1f} s  {name}", file=sys.stderr, flush=True)
    if not seconds:
        sys.exit("no compilations: build first, or check the pattern")
    slowest = sorted(seconds, key=lambda name: -seconds[name])[:arguments.rows]
    clock = "user CPU time, one unit at a time" if arguments.measure else "wall-clock time"
    print(f"The {len(slowest)} slowest of {len(seconds)} translation units ({clock}):")
    for name in slowest:
        print(f"{seconds[name]:8.1f} s  {name}")
    print(f"{sum(seconds.values()):8.1f} s  total of all {len(seconds)}")
    if arguments.limit and seconds[slowest[0]] > arguments.limit:
        sys.exit(f"{slowest[0]} takes longer than {arguments.limit:g} s")


if __name__ == "__main__":
    main()
