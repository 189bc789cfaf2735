# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of a scene from the results of marey stage, with Blender 3.4.

    blender -b -P draw_scene_pictures.py -- RESULTS OUT

RESULTS is the folder that `marey stage --out` wrote; the pictures are OUT/NAME-1.png,
OUT/NAME-2.png and so on.
"""

import json
import math
import pathlib
import sys

import bpy
import numpy
from mathutils import Vector

# The glTF importer of Blender 3.4 uses this name, which newer NumPy versions lack.
if not hasattr(numpy, "bool"):
    numpy.bool = bool

GREY = (0.35, 0.36, 0.38, 1.0)
PLATE = (0.62, 0.60, 0.55, 1.0)


def in_blender(point):
    """Converts a point from Y up to Z up."""
    return Vector((point[0], -point[2], point[1]))


def add_surface(name, corners, colour):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], [list(range(len(corners)))])
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = colour
    shader.inputs["Roughness"].default_value = 0.9
    mesh.materials.append(material)
    surface = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(surface)
    return surface


def add_lights(scene):
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy = 3.0
    sun.data.angle = 0.1
    sun.rotation_euler = (math.radians(40.0), 0.0, math.radians(35.0))
    scene.collection.objects.link(sun)
    scene.world = scene.world or bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.8, 0.85, 0.9, 1)
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0.7


def draw(scene, camera, picture, out):
    eye = in_blender(picture["camera_m"])
    camera.location = eye
    way = in_blender(picture["looks_at_m"]) - eye
    camera.rotation_euler = way.to_track_quat("-Z", "Y").to_euler()
    scene.frame_set(round(picture["time_s"] * scene.render.fps))
    plates = [
        add_surface("plate", [in_blender(p) for p in corners], PLATE)
        for corners in picture["floor_m"]
    ]
    scene.render.resolution_x = picture["width_px"]
    scene.render.resolution_y = picture["height_px"]
    scene.render.filepath = str(out)
    bpy.ops.render.render(write_still=True)
    for plate in plates:
        bpy.data.objects.remove(plate)


def main():
    results, folder = (pathlib.Path(p) for p in sys.argv[sys.argv.index("--") + 1 :])
    stage = json.loads((results / "stage.json").read_text())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = 60
    bpy.ops.import_scene.gltf(filepath=str(results / (stage["scene"] + ".glb")))
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 24
    scene.cycles.use_denoising = False
    add_lights(scene)
    add_surface(
        "floor",
        [Vector((x, y, -0.002)) for x, y in ((-40, -40), (40, -40), (40, 40), (-40, 40))],
        GREY,
    )
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    folder.mkdir(parents=True, exist_ok=True)
    for number, picture in enumerate(stage["pictures"], start=1):
        draw(scene, camera, picture, folder / f"{stage['scene']}-{number}.png")


main()
