"""Facets: what lies on a mesh, and the rest of a masked one."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.blender import mesh_io, selected_elements
from facet_kit import facet, is_closed, layered_box, read_all


def test_all_that_lies_on_a_mesh_is_carried_over():
    obj = layered_box()
    facet(mode="COUNT", facets=6)
    mesh, places = obj.data, kit.coordinates(obj)
    assert len(mesh.polygons) == 6
    assert [slot.name for slot in mesh.materials] == ["A", "B"]
    for face in mesh.polygons:
        assert face.material_index == int(face.center.z > 0.9)
        assert mesh.attributes["side"].data[face.index].value == np.argmax(np.abs(face.normal))
    for corner, color, uv in zip(
        mesh.loops, mesh.color_attributes["Paint"].data, mesh.uv_layers[0].data, strict=True
    ):
        wanted = 0.5 * places[corner.vertex_index] + 0.5
        np.testing.assert_allclose(np.array(color.color)[:3], wanted, atol=0.05)
        assert min(uv.uv) >= 0.0 and max(uv.uv) <= 1.0
    heights = [value.value for value in mesh.attributes["height"].data]
    np.testing.assert_allclose(heights, places[:, 2], atol=0.1)
    weights = mesh_io.group_weights(obj, "Up")
    np.testing.assert_allclose(weights, 0.5 + 0.5 * places[:, 2], atol=0.06)


@pytest.mark.parametrize("exponent", [-40, 40])
def test_the_same_is_carried_over_at_any_size(exponent):
    # Blender's own search finds nothing on triangles of size 1e12.
    found = []
    for e in (0, exponent):
        kit.empty_scene()
        obj = layered_box()
        kit.set_coordinates(obj, np.ldexp(kit.coordinates(obj), e))
        for edge in list(obj.data.edges)[::3]:
            edge.use_seam = True
        facet(mode="COUNT", facets=20)
        places = np.ldexp(kit.coordinates(obj), -e)
        seams = [edge.use_seam for edge in obj.data.edges]
        weights = mesh_io.group_weights(obj, "Up")
        found.append((places.tolist(), seams, weights.tolist(), read_all(obj.data)))
        found[-1][-1].pop("position")
    assert any(found[0][1])
    assert found[0] == found[1]


def test_uvs_of_a_face_are_of_one_island():
    # Blender's cube has its six sides beside each other in a cross: a corner on another island is far off.
    obj = layered_box()
    facet(mode="COUNT", facets=6)
    for face in obj.data.polygons:
        uvs = np.array([obj.data.uv_layers[0].data[corner].uv for corner in face.loop_indices])
        np.testing.assert_allclose(np.ptp(uvs, axis=0), 0.25, atol=0.03)


def kept_things(obj, inside):
    """What lies on the faces whose corners are all where `inside` says, named by places."""
    mesh, places = obj.data, [tuple(vertex.co) for vertex in obj.data.vertices]
    uv, paint = mesh.uv_layers[0].data, mesh.color_attributes["Paint"].data
    things = set()
    for face in mesh.polygons:
        if all(inside(np.array(places[vertex])) for vertex in face.vertices):
            corners = tuple(
                (places[mesh.loops[c].vertex_index], tuple(uv[c].uv), tuple(paint[c].color))
                for c in face.loop_indices
            )
            side = mesh.attributes["side"].data[face.index].value
            things.add((face.material_index, face.use_smooth, side, corners))
    for edge in mesh.edges:
        ends = sorted(places[vertex] for vertex in edge.vertices)
        if all(inside(np.array(end)) for end in ends):
            things.add((edge.use_seam, edge.use_edge_sharp, *ends))
    for vertex, weight in zip(mesh.vertices, mesh_io.group_weights(obj, "Up"), strict=True):
        if inside(np.array(vertex.co)):
            things.add((tuple(vertex.co), float(weight)))
    return things


def low(place):
    return place[2] < 0.2


@pytest.mark.parametrize("how", ["mask", "selection"])
def test_the_rest_stays_in_every_bit(how):
    obj = layered_box()
    mesh = obj.data
    mesh.edges[3].use_seam = True
    before, settings = kept_things(obj, low), {}
    if how == "mask":
        group = obj.vertex_groups.new(name="Free")
        free = [vertex.index for vertex in mesh.vertices if not low(vertex.co)]
        group.add(free, 1.0, "REPLACE")
        settings["strength_group"] = "Free"
    else:
        for face in mesh.polygons:
            face.select = not any(low(mesh.vertices[vertex].co) for vertex in face.vertices)
        for vertex in mesh.vertices:
            vertex.select = not low(vertex.co)
        chosen = [all(mesh.vertices[vertex].select for vertex in edge.vertices) for edge in mesh.edges]
        selected_elements.write(mesh, mesh.edges, np.array(chosen))
        bpy.ops.object.mode_set(mode="EDIT")
    n = len(mesh.polygons)
    facet(mode="COUNT", facets=12, **settings)
    if how == "selection":
        assert bpy.context.mode == "EDIT_MESH"
        bpy.ops.object.mode_set(mode="OBJECT")
    assert before <= kept_things(obj, low)
    assert is_closed(mesh) and len(mesh.polygons) < n
    selected = [face.select for face in mesh.polygons]
    assert how == "mask" or (any(selected) and not all(selected))


def test_loose_parts_stay():
    obj = kit.bumpy_box(noise=0.0)
    mesh = obj.data
    n = len(mesh.vertices)
    mesh.vertices.add(2)
    mesh.edges.add(1)
    mesh.vertices[n].co, mesh.vertices[n + 1].co = (3, 0, 0), (4, 0, 0)
    mesh.edges[-1].vertices = (n, n + 1)
    facet()
    assert len(mesh.vertices) == 10 and len(mesh.edges) == 13 and len(mesh.polygons) == 6


def test_no_texture_wraps_around_at_a_seam():
    # One island, whose two ends meet at a seam.
    bpy.ops.mesh.primitive_torus_add()
    obj = bpy.context.object
    before = kit.coordinates(obj)
    facet(mode="COUNT", facets=60)
    along = np.array([uv.uv[0] for uv in obj.data.uv_layers[0].data])
    places = kit.coordinates(obj)
    for face in obj.data.polygons:
        corners = list(face.loop_indices)
        around = np.unwrap(np.arctan2(*places[list(face.vertices)][:, 1::-1].T))
        assert np.ptp(along[corners]) < np.ptp(around) / (2 * np.pi) + 0.1
    assert len(before) > len(places)
