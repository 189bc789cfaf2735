#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""Checks an export of a motion library with NumPy and Python's own modules only.

check_library_export.py LIB DIR FORMAT [--own]

Reads the files of DIR, written by `marey library export LIB --to DIR --as FORMAT`, and
checks MANIFEST.sha256 and the layout. With --own, for exports that changed no body, rate
or place, it also compares the joints of each clip with forward kinematics of the objects
in LIB. Exit 1 and a message if something differs; 77 without NumPy.
"""
import csv
import hashlib
import io
import json
import os
import re
import sqlite3
import struct
import sys
import tarfile

try:
    import numpy as np
except ImportError:
    print("skipped: numpy is missing; apt-get install python3-numpy")
    sys.exit(77)

LIMIT_M = 1e-4
SMPL = """hips leftUpperLeg rightUpperLeg spine leftLowerLeg rightLowerLeg chest leftFoot
rightFoot upperChest leftToes rightToes neck leftShoulder rightShoulder head leftUpperArm
rightUpperArm leftLowerArm rightLowerArm leftHand rightHand""".split()


def turn(q, v):
    """Rotates vectors by quaternions w, x, y, z."""
    w, u = q[..., :1], q[..., 1:]
    t = 2.0 * np.cross(u, v)
    return v + w * t + np.cross(u, t)


def product(a, b):
    w = a[..., :1] * b[..., :1] - np.sum(a[..., 1:] * b[..., 1:], -1, keepdims=True)
    v = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + np.cross(a[..., 1:], b[..., 1:])
    return np.concatenate([w, v], -1)


def kinematics(root, local, parents, rest):
    """Returns places (F, J, 3) of joints."""
    frames, joints = local.shape[:2]
    place = np.zeros((frames, joints, 3))
    world = np.zeros((frames, joints, 4))
    for j in range(joints):
        if parents[j] < 0:
            place[:, j], world[:, j] = root, local[:, j]
        else:
            p = parents[j]
            world[:, j] = product(world[:, p], local[:, j])
            place[:, j] = place[:, p] + turn(world[:, p], np.broadcast_to(rest[j], (frames, 3)))
    return place


class Library:
    """Joints of the clips of a library, from its index and objects."""

    def __init__(self, folder):
        self.folder = folder
        index = sqlite3.connect("file:%s/library.sqlite?mode=ro&immutable=1" % folder, uri=True)
        rows = index.execute("select id, key, first, last from clip")
        self.clips = {clip: (key, first, last) for clip, key, first, last in rows}

    def joints(self, clip):
        """Returns names, bones and places of the joints of a clip."""
        key, first, last = self.clips[clip]
        a = np.load("%s/objects/%s/%s.npz" % (self.folder, key[:2], key[2:]))
        rows = slice(first - int(a["first_frame"]), last - int(a["first_frame"]) + 1)
        places = kinematics(a["root_m"][rows].astype(float),
                            a["rotations_wxyz"][rows].astype(float),
                            a["parents"], a["rest_translations_m"])
        return list(a["joint_names"]), list(a["human_bones"]), places


class Check:
    def __init__(self, library, folder, own):
        self.library = library
        self.folder = folder
        self.own = own
        self.worst = 0.0
        self.clips = 0

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def compare(self, clip, places, bones=None, names=None):
        self.clips += 1
        assert np.isfinite(places).all()
        if not self.own or clip.endswith("_mirror"):
            return
        own_names, own_bones, truth = self.library.joints(clip)
        if bones is not None:
            truth = truth[:, [own_bones.index(bone) for bone in bones]]
        elif names is not None:
            truth = truth[:, [own_names.index(name) for name in names]]
        assert truth.shape == places.shape, (clip, truth.shape, places.shape)
        error = np.linalg.norm(truth - places, axis=-1).max()
        self.worst = max(self.worst, error)
        assert error <= LIMIT_M, "clip %s: joints differ by %.3f mm" % (clip, 1000 * error)

    def npz(self, file, clip):
        a = np.load(file)
        assert int(a["format"]) == 1 and str(a["clip_id"]) == clip
        assert a["licence"].shape == () and len(str(a["licence"])) > 0
        assert a["label_times_s"].shape == (len(a["labels"]), 2)
        assert len(a["label_by"]) == len(a["labels"])
        frames, joints = a["positions"].shape[:2]
        assert a["contacts"].shape == (frames, 4)
        own = kinematics(a["positions"][:, 0], a["rotations_wxyz"], a["parents"],
                         a["rest_translations"])
        assert np.abs(own - a["positions"]).max() < 1e-9
        self.compare(clip, a["positions"], names=list(a["joint_names"]))
        return a

    def each(self, ending):
        files = sorted(f for f in os.listdir(self.folder) if f.endswith(ending))
        assert files, "no file " + ending
        return [(self.path(f), f[:-len(ending)]) for f in files]

    def check_npz(self):
        for file, clip in self.each(".npz"):
            self.npz(file, clip)

    def check_bvh(self):
        for file, clip in self.each(".bvh"):
            names, places = read_bvh(open(file).read())
            self.compare(clip, 0.01 * places, names=names if self.own else None)

    def check_glb(self, ending=".glb"):
        for file, clip in self.each(ending):
            names, places, document = read_glb(open(file, "rb").read())
            if ending == ".glb":
                self.compare(clip, places, names=names if self.own else None)
            else:
                humanoid = document["extensions"]["VRMC_vrm_animation"]["humanoid"]
                bones = humanoid["humanBones"]
                hips = [bones["hips"]["node"]]
                self.compare(clip, places[:, hips], bones=["hips"])

    def check_vrma(self):
        self.check_glb(".vrma")

    def check_amass(self):
        for subject in sorted(os.listdir(self.folder)):
            if not os.path.isdir(self.path(subject)):
                continue
            for file in sorted(os.listdir(self.path(subject))):
                assert file.endswith("_poses.npz")
                a = np.load(self.path(subject, file))
                frames = len(a["trans"])
                assert a["poses"].shape == (frames, 156) and a["poses"].dtype == np.float64
                assert a["trans"].shape == (frames, 3) and a["trans"].dtype == np.float64
                assert a["betas"].shape == (16,) and a["dmpls"].shape == (frames, 8)
                assert a["mocap_framerate"] == a["mocap_frame_rate"] > 0
                assert str(a["gender"]) == "neutral"
                hips = a["trans"][:, [0, 2, 1]] * [1, 1, -1]
                self.compare(file[:-len("_poses.npz")], hips[:, None], bones=["hips"])

    def check_joints22(self):
        for file, clip in self.each(".npy"):
            places = np.load(file)
            assert places.dtype == np.float32 and places.shape[1:] == (22, 3)
            self.compare(clip, places.astype(float), bones=SMPL)

    def check_shards(self):
        index = json.load(open(self.path("index.json")))
        tars = [f for f in os.listdir(self.folder) if f.endswith(".tar")]
        assert sorted(tars) == sorted(shard["file"] for shard in index["shards"])
        splits = self.splits()
        for shard in index["shards"]:
            assert os.path.getsize(self.path(shard["file"])) == shard["bytes"]
            assert shard["bytes"] <= 256e6 or shard["clips"] == 1
            with tarfile.open(self.path(shard["file"]), "r:") as tar:
                members = tar.getmembers()
                assert len(members) == 2 * shard["clips"]
                assert all(m.mtime == 0 and m.uid == 0 and m.gid == 0 for m in members)
                frames = 0
                for motion, facts in zip(members[::2], members[1::2]):
                    clip = motion.name[:-4]
                    assert motion.name == clip + ".npz" and facts.name == clip + ".json"
                    a = self.npz(io.BytesIO(tar.extractfile(motion).read()), clip)
                    record = json.load(tar.extractfile(facts))
                    assert record["clip_id"] == clip
                    assert splits[clip] == record["split"] == shard["split"]
                    frames += len(a["positions"])
                    first, last = record["frames"]
                    assert last - first + 1 == len(a["positions"])
                    assert record["rate_hz"] == a["rate_hz"]
                assert frames == shard["frames"]

    def check_pack(self):
        facts = json.load(open(self.path("skeleton.json")))
        rows = np.memmap(self.path("motion.f32"), "<f4", "r",
                         shape=(facts["frames"], facts["columns"]))

        def array(name):
            part = facts["arrays"][name]
            size = int(np.prod(part["shape"]))
            first = part["first_column"]
            return rows[:, first:first + size].reshape([-1] + part["shape"])

        start = 0
        for clip in csv.DictReader(open(self.path("clips.csv"))):
            assert int(clip["start"]) == start
            end = start + int(clip["frames"])
            assert int(clip["last_frame"]) - int(clip["first_frame"]) + 1 == end - start
            skeleton = facts["skeletons"][int(clip["skeleton"])]
            places = kinematics(array("root_m")[start:end].astype(float),
                                array("rotations_wxyz")[start:end].astype(float),
                                facts["parents"], np.array(skeleton["rest_translations_m"]))
            assert np.abs(places - array("positions_m")[start:end]).max() < 2e-5
            assert set(np.unique(array("contacts")[start:end])) <= {0.0, 1.0}
            self.compare(clip["clip_id"], places, names=facts["joint_names"])
            start = end
        assert start == facts["frames"]

    def check_matching(self):
        a = np.load(self.path("database.npz"))
        frames = len(a["features"])
        assert a["features"].shape == (frames, 27) and a["features"].dtype == np.float32
        assert len(a["feature_names"]) == 27 and len(set(a["feature_names"])) == 27
        assert a["range_starts"][0] == 0 and a["range_stops"][-1] == frames
        assert (a["range_starts"][1:] == a["range_stops"][:-1]).all()
        assert np.abs(a["features"].mean(0)).max() < 1e-3
        values = a["features"] * a["features_scale"] + a["features_offset"]
        facing = values[:, 21:27].reshape(-1, 3, 2)
        assert np.abs(np.linalg.norm(facing, axis=-1) - 1.0).max() < 1e-4
        self.clips = len(a["clip_ids"])
        assert set(a["clip_ids"]) == set(self.splits())

    def check_table(self):
        clips = list(csv.DictReader(open(self.path("clips.csv"), newline="")))
        known = {clip["clip_id"] for clip in clips}
        assert known == set(self.splits())
        for table in ("figures.csv", "labels.csv"):
            for row in csv.DictReader(open(self.path(table), newline="")):
                assert row["clip_id"] in known and None not in row
        index = sqlite3.connect("file:%s?mode=ro&immutable=1" % self.path("library.sqlite"),
                                uri=True)
        assert {row[0] for row in index.execute("select id from clip")} == known
        self.clips = len(clips)

    def splits(self):
        rows = csv.DictReader(open(self.path("splits.csv"), newline=""))
        return {row["clip_id"]: row["split"] for row in rows}

    def manifest(self):
        listed = {}
        for line in open(self.path("MANIFEST.sha256")):
            digest, file = line.rstrip("\n").split("  ", 1)
            listed[file] = digest
        assert list(listed) == sorted(listed)
        found = set()
        for folder, _, files in os.walk(self.folder):
            for file in files:
                found.add(os.path.relpath(os.path.join(folder, file), self.folder))
        assert found == set(listed) | {"MANIFEST.sha256"}, found ^ set(listed)
        for file, digest in listed.items():
            assert hashlib.sha256(open(self.path(file), "rb").read()).hexdigest() == digest
        for file in ("LICENCES.md", "DATASHEET.md", "splits.csv"):
            assert file in listed, file


def quaternion(axis, degrees):
    half = np.radians(degrees) / 2.0
    out = np.zeros(half.shape + (4,))
    out[..., 0] = np.cos(half)
    out[..., 1 + "XYZ".index(axis)] = np.sin(half)
    return out


def read_bvh(text):
    """Returns names of joints and places (F, J, 3) in the file's unit."""
    head, body = text.split("MOTION")
    names, parents, rest, channels, stack = [], [], [], [], []
    last = None
    for line in head.splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] in ("ROOT", "JOINT"):
            parents.append(stack[-1] if stack else -1)
            names.append(" ".join(words[1:]))
            last = len(names) - 1
        elif words[0] == "End":
            last = None
        elif words[0] == "{":
            stack.append(last)
        elif words[0] == "}":
            stack.pop()
        elif words[0] == "OFFSET" and last is not None:
            rest.append([float(w) for w in words[1:4]])
        elif words[0] == "CHANNELS":
            channels.append(words[2:])
    lines = body.split("\n", 3)
    rows = np.array([[float(w) for w in line.split()] for line in lines[3].splitlines()])
    assert len(rows) == int(re.search(r"Frames:\s*(\d+)", body).group(1))
    local = np.zeros((len(rows), len(names), 4))
    root = np.tile(np.array(rest[0]), (len(rows), 1))
    column = 0
    for j, list_of in enumerate(channels):
        q = np.zeros((len(rows), 4))
        q[:, 0] = 1.0
        for channel in list_of:
            values = rows[:, column]
            column += 1
            if channel.endswith("position"):
                root[:, "XYZ".index(channel[0])] = values
            else:
                q = product(q, quaternion(channel[0], values))
        local[:, j] = q
    assert column == rows.shape[1]
    return names, kinematics(root, local, parents, np.array(rest))


