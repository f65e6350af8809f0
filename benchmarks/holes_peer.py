"""Fill the holes of meshes with one tool, one mesh after the other.

    python benchmarks/holes_peer.py TOOL FOLDER

Reads `NAME.in.npz` (vertices, faces) of FOLDER and writes `NAME.out.npz` (vertices, faces, seconds) or
`NAME.error`. What has an answer is skipped: so a run that a crash ended can be taken up again after it.
Each tool is used as its manual says for filling a hole well, with its defaults elsewhere.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Arrays = tuple[NDArray, NDArray]
LARGEST = 1e6
"""Size or edge count of holes to be filled: all."""

# Each tool is imported where it is used: only one of them runs in one process.


def ridgeform(vertices: NDArray, faces: NDArray) -> Arrays:
    """Ours, with its defaults."""
    import ridgeform as tool  # noqa: PLC0415

    filled = tool.fill_holes(tool.Mesh(vertices, faces))
    return filled.vertices, filled.faces


def pyvista(vertices: NDArray, faces: NDArray) -> Arrays:
    """The filter of VTK."""
    import pyvista as tool  # noqa: PLC0415

    mesh = tool.PolyData.from_regular_faces(vertices, faces).fill_holes(LARGEST).triangulate()
    return np.asarray(mesh.points), mesh.regular_faces


def open3d(vertices: NDArray, faces: NDArray) -> Arrays:
    """Open3D's tensor meshes."""
    import open3d as tool  # noqa: PLC0415

    mesh = tool.t.geometry.TriangleMesh(
        tool.core.Tensor(vertices.astype(np.float32)), tool.core.Tensor(faces.astype(np.int64))
    )
    # The result refers to the memory of the mesh it was made from, and its arrays to its own: keep and copy.
    filled = mesh.fill_holes(LARGEST)
    return filled.vertex.positions.numpy().copy(), filled.triangle.indices.numpy().copy()


def meshfix(vertices: NDArray, faces: NDArray) -> Arrays:
    """MeshFix, only its filling, which refines."""
    import pymeshfix as tool  # noqa: PLC0415

    made = tool.PyTMesh()
    made.load_array(np.ascontiguousarray(vertices, float), np.ascontiguousarray(faces, np.int32))
    made.fill_small_boundaries(0, refine=True)
    return made.return_arrays()


def _meshlib(vertices: NDArray, faces: NDArray, nicely: bool) -> Arrays:
    import meshlib.mrmeshnumpy as arrays  # noqa: PLC0415
    import meshlib.mrmeshpy as tool  # noqa: PLC0415

    mesh = arrays.meshFromFacesVerts(np.ascontiguousarray(faces, np.int32), np.ascontiguousarray(vertices))
    for edge in mesh.topology.findHoleRepresentiveEdges():
        metric = tool.getUniversalMetric(mesh)
        if nicely:
            settings = tool.FillHoleNicelySettings()
            settings.triangulateParams.metric = metric
            settings.subdivideSettings.maxEdgeLen = _mean_edge(vertices, faces)
            tool.fillHoleNicely(mesh, edge, settings)
        else:
            settings = tool.FillHoleParams()
            settings.metric = metric
            tool.fillHole(mesh, edge, settings)
    mesh.pack()
    return arrays.getNumpyVerts(mesh), arrays.getNumpyFaces(mesh.topology)


def meshlib(vertices: NDArray, faces: NDArray) -> Arrays:
    """MeshLib, triangles across the hole only."""
    return _meshlib(vertices, faces, nicely=False)


def meshlib_nicely(vertices: NDArray, faces: NDArray) -> Arrays:
    """MeshLib, subdivided to the mesh's edge length and made smooth."""
    return _meshlib(vertices, faces, nicely=True)


def _mean_edge(vertices: NDArray, faces: NDArray) -> float:
    return float(np.linalg.norm(vertices[faces] - vertices[np.roll(faces, 1, axis=1)], axis=2).mean())


def _pymeshlab(vertices: NDArray, faces: NDArray, refine: bool) -> Arrays:
    import pymeshlab as tool  # noqa: PLC0415

    session = tool.MeshSet()
    session.add_mesh(tool.Mesh(vertices, faces))
    refinement = {"refinehole": True, "refineholeedgelen": tool.PureValue(_mean_edge(vertices, faces))}
    session.meshing_close_holes(maxholesize=int(LARGEST), **(refinement if refine else {}))
    mesh = session.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()


