"""What lies on a mesh stays, bit by bit, when its holes are filled, however the patches are appended."""

import addon_kit as kit
import bpy
import hole_kit
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.blender.mesh_layers import ATTRIBUTE_KINDS
from bl_ext.user_default.ridgeform.holes import growing

EXTRAS = ("nothing", "group", "key", "text", "normals")
MADE_ANEW = {".select_vert", ".select_edge", ".select_poly"}
SIZES = {"POINT": "vertices", "EDGE": "edges", "CORNER": "loops", "FACE": "polygons"}


def rich_box():
    """A box with a hole and an attribute of every type on every domain."""
    obj = hole_kit.box()
    mesh = obj.data
    rng = np.random.default_rng(0)
    for data_type, (prop, dtype, size) in ATTRIBUTE_KINDS.items():
        for domain in SIZES:
            attribute = mesh.attributes.new(f"{data_type} {domain}", data_type, domain)
            values = rng.random(len(attribute.data) * size)
            attribute.data.foreach_set(
                prop, (values * (100 if dtype is np.int32 else 1)).round(3).astype(dtype)
            )
    for name in ("First", "Second"):
        layer = mesh.uv_layers.new(name=name)
        layer.data.foreach_set("uv", rng.random(2 * len(mesh.loops)).astype(np.float32))
    mesh.uv_layers.active = mesh.uv_layers["Second"]
    mesh.uv_layers["First"].active_render = True
    mesh.color_attributes.active_color_name = "BYTE_COLOR CORNER"
    mesh.edges.foreach_set("use_seam", rng.random(len(mesh.edges)) < 0.2)
    mesh.polygons.foreach_set("use_smooth", rng.random(len(mesh.polygons)) < 0.5)
    mesh.polygons.foreach_set("hide", np.arange(len(mesh.polygons)) == 3)
    for name in "ab":
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", rng.integers(0, 2, len(mesh.polygons)).astype(np.int32))
    return obj


def add_extra(obj, extra):
    mesh = obj.data
    if extra == "group":
        for vertex in range(0, len(mesh.vertices), 3):
            group = obj.vertex_groups.get("bone") or obj.vertex_groups.new(name="bone")
            group.add([vertex], vertex / len(mesh.vertices), "REPLACE")
    elif extra == "key":
        kit.add_key(obj, "Basis", 0.0)
        kit.add_key(obj, "Odd", np.random.default_rng(1).normal(size=(len(mesh.vertices), 3)))
    elif extra == "text":
        mesh.attributes.new("text", "STRING", "FACE").data[7].value = b"seven"
    elif extra == "normals":
        mesh.normals_split_custom_set([(0.1, 0.2, 0.97)] * len(mesh.loops))


def readings(obj):
    """The bytes of every attribute that has fast access, and what is active."""
    mesh = obj.data
    found = {}
    for attribute in mesh.attributes:
        if attribute.data_type in ATTRIBUTE_KINDS and attribute.name not in MADE_ANEW:
            prop, dtype, size = ATTRIBUTE_KINDS[attribute.data_type]
            values = np.empty(len(attribute.data) * size, dtype)
            attribute.data.foreach_get(prop, values)
            found[attribute.name] = values.tobytes()
    active = (
        mesh.uv_layers.active.name,
        next(layer.name for layer in mesh.uv_layers if layer.active_render),
        mesh.color_attributes.active_color_name,
        [slot.name for slot in mesh.materials],
    )
    return found, active


@pytest.mark.parametrize("extra", EXTRAS)
def test_every_attribute_stays(extra):
    obj = rich_box()
    add_extra(obj, extra)
    assert growing.is_plain(obj) == (extra == "nothing")
    mesh = obj.data
    before, active = readings(obj)
    starts = [face.loop_start for face in mesh.polygons]
    edges = [tuple(edge.vertices) for edge in mesh.edges]
    weights = [[(g.group, g.weight) for g in vertex.groups] for vertex in mesh.vertices]
    keys = hole_kit.state(obj)["keys"]
    assert bpy.ops.ridgeform.fill_holes() == {"FINISHED"}
    assert not mesh.validate()
    after, active_now = readings(obj)
    assert active_now == active
    for name, old in before.items():
        assert after[name][: len(old)] == old, name
    assert [face.loop_start for face in mesh.polygons][: len(starts)] == starts
    assert [tuple(edge.vertices) for edge in mesh.edges][: len(edges)] == edges
    now = [[(g.group, g.weight) for g in vertex.groups] for vertex in mesh.vertices]
    assert now[: len(weights)] == weights
    for name, old in keys.items():
        assert hole_kit.state(obj)["keys"][name][: len(old)] == old
    if extra == "text":
        assert mesh.attributes["text"].data[7].value == b"seven"
