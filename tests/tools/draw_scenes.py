# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# blender -b --factory-startup --python-exit-code 1 --python draw_scenes.py -- \
#     FOLDER [--out PICTURES] [--width PIXELS]
#
# Makes NAME.png of each NAME.glb with its NAME.json in FOLDER (benchmarks/draw_adaptation
# writes them): without perspective, as large as fits.
import argparse
import json
import math
import pathlib
import sys

import bpy
import mathutils
import numpy

numpy.bool = bool  # Debian 12's Blender 3.4 is older than its numpy.

LETTER = 0.024  # Height of the labels' letters, in parts of the picture's width.
MARGIN = 1.02
MAX_HEIGHT_PX = 400


def parse_arguments():
    parser = argparse.ArgumentParser(prog="draw_scenes.py")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--width", type=int, default=960)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])


def in_blender(p):
    """Blender is Z up: it turns a file's (x, y, z) to (x, -z, y)."""
    return mathutils.Vector((p[0], -p[2], p[1]))


def split_by_material():
    mesh = next(o for o in bpy.context.scene.objects if o.type == "MESH")
    bpy.ops.object.select_all(action="DESELECT")
    mesh.select_set(True)
    bpy.context.view_layer.objects.active = mesh
    bpy.ops.mesh.separate(type="MATERIAL")
    meshes = [o for o in bpy.context.scene.objects if o.type == "MESH"]
    for part in meshes:
        part.show_in_front = part.active_material.name.startswith("within")
    return meshes


def add_label(label, camera_rotation, letter_m):
    curve = bpy.data.curves.new("label", "FONT")
    curve.body = label["text"]
    curve.size = letter_m
    curve.align_x = "CENTER"
    curve.align_y = "TOP"
    ink = bpy.data.materials.new("ink")
    ink.diffuse_color = (0.02, 0.02, 0.025, 1)
    curve.materials.append(ink)
    text = bpy.data.objects.new("label", curve)
    text.location = in_blender(label["at"])
    text.rotation_euler = camera_rotation
    bpy.context.collection.objects.link(text)
    bpy.context.view_layer.update()
    return text


def turn_camera(page):
    azimuth = math.radians(page["azimuth_deg"])
    elevation = math.radians(page["elevation_deg"])
    # Direction to the viewer, in the axes of the file.
    back = in_blender(
        (
            math.cos(elevation) * math.sin(azimuth),
            math.sin(elevation),
            math.cos(elevation) * math.cos(azimuth),
        )
    )
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type = "ORTHO"
    camera.rotation_euler = back.to_track_quat("Z", "Y").to_euler()
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    return camera, back


def frame(camera, back, objects, width):
    """Everything in the picture, whose height follows; returns its width in metres."""
    turned = camera.rotation_euler.to_matrix()
    places = []
    for thing in objects:
        corners = thing.bound_box if thing.type == "FONT" else None
        points = corners or [v.co for v in thing.data.vertices]
        seen = turned.transposed() @ thing.matrix_world.to_3x3()
        at = turned.transposed() @ thing.matrix_world.translation
        places += [seen @ mathutils.Vector(p) + at for p in points]
    low = [min(p[axis] for p in places) for axis in range(3)]
    high = [max(p[axis] for p in places) for axis in range(3)]
    middle = mathutils.Vector([0.5 * (a + b) for a, b in zip(low, high)])
    camera.location = turned @ middle + 20 * back
    across, up = (MARGIN * (high[axis] - low[axis]) + 0.06 for axis in (0, 1))
    render = bpy.context.scene.render
    width = min(width, round(MAX_HEIGHT_PX * across / up))
    render.resolution_x = width
    render.resolution_y = math.ceil(width * up / across)
    camera.data.ortho_scale = max(across, up)
    return across


def leave_out_notes(render):
    """Leaves out dates and paths, so that the same scene gives the same bytes."""
    for name in dir(render):
        if name.startswith("use_stamp") and isinstance(getattr(render, name), bool):
            setattr(render, name, False)


def shade():
    scene = bpy.context.scene
    leave_out_notes(scene.render)
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.compression = 100
    scene.render.film_transparent = False
    scene.render.dither_intensity = 0  # PNG cannot compress noise.
    scene.view_settings.view_transform = "Standard"
    scene.display.render_aa = "8"
    shading = scene.display.shading
    shading.light = "STUDIO"
    shading.color_type = "MATERIAL"
    shading.show_object_outline = False
    shading.show_shadows = False
    shading.background_type = "WORLD"
    world = bpy.data.worlds.new("paper")
    world.color = (0.9, 0.9, 0.9)
    scene.world = world


def draw(glb, out, width):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    page = json.loads(glb.with_suffix(".json").read_text(encoding="utf-8"))
    bpy.ops.import_scene.gltf(filepath=str(glb))
    camera, back = turn_camera(page)
    things = split_by_material()
    letter_m = LETTER * frame(camera, back, things, width)
    labels = [add_label(label, camera.rotation_euler, letter_m) for label in page["labels"]]
    frame(camera, back, things + labels, width)
    shade()
    bpy.context.scene.render.filepath = str((out / glb.stem).with_suffix(".png").resolve())
    bpy.ops.render.render(write_still=True)


def main():
    arguments = parse_arguments()
    out = arguments.out or arguments.folder
    scenes = sorted(arguments.folder.glob("*.glb"))
    if not scenes:
        sys.exit(f"{arguments.folder}: no .glb files; run draw_adaptation first")
    for glb in scenes:
        draw(glb, out, arguments.width)


if __name__ == "__main__":
    main()