def pymeshlab(vertices: NDArray, faces: NDArray) -> Arrays:
    """MeshLab, triangles across the hole only."""
    return _pymeshlab(vertices, faces, refine=False)


def pymeshlab_refined(vertices: NDArray, faces: NDArray) -> Arrays:
    """MeshLab, refined to the mesh's edge length."""
    return _pymeshlab(vertices, faces, refine=True)


def _cgal(vertices: NDArray, faces: NDArray, fair: bool) -> Arrays:
    from CGAL import CGAL_Polygon_mesh_processing as tool  # noqa: PLC0415
    from CGAL.CGAL_Kernel import Point_3  # noqa: PLC0415
    from CGAL.CGAL_Polyhedron_3 import (  # noqa: PLC0415
        Polyhedron_3,
        Polyhedron_modifier,
    )

    modifier = Polyhedron_modifier()
    modifier.begin_surface(len(vertices), len(faces))
    for point in vertices.tolist():
        modifier.add_vertex(Point_3(*point))
    for face in faces.tolist():
        modifier.begin_facet()
        for vertex in face:
            modifier.add_vertex_to_facet(vertex)
        modifier.end_facet()
    modifier.end_surface()
    mesh = Polyhedron_3()
    mesh.delegate(modifier)
    while not mesh.is_closed():
        border = next(halfedge for halfedge in mesh.halfedges() if halfedge.is_border())
        made: tuple[list, list] = ([], [])
        if fair:
            tool.triangulate_refine_and_fair_hole(mesh, border, *made)
        else:
            tool.triangulate_hole(mesh, border, made[0])
    # The bindings have no access by index: what is written to a file is read again.
    with tempfile.NamedTemporaryFile(suffix=".off", mode="r", encoding="utf-8") as file:
        mesh.write_to_file(file.name, 17)
        words = iter(file.read().split())
    next(words)
    n_vertices, n_faces, _ = (int(next(words)) for _ in range(3))
    points = np.array([float(next(words)) for _ in range(3 * n_vertices)]).reshape(-1, 3)
    rows = np.array([int(next(words)) for _ in range(4 * n_faces)]).reshape(-1, 4)
    return points, rows[:, 1:]


def cgal(vertices: NDArray, faces: NDArray) -> Arrays:
    """CGAL, triangles across the hole only [Liepa 2003]."""
    return _cgal(vertices, faces, fair=False)


def cgal_fair(vertices: NDArray, faces: NDArray) -> Arrays:
    """CGAL, refined and faired."""
    return _cgal(vertices, faces, fair=True)


TOOLS: dict[str, Callable[[NDArray, NDArray], Arrays]] = {
    tool.__name__: tool
    for tool in (
        ridgeform,
        pyvista,
        open3d,
        meshfix,
        meshlib,
        meshlib_nicely,
        pymeshlab,
        pymeshlab_refined,
        cgal,
        cgal_fair,
    )
}
"""The tools by the word on the command line."""


WARM_UP = (
    np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]),
    np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3]]),
)
"""A tetrahedron without one face, so that importing is not timed."""


def main(arguments: list[str]) -> None:
    """Fill what has no answer yet."""
    tool, folder = TOOLS[arguments[0]], Path(arguments[1])
    try:
        tool(*WARM_UP)
    except ImportError as error:
        sys.exit(f"cannot be imported: {error}")
    except Exception as error:
        print(f"{arguments[0]}: a tetrahedron without a face: {error}", file=sys.stderr)
    for source in sorted(folder.glob("*.in.npz")):
        name = source.name.removesuffix(".in.npz")
        if (folder / f"{name}.out.npz").exists() or (folder / f"{name}.error").exists():
            continue
        # What the driver finds if the tool takes this process down with it.
        (folder / "at").write_text(name, encoding="utf-8")
        data = np.load(source)
        vertices, faces = data["vertices"], data["faces"]
        begin = time.perf_counter()
        try:
            points, triangles = tool(vertices, faces)
        except Exception as error:
            words = " ".join(str(error).split())
            (folder / f"{name}.error").write_text(f"{type(error).__name__}: {words}", encoding="utf-8")
            continue
        seconds = time.perf_counter() - begin
        np.savez(folder / f"{name}.out.npz", vertices=points, faces=triangles, seconds=seconds)


if __name__ == "__main__":
    main(sys.argv[1:])
