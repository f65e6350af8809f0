"""Prepare a scan in Blender: close its holes, divide it into faces, and mark their borders as seams.

    blender --background scan.blend --python blender_prepare_scan.py -- prepared.blend

Works on the active object. Needs the extension installed and enabled.
"""

import sys

import bpy

target = sys.argv[sys.argv.index("--") + 1]
obj = bpy.context.view_layer.objects.active
faces = len(obj.data.polygons)

bpy.ops.object.select_all(action="DESELECT")
obj.select_set(True)
bpy.ops.ridgeform.fill_holes()
print(f"{len(obj.data.polygons) - faces} faces fill the holes")

bpy.ops.ridgeform.segment(outputs={"MATERIALS", "SEAMS"})
seams = sum(edge.use_seam for edge in obj.data.edges)
print(f"{len(obj.material_slots)} segments, {seams} edges are seams")
bpy.ops.wm.save_as_mainfile(filepath=target, copy=True)