def read_glb(data):
    """Returns names of nodes, their places (F, N, 3), and the document."""
    magic, version, size = struct.unpack_from("<4sII", data)
    assert magic == b"glTF" and version == 2 and size == len(data)
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20:20 + length])
    buffer = data[20 + length + 8:]

    def floats(number):
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = np.frombuffer(buffer, "<f4", accessor["count"] * width, start)
        return values.reshape(-1, width).astype(float)

    nodes = document["nodes"]
    parents = [-1] * len(nodes)
    for i, node in enumerate(nodes):
        for child in node.get("children", []):
            parents[child] = i
    animation = document["animations"][0]
    frames = len(floats(animation["samplers"][0]["input"]))
    rest = np.array([node.get("translation", [0, 0, 0]) for node in nodes], float)
    local = np.zeros((frames, len(nodes), 4))
    for i, node in enumerate(nodes):
        x, y, z, w = node.get("rotation", [0, 0, 0, 1])
        local[:, i] = [w, x, y, z]
    root = np.tile(rest[0], (frames, 1))
    for channel in animation["channels"]:
        target = channel["target"]
        values = floats(animation["samplers"][channel["sampler"]]["output"])
        if target["path"] == "rotation":
            local[:, target["node"]] = values[:, [3, 0, 1, 2]]
        elif target["path"] == "translation":
            assert target["node"] == 0
            root = values
    assert all(p < i for i, p in enumerate(parents))
    return [node.get("name") for node in nodes], kinematics(root, local, parents, rest), document


def main():
    library, folder, layout = sys.argv[1:4]
    check = Check(Library(library), folder, "--own" in sys.argv)
    check.manifest()
    getattr(check, "check_" + layout)()
    assert check.clips == len(check.splits()), (check.clips, len(check.splits()))
    print("%d clips, largest difference %.5f mm" % (check.clips, 1000 * check.worst))


main()
