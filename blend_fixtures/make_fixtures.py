"""Write the .blend fixtures beside this file, with the bpy of Blender 4.2: every newer one opens them.

    HOME=/ PYTHONPATH=tests python blend_fixtures/make_fixtures.py

What each file holds is the docstring of the function of its name. Blender notes the home folder in every
file, hence the neutral one.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from known_shapes import shapes
from mathutils import Euler, Matrix
from numpy.typing import ArrayLike

HERE = Path(__file__).resolve().parent
Polygons = list[list[int]]


def add_object(
    name: str,
    vertices: ArrayLike,
    polygons: ArrayLike | Polygons,
    location: tuple[float, float, float] = (0, 0, 0),
) -> bpy.types.Object:
    """Link a new mesh object of flat polygons, built without any repair of bad geometry."""
    mesh = bpy.data.meshes.new(name)
    rows = polygons.tolist() if isinstance(polygons, np.ndarray) else polygons
    mesh.from_pydata(np.asarray(vertices, dtype=float).tolist(), [], rows, shade_flat=True)
    return link_object(name, mesh, location)


def link_object(
    name: str, mesh: bpy.types.Mesh, location: tuple[float, float, float] = (0, 0, 0)
) -> bpy.types.Object:
    """Link a new object that shows `mesh`."""
    obj = bpy.data.objects.new(name, mesh)
    obj.location = location
    bpy.context.scene.collection.objects.link(obj)
    return obj


def clean() -> None:
    """One object per generated shape, in a row: closed, open, flat and curved, all manifold."""
    closed = {
        "Cube": shapes.cube(8),
        "House": shapes.house(3),
        "Staircase": shapes.staircase(3, 4),
        "L Shape": shapes.l_shape(4),
        "Dodecahedron": shapes.dodecahedron(2),
        "Tetrahedron": shapes.tetrahedron(),
        "Icosphere": shapes.icosphere(3),
        "UV Sphere": shapes.uv_sphere(),
        "Cylinder": shapes.cylinder(),
        "Torus": shapes.torus(),
    }
    flat_or_open = {
        "Grid": (shapes.grid(8, 8)[0] * 0.25, shapes.grid(8, 8)[1]),
        "Open Cone": shapes.open_cone(16),
    }
    for i, (name, shape) in enumerate({**closed, **flat_or_open}.items()):
        add_object(name, *shape, location=(4.0 * i, 0, 0))


def noisy() -> None:
    """Shapes with planar sides under noise: the benchmark cube of 1538 vertices, a house, a dodecahedron."""
    add_object("Noisy Cube", *shapes.noisy_cube(seed=0))
    for i, (name, (vertices, faces)) in enumerate(
        {"Noisy House": shapes.house(4), "Noisy Dodecahedron": shapes.dodecahedron(3)}.items(), start=1
    ):
        add_object(name, shapes.add_noise(vertices, faces, 0.15, seed=i), faces, location=(4.0 * i, 0, 0))


def ngons() -> None:
    """Quads under noise, a dodecahedron of true pentagons, a block with a concave n-gon, all kinds mixed."""
    add_object("Quads", *noisy_quad_cube(8))
    vertices, faces = shapes.dodecahedron(0)
    pentagons = [[int(face[1]) for face in faces[5 * k : 5 * k + 5]] for k in range(12)]
    add_object("Pentagons", vertices[:20], pentagons, location=(4, 0, 0))
    add_object("Concave", *concave_block(), location=(8, 0, 0))
    vertices, quads = noisy_quad_cube(6)
    mixed = [[*quad[:2], quad[2]] if k % 3 == 0 else quad for k, quad in enumerate(quads)]
    mixed += [[quad[0], quad[2], quad[3]] for k, quad in enumerate(quads) if k % 3 == 0]
    add_object("Mixed", vertices, mixed, location=(12, 0, 0))


def noisy_quad_cube(n: int) -> tuple[np.ndarray, Polygons]:
    """The noisy cube with its pairs of triangles joined again to quads: `6 n²` slightly bent quads."""
    vertices, faces = shapes.cube(n)
    half = len(faces) // 2  # triangles (0, 1, 2) of all quads come first, then triangles (0, 2, 3)
    quads = np.column_stack([faces[:half], faces[half:, 2]])
    return shapes.add_noise(vertices, faces, 0.1, seed=3), quads.tolist()


def concave_block() -> tuple[np.ndarray, Polygons]:
    """A prism over a C: two concave octagons and eight quads."""
    outline = np.array([[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [3, 2], [3, 3], [0, 3]]) - 1.5
    vertices = np.concatenate([np.column_stack([outline, np.full(8, z)]) for z in (-0.5, 0.5)])
    sides = [[i, (i + 1) % 8, (i + 1) % 8 + 8, i + 8] for i in range(8)]
    return vertices, [list(range(7, -1, -1)), list(range(8, 16)), *sides]


def shape_keys() -> None:
    """One bent tube with all a modeler's data, with shape keys ("Keyed") and without ("Dressed")."""
    vertices, faces = shapes.cylinder(32, 16, 4)
    for name, location in (("Keyed", (0, 0, 0)), ("Dressed", (4, 0, 0))):
        obj = add_object(name, vertices, faces, location)
        obj.rotation_euler, obj.scale = Euler((0.3, 0.2, 0.5)), (1.0, 1.0, 1.5)
        dress(obj, vertices)
    keyed = bpy.data.objects["Keyed"]
    x, y, z = vertices.T
    keys = {
        "Basis": vertices,
        "Bent": np.column_stack([x + 0.4 * z**2, y, z]),
        "Bulged": vertices * (1 + 0.3 * np.cos(3 * np.arctan2(y, x)) * (1 - z**2))[:, None] ** [1, 1, 0],
    }
    for key_name, coordinates in keys.items():
        key = keyed.shape_key_add(name=key_name, from_mix=False)
        key.data.foreach_set("co", coordinates.astype(np.float32).ravel())
    keyed.data.shape_keys.key_blocks["Bent"].value = 0.5
    keyed.data.shape_keys.key_blocks["Bulged"].value = 0.25
    keyed.active_shape_key_index = 2


