"""Meshes of every kind for the random sequences: sound ones, and such as no tool is made for."""

import addon_kit as kit
import bpy
import hole_kit
import modal_kit
import numpy as np

NAMES = ["Box", "☃é", "a" * 60, "q\"uo'te\\", "../../etc", "x\ny", " ", ".", "%s{0}", "-o", "a/b", "CON"]


def _with_keys():
    obj = modal_kit.open_box(cuts=2)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="Key")
    key.data[0].co.x += 0.3
    obj.active_shape_key_index = 1
    return obj


def _fan():
    """Three faces around one edge, and one that touches it in a vertex only."""
    points = [(0, 0, 0), (0, 0, 1), (1, 0, 0), (-1, 0.5, 0), (0, -1, 0), (2, 2, 2), (2, 3, 2)]
    return kit.add_object("Fan", points, [(0, 1, 2), (0, 1, 3), (0, 1, 4), (0, 5, 6)])


def _flat():
    """Faces without area, among sound ones."""
    points = [(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0), (1, 0, 0)]
    return kit.add_object("Flat", points, [(0, 1, 4, 3), (1, 2, 5, 4), (0, 1, 2), (1, 6, 4)])


def _double():
    """Linked duplicates: two objects, one mesh."""
    obj = kit.bumpy_box("Twin", cuts=1)
    return kit.link(bpy.data.objects.new("Twin", obj.data))


def _tiny():
    obj = kit.bumpy_box("Tiny", cuts=2)
    kit.set_coordinates(obj, kit.coordinates(obj) * np.float32(1e-12))
    return obj


def _huge():
    obj = kit.bumpy_box("Huge", cuts=2)
    kit.set_coordinates(obj, kit.coordinates(obj) * np.float32(1e12))
    return obj


KINDS = {
    "open box": lambda: modal_kit.open_box(cuts=2),
    "shape keys": _with_keys,
    "closed box": lambda: kit.bumpy_box(cuts=2),
    "n-gons": lambda: kit.ngon_prism(sides=7, rings=3),
    "sheet": lambda: hole_kit.sheet(6, (2, 4)),
    "box with a round hole": lambda: hole_kit.box(4, 0.6),
    "fan": _fan,
    "flat faces": _flat,
    "triangle": lambda: kit.add_object("Triangle", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]),
    "points": lambda: kit.add_object("Points", [(0, 0, 0), (1, 0, 0)], []),
    "nothing": lambda: kit.add_object("Nothing", np.empty((0, 3)), []),
    "linked duplicate": _double,
    "tiny": _tiny,
    "huge": _huge,
}
"""How to make each kind."""
