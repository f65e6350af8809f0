"""The committed .blend files open in this Blender and hold what their names promise."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from known_shapes import shapes

FOLDER = Path(__file__).resolve().parents[2] / "blend_fixtures"


def open_fixture(name):
    """Open a fixture and return its mesh objects by name."""
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / f"{name}.blend"))
    return {obj.name: obj for obj in bpy.data.objects if obj.type == "MESH"}


def coordinates(mesh):
    """Vertex positions, `(n, 3)`."""
    values = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def faces_on_edges(mesh):
    """Number of polygons on every edge."""
    edges = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("edge_index", edges)
    return np.bincount(edges, minlength=len(mesh.edges))


def test_the_folder_is_small():
    assert sum(path.stat().st_size for path in FOLDER.rglob("*") if path.is_file()) < 4e6


@pytest.mark.parametrize(
    ("fixture", "name", "n_vertices"),
    [("bust", "Bust", 9002), ("spot", "Spot", 829), ("spot", "Spot Dense", 11533)],
)
def test_scans_are_closed_manifold_and_upright(fixture, name, n_vertices):
    mesh = open_fixture(fixture)[name].data
    assert len(mesh.vertices) == n_vertices
    assert (faces_on_edges(mesh) == 2).all()
    assert len(mesh.vertices) - len(mesh.edges) + len(mesh.polygons) == 2
    low, high = coordinates(mesh).min(axis=0), coordinates(mesh).max(axis=0)
    assert (low[2], high[2]) == pytest.approx((0, 2), abs=0.01)


def test_the_bust_has_no_slivers():
    mesh = open_fixture("bust")["Bust"].data
    corners = coordinates(mesh)[[list(polygon.vertices) for polygon in mesh.polygons]]
    sides = np.roll(corners, -1, axis=1) - corners
    squared = (sides**2).sum(axis=(1, 2))
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2
    assert (4 * np.sqrt(3) * area / squared).min() > 0.4  # 1 for an equilateral triangle


def test_clean_shapes_are_manifold_and_the_closed_ones_closed():
    objects = open_fixture("clean")
    assert len(objects) == 12
    for name, obj in objects.items():
        counts = faces_on_edges(obj.data)
        assert counts.min() >= 1
        assert counts.max() == 2
        assert (1 in counts) == (name in ("Grid", "Open Cone"))


def test_noisy_cube_is_the_benchmark_cube():
    mesh = open_fixture("noisy")["Noisy Cube"].data
    assert coordinates(mesh) == pytest.approx(shapes.noisy_cube(0)[0], abs=1e-6)


def test_ngons_have_the_polygons_that_their_names_say():
    objects = open_fixture("ngons")
    sizes = {name: sorted({len(p.vertices) for p in obj.data.polygons}) for name, obj in objects.items()}
    assert sizes == {"Quads": [4], "Pentagons": [5], "Concave": [4, 8], "Mixed": [3, 4]}
    for obj in objects.values():
        assert (faces_on_edges(obj.data) == 2).all()


def test_shape_keys_and_all_other_data_are_there():
    objects = open_fixture("shape_keys")
    keys = objects["Keyed"].data.shape_keys.key_blocks
    assert keys.keys() == ["Basis", "Bent", "Bulged"]
    assert objects["Keyed"].active_shape_key.name == "Bulged"
    assert objects["Dressed"].data.shape_keys is None
    basis = np.array([point.co for point in keys["Basis"].data])
    for key in ("Bent", "Bulged"):
        assert np.abs(np.array([point.co for point in keys[key].data]) - basis).max() > 0.2
    for obj in objects.values():
        mesh = obj.data
        assert obj.vertex_groups.keys() == ["strength", "ridges"]
        assert mesh.uv_layers.keys() == ["UVMap"]
        assert {"Color", "temperature", "crease_edge"} <= set(mesh.attributes.keys())
        assert {polygon.material_index for polygon in mesh.polygons} == {0, 1}
        assert sum(edge.use_edge_sharp for edge in mesh.edges) == 64
        assert any(edge.use_seam for edge in mesh.edges)


def test_shared_data_is_shared():
    objects = open_fixture("shared_data")
    assert objects["Left"].data == objects["Right"].data
    assert objects["Alone"].data.users == 1
    assert objects["Child"].parent == objects["Alone"]


def test_nonmanifold_objects_have_their_defects():
    objects = open_fixture("nonmanifold")
    most_faces = {name: faces_on_edges(obj.data).max(initial=0) for name, obj in objects.items()}
    assert most_faces["Three Faces"] == 3
    assert most_faces["Touching Cubes"] == 4
    assert most_faces["Everything"] == 4
    assert {len(p.vertices) for p in objects["Everything"].data.polygons} == {3}
    polygons = [tuple(sorted(p.vertices)) for p in objects["Duplicate Faces"].data.polygons]
    assert len(polygons) - len(set(polygons)) == 3
    assert sum(p.area == 0 for p in objects["Zero Area"].data.polygons) == 2
    assert (faces_on_edges(objects["Loose"].data) == 0).sum() == 1
    assert len(objects["Empty"].data.vertices) == 0
    assert np.isnan(coordinates(objects["Not a Number"].data)).sum() == 1
