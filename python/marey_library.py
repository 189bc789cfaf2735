# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""Reads motion libraries (`marey library build LIB`) with NumPy and the standard library.

    from marey_library import Library, Windows
    lib = Library("LIB")
    walks = lib.query("quality = 'pass' AND seconds > 2", label="content:walk")
    places = lib.positions(walks[0])                # (frames, joints, 3), metres, Y up
    data = Windows(lib, frames=64, stride=16, split="train", rate=30)

A Library opens files when they are needed and holds no connection: it can be pickled,
and used after a fork and in threads. docs/build_library.md has examples, and
docs/formats/library.md has the files. The checksums of search rows are not verified.
"""
from __future__ import annotations

import ast
import json
import math
import mmap
import os
import re
import sqlite3
import weakref
import zipfile
from collections import OrderedDict
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Iterator, Sequence

import numpy as np

INDEX_APPLICATION = 0x4D4C4942  # "MLIB"
INDEX_VERSION = 5
MOTION_LAYOUT = 2
ROWS_LAYOUT = 1
FEATURES = 57  # Values per instant; files have 7 zeros after them.
FEATURE_STRIDE = 64
FEATURE_RATE_HZ = 10.0
_SAME = 1e-6  # Tolerance of instants, in frames.
# A mapping keeps a file descriptor; more objects than this are read into memory instead.
_MAX_MAPPED = 256
_MAX_KEPT = 64  # Motions that a Library keeps open.
_mapped: "weakref.WeakSet[mmap.mmap]" = weakref.WeakSet()


class LibraryError(Exception):
    """A library that cannot be read. The text has the file, the cause and the next step."""


@dataclass(frozen=True)
class Clip:
    """One motion of a library, without its frames."""
    id: str
    name: str
    seconds: float
    rate: float  # Frames per second.
    quality: str  # "pass", "warn" or "fail".
    licence: str  # SPDX expression, or "unknown".
    subject: str
    split: str  # "train", "val" or "test".
    labels: list[str]  # By people and names of files.
    figures: dict[str, float]


@dataclass(frozen=True)
class Motion:
    """Arrays of F frames and J joints, read-only and mapped from the disk. Y is up; the
    body faces +Z at rest. docs/formats/library.md, layout 2."""
    rate: float  # Frames per second.
    root_m: np.ndarray  # (F, 3) float32, of the first joint in the world.
    rotations_wxyz: np.ndarray  # (F, J, 4) float32, of joints in their parents.
    joint_names: list[str]
    human_bones: list[str]  # VRM's names, or "".
    parents: np.ndarray  # (J,) int32, -1 for the root; parents come first.
    rest_translations_m: np.ndarray  # (J, 3) float32, of joints in their parents.
    contacts: np.ndarray  # (F, 4) uint8: left heel, left ball, right heel, right ball.
    sigma_m: np.ndarray | None = None  # (F, J) float32: uncertainty.
    source: np.ndarray | None = None  # (F, J) uint8: 0 measured, 1 repaired, 2 inferred.


@dataclass(frozen=True)
class Similar:
    """Part of a clip that is similar to a motion. Times since the clip's first frame."""
    id: str
    name: str
    distance: float
    start_s: float
    end_s: float


@dataclass(frozen=True)
class Licence:
    """Clips of one licence."""
    licence: str
    clips: int
    seconds: float
    attributions: list[str]


@dataclass(frozen=True)
class _Row:
    """Place of a clip's frames."""
    number: int
    id: str
    name: str
    key: str
    first: int  # Frames in the source.
    last: int
    rate: float


