# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# blender -b --factory-startup --python-exit-code 1 --python make_blender_files.py
#
# Makes blender_arm.bvh and blender_arm.glb next to this script: an arm of three bones that
# Blender's own exporters write, and blender_arm.csv: where Blender itself puts the bones'
# heads, in metres and with Y up, frame by frame.
import csv
import math
import pathlib

import bpy
import numpy
from mathutils import Vector

# Debian 12's Blender 3.4 brings an exporter older than its numpy.
numpy.bool = bool

HERE = pathlib.Path(__file__).resolve().parent
FRAMES = range(1, 6)
HEADS = {"shoulder": (0.2, 0, 1.4), "elbow": (0.5, 0, 1.4), "wrist": (0.75, 0, 1.4)}
TIP = (0.85, 0, 1.4)


def make_armature():
    armature = bpy.data.objects.new("arm", bpy.data.armatures.new("arm"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    ends = list(HEADS.values())[1:] + [TIP]
    parent = None
    for (name, head), tail in zip(HEADS.items(), ends):
        bone = armature.data.edit_bones.new(name)
        bone.head, bone.tail, bone.parent = Vector(head), Vector(tail), parent
        parent = bone
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def make_skin(armature):
    """A square ribbon along the arm, one ring of four vertices per joint."""
    rings = list(HEADS.values()) + [TIP]
    corners = [(0.03, 0.03), (-0.03, 0.03), (-0.03, -0.03), (0.03, -0.03)]
    vertices = [(x, y + a, z + b) for x, y, z in rings for a, b in corners]
    faces = [
        (4 * r + i, 4 * r + (i + 1) % 4, 4 * r + 4 + (i + 1) % 4, 4 * r + 4 + i)
        for r in range(len(rings) - 1)
        for i in range(4)
    ]
    mesh = bpy.data.meshes.new("skin")
    mesh.from_pydata(vertices, [], faces)
    skin = bpy.data.objects.new("skin", mesh)
    bpy.context.scene.collection.objects.link(skin)
    names = list(HEADS)
    for r in range(len(rings)):
        name = names[min(r, len(names) - 1)]
        group = skin.vertex_groups.get(name) or skin.vertex_groups.new(name=name)
        group.add([4 * r + i for i in range(4)], 1.0, "REPLACE")
    skin.parent = armature
    skin.modifiers.new("armature", "ARMATURE").object = armature


def animate(armature):
    for frame in FRAMES:
        share = (frame - 1) / (len(FRAMES) - 1)
        for name, euler in {
            "shoulder": (20 * share, -30 * share, 45 * share),
            "elbow": (0, 10 * share, 80 * share),
            "wrist": (-25 * share, 0, 15 * share),
        }.items():
            bone = armature.pose.bones[name]
            bone.rotation_mode = "XYZ"
            bone.rotation_euler = [math.radians(degrees) for degrees in euler]
            bone.keyframe_insert("rotation_euler", frame=frame)
        root = armature.pose.bones["shoulder"]
        root.location = (0.1 * share, 0.2 * share, -0.05 * share)
        root.keyframe_insert("location", frame=frame)


def write_truth(armature):
    scene = bpy.context.scene
    with open(HERE / "blender_arm.csv", "w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["frame", "joint", "x", "y", "z"])
        for frame in FRAMES:
            scene.frame_set(frame)
            bpy.context.view_layer.update()
            for name in HEADS:
                x, y, z = armature.matrix_world @ armature.pose.bones[name].head
                rows.writerow([frame - 1, name, f"{x:.6f}", f"{z:.6f}", f"{0.0 - y:.6f}"])


bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = 25
scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
arm = make_armature()
make_skin(arm)
animate(arm)
write_truth(arm)
bpy.ops.object.select_all(action="SELECT")
bpy.ops.export_scene.gltf(filepath=str(HERE / "blender_arm.glb"), export_format="GLB")
bpy.ops.object.select_all(action="DESELECT")
arm.select_set(True)
bpy.context.view_layer.objects.active = arm
bpy.ops.export_anim.bvh(
    filepath=str(HERE / "blender_arm.bvh"),
    frame_start=FRAMES[0],
    frame_end=FRAMES[-1],
    rotate_mode="NATIVE",
)