def dress(obj: bpy.types.Object, vertices: np.ndarray) -> None:
    """Give a mesh vertex groups, UVs, colors, an attribute, materials, sharp edges, seams and creases."""
    mesh = obj.data
    strength, ridges = obj.vertex_groups.new(name="strength"), obj.vertex_groups.new(name="ridges")
    for i, (x, _, z) in enumerate(vertices):
        strength.add([i], float(np.clip(0.5 + 0.5 * z, 0, 1)), "REPLACE")  # 0 at the bottom, 1 at the top
        if abs(x) < 0.25:
            ridges.add([i], 1.0, "REPLACE")
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    x, y, z = vertices[corners].T
    uv = np.column_stack([np.arctan2(y, x) / (2 * np.pi) + 0.5, 0.5 * z + 0.5])
    mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", uv.ravel())
    rgba = np.column_stack([0.5 + 0.5 * vertices, np.ones(len(vertices))])
    mesh.color_attributes.new("Color", "FLOAT_COLOR", "POINT").data.foreach_set("color", rgba.ravel())
    mesh.attributes.new("temperature", "FLOAT", "POINT").data.foreach_set("value", vertices[:, 2])
    for name, rgb in (("Red", (0.8, 0.1, 0.1, 1)), ("Blue", (0.1, 0.2, 0.8, 1))):
        material = bpy.data.materials.new(f"{obj.name} {name}")
        material.diffuse_color = rgb
        mesh.materials.append(material)
    for polygon in mesh.polygons:
        polygon.material_index = int(polygon.center.z > 0)
    crease = mesh.attributes.new("crease_edge", "FLOAT", "EDGE")
    for edge in mesh.edges:
        on_rim = all(
            abs(abs(vertices[v, 2]) - 1) < 1e-6 and np.hypot(*vertices[v, :2]) > 0.99 for v in edge.vertices
        )
        edge.use_edge_sharp = on_rim
        crease.data[edge.index].value = float(on_rim)
        edge.use_seam = all(abs(vertices[v, 1]) < 1e-6 and vertices[v, 0] > 0 for v in edge.vertices)


