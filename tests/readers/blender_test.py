"""Surfaces as Blender imports them, run by it without a display.

Usage: blender --background --factory-startup --python-exit-code 1 --python blender_test.py -- DIRECTORY
"""
import os
import sys

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from expected import POINT_ARRAYS, POINTS_ALONE, Job  # noqa: E402

DIRECTORY = sys.argv[sys.argv.index("--") + 1]


def imported(path):
    bpy.ops.import_mesh.ply(filepath=path)
    return bpy.context.view_layer.objects.active.data


for job in (Job(DIRECTORY, "axis"), Job(DIRECTORY, "affine")):
    for kind, arrays in POINT_ARRAYS.items():
        mesh = imported(job.path(kind + ".ply"))
        assert len(mesh.vertices) > 0, kind
        if kind in POINTS_ALONE or "E" not in arrays:
            continue
        assert len(mesh.polygons) > 0, kind
        colours = {tuple(round(part, 3) for part in corner.color) for corner in mesh.vertex_colors.active.data}
        assert len(colours) > 10, (kind, len(colours))
        print(f"{job.frame} {kind}: {len(mesh.polygons)} faces, {len(colours)} colours")
print("all kinds of files opened")
