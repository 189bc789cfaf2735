#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""Measures `marey library build` on a folder of motions: time and memory from nothing and
without changes, the same bytes in every way of building, and builds that are killed.

    python3 tests/tools/measure_library_build.py build/release/app/marey FOLDER [KILLS]

FOLDER has the motions. All libraries are made in a temporary folder. The bars are those
of docs/accuracy/library_build.md."""
import hashlib
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time


def run(*words, check=(0, 4)):
    """Runs a command. Returns its seconds, and the largest resident memory in MB."""
    begin = time.monotonic()
    child = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    text = child.stderr.read().decode()
    _, status, usage = os.wait4(child.pid, 0)
    code = os.waitstatus_to_exitcode(status)
    if code not in check:
        sys.exit(f"{' '.join(map(str, words))}: exit {code}\n{text}")
    return time.monotonic() - begin, usage.ru_maxrss / 1024


def make_library(folder, sources, extra=""):
    folder.mkdir(parents=True)
    (folder / "library.toml").write_text(
        f'format = 1\nname = "measured"\n{extra}\n[[source]]\npath = "{sources}"\n'
        'licence = "CC-BY-NC-4.0"\npattern = "dataset-{set}_{content}_{style}_{n}"\n')
    return folder


def tree_digest(library):
    """Returns the digest of everything that a build makes."""
    digest = hashlib.sha256()
    for part in ("objects", "search", "versions", "failed", "library.sqlite"):
        top = library / part
        files = [top] if top.is_file() else sorted(p for p in top.rglob("*") if p.is_file())
        for file in files:
            digest.update(str(file.relative_to(library)).encode() + b"\0")
            digest.update(hashlib.sha256(file.read_bytes()).digest())
    return digest.hexdigest()


def is_readable(marey, library):
    """Returns true if the last version can be read, or there is none yet."""
    if not (library / "library.sqlite").exists():
        return True
    done = subprocess.run([marey, "library", "versions", library], capture_output=True)
    query = subprocess.run([marey, "library", "query", library, "", "--count"],
                           capture_output=True)
    return done.returncode == 0 and query.returncode == 0


def measure_times(marey, top, sources):
    library = make_library(top / "times", sources)
    frames = sum(int(line.split()[1]) for file in sources.rglob("*.bvh")
                 for line in open(file) if line.startswith("Frames:"))
    before = os.times()
    seconds, memory = run(marey, "library", "build", library, "--jobs", "2")
    after = os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"from nothing, 2 jobs: {seconds:.1f} s; {frames} frames, "
          f"{frames / cpu:.0f} frames per second of processor; largest process "
          f"{max(memory, largest):.0f} MB")
    time.sleep(2.1)  # Files that changed less than 2 s ago are read again.
    print(f"again: {run(marey, 'library', 'build', library)[0]:.2f} s")
    nothing = min(run(marey, "library", "build", library)[0] for _ in range(3))
    print(f"nothing changed: {nothing:.2f} s")
    text = (library / "library.toml").read_text()
    (library / "library.toml").write_text(text + "\n[quality]\nslide_cm_s = [3.0, 7.0]\n")
    print(f"a threshold changed: {run(marey, 'library', 'build', library)[0]:.1f} s")
    (library / "library.toml").write_text(text)
    run(marey, "library", "build", library)
    copy = top / "changed"
    shutil.copytree(sources, copy)
    library = make_library(top / "one", copy)
    run(marey, "library", "build", library)
    time.sleep(2.1)
    run(marey, "library", "build", library)
    first = sorted(copy.rglob("*.bvh"))[0]
    first.write_text(first.read_text() + "\n")
    print(f"one source changed: {run(marey, 'library', 'build', library)[0]:.2f} s")


def measure_bytes(marey, top, sources):
    one = make_library(top / "jobs1", sources)
    run(marey, "library", "build", one, "--jobs", "1")
    expected = tree_digest(one)
    two = make_library(top / "a" / "folder" / "elsewhere", sources)
    run(marey, "library", "build", two, "--jobs", "2")
    shards = make_library(top / "shards", sources)
    run(marey, "library", "plan", shards, "--shards", "4")
    for shard in (3, 1, 4, 2):
        run(marey, "library", "work", shards, "--shard", str(shard), "--jobs", "1")
    run(marey, "library", "merge", shards)
    print("one job = two jobs elsewhere:", tree_digest(two) == expected)
    print("one job = four shards:", tree_digest(shards) == expected)


def measure_kills(marey, top, sources, kills):
    """Kills builds of every eighth file at random instants, up to after their end."""
    some = top / "some"
    some.mkdir()
    for file in sorted(sources.rglob("*.bvh"))[::8]:
        (some / file.name).symlink_to(file)
    whole = make_library(top / "whole", some)
    seconds = run(marey, "library", "build", whole)[0]
    expected = tree_digest(whole)
    rng = random.Random(20)
    library = make_library(top / "killed", some)
    unreadable = finished = different = left = 0
    for _ in range(kills):
        child = subprocess.Popen([marey, "library", "build", library],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            child.wait(timeout=rng.uniform(0.0, 0.5 * seconds))
        except subprocess.TimeoutExpired:
            child.send_signal(signal.SIGKILL)
            child.wait()
            unreadable += not is_readable(marey, library)
            continue
        # The library is complete. The next kills belong to a new one.
        finished += 1
        different += tree_digest(library) != expected
        left += len(list(library.rglob("*.partial")) + list(library.glob("LOCK*")))
        shutil.rmtree(library)
        library = make_library(top / "killed", some)
    run(marey, "library", "build", library)
    different += tree_digest(library) != expected
    print(f"{kills} kills of a build of {seconds:.1f} s: {finished} reached the end after "
          f"kills; unreadable {unreadable}; other bytes than never killed {different}; "
          f"files left {left}")


def main():
    marey, sources = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    kills = int(sys.argv[3]) if len(sys.argv) > 3 else 100
    with tempfile.TemporaryDirectory() as folder:
        top = pathlib.Path(folder)
        measure_times(marey, top, sources)
        measure_bytes(marey, top, sources)
        if kills:
            measure_kills(marey, top, sources, kills)


if __name__ == "__main__":
    main()
