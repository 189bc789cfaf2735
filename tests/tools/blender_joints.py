# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# blender -b --factory-startup --python-exit-code 1 --python blender_joints.py -- \
#     MOTION.(bvh|glb) [--unit METRES] [--compare JOINTS.csv] [--out OUT.csv]
#
# Imports a motion with Blender and prints the joint places that Blender computes for each
# frame: `frame,time,joint,x,y,z,sigma` in metres, Y up, as marey writes joints.csv. With
# --compare, prints the largest distance to such a file; exit 1 above 0.1 mm, or when a BVH
# has another rate.
import argparse
import builtins
import csv
import sys

import bpy
import numpy

LIMIT_MM = 0.1

# Debian 12's Blender 3.4 brings importers older than its Python and numpy.
numpy.bool = bool
import io_anim_bvh.import_bvh as bvh_importer  # noqa: E402

bvh_importer.open = lambda path, mode="r", *rest, **options: builtins.open(
    path, mode.replace("U", ""), *rest, **options
)


def parse_arguments():
    parser = argparse.ArgumentParser(prog="blender_joints.py")
    parser.add_argument("motion")
    parser.add_argument("--unit", type=float, default=0.01, help="metres per unit of a BVH")
    parser.add_argument("--compare")
    parser.add_argument("--out")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])


def import_motion(path, unit):
    """The armature and the Blender frame of the motion's first frame."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".bvh"):
        bpy.ops.import_anim.bvh(
            filepath=path, global_scale=unit, use_fps_scale=False, update_scene_fps=True
        )
        first = 1
    else:
        bpy.context.scene.render.fps = 30
        bpy.ops.import_scene.gltf(filepath=path)
        first = 0
    armatures = [o for o in bpy.context.scene.objects if o.type == "ARMATURE"]
    if len(armatures) != 1 or armatures[0].animation_data is None:
        sys.exit(f"{path}: expected one animated armature, found {len(armatures)}")
    return armatures[0], first


def same_rate(path):
    """Returns whether Blender's frame rate of a BVH is the rate of these joint places."""
    with builtins.open(path, encoding="utf-8") as file:
        times = sorted({float(row["time"]) for row in csv.DictReader(file)})
    if len(times) < 2:
        return True
    ours = (len(times) - 1) / (times[-1] - times[0])
    render = bpy.context.scene.render
    theirs = render.fps / render.fps_base
    print(f"rate {theirs:.6f} Hz of {ours:.6f} Hz")
    return abs(theirs - ours) <= 1e-5 * ours


def joint_rows(armature, first):
    last = int(round(armature.animation_data.action.frame_range[1]))
    for frame in range(first, last + 1):
        bpy.context.scene.frame_set(frame)
        for bone in armature.pose.bones:
            p = armature.matrix_world @ bone.head
            # Blender is Z up; it turned the file's (x, y, z) to (x, -z, y).
            yield frame - first, bone.name, (p.x, p.z, -p.y)


def write_rows(rows, path):
    with builtins.open(path, "w", encoding="utf-8") as out:
        out.write("frame,time,joint,x,y,z,sigma\n")
        for frame, joint, (x, y, z) in rows:
            out.write(f"{frame},{frame / 30:.7f},{joint},{x:.7f},{y:.7f},{z:.7f},0\n")


def compare(rows, path):
    """Exit status: 0 when both have the same joints in the same places."""
    ours = {}
    with builtins.open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            place = numpy.array([float(row[axis]) for axis in "xyz"])
            ours[int(row["frame"]), row["joint"]] = place
    theirs = {(frame, joint): numpy.array(place) for frame, joint, place in rows}
    missing = set(ours) ^ set(theirs)
    if missing or not ours:
        print(f"only in one of both: {len(missing)} of {len(ours)}, {sorted(missing)[:5]}")
        return 1
    distances_mm = {key: 1000 * numpy.linalg.norm(ours[key] - theirs[key]) for key in ours}
    worst = max(distances_mm, key=distances_mm.get)
    frames = 1 + max(frame for frame, _ in ours)
    print(
        f"largest distance {distances_mm[worst]:.5f} mm "
        f"(frame {worst[0]}, {worst[1]}; {frames} frames, {len(ours)} places)"
    )
    return 0 if distances_mm[worst] <= LIMIT_MM else 1


def main():
    arguments = parse_arguments()
    rows = list(joint_rows(*import_motion(arguments.motion, arguments.unit)))
    if arguments.out:
        write_rows(rows, arguments.out)
    status = compare(rows, arguments.compare) if arguments.compare else 0
    if arguments.compare and arguments.motion.endswith(".bvh"):
        status = status or (0 if same_rate(arguments.compare) else 1)
    sys.exit(status)


main()
