"""One press cures a fault, and what lies on the mesh stays."""

import addon_kit as kit
import bmesh
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform import check
from bl_ext.user_default.ridgeform.check.kinds import KIND, KINDS
from bl_ext.user_default.ridgeform.framework import files
from test_check import CUBE, FAULTS, FIXTURES, SIDES, cube, names

CURABLE = [kind.name for kind in KINDS if kind.cure and kind.name in FAULTS]


def dress(obj: bpy.types.Object) -> None:
    """Put a UV map, colors, a vertex group, materials, two shape keys, and numbers on a mesh."""
    mesh = obj.data
    mesh.uv_layers.new(name="First")
    mesh.uv_layers.new(name="Map")
    mesh.uv_layers.active_index = 0
    mesh.uv_layers["Map"].data.foreach_set("uv", np.arange(2 * len(mesh.loops)) / 7)
    colors = mesh.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    colors.data.foreach_set("color", np.arange(4 * len(mesh.vertices)) / 3)
    numbers = mesh.attributes.new("number", "INT", "FACE")
    numbers.data.foreach_set("value", np.arange(len(mesh.polygons)))
    group = obj.vertex_groups.new(name="Group")
    for vertex in range(len(mesh.vertices)):
        group.add([vertex], vertex / 100, "REPLACE")
    for name in ("One", "Two"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", np.arange(len(mesh.polygons)) % 2)
    kit.add_key(obj, "Basis", np.zeros((len(mesh.vertices), 3)))
    kit.add_key(obj, "Up", np.array([0, 0, 1.0]))


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("kind", CURABLE)
def test_a_cure_leaves_nothing_of_the_fault(kind, mode):
    vertices, faces, _ = FAULTS[kind]
    obj = kit.add_object("Mesh", vertices, faces)
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.ridgeform.cure_faults(kind=kind) == {"FINISHED"}
    assert obj.mode == mode
    bpy.ops.object.mode_set(mode="OBJECT")
    # Nothing else has come in its place either.
    assert names(check.examine(obj)) == set()
    assert not obj.data.validate(verbose=True)
    assert bpy.ops.ridgeform.cure_faults(kind=kind) == {"CANCELLED"}


@pytest.mark.parametrize("kind", CURABLE)
def test_what_lies_on_a_mesh_stays(kind):
    vertices, faces, _ = FAULTS[kind]
    obj = kit.add_object("Mesh", vertices, faces)
    dress(obj)
    before = corner_values(obj)
    assert bpy.ops.ridgeform.cure_faults(kind=kind) == {"FINISHED"}
    mesh = obj.data
    assert mesh.uv_layers.active.name == "First"
    assert [slot.name for slot in obj.material_slots] == ["One", "Two"]
    assert [key.name for key in mesh.shape_keys.key_blocks] == ["Basis", "Up"]
    assert np.allclose(kit.key_coordinates(obj, "Up") - kit.key_coordinates(obj, "Basis"), [0, 0, 1])
    assert np.allclose(kit.key_coordinates(obj, "Basis"), kit.coordinates(obj))
    after = corner_values(obj)
    gone = {"duplicate_faces": {6}}.get(kind, set())
    assert set(after) == set(before) - gone
    for face, rows in after.items():
        # A corner is told by its UVs, and has all that it had; joining only adds corners, and welding takes
        # the vertex of another.
        for uv, (material, color, weight, place) in rows.items():
            if kind == "t_junctions" and uv not in before[face]:
                continue
            old = before[face][uv]
            assert material == old[0]
            if kind != "seams":
                assert np.allclose(color, old[1])
                assert weight == pytest.approx(old[2])
            assert np.allclose(place, old[3])


def corner_values(obj: bpy.types.Object) -> dict[int, dict[tuple, tuple]]:
    """By number of face and UV of corner: material, color, weight, and place."""
    mesh, values = obj.data, {}
    for face in mesh.polygons:
        rows = values.setdefault(mesh.attributes["number"].data[face.index].value, {})
        for corner in face.loop_indices:
            vertex = mesh.loops[corner].vertex_index
            uv = tuple(np.round(mesh.uv_layers["Map"].data[corner].uv, 5))
            color = tuple(mesh.color_attributes["Paint"].data[vertex].color)
            weight = mesh.vertices[vertex].groups[0].weight
            rows[uv] = face.material_index, color, weight, tuple(mesh.vertices[vertex].co)
    return values


def test_loose_edges_go_with_their_own_vertices_alone():
    obj = cube()
    obj.data.vertices.add(2)
    obj.data.edges.add(3)
    for edge, ends in zip((12, 13, 14), ((8, 9), (0, 9), (0, 7)), strict=True):
        obj.data.edges[edge].vertices = ends
    assert bpy.ops.ridgeform.cure_faults(kind="loose_edges") == {"FINISHED"}
    assert (len(obj.data.vertices), len(obj.data.edges), len(obj.data.polygons)) == (8, 12, 6)


def test_applying_the_scale():
    obj = cube()
    obj.scale = (1.0, 2.0, 1.0)
    bpy.context.view_layer.update()
    assert bpy.ops.ridgeform.cure_faults(kind="uneven_scale") == {"FINISHED"}
    assert tuple(obj.scale) == (1, 1, 1)
    assert kit.coordinates(obj).max(axis=0).tolist() == [1, 2, 1]
    twin = kit.link(bpy.data.objects.new("Twin", obj.data))
    twin.scale = (1.0, 2.0, 1.0)
    bpy.context.view_layer.update()
    assert bpy.ops.ridgeform.cure_faults(kind="uneven_scale") == {"CANCELLED"}
    assert tuple(twin.scale) == (1, 2, 1)


def test_flipped_faces_keep_custom_normals():
    for kind in ("flipped_faces", "seams"):
        vertices, faces, _ = FAULTS[kind]
        obj = kit.add_object("Mesh", vertices, faces)
        wanted = np.tile([0.6, 0.0, 0.8], (len(obj.data.loops), 1))
        if kind == "flipped_faces":
            wanted[-4:] *= -1.0
        obj.data.normals_split_custom_set(wanted.tolist())
        assert bpy.ops.ridgeform.cure_faults(kind=kind) == {"FINISHED"}
        normals = np.empty(3 * len(obj.data.loops), np.float32)
        obj.data.corner_normals.foreach_get("vector", normals)
        assert np.allclose(normals.reshape(-1, 3), [0.6, 0.0, 0.8], atol=1e-3)
        assert not [layer.name for layer in obj.data.attributes if "ridgeform" in layer.name]


def test_parting_keeps_together_what_goes_on():
    """A fin on a plane comes off in one piece, and the plane has no cut."""
    obj = kit.add_object("Plane", *grid(4, 2))
    with kit.edited(obj) as mesh:
        line = [mesh.verts[5 + k] for k in (1, 2, 3)]
        top = [mesh.verts.new(vert.co + line[0].co.__class__((0, 0, 1))) for vert in line]
        for k in (0, 1):
            mesh.faces.new((line[k], line[k + 1], top[k + 1], top[k]))
    assert check.examine(obj)["nonmanifold_edges"].count == 2
    assert bpy.ops.ridgeform.cure_faults(kind="nonmanifold_edges") == {"FINISHED"}
    assert names(check.examine(obj)) == set()
    assert len(obj.data.vertices) == 15 + 6
    uses = np.bincount([loop.edge_index for loop in obj.data.loops])
    assert (uses == 1).sum() == 12 + 6


def test_two_boxes_at_an_edge_come_apart_as_boxes():
    both = np.concatenate([CUBE, CUBE + np.array([1, 1, 0])])
    faces = [*SIDES, *[[8 + vertex for vertex in side] for side in SIDES]]
    shared = {8: 6, 9: 7}
    faces = [[shared.get(vertex, vertex) for vertex in face] for face in faces]
    obj = kit.add_object("Boxes", both, faces)
    bpy.ops.ridgeform.cure_faults(kind="loose_vertices")
    assert names(check.examine(obj)) == {"nonmanifold_edges"}
    assert bpy.ops.ridgeform.cure_faults(kind="nonmanifold_edges") == {"FINISHED"}
    assert names(check.examine(obj)) == set()
    assert len(obj.data.vertices) == 16
    assert np.bincount([loop.edge_index for loop in obj.data.loops]).tolist() == [2] * 24


def grid(width: int, height: int) -> tuple[list, list]:
    """Vertices and faces of a plane of squares."""
    vertices = [[x, y, 0.0] for y in range(height + 1) for x in range(width + 1)]
    across = width + 1
    return vertices, [
        [y * across + x, y * across + x + 1, (y + 1) * across + x + 1, (y + 1) * across + x]
        for y in range(height)
        for x in range(width)
    ]


def soup(obj: bpy.types.Object) -> bpy.types.Object:
    """A copy of a mesh with every face on vertices of its own, as an STL file has it."""
    mesh = obj.data
    places = np.array([mesh.vertices[loop.vertex_index].co for loop in mesh.loops])
    faces = [list(face.loop_indices) for face in mesh.polygons]
    return kit.add_object("Soup", places, faces)


def test_a_soup_becomes_the_mesh_that_it_was():
    whole = kit.bumpy_box()
    obj = soup(whole)
    flipped = [3, 50, 51]
    with kit.edited(obj) as mesh:
        bmesh.ops.reverse_faces(mesh, faces=[mesh.faces[face] for face in flipped])
    report = check.examine(obj)
    assert names(report) == {"seams", "flipped_faces"}
    assert report["flipped_faces"].elements.tolist() == flipped
    assert bpy.ops.ridgeform.cure_faults(kind="flipped_faces") == {"FINISHED"}
    assert bpy.ops.ridgeform.cure_faults(kind="seams") == {"FINISHED"}
    assert names(check.examine(obj)) == set()
    assert len(obj.data.vertices) == len(whole.data.vertices)
    assert len(obj.data.edges) == len(whole.data.edges)


def test_a_scan_with_all_kinds_of_faults_becomes_what_it_was():
    (obj,) = files.read_file(FIXTURES / "bust.blend")
    before = kit.coordinates(obj), [tuple(face.vertices) for face in obj.data.polygons]
    rng = np.random.default_rng(2)
    with kit.edited(obj) as mesh:
        chosen = [mesh.faces[face] for face in rng.choice(len(mesh.faces), 40, replace=False).tolist()]
        doubled = [face.copy(verts=False, edges=False) for face in chosen[20:]]
        bmesh.ops.reverse_faces(mesh, faces=chosen[:20])
        for _ in range(3):
            mesh.verts.new(rng.random(3).tolist())
        mesh.edges.new([mesh.verts.new(rng.random(3).tolist()) for _ in range(2)])
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    counts = {found.kind.name: found.count for found in check.examine(obj).findings}
    assert counts["duplicate_faces"] == len(doubled)
    assert counts["loose_vertices"] == 3
    assert counts["loose_edges"] == 1
    for kind in ("duplicate_faces", "flipped_faces", "loose_edges", "loose_vertices"):
        assert bpy.ops.ridgeform.cure_faults(kind=kind) == {"FINISHED"}
    assert names(check.examine(obj)) == set()
    assert kit.same_bits(kit.coordinates(obj), before[0])
    after = [tuple(face.vertices) for face in obj.data.polygons]
    assert len(after) == len(before[1])
    # The same faces with the same outside, wherever they begin.
    assert {_rolled(face) for face in after} == {_rolled(face) for face in before[1]}


def _rolled(face: tuple[int, ...]) -> tuple[int, ...]:
    start = face.index(min(face))
    return face[start:] + face[:start]


def test_several_meshes_are_cured_at_once():
    vertices, faces, _ = FAULTS["flipped_faces"]
    objects = [kit.add_object(name, vertices, faces) for name in ("A", "B")]
    clean = cube()
    for obj in objects:
        obj.select_set(True)
    assert bpy.ops.ridgeform.cure_faults(kind="flipped_faces") == {"FINISHED"}
    assert all(names(check.examine(obj)) == set() for obj in (*objects, clean))


def test_every_cure_has_words():
    for name in KIND:
        kind = KIND[name]
        assert bool(kind.cure) == bool(kind.cure_text), name
