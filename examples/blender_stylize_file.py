"""Stylize every mesh of a .blend file with Ridgeform, keep the volume, and save a copy.

    blender --background statue.blend --python blender_stylize_file.py -- faceted.blend

Needs the extension installed and enabled. The file that was opened is not changed.
"""

import sys

import bpy

target = sys.argv[sys.argv.index("--") + 1]

bpy.ops.object.select_all(action="DESELECT")
meshes = [obj for obj in bpy.context.view_layer.objects if obj.type == "MESH" and obj.data.polygons]
for obj in meshes:
    obj.select_set(True)
bpy.context.view_layer.objects.active = meshes[0]

bpy.ops.ridgeform.stylize(steps=15, strength=0.6, sharpness=0.75, keep_volume=True)
bpy.ops.wm.save_as_mainfile(filepath=target, copy=True)
print(f"{len(meshes)} meshes stylized, saved as {target}")
