"""Fillets and bevels of a modeled object: the operator keeps them apart or joins them, as the wheel does."""

import addon_kit as kit
import bmesh
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender.stored_numbers import read_ints
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from bl_ext.user_default.ridgeform.segments import layers
from bl_ext.user_default.ridgeform.segments.settings import SegmentSettings, segment_options

SIDES, FACES = 6, 26


def beveled_cube(segments):
    """A cube with all edges beveled, as Blender does it."""
    mesh = bpy.data.meshes.new("Beveled")
    work = bmesh.new()
    bmesh.ops.create_cube(work, size=2.0)
    bmesh.ops.bevel(
        work,
        geom=list(work.edges),
        offset=0.2,
        offset_type="OFFSET",
        segments=segments,
        profile=0.5,
        affect="EDGES",
        clamp_overlap=True,
    )
    work.to_mesh(mesh)
    work.free()
    return kit.link(bpy.data.objects.new("Beveled", mesh))


def labels_of(obj):
    return read_ints(obj.data, layers.SEGMENT, "FACE", -7)


def labels_of_wheel(obj, option):
    """The same of the wheel, for faces of which all triangles have one segment."""
    obj.data.calc_loop_triangles()
    triangles = np.array([triangle.vertices[:] for triangle in obj.data.loop_triangles])
    faces = np.array([triangle.polygon_index for triangle in obj.data.loop_triangles])
    vertices = np.array([vertex.co[:] for vertex in obj.data.vertices])
    found = ridgeform.segment(ridgeform.Mesh(vertices, triangles), fillets=option)
    labels = np.full(len(obj.data.polygons), -1)
    labels[faces] = found.labels
    return labels


@pytest.mark.parametrize("segments", [1, 4])
@pytest.mark.parametrize(("option", "count"), [("apart", FACES), ("joined", SIDES)])
def test_a_beveled_cube_has_26_faces_apart_and_6_sides_joined(segments, option, count):
    obj = beveled_cube(segments)
    assert bpy.ops.ridgeform.segment(fillets=option) == {"FINISHED"}
    labels = labels_of(obj)
    assert labels.max() + 1 == count
    assert len(obj.material_slots) == count
    assert np.array_equal(labels, labels_of_wheel(obj, option))
    normals = np.array([face.normal[:] for face in obj.data.polygons])
    sides = labels[np.abs(normals).max(axis=1) > 1.0 - 1e-6]
    assert len(np.unique(sides)) == SIDES
    (entry,) = job.last_summary()
    assert entry["possible"] == [1, FACES]


def test_the_number_of_segments_goes_through_both():
    obj = beveled_cube(4)
    assert bpy.ops.ridgeform.segment(fillets="joined") == {"FINISHED"}
    joined = labels_of(obj)
    assert bpy.ops.ridgeform.segment(fillets="apart", mode="COUNT", count=SIDES) == {"FINISHED"}
    assert np.array_equal(labels_of(obj), joined)


def test_fillets_are_of_shapes_only():
    settings = defaults_of(SegmentSettings)
    settings.fillets = "joined"
    assert segment_options(settings)["fillets"] == "joined"
    for name, value in (("source", "ATTRIBUTE"), ("method", "paper"), ("use_fidelity", True)):
        other = defaults_of(SegmentSettings)
        other.fillets = "joined"
        setattr(other, name, value)
        assert segment_options(other)["fillets"] == "automatic"
