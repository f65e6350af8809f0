"""What the check finds on shapes with one fault each, and on none."""

from pathlib import Path

import addon_kit as kit
import bmesh
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform import check
from bl_ext.user_default.ridgeform.check.kinds import KINDS
from bl_ext.user_default.ridgeform.framework import files

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
FAN = kit.BAD_MESHES["three faces at an edge"]
SEAM = ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [2, 0, 0], [2, 1, 0]],
        [[0, 1, 2, 3], [4, 6, 7, 5]])  # fmt: skip
T_JUNCTION = ([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [0, -1, 0], [1, -1, 0], [2, -1, 0], [1, 0, 0]],
              [[0, 1, 2, 3], [4, 5, 7, 0], [5, 6, 1, 7]])  # fmt: skip
SECOND_LID = [*SIDES, [1, 5, 3], [5, 7, 3]]
BOW_TIE = ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], [[0, 1, 2], [0, 3, 4]])

FAULTS = {
    "nonmanifold_edges": (*FAN, 1),
    "nonmanifold_vertices": (*BOW_TIE, 1),
    "seams": (*SEAM, 4),
    "t_junctions": (*T_JUNCTION, 1),
    "flipped_faces": (CUBE, [*SIDES[:5], SIDES[5][::-1]], 1),
    "duplicate_faces": (CUBE, [*SIDES, SIDES[2]], 1),
    "doubled_faces": (CUBE, SECOND_LID, 3),
    "degenerate_faces": ([*CUBE, [0, 0, 5], [0, 0, 6], [0, 0, 7]], [*SIDES, [8, 9, 10]], 1),
    "loose_vertices": ([*CUBE, [5, 5, 5], [6, 5, 5]], SIDES, 2),
    "not_finite": ([*CUBE[:7], [1, 1, np.nan]], SIDES, 1),
    "uneven_ngons": ([[0, 0, 0], [1, 0, 0], [1.5, 1, 0.5], [0.5, 2, 0], [-0.5, 1, 0]], [[0, 1, 2, 3, 4]], 1),
    "far_away": (CUBE + 1e5, SIDES, 1),
}
"""Vertices, faces, and how many there are of the fault."""
TOGETHER = {
    "duplicate_faces": {"nonmanifold_edges", "flipped_faces"},
    "doubled_faces": {"nonmanifold_edges"},
}
"""What is found with it, for there it is."""


def cube() -> bpy.types.Object:
    """A cube without a fault."""
    return kit.add_object("Cube", CUBE, SIDES)


def names(report: object) -> set[str]:
    """The kinds that a report has."""
    return {found.kind.name for found in report.findings}


def test_a_flat_polygon_is_flat_although_its_corners_are_rounded():
    """A hexagon in a plane as a result of Facet has it: two of its corners lie almost on an edge, so that the
    triangles there are slivers whose normals are rounding."""
    across, along = np.array([0.6, 0.64, 0.48]), np.array([-0.8, 0.48, 0.36])
    flat = np.array([[0, 0], [1, 1e-5], [2, 1e-5], [3, 0], [3, 2], [0, 2]])
    obj = kit.add_object("Flat", 100.0 * (flat @ np.stack([across, along]) + 0.1), [[0, 1, 2, 3, 4, 5]])
    assert check.examine(obj).findings == []


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_is_found_and_no_other(kind):
    vertices, faces, count = FAULTS[kind]
    obj = kit.add_object("Mesh", vertices, faces)
    before = kit.coordinates(obj)
    report = check.examine(obj)
    assert names(report) - TOGETHER.get(kind, set()) == {kind}
    assert report[kind].count == count
    assert kit.same_bits(kit.coordinates(obj), before)


def test_clean_shapes_have_none():
    for obj in (cube(), kit.bumpy_box(), kit.ngon_prism(sides=4)):
        assert check.examine(obj).findings == []


def test_loose_edges():
    obj = cube()
    obj.data.vertices.add(2)
    obj.data.vertices.foreach_set("co", np.concatenate([CUBE, [[5, 0, 0], [6, 0, 0]]]).ravel())
    obj.data.edges.add(2)
    obj.data.edges[12].vertices, obj.data.edges[13].vertices = (8, 9), (0, 9)
    report = check.examine(obj)
    assert names(report) == {"loose_edges"}
    assert report["loose_edges"].elements.tolist() == [12, 13]


