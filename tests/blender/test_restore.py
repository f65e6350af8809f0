"""Restore: the operator gives what the wheel gives, holds what it is told to, and says what is not sure."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.framework import job


def restore(**settings):
    """Press the button with these settings."""
    assert bpy.ops.ridgeform.restore(**settings) == {"FINISHED"}
    return job.last_summary()[0]


def values_of(mesh, name):
    """A face attribute of whole numbers."""
    values = np.empty(len(mesh.polygons), np.int32)
    mesh.attributes[name].data.foreach_get("value", values)
    return values


def test_the_operator_gives_what_the_wheel_gives():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    entry = restore()
    expected = ridgeform.restore(ridgeform.Mesh(before, mesh_io.triangles(obj.data)))
    np.testing.assert_allclose(kit.coordinates(obj), expected.vertices, atol=1e-6)
    assert entry["status"] == expected.status == "restored"
    assert [surface["kind"] for surface in entry["surfaces"]] == ["plane"] * 6
    labels = values_of(obj.data, "ridgeform_surface")
    assert sorted(set(labels.tolist())) == list(range(6))
    assert (values_of(obj.data, "ridgeform_surface_kind") == 1).all()


def sharp_edges(obj):
    """Which edges are marked sharp."""
    marked = np.zeros(len(obj.data.edges), bool)
    obj.data.edges.foreach_get("use_edge_sharp", marked)
    return marked


def test_creases_between_surfaces_are_seen_on_a_smooth_shaded_mesh():
    """The edges between two sides of the box are marked, and no other."""
    obj = kit.bumpy_box()
    obj.data.shade_smooth()
    ends = kit.coordinates(obj)[mesh_io.edges(obj.data)]
    on_sides = ((ends > 0.85).all(axis=1) | (ends < -0.85).all(axis=1)).sum(axis=1)
    restore(marks=set())
    assert not sharp_edges(obj).any()
    restore()
    np.testing.assert_array_equal(sharp_edges(obj), on_sides == 2)
    assert sharp_edges(obj).sum() == 60


def test_undo_takes_everything_back():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    bpy.ops.ed.undo_push(message="before")
    restore(outputs={"ATTRIBUTES", "EMPTIES"})
    bpy.ops.ed.undo_push(message="after")
    assert len(bpy.data.objects) == 7
    bpy.ops.ed.undo()
    obj = bpy.context.object
    np.testing.assert_array_equal(kit.coordinates(obj), before)
    assert len(bpy.data.objects) == 1


def test_a_mask_holds_the_rest_bit_by_bit():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    held = before[:, 0] > 0.2
    group = obj.vertex_groups.new(name="Here")
    group.add(np.flatnonzero(~held).tolist(), 1.0, "REPLACE")
    restore(strength_group="Here")
    after = kit.coordinates(obj)
    assert kit.same_bits(after[held], before[held])
    assert (after[~held] != before[~held]).any(axis=1).mean() > 0.9


def test_in_edit_mode_only_the_selection_moves():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    chosen = before[:, 2] > 0.2
    kit.select_only(obj, chosen)
    restore()
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    after = kit.coordinates(obj)
    assert kit.same_bits(after[~chosen], before[~chosen])
    assert (after[chosen] != before[chosen]).any(axis=1).mean() > 0.9


def test_empties_stand_on_the_surfaces_and_are_replaced():
    obj = kit.bumpy_box()
    obj.location = (3.0, 0.0, 0.0)
    entry = restore(outputs={"EMPTIES"}, use_regularize=True)
    restore(outputs={"EMPTIES"}, use_regularize=True)
    made = [child for child in obj.children if child.type == "EMPTY"]
    assert len(made) == 6
    normals = {tuple(np.round(surface["normal"], 3)) for surface in entry["surfaces"]}
    for child in made:
        axis = np.array(child.matrix_local.to_3x3().col[2])
        assert any(np.allclose(axis, normal, atol=2e-2) for normal in normals)
        assert child["kind"] == "plane"


def test_a_shape_key_is_written_where_it_is_active():
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    obj.shape_key_add(name="Basis", from_mix=False)
    key = obj.shape_key_add(name="Restored", from_mix=False)
    obj.active_shape_key_index = 1
    restore()
    np.testing.assert_array_equal(kit.coordinates(obj), before)
    written = np.empty(3 * len(before), np.float32)
    key.data.foreach_get("co", written)
    assert (written.reshape(-1, 3) != before).any()


def test_nothing_to_move_is_refused():
    obj = kit.bumpy_box()
    obj.vertex_groups.new(name="Empty")
    with pytest.raises(RuntimeError, match="may move"):
        bpy.ops.ridgeform.restore(strength_group="Empty")


def test_node_trees_read_the_surfaces():
    """Geometry nodes see the faces of one surface as the attribute says."""
    obj = kit.bumpy_box()
    restore()
    tree = bpy.data.node_groups.new("First Surface", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    kinds = ("NodeGroupInput", "NodeGroupOutput", "GeometryNodeInputNamedAttribute", "FunctionNodeCompare")
    given, made, number, is_first = (tree.nodes.new(kind) for kind in kinds)
    chosen = tree.nodes.new("GeometryNodeSeparateGeometry")
    number.data_type = is_first.data_type = "INT"
    is_first.operation, chosen.domain = "EQUAL", "FACE"
    number.inputs["Name"].default_value = "ridgeform_surface"
    numbers = [socket for socket in is_first.inputs if socket.enabled]
    tree.links.new(next(socket for socket in number.outputs if socket.enabled), numbers[0])
    tree.links.new(is_first.outputs["Result"], chosen.inputs["Selection"])
    tree.links.new(given.outputs["Geometry"], chosen.inputs["Geometry"])
    tree.links.new(chosen.outputs["Selection"], made.inputs["Geometry"])
    obj.modifiers.new("First Surface", "NODES").node_group = tree
    seen = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert len(seen.polygons) == (values_of(obj.data, "ridgeform_surface") == 0).sum()
    assert 0 < len(seen.polygons) < len(obj.data.polygons)
