"""What panels say of the last check: the same mesh, a changed one, and which report it was."""

from types import SimpleNamespace

import addon_kit as kit
import bmesh
import bpy
import layout_kit
import numpy as np
from bl_ext.user_default.ridgeform.check import known, panel
from test_check import FAULTS, cube


def changed(obj):
    """Whether the panel would say that a mesh has changed, once Blender has drawn."""
    bpy.context.view_layer.update()
    checked = known.of(obj)
    checked.settle()
    return checked.has_changed


def test_a_mesh_that_nothing_happens_to_is_the_same():
    obj, other = cube(), kit.bumpy_box("Other")
    assert known.of(obj) is None
    known.check(obj)
    assert not changed(obj)
    other.data.vertices[0].co.x += 1.0
    other.data.update()
    obj.location.x = 3.0
    assert not changed(obj)
    bpy.context.view_layer.objects.active = obj
    other.select_set(False)
    bpy.ops.object.mode_set(mode="EDIT")
    assert not changed(obj)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert not changed(obj)


def test_what_happens_to_a_mesh_is_seen():
    def move(obj):
        obj.data.vertices[0].co.x += 1e-6
        obj.data.update()

    def stretch(obj):
        obj.scale.x = 2.0

    def modify(obj):
        obj.modifiers.new("Round", "SUBSURF")

    def exchange(obj):
        obj.data = obj.data.copy()

    def edit(obj):
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.context.view_layer.update()
        edited = bmesh.from_edit_mesh(obj.data)
        edited.verts.new((5, 5, 5))
        bmesh.update_edit_mesh(obj.data)
        bpy.context.view_layer.update()
        bpy.ops.object.mode_set(mode="OBJECT")

    for change in (move, stretch, modify, exchange, edit):
        kit.empty_scene()
        obj = cube()
        known.check(obj)
        assert not changed(obj)
        change(obj)
        assert changed(obj), change.__name__
        known.check(obj)
        assert not changed(obj), change.__name__


def test_another_file_has_nothing_known():
    obj = cube()
    known.check(obj)
    kit.empty_scene()
    assert known.of(cube()) is None


def test_the_line_says_the_gravest():
    obj = cube()
    assert panel.line_of(known.check(obj))[0] == "Ready"
    for kind, icon in (("not_finite", "ERROR"), ("nonmanifold_edges", "INFO"), ("seams", "CHECKMARK")):
        vertices, faces, _ = FAULTS[kind]
        text, found = panel.line_of(known.check(kit.add_object("Mesh", vertices, faces)))
        assert found == icon
        assert text


def test_small_meshes_only_are_checked_unasked():
    assert known.is_cheap(cube())
    side = np.arange(200)
    vertices = [[x, y, 0] for y in side for x in side]
    faces = [
        [200 * y + x, 200 * y + x + 1, 200 * y + x + 201, 200 * y + x + 200]
        for y in side[:-1]
        for x in side[:-1]
    ]
    assert not known.is_cheap(kit.add_object("Large", vertices, faces))


def drawn(draw, *arguments):
    """What a function draws."""
    layout = layout_kit.Layout()
    draw(layout, *arguments)
    return layout


def test_the_panel_lists_what_was_found_with_its_buttons():
    vertices, faces, _ = FAULTS["flipped_faces"]
    obj = kit.add_object("Mesh", vertices, faces)
    check_button = ("ridgeform.check", "")
    assert drawn(panel.draw_line, obj).buttons == [check_button]
    known.check(obj)
    line = drawn(panel.draw_line, obj)
    assert line.labels == ["Ready: 1 face turned against its neighbors"]
    shown = drawn(lambda layout: panel.RIDGEFORM_PT_check.draw(SimpleNamespace(layout=layout), bpy.context))
    assert shown.buttons == [
        check_button,
        ("ridgeform.select_faults", "Select"),
        ("ridgeform.cure_faults", "Turn"),
    ]
    assert "Computed as if turned back" in shown.labels
    obj.data.vertices[0].co.x += 1.0
    obj.data.update()
    assert changed(obj)
    assert drawn(panel.draw_line, obj).labels == ["Changed since the check"]
    assert drawn(panel.draw_line, None).buttons == []
