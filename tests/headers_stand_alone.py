#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""Compiles every public header of a configured build alone.

    headers_stand_alone.py BUILD [--jobs N]

The commands are those of CMake's target all_verify_interface_header_sets, taken from
BUILD/compile_commands.json, so that a header sees only the library paths that its room
publishes. Most of their time goes into the headers of other projects. A set of these is
therefore compiled once and given to each header that includes the whole set by itself,
directly or through others: such a header compiles alone if and only if it compiles so.

Exits with 1 and names the headers that do not compile, or when there is no header.
"""
import argparse
import concurrent.futures
import functools
import json
import pathlib
import re
import shlex
import subprocess
import sys

# The sets, from the largest to the smallest. g++ alone: other compilers precompile in
# other ways.
PLACES = ["<array>", "<cstddef>", "<optional>", "<string>", "<vector>",
          "<glm/gtc/quaternion.hpp>", "<glm/vec3.hpp>"]
TIMES = [*PLACES, "<chrono>", "<cmath>"]
SETS = [[*TIMES, "<Eigen/Geometry>"], [*PLACES, "<Eigen/Core>"], ["<Eigen/Core>"],
        [*TIMES, "<filesystem>"], [*PLACES, "<filesystem>"], ["<string>", "<filesystem>"],
        TIMES, PLACES, ["<string>", "<chrono>"], ["<glm/vec3.hpp>", "<string>"], ["<chrono>"],
        ["<string>"], ["<vector>"]]
INCLUDE = re.compile(r'^#include\s+("[^"]+"|<[^>]+>)', re.MULTILINE)
VERIFIED = "_verify_interface_header_sets"


@functools.cache
def included_by(header, root):
    """Everything that a header includes, by the names in its text."""
    found = set()
    waiting = [header]
    while waiting:
        for name in INCLUDE.findall(waiting.pop().read_text()):
            if name in found:
                continue
            found.add(name)
            own = root / name[1:-1]
            if name.startswith('"') and own.is_file():
                waiting.append(own)
    return frozenset(found)


class Headers:
    def __init__(self, build):
        self.build = build
        self.root = pathlib.Path(
            re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$",
                      (build / "CMakeCache.txt").read_text(), re.MULTILINE).group(1))
        self.scratch = build / "headers_stand_alone"
        self.scratch.mkdir(exist_ok=True)
        # [(header, the command's words without its source and object)]
        self.all = []
        commands = build / "compile_commands.json"
        for entry in json.loads(commands.read_text()) if commands.is_file() else []:
            source = entry["file"]
            if VERIFIED not in source:
                continue
            header = source.rsplit(VERIFIED + "/", 1)[1].removesuffix(".cxx")
            words = shlex.split(entry["command"])
            at = words.index("-o")
            del words[at:at + 2]
            if "-x" in words:
                at = words.index("-x")
                del words[at:at + 2]
            words.remove("-c")
            words.remove(source)
            self.all.append((header, words))
        self.is_gnu = bool(self.all) and "Free Software Foundation" in subprocess.run(
            [self.all[0][1][0], "--version"], capture_output=True, text=True).stdout

    def precompile(self):
        """Returns for each header the set it is given, or None."""
        chosen = {}
        made = {}
        for header, words in self.all if self.is_gnu else []:
            own = included_by(self.root / header, self.root)
            number = next((k for k, names in enumerate(SETS) if own >= set(names)), None)
            if number is not None and number not in made:
                made[number] = self.compile_set(number, words)
            chosen[header] = made.get(number)
        return chosen

    def compile_set(self, number, words):
        """Returns the file to include."""
        file = self.scratch / f"set_{number}.h"
        file.write_text("".join(f"#include {name}\n" for name in SETS[number]))
        done = subprocess.run(
            [*words, "-x", "c++-header", str(file), "-o", f"{file}.gch"],
            capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"error: {file} cannot be precompiled:\n{done.stderr}")
        return file

    def compile(self, header, words, given):
        """Returns the compiler's messages; empty when the header compiles alone."""
        options = ["-include", str(given), "-Winvalid-pch"] if given else []
        done = subprocess.run(
            [*words, *options, "-fsyntax-only", "-x", "c++", "-"],
            input=f'#include "{header}"\n', capture_output=True, text=True, cwd=self.build)
        return done.stderr or ("it does not compile" if done.returncode else "")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    headers = Headers(arguments.build.resolve())
    given = headers.precompile()
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        messages = pool.map(
            lambda item: headers.compile(*item, given.get(item[0])), headers.all)
        failed = 0
        for (header, _), message in zip(headers.all, messages):
            if message:
                failed += 1
                print(f"error: {header} does not compile alone:\n{message}")
    print(f"headers checked: {len(headers.all)}, failed: {failed}")
    sys.exit(1 if failed or not headers.all else 0)


if __name__ == "__main__":
    main()