def test_uneven_scale_modifiers_and_shape_keys():
    obj = cube()
    obj.scale = (1.0, 2.0, 1.0)
    obj.modifiers.new("Round", "SUBSURF")
    kit.add_key(obj, "Basis", np.zeros((8, 3)))
    kit.add_key(obj, "Up", np.ones((8, 3))).value = 0.0
    obj.active_shape_key_index = 1
    bpy.context.view_layer.update()
    report = check.examine(obj)
    assert names(report) == {"uneven_scale", "modifiers", "shape_keys"}
    assert "1, 2, 1" in report["uneven_scale"].notes[0]
    assert '"Round"' in report["modifiers"].notes[0]
    assert '"Up"' in report["shape_keys"].notes[0]


def test_what_no_tool_can_work_on():
    obj = cube()
    obj.modifiers.new("Sculpted", "MULTIRES")
    report = check.examine(obj)
    assert report.findings[0].kind.name == "refused"
    assert "Multiresolution" in report.sentence
    empty = kit.add_object("Empty", [[0, 0, 0]], [])
    assert names(check.examine(empty)) == {"refused", "loose_vertices"}


def test_far_and_small_junctions_alike():
    """A T-junction is one at any size and place, and corners that do not touch are none."""
    vertices, faces, _ = FAULTS["t_junctions"]
    for scale, shift in ((1e-4, 0.0), (1e4, 0.0), (1.0, 300.0)):
        obj = kit.add_object("Mesh", scale * np.array(vertices, float) + shift, faces)
        assert check.examine(obj)["t_junctions"].elements.tolist() == [7]
    apart = np.array(vertices, float)
    apart[7, 1] -= 1e-3
    assert check.examine(kit.add_object("Mesh", apart, faces))["t_junctions"] is None


def test_many_junctions_are_those_that_were_made():
    """A coarse row of squares on a row of other width: each inner corner lies on an edge of the other row."""
    rng = np.random.default_rng(3)
    above, below = (np.sort(np.r_[0.0, rng.uniform(0, 100, 200), 100.0]) for _ in range(2))
    vertices, faces = [], []
    for row, side in ((above, 1.0), (below, -1.0)):
        first = len(vertices)
        vertices += [[x, 0.0, 0.0] for x in row] + [[x, 0.1 * side, 0.0] for x in row]
        for k in range(len(row) - 1):
            quad = [first + k, first + k + 1, first + len(row) + k + 1, first + len(row) + k]
            faces.append(quad if side > 0 else quad[::-1])
    obj = kit.add_object("Rows", vertices, faces)
    found = set(check.examine(obj)["t_junctions"].elements.tolist())
    inner = {*range(1, 201), *range(404 + 1, 404 + 201)}
    # Corners of the two rows that are nearly in one place are no junctions.
    assert found <= inner
    assert len(found) > 0.95 * len(inner)


def test_faces_that_lie_on_others_are_told_from_duplicates():
    """A lid, the same again, and one that is cut otherwise; as a soup too; next to it a fin is none."""
    faces = [*SECOND_LID, SIDES[5]]
    soup = np.concatenate([CUBE[face] for face in faces])
    ends = np.cumsum([len(face) for face in faces])
    apart = [list(range(end - len(face), end)) for face, end in zip(faces, ends, strict=True)]
    for vertices, corners in ((CUBE, faces), (soup, apart)):
        report = check.examine(kit.add_object("Mesh", vertices, corners))
        assert report["duplicate_faces"].elements.tolist() == [8]
        assert report["doubled_faces"].elements.tolist() == [5, 6, 7]
    fin = kit.add_object("Fin", [*CUBE, [0.5, 2, 0.5]], [*SIDES, [1, 5, 8]])
    assert check.examine(fin)["doubled_faces"] is None
    assert check.examine(fin)["nonmanifold_edges"].count == 1


def test_the_operator_reports_and_returns():
    first, second = cube(), kit.add_object("Fan", *FAN)
    first.select_set(True)
    assert bpy.ops.ridgeform.check() == {"FINISHED"}
    reports = check.last()
    assert [report["name"] for report in reports] == ["Fan", "Cube"]
    assert [found["kind"] for found in reports[0]["findings"]] == ["nonmanifold_edges"]
    assert reports[1]["findings"] == []
    assert bpy.context.mode == "OBJECT"
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.ridgeform.check() == {"FINISHED"}
    assert {report["name"] for report in check.last()} == {"Fan", "Cube"}
    assert second.mode == "EDIT"


