#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""Tests of marey_library.py on a library that the program builds.

    MAREY=build/release/app/marey python3 python/test_marey_library.py
    python3 python/test_marey_library.py --walks DIR COUNT    writes simulated walks (BVH)

The walks are computed here, with their own forward kinematics in degrees and matrices.
Prints "skipped:" and a reason without NumPy or the program.
"""
import json
import multiprocessing
import os
import pickle
import sqlite3
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is missing; apt-get install python3-numpy")
    sys.exit(0)

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import marey_library  # noqa: E402
from marey_library import Library, LibraryError, Windows  # noqa: E402

PROGRAM = os.environ.get("MAREY", "marey")
CLIPS = 6
LIMIT_M = 1e-5

# Names, parents and places in the parent [cm].
JOINTS = [("Hips", None, (0, 92, 0)), ("Spine", "Hips", (0, 12, 0)),
          ("Chest", "Spine", (0, 18, 0)), ("Neck", "Chest", (0, 20, 0)),
          ("Head", "Neck", (0, 9, 2))]
for side, x in (("Left", 1), ("Right", -1)):
    JOINTS += [(side + "Shoulder", "Chest", (3 * x, 16, 0)),
               (side + "Arm", side + "Shoulder", (14 * x, 0, 0)),
               (side + "ForeArm", side + "Arm", (27 * x, 0, 0)),
               (side + "Hand", side + "ForeArm", (25 * x, 0, 0)),
               (side + "UpLeg", "Hips", (9 * x, -4, 0)),
               (side + "Leg", side + "UpLeg", (0, -41, 0)),
               (side + "Foot", side + "Leg", (0, -40, 0)),
               (side + "ToeBase", side + "Foot", (0, -6, 14))]
NAMES = [name for name, _, _ in JOINTS]
PARENTS = [NAMES.index(parent) if parent else -1 for _, parent, _ in JOINTS]


def walk(number):
    """Returns the rate, the root's places (F, 3) in cm and the angles Z, X, Y of joints
    (F, J, 3) in degrees. Each number is another motion; even ones have 30 Hz."""
    rate = 30 if number % 2 == 0 else 60
    t = np.arange((80 + 20 * number) * rate // 30) / rate
    phase = 2 * np.pi * (0.8 + 0.05 * number) * t
    angles = np.zeros((len(t), len(JOINTS), 3))
    root = np.stack([3 * np.sin(phase), 92 + 1.5 * np.cos(2 * phase),
                     (90 + 5 * number) * t], 1)
    for side, shift in (("Left", 0), ("Right", np.pi)):
        swing = np.sin(phase + shift)
        angles[:, NAMES.index(side + "UpLeg"), 1] = -28 * swing
        angles[:, NAMES.index(side + "Leg"), 1] = 20 - 18 * np.cos(phase + shift + 0.6)
        angles[:, NAMES.index(side + "Foot"), 1] = 8 * swing
        down = -70 if side == "Left" else 70
        angles[:, NAMES.index(side + "Arm"), 0] = down
        angles[:, NAMES.index(side + "Arm"), 1] = (15 + 2 * number) * swing
        angles[:, NAMES.index(side + "ForeArm"), 2] = -20 if side == "Left" else 20
    angles[:, NAMES.index("Spine"), 2] = 6 * np.sin(phase)
    angles[:, NAMES.index("Hips"), 2] = 4 * number * np.sin(0.4 * t)
    return rate, root, angles


def matrices(angles, axis):
    c, s = np.cos(np.radians(angles)), np.sin(np.radians(angles))
    a, b = (axis + 1) % 3, (axis + 2) % 3
    out = np.zeros(angles.shape + (3, 3))
    out[..., axis, axis] = 1
    out[..., a, a], out[..., a, b], out[..., b, a], out[..., b, b] = c, -s, s, c
    return out


def walk_places(number):
    """Returns the places of the joints of a walk, (F, J, 3) in metres."""
    _, root, angles = walk(number)
    local = (matrices(angles[..., 0], 2) @ matrices(angles[..., 1], 0)
             @ matrices(angles[..., 2], 1))
    places, turns = [], []
    for joint, parent in enumerate(PARENTS):
        turn, place = local[:, joint], root
        if parent >= 0:
            turn = turns[parent] @ turn
            place = places[parent] + turns[parent] @ np.array(JOINTS[joint][2], float)
        turns.append(turn)
        places.append(place)
    return 0.01 * np.stack(places, 1)


def write_walks(folder, count):
    """Writes FOLDER/walk_01.bvh and so on."""
    Path(folder).mkdir(parents=True, exist_ok=True)

    def joint(index, depth):
        name, parent, place = JOINTS[index]
        pad = "  " * depth
        channels = "3 Zrotation Xrotation Yrotation"
        if parent is None:
            channels = "6 Xposition Yposition Zposition" + channels[1:]
        children = [k for k, p in enumerate(PARENTS) if p == index]
        inside = "".join(joint(k, depth + 1) for k in children) or (
            f"{pad}  End Site\n{pad}  {{\n{pad}    OFFSET 0 0 5\n{pad}  }}\n")
        order.append(index)
        kind = "ROOT" if parent is None else "JOINT"
        return (f"{pad}{kind} {name}\n{pad}{{\n{pad}  OFFSET {place[0]} {place[1]} {place[2]}\n"
                f"{pad}  CHANNELS {channels}\n{inside}{pad}}}\n")

    def in_order(index):
        return [index] + [k for child, p in enumerate(PARENTS) if p == index
                          for k in in_order(child)]

    for number in range(1, count + 1):
        rate, root, angles = walk(number)
        order = []
        text = "HIERARCHY\n" + joint(0, 0)
        rows = np.concatenate(
            [root, angles[:, in_order(0)].reshape(len(root), -1)], 1)
        text += f"MOTION\nFrames: {len(rows)}\nFrame Time: {1 / rate:.9f}\n"
        text += "".join(" ".join(f"{v:.6f}" for v in row) + "\n" for row in rows)
        (Path(folder) / f"walk_{number:02d}.bvh").write_text(text)


def read_item(data, index):
    """Runs in another process."""
    item = data[index]
    return item["clip"], item["first_frame"], float(item["root_m"].sum())


class LibraryTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        folder = Path(cls.scratch.name)
        write_walks(folder / "walks", CLIPS)
        cls.path = folder / "a #1 library?"
        cls.path.mkdir()
        (cls.path / "library.toml").write_text(
            'format = 1\nname = "walks"\n[[source]]\npath = "../walks"\n'
            'licence = "CC0-1.0"\nattribution = "Anna"\nsubject = "S1"\n'
            'pattern = "{content}_{n}"\n')
        cls.marey("build")
        cls.lib = Library(cls.path)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def marey(cls, command, *rest):
        run = subprocess.run([PROGRAM, "library", command, cls.path, *rest],
                             capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
        return run.stdout

    def message(self, call, *args, **named):
        with self.assertRaises(LibraryError) as caught:
            call(*args, **named)
        return str(caught.exception)

    def test_lists_and_queries_clips(self):
        clips = self.lib.clips()
        self.assertEqual([clip.name for clip in clips],
                         [f"walk_{k:02d}" for k in range(1, CLIPS + 1)])
        self.assertEqual([clip.id for clip in clips], self.lib.query())
        self.assertEqual(clips[1].rate, 30.0)
        self.assertAlmostEqual(clips[1].seconds, len(walk_places(2)) / 30 - 1 / 30)
        self.assertEqual(clips[0].labels, ["content:walk", "n:01"])
        self.assertIn("slide_cm_s", clips[0].figures)
        self.assertEqual(self.lib.clips([clips[3].id, clips[1].id]), [clips[3], clips[1]])
        self.assertEqual(self.lib.query("rate_hz = 30", label="n:02"), [clips[1].id])
        self.assertEqual(self.lib.query(label="n:99"), [])
        splits = [self.lib.query(split=split) for split in ("train", "val", "test")]
        self.assertEqual(sum(map(len, splits)), CLIPS)
        one, = self.lib.licences()
        self.assertEqual((one.licence, one.clips, one.attributions),
                         ("CC0-1.0", CLIPS, ["Anna"]))

    def test_positions_are_the_files(self):
        for number, id in enumerate(self.lib.query(), 1):
            motion = self.lib.motion(id)
            columns = [motion.joint_names.index(name) for name in NAMES]
            places, truth = self.lib.positions(id)[:, columns], walk_places(number)
            self.assertEqual(places.shape, truth.shape)
            # A build puts clips on the floor: one height for all frames.
            places[..., 1] += truth[0, 0, 1] - places[0, 0, 1]
            self.assertLess(np.abs(places - truth).max(), LIMIT_M)

    def test_positions_are_the_programs(self):
        to = Path(self.scratch.name) / "export"
        self.marey("export", "--to", str(to), "--as", "npz")
        for id in self.lib.query():
            exported = np.load(to / f"{id}.npz")
            motion = self.lib.motion(id)
            self.assertEqual(list(exported["joint_names"]), motion.joint_names)
            self.assertLess(np.abs(exported["positions"] - self.lib.positions(id)).max(),
                            LIMIT_M)

    def test_motions_are_mapped(self):
        motion = self.lib.motion(self.lib.query()[0])
        base = motion.rotations_wxyz
        while isinstance(base, np.ndarray):
            self.assertFalse(base.flags.owndata)
            base = base.base
        self.assertFalse(motion.root_m.flags.writeable)
        self.assertEqual(motion.contacts.shape, (len(motion.root_m), 4))

    def test_more_motions_than_descriptors(self):
        kept, limit = [], marey_library._MAX_MAPPED
        marey_library._MAX_MAPPED = 2
        try:
            lib = Library(self.path)
            kept = [lib.motion(id) for id in lib.query()]
        finally:
            marey_library._MAX_MAPPED = limit
        self.assertEqual(len(kept), CLIPS)
        for motion, id in zip(kept, self.lib.query()):
            np.testing.assert_array_equal(motion.root_m, self.lib.motion(id).root_m)

    def test_similar_is_the_programs(self):
        for id in self.lib.query():
            found = self.lib.similar(id, top=3)
            truth = json.loads(self.marey("similar", id, "--exact", "--json", "--top", "3"))
            self.assertEqual(found[0].id, truth["clips"][0]["clip_id"])
            for one, other in zip(found, truth["clips"]):
                self.assertAlmostEqual(one.distance, other["distance"], 5)
                self.assertAlmostEqual(one.start_s, other["start_s"], 9)
                self.assertAlmostEqual(one.end_s, other["end_s"], 9)
        id = self.lib.query()[3]
        part = self.lib.similar(self.lib.features(id)[5:20], length_s=None)[0]
        self.assertEqual((part.id, part.distance), (id, 0.0))
        self.assertAlmostEqual(part.start_s, 0.5)
        self.assertAlmostEqual(part.end_s, 1.9)

    def test_windows_cut_clips(self):
        data = Windows(self.lib, frames=32, stride=10, query="rate_hz = 30")
        counts = [(80 + 20 * n - 32) // 10 + 1 for n in (2, 4, 6)]
        self.assertEqual(len(data), sum(counts))
        item = data[counts[0] + 1]
        self.assertEqual(item["clip"], self.lib.query()[3])
        self.assertEqual(item["first_frame"], 10)
        self.assertEqual(item["rotations_wxyz"].shape, (32, len(JOINTS), 4))
        np.testing.assert_array_equal(item["root_m"],
                                      self.lib.motion(item["clip"]).root_m[10:42])
        self.assertTrue(item["root_m"].flags.writeable)
        self.assertEqual(len(list(data)), len(data))
        self.assertEqual(data[-1]["clip"], self.lib.query()[5])
        self.assertRaises(IndexError, data.__getitem__, len(data))
        long = Windows(self.lib, frames=10000)
        self.assertEqual((len(long), len(long.short_clips)), (0, CLIPS))

    def test_windows_resample(self):
        data = Windows(self.lib, frames=16, stride=16, rate=20, bones=["hips", "leftHand"],
                       arrays=["positions_m", "rotations_wxyz"])
        columns = [self.lib.motion(self.lib.query()[0]).human_bones.index(bone)
                   for bone in ("hips", "leftHand")]
        for item in data:
            self.assertEqual(item["positions_m"].shape, (16, 2, 3))
            whole = self.lib.positions(item["clip"])[:, columns]
            rate = self.lib.motion(item["clip"]).rate
            at = (item["first_frame"] + np.arange(16)) * rate / 20
            is_frame = np.abs(at - np.round(at)) < 1e-6
            truth = whole[np.round(at[is_frame]).astype(int)]
            self.assertLess(np.abs(item["positions_m"][is_frame] - truth).max(), LIMIT_M)
            # Between frames: near the mean of the two, and lengths stay 1.
            self.assertLess(np.abs(item["positions_m"] - whole[np.round(at).astype(int)]).max(),
                            0.05)
            length = np.linalg.norm(item["rotations_wxyz"], axis=-1)
            self.assertLess(np.abs(length - 1).max(), 1e-5)
        self.assertIn("no tail", self.message(lambda: Windows(self.lib, bones=["tail"])[0]))

    def test_works_in_other_processes(self):
        data = Windows(self.lib, frames=32)
        wanted = [read_item(data, index) for index in range(len(data))]
        self.assertLess(len(pickle.dumps(data)), 20000)
        for way in ("fork", "spawn"):
            with multiprocessing.get_context(way).Pool(2) as pool:
                got = pool.starmap(read_item, [(data, k) for k in range(len(data))])
            self.assertEqual(got, wanted)

    def test_statistics_of_the_example(self):
        script = Path(__file__).resolve().parents[1] / "examples" / "library_statistics.py"
        picture = Path(self.scratch.name) / "map.png"
        run = subprocess.run(
            [sys.executable, "-B", script, self.path, "--to", picture], text=True,
            capture_output=True,
            env={**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parent)})
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stdout, r"\nwalk +6 ")
        if "matplotlib is missing" not in run.stdout:
            self.assertEqual(picture.read_bytes()[:4], b"\x89PNG")

    def test_messages(self):
        empty = Path(self.scratch.name) / "empty"
        empty.mkdir(exist_ok=True)
        self.assertIn("marey library build", self.message(Library, empty))
        self.assertIn("no clip has the id 'x'", self.message(self.lib.motion, "x"))
        self.assertIn("no such column", self.message(self.lib.query, "speed > 1"))
        index = (self.path / "library.sqlite").read_bytes()
        damaged = empty / "library.sqlite"
        try:
            damaged.write_bytes(index[:5000])
            self.assertIn("damaged", self.message(Library, empty))
            damaged.write_bytes(index[:1000] + b"\xff" * (len(index) - 1000))
            self.assertIn("damaged", self.message(Library, empty))
            damaged.write_bytes(b"nothing" * 1000)
            self.assertIn("damaged: file is not a database", self.message(Library, empty))
            damaged.write_bytes(index)
            with sqlite3.connect(damaged) as other:
                other.execute("PRAGMA user_version = 99")
            other.close()
            self.assertIn("another version of marey made it (tables 99",
                          self.message(Library, empty))
            damaged.write_bytes(index)
            lib = Library(empty)
            self.assertIn("no such file", self.message(lib.motion, lib.query()[0]))
            self.assertIn("no such file", self.message(lib.features, lib.query()[0]))
            with sqlite3.connect(damaged) as other:
                other.execute("UPDATE head SET version_name = 'other'")
            other.close()
            self.assertIn("built again meanwhile", self.message(lib.query))
        finally:
            damaged.unlink()

    def test_damaged_files_have_messages(self):
        id = self.lib.query()[0]
        file = self.lib._object(self.lib._row(id).key)
        rows = self.lib._search / "features.f32"
        for path, read in ((file, lambda: Library(self.path).motion(id)),
                           (rows, lambda: Library(self.path).features(id))):
            whole = path.read_bytes()
            kept = path.rename(path.with_suffix(".kept"))
            try:
                for part in (b"", whole[:10], whole[:len(whole) // 2], b"x" * len(whole)):
                    path.write_bytes(part)
                    self.assertIn(str(path), self.message(read))
            finally:
                kept.rename(path)


def main():
    if sys.argv[1:2] == ["--walks"]:
        write_walks(sys.argv[2], int(sys.argv[3]))
        return
    try:
        subprocess.run([PROGRAM, "--version"], capture_output=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        print("skipped: the program is missing; name it by MAREY=build/release/app/marey")
        return
    unittest.main()


if __name__ == "__main__":
    main()
