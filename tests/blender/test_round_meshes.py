"""Coarse and regular round meshes, on which the flow forms hardly any facets: what each Finish makes."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.framework import job
from facet_kit import is_closed, off_planes

ROUND = {
    "uv sphere": (bpy.ops.mesh.primitive_uv_sphere_add, {}, 2),
    "fine uv sphere": (bpy.ops.mesh.primitive_uv_sphere_add, {"segments": 48, "ring_count": 24}, 2),
    "icosphere": (bpy.ops.mesh.primitive_ico_sphere_add, {"subdivisions": 4}, 2),
    "torus": (bpy.ops.mesh.primitive_torus_add, {}, 0),
    "fine torus": (bpy.ops.mesh.primitive_torus_add, {"major_segments": 64, "minor_segments": 24}, 0),
}


def made(name):
    add, given, _ = ROUND[name]
    add(**given)
    bpy.ops.object.shade_smooth()
    return bpy.context.object


def said():
    return "; ".join(job.last_summary()[0]["warnings"])


@pytest.mark.parametrize("name", ROUND)
def test_facets_are_near_the_shape(name):
    obj = made(name)
    before, area = kit.coordinates(obj), sum(face.area for face in obj.data.polygons)
    assert bpy.ops.ridgeform.stylize(finish="FACETS") == {"FINISHED"}
    mesh, (entry,) = obj.data, job.last_summary()
    assert 50 < entry["facets"] < 260
    assert is_closed(mesh) and off_planes(mesh) < 1e-5
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == ROUND[name][2]
    assert 0.0 < entry["moved"] < 0.1
    # No facet may reach across the hole of a torus.
    assert sum(face.area for face in mesh.polygons) == pytest.approx(area, rel=0.1)
    size = np.ptp(before, axis=0)
    assert np.allclose(np.ptp(kit.coordinates(obj), axis=0), size, atol=0.1 * size.max())


@pytest.mark.parametrize("name", ["uv sphere", "fine uv sphere", "icosphere", "torus"])
def test_where_the_flow_rounds_off_facets_are_those_of_the_shape(name):
    obj = made(name)
    reach = np.linalg.norm(kit.coordinates(obj), axis=1).max()
    bpy.ops.ridgeform.stylize(finish="FACETS")
    assert "facets were made of the shape as it was" in said()
    assert np.linalg.norm(kit.coordinates(obj), axis=1).max() == pytest.approx(reach, rel=0.05)


def test_strength_says_how_many():
    counts = []
    for strength in (0.2, 0.5, 0.8):
        kit.empty_scene()
        made("uv sphere")
        bpy.ops.ridgeform.stylize(finish="FACETS", strength=strength)
        counts.append(job.last_summary()[0]["facets"])
    assert counts[0] > 1.5 * counts[1] > 2.0 * counts[2]


def test_a_number_of_facets_is_kept_to():
    made("uv sphere")
    bpy.ops.ridgeform.stylize(finish="FACETS", use_facets=True, facets=60)
    assert job.last_summary()[0]["facets"] == 60


@pytest.mark.parametrize("name", ROUND)
def test_without_them_what_helps_is_said(name):
    made(name)
    bpy.ops.ridgeform.stylize()
    assert "choose the finish Facets" in said()


def test_few_steps_are_no_reason_to_say_so():
    made("uv sphere")
    bpy.ops.ridgeform.stylize(steps=1, finish="FACETS")
    assert "raise Steps" in said() and "as it was" not in said()


def test_low_poly_counts_what_it_makes():
    obj = made("icosphere")
    bpy.ops.ridgeform.stylize(finish="LOW_POLY", reduce_ratio=0.05)
    assert "hardly" not in said()
    assert 0.8 * len(obj.data.polygons) < job.last_summary()[0]["facets"] <= len(obj.data.polygons)


def test_a_dense_ball_is_not_flat_before_it_begins():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6)
    bpy.ops.ridgeform.stylize()
    (entry,) = job.last_summary()
    assert entry["steps"] > 5 and 12 <= entry["facets"] <= 200 and entry["moved"] > 0.002