def test_edit_mode_sees_what_is_edited():
    obj = cube()
    bpy.ops.object.mode_set(mode="EDIT")
    edited = bmesh.from_edit_mesh(obj.data)
    edited.faces.ensure_lookup_table()
    edited.faces[2].normal_flip()
    edited.verts.new((9, 9, 9))
    bmesh.update_edit_mesh(obj.data)
    report = check.examine(obj)
    assert names(report) == {"flipped_faces", "loose_vertices"}
    assert report["flipped_faces"].elements.tolist() == [2]
    assert report["loose_vertices"].elements.tolist() == [8]


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("kind", [kind for kind in FAULTS if kind != "far_away"])
def test_selecting_selects_just_that(kind, mode):
    vertices, faces, _ = FAULTS[kind]
    obj = kit.add_object("Mesh", vertices, faces)
    other = kit.bumpy_box("Other")
    obj.select_set(True)
    for mesh in (obj.data, other.data):
        mesh.vertices.foreach_set("hide", np.ones(len(mesh.vertices), bool))
        mesh.polygons.foreach_set("hide", np.ones(len(mesh.polygons), bool))
        mesh.edges.foreach_set("hide", np.ones(len(mesh.edges), bool))
    expected = check.examine(obj)[kind]
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.ridgeform.select_faults(kind=kind) == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH"
    assert (
        tuple(bpy.context.scene.tool_settings.mesh_select_mode)
        == {
            "VERT": (True, False, False),
            "EDGE": (False, True, False),
            "FACE": (False, False, True),
        }[expected.kind.domain.value]
    )
    bpy.ops.object.mode_set(mode="OBJECT")
    items = {"VERT": obj.data.vertices, "EDGE": obj.data.edges, "FACE": obj.data.polygons}
    items = items[expected.kind.domain.value]
    selected = [item.index for item in items if item.select and not item.hide]
    assert selected == expected.elements.tolist()
    assert not any(item.select for item in (*other.data.vertices, *other.data.polygons))


def test_selecting_where_there_is_nothing():
    cube()
    assert bpy.ops.ridgeform.select_faults(kind="seams") == {"CANCELLED"}
    assert bpy.context.mode == "OBJECT"


FIXTURES = Path(__file__).parents[2] / "blend_fixtures"


def test_files_with_faults():
    """What the fixtures are made for is found, and nothing in clean ones."""
    found = {}
    for name in ("nonmanifold", "clean", "ngons", "noisy", "bust", "spot"):
        for obj in files.read_file(FIXTURES / f"{name}.blend"):
            kinds = {item.kind.name: item.count for item in check.examine(obj).findings}
            if name == "nonmanifold":
                found[obj.name] = kinds
            else:
                assert kinds == {}, obj.name
    assert found.pop("Empty") == {"refused": 1}
    assert {name: set(kinds) for name, kinds in found.items()} == {
        "Bow Tie": {"nonmanifold_vertices"},
        "Coincident Vertices": {"seams"},
        "Duplicate Faces": {"nonmanifold_edges", "duplicate_faces", "flipped_faces"},
        "Loose": {"loose_edges", "loose_vertices"},
        "Moebius": {"one_sided"},
        "Not a Number": {"not_finite"},
        "Three Faces": {"nonmanifold_edges"},
        "Touching Cubes": {"nonmanifold_edges"},
        "Zero Area": {"seams", "degenerate_faces"},
        "Everything": {
            "one_sided",
            "nonmanifold_edges",
            "nonmanifold_vertices",
            "duplicate_faces",
            "seams",
            "flipped_faces",
            "degenerate_faces",
            "loose_vertices",
        },
    }
    assert found["Moebius"]["one_sided"] == 1
    assert found["Coincident Vertices"]["seams"] == 24
    assert found["Touching Cubes"]["nonmanifold_edges"] == 4


def test_all_kinds_are_tested():
    here = {*FAULTS, "refused", "one_sided", "loose_edges", "uneven_scale", "modifiers", "shape_keys"}
    assert here == {kind.name for kind in KINDS}
