"""Coarse and regular round meshes, on which the flow forms hardly any facets: what each Finish makes."""

import addon_kit as kit
import bpy
import mirror_kit
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


def facets_by_ridges(mesh):
    """How many parts sharp edges enclose, and how far the farthest corner is from the plane of its part."""
    sharp = np.array([edge.use_edge_sharp for edge in mesh.edges])
    faces_at = [[] for _ in mesh.edges]
    for face in mesh.polygons:
        for loop in face.loop_indices:
            faces_at[mesh.loops[loop].edge_index].append(face.index)
    part = np.arange(len(mesh.polygons))
    for faces, is_sharp in zip(faces_at, sharp, strict=True):
        if len(faces) == 2 and not is_sharp:
            one, other = part[faces]
            part[part == other] = one
    worst = 0.0
    for label in np.unique(part):
        vertices = {v for face in np.flatnonzero(part == label) for v in mesh.polygons[face].vertices}
        places = np.array([mesh.vertices[v].co for v in vertices], np.float64)
        places -= places.mean(axis=0)
        worst = max(worst, np.abs(places @ np.linalg.svd(places)[2][2]).max())
    return len(np.unique(part)), worst


@pytest.mark.parametrize("name", [*ROUND, "cylinder", "head", "letters"])
def test_with_its_own_faces_a_mesh_lies_on_facets_of_the_shape(name):
    if name == "cylinder":
        bpy.ops.mesh.primitive_cylinder_add()
    elif name == "head":
        bpy.ops.mesh.primitive_monkey_add()
    elif name == "letters":
        bpy.ops.object.text_add()
        bpy.context.object.data.body, bpy.context.object.data.extrude = "Rg&", 0.1
        bpy.ops.object.convert(target="MESH")
    else:
        made(name)
    mesh = bpy.context.object.data
    before, faces = kit.coordinates(bpy.context.object), [tuple(face.vertices) for face in mesh.polygons]
    assert bpy.ops.ridgeform.stylize() == {"FINISHED"}
    (entry,) = job.last_summary()
    assert "facets were made of the shape as it was" in said() and "hardly" not in said()
    assert [tuple(face.vertices) for face in mesh.polygons] == faces
    assert 0.0 < entry["moved"] < 0.1 and entry["facets"] < len(faces)
    count, off = facets_by_ridges(mesh)
    size = np.ptp(before, axis=0)
    # Two quads of the head lie across a ridge.
    assert off < (0.03 if name == "head" else 1e-5) * size.max()
    # A facet may be in two pieces, as where letters are on both sides of a hole.
    assert count == pytest.approx(entry["facets"], rel=0.15)
    assert np.allclose(np.ptp(kit.coordinates(bpy.context.object), axis=0), size, atol=0.1 * size.max())


def test_that_is_done_in_edit_mode_where_it_is_selected():
    obj = made("uv sphere")
    before = kit.coordinates(obj)
    top = before[:, 2] > 0.1
    kit.select_only(obj, top)
    bpy.ops.ridgeform.stylize()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert "as it was" in said()
    after = kit.coordinates(obj)
    assert (after[~top] == before[~top]).all() and (after[top] != before[top]).any()


def test_what_became_flat_is_measured_where_the_mesh_may_move():
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=6)
    obj = bpy.context.object
    group = obj.vertex_groups.new(name="Cap")
    group.add(np.flatnonzero(kit.coordinates(obj)[:, 2] > 0.7).tolist(), 1.0, "REPLACE")
    bpy.ops.ridgeform.stylize(strength_group="Cap")
    assert "as it was" not in said()


def test_half_a_ball_under_a_mirror_stays_closed():
    obj = made("torus")
    half = mirror_kit.cut(obj, "X")
    mirror_kit.mirror(obj, "X")
    bpy.ops.ridgeform.stylize()
    assert "as it was" in said()
    after = kit.coordinates(obj)
    on = half[:, 0] == 0.0
    assert on.sum() > 20 and (after[on, 0] == 0.0).all() and (after[~on, 0] > 0.0).all()


@pytest.mark.parametrize("output", ["SHAPE_KEY", "ATTRIBUTE"])
def test_the_mesh_may_stay_as_it_is(output):
    obj = made("icosphere")
    before = kit.coordinates(obj)
    bpy.ops.ridgeform.stylize(output=output)
    assert "facets were made of the shape as it was" in said()
    assert kit.same_bits(kit.coordinates(obj), before)
    if output == "SHAPE_KEY":
        key = obj.data.shape_keys.key_blocks["Stylized"]
        there = np.array([point.co for point in key.data])
        assert np.abs(there - before).max() > 0.01


def test_low_poly_reduces_the_shape_as_it_was():
    obj = made("uv sphere")
    before = {tuple(place) for place in kit.coordinates(obj).round(4)}
    bpy.ops.ridgeform.stylize(finish="LOW_POLY", reduce_ratio=0.3)
    assert "the shape was reduced as it was" in said()
    reach = np.linalg.norm(kit.coordinates(obj), axis=1)
    assert len(before) > 2 * len(reach) and reach.min() > 0.95


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
