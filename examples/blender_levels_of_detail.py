"""Make three versions of the active mesh with fewer and fewer triangles, for a game.

    blender --background statue.blend --python blender_levels_of_detail.py -- levels.blend

Each is stylized first: flat facets need fewer triangles than a bumpy surface. Needs the extension installed.
"""

import sys

import bpy

target = sys.argv[sys.argv.index("--") + 1]
original = bpy.context.view_layer.objects.active

for level, ratio in enumerate((0.5, 0.25, 0.1), 1):
    copy = original.copy()
    copy.data = original.data.copy()
    copy.name = copy.data.name = f"{original.name}_LOD{level}"
    bpy.context.collection.objects.link(copy)
    bpy.ops.object.select_all(action="DESELECT")
    copy.select_set(True)
    bpy.context.view_layer.objects.active = copy
    bpy.ops.ridgeform.stylize(steps=10, strength=0.5, finish="LOW_POLY", reduce_ratio=ratio)
    print(f"{copy.name}: {len(copy.data.polygons)} triangles")

bpy.ops.wm.save_as_mainfile(filepath=target, copy=True)