def shared_data() -> None:
    """One mesh under two transforms ("Left", "Right"), a mesh with one user ("Alone"), its scaled "Child"."""
    vertices, faces = shapes.cube(8)
    shared = add_object("Left", shapes.add_noise(vertices, faces, 0.1, seed=5), faces)
    right = link_object("Right", shared.data, location=(5, 0, 0))
    right.rotation_euler, right.scale = Euler((0.4, 0.0, 0.8)), (1.0, 2.0, 0.5)
    alone = add_object("Alone", shapes.add_noise(vertices, faces, 0.1, seed=6), faces, location=(10, 0, 0))
    child = add_object("Child", *shapes.icosphere(2), location=(0, 0, 3))
    child.parent, child.matrix_parent_inverse = alone, Matrix.Scale(0.5, 4)


def nonmanifold() -> None:
    """Every defect in its own object, most of them in "Everything"; "Empty"; a NaN ("Not a Number")."""
    cone, cone_faces = shapes.open_cone(8)
    coincident, collinear = [[2, 0, 0], [2, 1, 0], [2, 0, 0]], [[3, 0, 0], [3, 1, 0], [3, 3, 0]]
    parts = {
        "Three Faces": shapes.three_faces_on_an_edge(),
        "Bow Tie": shapes.bow_tie(),
        "Touching Cubes": shapes.voxels([(0, 0, 0), (1, 1, 0)], 4),
        "Moebius": shapes.moebius_strip(),
        "Duplicate Faces": (cone, np.concatenate([cone_faces, cone_faces[:2], cone_faces[2:3, ::-1]])),
        "Zero Area": (
            np.concatenate([cone, coincident, collinear]),
            np.concatenate([cone_faces, [[9, 10, 11], [12, 13, 14]]]),
        ),
        "Coincident Vertices": (
            cone[cone_faces].reshape(-1, 3),
            np.arange(3 * len(cone_faces)).reshape(-1, 3),
        ),
    }
    for i, (name, (vertices, faces)) in enumerate(parts.items()):
        add_object(name, vertices, faces, location=(4.0 * i, 0, 0))
    loose = np.concatenate([cone, [[0, 0, 2], [1, 0, 2], [0, 1, 2]]])
    mesh = bpy.data.meshes.new("Loose")
    mesh.from_pydata(loose.tolist(), [(9, 10)], cone_faces.tolist())
    link_object("Loose", mesh, location=(28, 0, 0))
    counts = np.cumsum([0] + [len(vertices) for vertices, _ in parts.values()])
    everything = np.concatenate(
        [vertices + np.array([4.0 * i, 4, 0]) for i, (vertices, _) in enumerate(parts.values())]
    )
    faces = np.concatenate([faces + first for first, (_, faces) in zip(counts, parts.values(), strict=False)])
    add_object("Everything", np.concatenate([everything, [[0, 4, 3]]]), faces)
    link_object("Empty", bpy.data.meshes.new("Empty"))
    broken = cone.copy()
    broken[3, 1] = np.nan
    add_object("Not a Number", broken, cone_faces, location=(32, 0, 0))


def from_source(name: str, source: str, location: tuple[float, float, float] = (0, 0, 0)) -> None:
    """Add the mesh of a file in `sources`."""
    with np.load(HERE / "sources" / f"{source}.npz") as data:
        add_object(name, data["vertices"], data["faces"].astype(np.int64), location)


def spot() -> None:
    """Spot the cow: "Spot" of 829 vertices, "Spot Dense" of 11 533."""
    from_source("Spot", "spot_low_resolution")
    from_source("Spot Dense", "spot", location=(2.5, 0, 0))


def bust() -> None:
    """The bust of Nefertiti, 9002 vertices: "Bust", upright, facing -y, height 2."""
    from_source("Bust", "bust")


def save(path: Path) -> None:
    """Save compressed, by way of a temporary folder: Blender notes the folder of a file in the file."""
    with tempfile.TemporaryDirectory() as folder:
        temporary = Path(folder) / path.name
        bpy.ops.wm.save_as_mainfile(filepath=str(temporary), compress=True)
        shutil.copyfile(temporary, path)


def main() -> None:
    """Make all fixtures, or those named on the command line."""
    if bpy.app.version[:2] != (4, 2):
        raise SystemExit("Fixtures are saved by Blender 4.2: a newer one writes files that 4.2 cannot open.")
    makers = (clean, noisy, ngons, shape_keys, shared_data, nonmanifold, spot, bust)
    for make in makers:
        if len(sys.argv) > 1 and make.__name__ not in sys.argv[1:]:
            continue
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        make()
        path = HERE / f"{make.__name__}.blend"
        save(path)
        print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
