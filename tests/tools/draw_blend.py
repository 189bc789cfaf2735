# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# blender -b --factory-startup --python-exit-code 1 --python draw_blend.py -- \
#     OUT.glb FIGURES.json PICTURE.png [--every FRAMES] [--width PIXELS] [--turn DEGREES]
#
# Draws a transition that `marey blend A B --on BODY.glb --out OUT.glb --json` made, with
# FIGURES.json its output: the body every few frames on its way, from the side. Bodies
# before the switch are grey, those during the fade yellow, later ones blue.
import argparse
import json
import math
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import draw_scenes  # noqa: E402

BEFORE = (0.42, 0.42, 0.45, 1)
FADE = (0.85, 0.55, 0.08, 1)
AFTER = (0.08, 0.28, 0.62, 1)


def parse_arguments():
    parser = argparse.ArgumentParser(prog="draw_blend.py")
    parser.add_argument("glb", type=pathlib.Path)
    parser.add_argument("figures", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--every", type=int, default=12)
    parser.add_argument("--around", type=int, default=72, help="frames before and after")
    parser.add_argument("--width", type=int, default=960)
    parser.add_argument("--turn", type=float, default=0.0)
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])


def ink(name, colour):
    material = bpy.data.materials.new(name)
    material.diffuse_color = colour
    return material


def pose_at(body, frame, material):
    """Returns a copy of the skinned body as it is in a frame, in the world."""
    scene = bpy.context.scene
    time = frame / 60.0 * scene.render.fps / scene.render.fps_base
    scene.frame_set(int(time), subframe=time - int(time))
    graph = bpy.context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(body.evaluated_get(graph), depsgraph=graph)
    mesh.transform(body.matrix_world)
    mesh.materials.clear()
    mesh.materials.append(material)
    for polygon in mesh.polygons:
        polygon.material_index = 0
    copy = bpy.data.objects.new(f"frame {frame}", mesh)
    bpy.context.collection.objects.link(copy)
    return copy


def main():
    arguments = parse_arguments()
    figures = json.loads(arguments.figures.read_text(encoding="utf-8"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(arguments.glb))
    bodies = [o for o in bpy.context.scene.objects if o.find_armature() is not None]
    before, fade, after = ink("before", BEFORE), ink("fade", FADE), ink("after", AFTER)
    switch = figures["switch_frame"]
    end = switch + round(figures["fade_s"] * figures["rate_hz"])
    first = max(0, switch - arguments.around)
    first += (switch - first) % arguments.every
    last = min(figures["frames"] - 1, switch + arguments.around)
    things = []
    for frame in range(first, last + 1, arguments.every):
        material = before if frame <= switch else fade if frame <= end else after
        things += [pose_at(body, frame, material) for body in bodies]
    for other in list(bpy.context.scene.objects):
        if other not in things:
            bpy.data.objects.remove(other)
    # From the side of the way.
    ways = [thing.bound_box for thing in (things[0], things[-1])]
    middles = [[sum(p[a] for p in box) / 8 for a in range(3)] for box in ways]
    way = math.atan2(middles[1][0] - middles[0][0], -(middles[1][1] - middles[0][1]))
    page = {"azimuth_deg": math.degrees(way) - 90.0 + arguments.turn, "elevation_deg": 12}
    camera, back = draw_scenes.turn_camera(page)
    draw_scenes.frame(camera, back, things, arguments.width)
    draw_scenes.shade()
    bpy.context.scene.render.filepath = str(arguments.picture.resolve())
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