class Library:
    """A library folder. Reads one version: after a build that changes the library, calls
    raise LibraryError, and it has to be opened again."""

    def __init__(self, path: str | os.PathLike[str]):
        """Reads the list of clips. Raises LibraryError: no library; another version."""
        self.path = Path(path)
        self._version: str | None = None
        with self._index() as index:
            self.version, self._version, search = index.execute(
                "SELECT version, version_name, search FROM head").fetchone()
            rows = [_Row(*row) for row in index.execute(
                "SELECT number, id, name, key, first, last, rate_hz FROM clip "
                "ORDER BY number")]
        is_whole = isinstance(search, str) and all(
            isinstance(row.id, str) and isinstance(row.key, str) and row.rate
            and isinstance(row.first, int) and isinstance(row.last, int)
            and row.number == place for place, row in enumerate(rows))
        if not is_whole:
            raise _damaged(self.path / "library.sqlite", "it is damaged", self.path)
        self._search = self.path / "search" / Path(search).name
        self._rows = {row.id: row for row in rows}
        self._kept: OrderedDict[str, tuple[Motion, int]] = OrderedDict()

    def __len__(self) -> int:
        return len(self._rows)

    def __getstate__(self) -> dict[str, Any]:
        # Pickled arrays would be copies of the files.
        return {**self.__dict__, "_kept": OrderedDict()}

    def query(self, condition: str = "", *, label: str = "", split: str = "") -> list[str]:
        """Returns the ids of clips that fulfil a condition, in the library's order.

        `condition` is SQL on the table `clip` (number, id, name, body, first, last,
        rate_hz, seconds, quality, licence, subject, split, duplicate_of, mirror_of). Other
        tables are reached by the number:
            "number IN (SELECT clip FROM figure WHERE name = 'sparc' AND value > -3)"
        `label` and `split` are exact. Conditions such as "licence NOT LIKE '%-NC%'" and
        "duplicate_of = ''" leave out clips that must not, or should not, be used.
        """
        parts, values = ["(" + (condition.strip() or "TRUE") + "\n)"], []
        if label:
            parts.append("number IN (SELECT clip FROM label WHERE name = ?)")
            values.append(label)
        if split:
            parts.append("split = ?")
            values.append(split)
        with self._index() as index:
            try:
                return [row[0] for row in index.execute(
                    f"SELECT id FROM clip WHERE {' AND '.join(parts)} ORDER BY number", values)]
            except sqlite3.OperationalError as error:
                raise LibraryError(f"{condition!r}: {error}; give an SQL condition on clips, "
                                   "such as \"quality = 'pass'\"") from None

    def clips(self, ids: Sequence[str] | None = None) -> list[Clip]:
        """Returns clips with labels and figures: all, or those of `ids` in their order."""
        wanted = None if ids is None else {self._row(id).number for id in ids}
        labels: dict[int, list[str]] = {}
        figures: dict[int, dict[str, float]] = {}
        with self._index() as index:
            for clip, name in index.execute(
                    "SELECT DISTINCT clip, name FROM label WHERE by <> 'marey'"):
                labels.setdefault(clip, []).append(name)
            for clip, name, value in index.execute("SELECT clip, name, value FROM figure"):
                if wanted is None or clip in wanted:
                    figures.setdefault(clip, {})[name] = value
            found = {row[1]: Clip(*row[1:], sorted(labels.get(row[0], [])),
                                  figures.get(row[0], {}))
                     for row in index.execute(
                         "SELECT number, id, name, seconds, rate_hz, quality, licence, "
                         "subject, split FROM clip ORDER BY number")
                     if wanted is None or row[0] in wanted}
        return [found[id] for id in (found if ids is None else ids)]

    def licences(self) -> list[Licence]:
        """Returns the licences of all clips, with the persons to name. This module does not check
        permissions: `marey library export` does, and query() selects by licence."""
        with self._index() as index:
            rows = index.execute(
                "SELECT clip.licence, count(*), sum(seconds), json_group_array(DISTINCT "
                "attribution) FROM clip JOIN source ON source.id = clip.source "
                "GROUP BY clip.licence ORDER BY clip.licence").fetchall()
        return [Licence(*row[:3], sorted(filter(None, json.loads(row[3])))) for row in rows]

    def motion(self, id: str) -> Motion:
        """Returns the frames of a clip. Constant time: pages are read when used."""
        row = self._row(id)
        if row.key not in self._kept:
            self._kept[row.key] = _map_motion(self._object(row.key), self.path)
            if len(self._kept) > _MAX_KEPT:
                self._kept.popitem(last=False)
        else:
            self._kept.move_to_end(row.key)
        whole, first = self._kept[row.key]
        frames = slice(row.first - first, row.last - first + 1)
        if frames.start < 0 or frames.stop > len(whole.root_m):
            raise _damaged(self._object(row.key), "it lacks frames of the clip", self.path)
        return replace(
            whole, rate=row.rate, root_m=whole.root_m[frames],
            rotations_wxyz=whole.rotations_wxyz[frames], contacts=whole.contacts[frames],
            sigma_m=None if whole.sigma_m is None else whole.sigma_m[frames],
            source=None if whole.source is None else whole.source[frames])

    def positions(self, id: str) -> np.ndarray:
        """Returns the joints' places in the world, (F, J, 3) float64, in metres."""
        motion = self.motion(id)
        return forward_kinematics(motion.root_m, motion.rotations_wxyz, motion.parents,
                                  motion.rest_translations_m)

    def features(self, id: str) -> np.ndarray:
        """Returns the features of a clip, (instants, 57) float32, one row per 0.1 s, mapped
        from the disk. library/features/body_features.h has their meaning."""
        number = self._row(id).number
        rows, begins = self._feature_rows()
        return rows[int(begins[number]):int(begins[number + 1]), :FEATURES]

    def similar(self, query: str | np.ndarray, top: int = 10,
                length_s: float | None = 2.0) -> list[Similar]:
        """Returns the clips that are similar to a clip (its id), or to rows of features().

        The middle `length_s` of a longer query is searched; None: all of it. Every clip is
        compared by dynamic time warping, as by `marey library similar --exact`: a plain
        scan without an index, 0.1 s for an hour of motion. The order of clips whose
        distances are equal to 6 digits may differ from the program's.
        """
        rows, begins = self._feature_rows()
        part = np.asarray(self.features(query) if isinstance(query, str) else query)
        if part.ndim != 2 or part.shape[1] < FEATURES or len(part) == 0:
            raise ValueError("similar() needs the id of a clip, or rows of features()")
        part = np.pad(part[:, :FEATURES].astype(np.float32),
                      ((0, 0), (0, FEATURE_STRIDE - FEATURES)))
        if length_s is not None:
            count = math.floor(max(0.0, length_s) * FEATURE_RATE_HZ + 0.5) + 1
            if count < len(part):
                first = (len(part) - count) // 2
                part = part[first:first + count]
        distance, start, end = _warp_distances(part, rows, begins)
        if isinstance(query, str):
            distance[self._row(query).number] = np.inf
        clips = list(self._rows.values())
        out = []
        for number in np.argsort(distance, kind="stable")[:top]:
            if not np.isfinite(distance[number]):
                break
            clip = clips[number]
            before = max(0.0, math.ceil(clip.first * FEATURE_RATE_HZ / clip.rate - _SAME)
                         / FEATURE_RATE_HZ - clip.first / clip.rate)
            last = (clip.last - clip.first) / clip.rate
            out.append(Similar(clip.id, clip.name, float(distance[number]), *(
                min(before + (at[number] - int(begins[number])) / FEATURE_RATE_HZ, last)
                for at in (start, end))))
        return out

    @contextmanager
    def _index(self) -> Iterator[sqlite3.Connection]:
        """Opens library.sqlite as an immutable file, and checks that it is this version."""
        path = self.path / "library.sqlite"
        if not path.is_file():
            raise LibraryError(f"{path}: no such file; make it: marey library build {self.path}")
        index = None
        try:
            index = sqlite3.connect(path.resolve().as_uri() + "?mode=ro&immutable=1", uri=True)
            settings = [index.execute("PRAGMA " + name).fetchone()[0] for name in (
                "application_id", "user_version", "page_size")]
            if settings[0] != INDEX_APPLICATION:
                raise _damaged(path, "it is no index of a library, or it is damaged", self.path)
            if settings[1] != INDEX_VERSION:
                raise _damaged(path, f"another version of marey made it (tables {settings[1]}, "
                               f"this module reads {INDEX_VERSION})", self.path)
            if path.stat().st_size % settings[2] != 0:
                raise _damaged(path, "it is damaged: it was cut short", self.path)
            name = index.execute("SELECT version_name FROM head").fetchone()
            if name is None:
                raise _damaged(path, "it has no head", self.path)
            if self._version not in (None, name[0]):
                raise LibraryError(f"{path}: the library was built again meanwhile; open it "
                                   "again with Library(path)")
            yield index
        except (sqlite3.DatabaseError, UnicodeDecodeError) as error:
            raise _damaged(path, f"it is damaged: {error}", self.path) from None
        finally:
            if index is not None:
                index.close()

    def _row(self, id: str) -> _Row:
        try:
            return self._rows[id]
        except KeyError:
            raise LibraryError(f"{self.path}: no clip has the id {id!r}; list them: "
                               f"marey library query {self.path}") from None

    def _object(self, key: str) -> Path:
        if not re.fullmatch("[0-9a-f]{64}", key):
            raise _damaged(self.path / "library.sqlite", "a key is damaged", self.path)
        return self.path / "objects" / key[:2] / (key[2:] + ".npz")

    def _feature_rows(self) -> tuple[np.ndarray, np.ndarray]:
        """Returns all rows, and the first row of each clip and of the end."""
        path = self._search / "features.f32"
        data = _read(path, self.path)
        head = np.frombuffer(data, "<u4", 4, 0) if len(data) >= 64 else np.zeros(4, "<u4")
        if bytes(data[:8]) != b"MAREYROW":
            raise _damaged(path, "it is no file of rows", self.path)
        if head[2] != ROWS_LAYOUT or head[3] != FEATURE_STRIDE:
            raise _damaged(path, "another version of marey wrote it", self.path)
        count, clips = (int(n) for n in np.frombuffer(data, "<u8", 2, 16))
        begins = np.array([0, count], "<u8")
        if clips != 1:
            idx = _read(path.with_suffix(".idx"), self.path)
            begins = np.frombuffer(idx, "<u8", len(idx) // 8)
        if (len(data) != 64 + count * FEATURE_STRIDE * 4 or clips != len(self._rows)
                or len(begins) != clips + 1 or begins[0] != 0 or begins[-1] != count
                or np.any(begins[:-1] > begins[1:])):
            raise _damaged(path, "its size does not fit the clips", self.path)
        rows = np.frombuffer(data, "<f4", count * FEATURE_STRIDE, 64)
        return rows.reshape(count, FEATURE_STRIDE), begins


class Windows:
    """Windows of equal length over the clips of a library: a data set for PyTorch's
    DataLoader (__len__, __getitem__), without PyTorch.

    `query` (SQL), `label` and `split` select clips as Library.query() does, all licences
    included. With `rate`, motions are resampled to it; else each clip keeps its own rate.
    `bones` are VRM's names of joints to keep, in this order; needed if skeletons differ.
    `arrays` may also have "positions_m". Clips shorter than a window are in `short_clips`.
    """

    def __init__(self, library: Library, frames: int = 64, stride: int = 16, query: str = "",
                 split: str = "", rate: float | None = None, label: str = "",
                 bones: Sequence[str] | None = None,
                 arrays: Sequence[str] = ("root_m", "rotations_wxyz", "contacts")):
        unknown = set(arrays) - {"root_m", "rotations_wxyz", "contacts", "positions_m"}
        if frames < 1 or stride < 1 or (rate is not None and rate <= 0) or unknown:
            raise ValueError(f"frames, stride and rate must be positive; arrays: {unknown}")
        self.library, self.frames, self.stride, self.rate = library, frames, stride, rate
        self.bones, self.arrays = bones, tuple(arrays)
        ids = library.query(query, label=label, split=split)
        counts = []
        for id in ids:
            row = library._row(id)
            steps = row.last - row.first
            length = (steps if rate is None else math.floor(steps * rate / row.rate + _SAME)) + 1
            counts.append(max(0, (length - frames) // stride + 1))
        self.ids = [id for id, count in zip(ids, counts) if count]
        self.short_clips = [id for id, count in zip(ids, counts) if not count]
        self._ends = np.cumsum([count for count in counts if count], dtype=np.int64)

    def __len__(self) -> int:
        return int(self._ends[-1]) if len(self._ends) else 0

    def __getitem__(self, index: int) -> dict[str, Any]:
        """Returns arrays of `frames` rows, the id of the clip as "clip", the "rate" and the
        first frame of the window in the clip, at this rate, as "first_frame"."""
        if index < 0:
            index += len(self)
        if not 0 <= index < len(self):
            raise IndexError(index)
        place = int(np.searchsorted(self._ends, index, side="right"))
        first = (index - (int(self._ends[place - 1]) if place else 0)) * self.stride
        motion = self.library.motion(self.ids[place])
        rate = motion.rate if self.rate is None else float(self.rate)
        at = np.minimum((first + np.arange(self.frames)) * (motion.rate / rate),
                        len(motion.root_m) - 1.0)
        root, rotations, contacts = _sample(motion, at)
        joints = slice(None) if self.bones is None else self._joints(motion)
        out: dict[str, Any] = {"clip": self.ids[place], "rate": rate, "first_frame": first}
        for name in self.arrays:
            if name == "positions_m":
                out[name] = forward_kinematics(
                    root, rotations, motion.parents,
                    motion.rest_translations_m)[:, joints].astype(np.float32)
            else:
                out[name] = {"root_m": root, "contacts": contacts,
                             "rotations_wxyz": rotations[:, joints]}[name]
        return out

    def _joints(self, motion: Motion) -> list[int]:
        missing = [bone for bone in self.bones if bone not in motion.human_bones]
        if missing:
            raise LibraryError(f"{self.library.path}: a skeleton has no {', '.join(missing)}; "
                               "choose other bones, or select clips by a query")
        return [motion.human_bones.index(bone) for bone in self.bones]


def forward_kinematics(root_m: np.ndarray, rotations_wxyz: np.ndarray, parents: np.ndarray,
                       rest_translations_m: np.ndarray) -> np.ndarray:
    """Returns places of joints in the world, (F, J, 3) float64. Parents come first."""
    local = np.moveaxis(np.asarray(rotations_wxyz, np.float64), 0, -1)  # (J, 4, F)
    rest = np.asarray(rest_translations_m, np.float64)
    turns = np.empty_like(local)
    places = np.empty((len(parents), 3, local.shape[-1]))
    for joint, parent in enumerate(parents):
        if parent < 0:
            turns[joint], places[joint] = local[joint], np.asarray(root_m, np.float64).T
            continue
        w, x, y, z = turns[parent]
        a, b, c, d = local[joint]
        turns[joint] = (w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
                        w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a)
        u, v, t = rest[joint]
        e, f, g = 2 * (y * t - z * v), 2 * (z * u - x * t), 2 * (x * v - y * u)
        places[joint] = places[parent] + (
            u + w * e + y * g - z * f, v + w * f + z * e - x * g, t + w * g + x * f - y * e)
    return np.moveaxis(places, -1, 0)


def _sample(motion: Motion, at: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns root, rotations and contacts at these frames, which may be fractions:
    linear, on the sphere, and of the nearest frame. The arrays are copies."""
    nearest = np.floor(at + 0.5).astype(np.int64)
    if np.all(np.abs(at - nearest) < _SAME):
        return (motion.root_m[nearest], motion.rotations_wxyz[nearest],
                motion.contacts[nearest])
    low = np.floor(at).astype(np.int64)
    high = np.minimum(low + 1, len(motion.root_m) - 1)
    share = (at - low).astype(np.float32)[:, None]
    root = motion.root_m[low] * (1 - share) + motion.root_m[high] * share
    p, q = motion.rotations_wxyz[low], motion.rotations_wxyz[high]
    share = share[..., None]
    cosine = np.sum(p * q, -1, keepdims=True)
    q = np.where(cosine < 0, -q, q)
    angle = np.arccos(np.clip(np.abs(cosine), 0, 1))
    sine = np.sin(angle)
    is_small = sine < 1e-3
    divisor = np.where(is_small, 1, sine)
    turned = (np.where(is_small, 1 - share, np.sin((1 - share) * angle) / divisor) * p
              + np.where(is_small, share, np.sin(share * angle) / divisor) * q)
    turned /= np.linalg.norm(turned, axis=-1, keepdims=True)
    return root, turned, motion.contacts[nearest]


def _warp_distances(query: np.ndarray, rows: np.ndarray,
                    begins: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns the distance of the query from each clip, infinite if the clip is too short,
    and the first and last row of the part. library/search/warp_distance.h has the formula:
        D(i,j) = c(i,j) + min{D(i-1,j-1), D(i-2,j-1) + c(i-1,j), D(i-1,j-2) + c(i,j-1)}
    All clips are one line of columns; two infinite ones before each stop the steps."""
    clips = len(begins) - 1
    counts = np.diff(begins.astype(np.int64))
    gaps = 2 * (np.repeat(np.arange(clips), counts) + 1)
    place = np.arange(len(rows)) + gaps  # Column of each row.
    width = len(rows) + 2 * clips + 2

    def line() -> np.ndarray:
        return np.full(width, np.inf, np.float32)

    before, earlier, costs_before = line(), line(), line()
    from_before, from_earlier = np.zeros(width, np.int64), np.zeros(width, np.int64)
    for i, instant in enumerate(query):
        costs = line()
        for k in range(0, len(rows), 8192):
            apart = rows[k:k + 8192] - instant
            costs[place[k:k + 8192]] = np.sqrt(np.einsum("ij,ij->i", apart, apart))
        sums, start = line(), np.zeros(width, np.int64)
        if i == 0:
            sums = costs.copy()
            start[place] = np.arange(len(rows))
        else:
            best = before[1:-1].copy()
            start[2:] = from_before[1:-1]
            for other, origin in ((earlier[1:-1] + costs_before[2:], from_earlier[1:-1]),
                                  (before[:-2] + costs[1:-1], from_before[:-2])):
                is_less = other < best
                best = np.where(is_less, other, best)
                start[2:] = np.where(is_less, origin, start[2:])
            sums[2:] = best + costs[2:]
        earlier, before, costs_before = before, sums, costs
        from_earlier, from_before = from_before, start
    distance = np.full(clips, np.inf)
    first, last = np.zeros(clips, np.int64), np.zeros(clips, np.int64)
    for clip in np.flatnonzero(counts):
        a = int(begins[clip]) + 2 * (clip + 1)
        end = a + int(np.argmin(before[a:a + counts[clip]]))
        distance[clip] = float(before[end]) / len(query)
        first[clip], last[clip] = from_before[end], end - 2 * (clip + 1)
    return distance, first, last


def _damaged(path: Path, cause: str, library: Path) -> LibraryError:
    return LibraryError(f"{path}: {cause}; make it again: marey library build {library}")


def _read(path: Path, library: Path) -> Any:
    """Returns the bytes of a file: mapped, unless many files are mapped already."""
    try:
        with open(path, "rb") as file:
            if len(_mapped) >= _MAX_MAPPED:
                return file.read()
            data = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
            _mapped.add(data)
            return data
    except FileNotFoundError:
        raise _damaged(path, "no such file", library) from None
    except (OSError, ValueError) as error:
        raise _damaged(path, f"it cannot be read: {error}", library) from None


def _map_motion(path: Path, library: Path) -> tuple[Motion, int]:
    """Returns a motion object, and the number of its first frame in the source."""
    data = _read(path, library)
    arrays: dict[str, np.ndarray] = {}
    try:
        with zipfile.ZipFile(path) as archive:
            for member in archive.infolist():
                if member.compress_type != zipfile.ZIP_STORED:
                    raise ValueError(member.filename + " is compressed")
                # The local header has a name and extra bytes of its own lengths.
                name, extra = np.frombuffer(data, "<u2", 2, member.header_offset + 26)
                at = member.header_offset + 30 + int(name) + int(extra)
                arrays[member.filename.removesuffix(".npy")] = _map_array(data, at)
        layout = int(arrays["format"])
        if layout != MOTION_LAYOUT:
            raise ValueError(f"another version of marey wrote it (layout {layout}, this "
                             f"module reads {MOTION_LAYOUT})")
        first = int(arrays.pop("first_frame"))
        rate = float(arrays.pop("rate_hz"))
        names = {name: [str(word) for word in arrays.pop(name)]
                 for name in ("joint_names", "human_bones")}
        del arrays["format"]
        motion = Motion(rate=rate, **names, **arrays)
        frames, joints = motion.rotations_wxyz.shape[:2]
        shapes = {"root_m": (frames, 3), "rotations_wxyz": (frames, joints, 4),
                  "contacts": (frames, 4), "parents": (joints,),
                  "rest_translations_m": (joints, 3)}
        if any(arrays[name].shape != shape for name, shape in shapes.items()):
            raise ValueError("the shapes of its arrays differ")
        if np.any(motion.parents >= np.arange(joints)):
            raise ValueError("a joint comes before its parent")
        return motion, first
    except (zipfile.BadZipFile, AttributeError, KeyError, NotImplementedError, SyntaxError,
            OverflowError, TypeError, ValueError) as error:
        raise _damaged(path, f"it is damaged: {error}", library) from None


def _map_array(data: Any, at: int) -> np.ndarray:
    """Returns the array whose .npy file begins at `at`."""
    if bytes(data[at:at + 8]) != b"\x93NUMPY\x01\x00":
        raise ValueError("an array is no .npy of version 1")
    size = int(np.frombuffer(data, "<u2", 1, at + 8)[0])
    head = ast.literal_eval(bytes(data[at + 10:at + 10 + size]).decode("latin1"))
    count = math.prod(head["shape"])
    array = np.frombuffer(data, np.dtype(head["descr"]), count, at + 10 + size)
    return array.reshape(head["shape"], order="F" if head["fortran_order"] else "C")
