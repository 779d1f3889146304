"""Surfaces as Blender imports them, run by it without a display.

Usage: blender --background --factory-startup --python-exit-code 1 --python blender_test.py -- DIRECTORY
"""
import os
import re
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

# The armature stands in the mesh, and moves it.
for job in (Job(DIRECTORY, "axis"), Job(DIRECTORY, "affine")):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Blender 3.4 of Debian 12 cannot guess the shading with Debian's NumPy.
    bpy.ops.import_scene.gltf(filepath=job.path("curve.glb"), import_shading="FLAT")
    armature, = (one for one in bpy.data.objects if one.type == "ARMATURE")
    body, = (one for one in bpy.data.objects if one.type == "MESH" and one.parent == armature)

    def places():
        bpy.context.view_layer.update()
        moved = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
        return [moved.matrix_world @ vertex.co for vertex in moved.to_mesh().vertices]

    # Its triangles are cut where parts meet, as those of the file of thickness.
    with open(job.path("thickness.vtp"), encoding="latin-1") as file:
        triangles = int(re.search('NumberOfPolys="([0-9]+)"', file.read(4096)).group(1))
    assert len(body.data.polygons) == triangles > job.triangles, len(body.data.polygons)
    rest = places()
    low, high = (tuple(side(place[axis] for place in rest) for axis in range(3)) for side in (min, max))
    assert high[2] - low[2] > 2 * (high[1] - low[1]), "upright"
    for bone in armature.data.bones:
        head = armature.matrix_world @ bone.head_local
        assert all(low[axis] <= head[axis] <= high[axis] for axis in range(3)), (bone.name, head)
    # The first bone of the part that ends lowest, which is a leg, takes its triangles along and leaves the rest.
    lowest = min(armature.data.bones, key=lambda bone: (armature.matrix_world @ bone.head_local)[2])
    bone = armature.pose.bones[lowest.name.split(".")[0] + ".0"]
    bone.rotation_mode = "XYZ"
    bone.rotation_euler = (0.5, 0, 0)
    moves = [(place - now).length > 1e-3 * (high[2] - low[2]) for place, now in zip(rest, places())]
    share = (sum(face.area for face in body.data.polygons if any(moves[v] for v in face.vertices)) /
             sum(face.area for face in body.data.polygons))
    assert 0.02 < share < 0.5, share  # a leg; in a frame that makes bodies deep a foot
    assert max(place[2] for place, moved in zip(rest, moves) if moved) < (low[2] + 2 * high[2]) / 3, "the head stays"
    print(f"{job.frame}: {len(armature.data.bones)} bones")
print("all kinds of files opened")
