"""What holds of every answer: numbers, near what went in, that claim no more than is so."""

import collections
from typing import Any

import numpy as np
import ridgeform

Given = dict[str, Any]
STATUSES = {"solved", "inaccurate", "stopped"}


def finite(*arrays: Any) -> None:
    """Asserts that all entries are numbers."""
    for array in arrays:
        assert np.isfinite(np.asarray(array, float)).all(), "not a number"


def near(points: np.ndarray, mesh: ridgeform.Mesh) -> None:
    """Asserts that points are not farther from the mesh than ten times its size."""
    finite(points)
    corners = mesh.vertices[np.unique(mesh.faces)]
    if len(corners) and len(points):
        size = np.ptp(corners, axis=0).max()
        away = np.maximum(corners.min(axis=0) - points, points - corners.max(axis=0)).max()
        assert away <= 10.01 * size + 1e-300, f"{away:.1e} away from a mesh of size {size:.1e}"


def crowded(faces: np.ndarray) -> tuple[int, int]:
    """How many edges have more than two faces, and how many are run twice in the same direction."""
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    counts = [np.unique(pairs, axis=0, return_counts=True)[1] for pairs in (np.sort(directed), directed)]
    return int((counts[0] > 2).sum()), int((counts[1] > 1).sum())


def is_plain(mesh: ridgeform.Mesh) -> bool:
    """Whether tools compute on the mesh as it is: no face is turned and no seam is joined first."""
    if mesh.vertices is None or ridgeform.orient(mesh.faces)[1].any():
        return False
    return len(ridgeform.weld(mesh.vertices, mesh.faces)[0]) == mesh.n_vertices


def _holes(mesh: ridgeform.Mesh) -> None:
    """Every edge of one face is on one rim; all rims of a manifold mesh are boundary loops."""
    holes = ridgeform.find_holes(mesh)
    # They are looked for after faces are oriented and seams joined.
    if not is_plain(mesh):
        return
    faces = mesh.faces
    faces = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])]
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]))
    edges, counts = np.unique(edges, axis=0, return_counts=True)
    rims: collections.Counter[tuple[int, ...]] = collections.Counter()
    for hole in holes:
        # A rim that does not close is a walk from end to end.
        is_open = "ends at non-manifold edges" in (hole.refusal or "")
        ends = hole.vertices[1:] if is_open else np.roll(hole.vertices, -1)
        pairs = np.sort(np.stack([hole.vertices[: len(ends)], ends], 1))
        rims.update(map(tuple, pairs.tolist()))
    assert all(rims[tuple(edge)] == 1 for edge in edges[counts == 1].tolist())
    if crowded(mesh.faces) == (0, 0):
        # An island that touches the ring around it makes one rim of two loops.
        assert len(holes) <= len(ridgeform.boundary_loops(mesh))
        assert len(rims) == (counts == 1).sum()


def operators(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """The operators, and the report."""
    report = mesh.report
    assert report.n_boundary_loops == len(ridgeform.boundary_loops(mesh))
    _holes(mesh)
    finite(ridgeform.cotangent_laplacian(mesh).data, ridgeform.intrinsic_delaunay(mesh).edge_lengths)
    dual = given["dual"]
    finite(ridgeform.hessian(mesh, dual=dual).data)
    values = np.cos(np.arange(mesh.n_vertices))
    if given["kind"] != "l1_hessian":
        dual = "barycentric"
    finite(ridgeform.energy(mesh, values, kind=given["kind"], dual=dual))
    finite(ridgeform.hessian_norm(mesh, values))
    mass = ridgeform.voronoi_mass(mesh)
    finite(mass)
    assert (mass >= 0).all()


def _solution(mesh: ridgeform.Mesh, given: Given, found: ridgeform.Solution, sane: bool) -> None:
    finite(found.values, found.objective, found.gap)
    assert found.gap >= 0
    assert found.status in STATUSES
    tolerance = given.get("tolerance", 1e-3)
    if sane and found.status == "solved" and tolerance:
        assert found.gap <= tolerance, f"solved with a gap of {found.gap}"


def denoise(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """Values like those given; those that are fixed keep every bit."""
    constraints = given.get("linear_constraints")
    if sane and constraints:
        given["linear_constraints"] = (constraints[0], np.zeros((1, given["values"].shape[1])))
    found = ridgeform.denoise(mesh, **given)
    _solution(mesh, given, found, sane)
    if sane:
        assert found.values.shape == given["values"].shape
        fixed = given.get("fixed", np.zeros(mesh.n_vertices, bool))
        np.testing.assert_array_equal(found.values[fixed], given["values"][fixed])
        _objective(mesh, given, found)


def _objective(mesh: ridgeform.Mesh, given: Given, found: ridgeform.Solution) -> None:
    if not is_plain(mesh):
        return
    if given.get("delaunay") or given.get("sharpness") or given.get("coupling") == "separate":
        return
    words = {name: given[name] for name in ("dual", "face_weights") if name in given}
    try:
        objective = ridgeform.energy(mesh, found.values, kind=given.get("energy", "l1_hessian"), **words)
        if "fidelity" in given:
            # The square of what moved by 1e-164 would be lost, that of its product with lengths is not.
            lengths = np.sqrt(ridgeform.voronoi_mass(mesh))
            moved = (found.values - given["values"]).reshape(len(lengths), -1)
            objective += given["fidelity"] * ((lengths[:, None] * moved) ** 2).sum()
    except ridgeform.SolveError:
        return
    if np.isfinite(objective) and objective > 1e-290:
        np.testing.assert_allclose(
            found.objective, objective, rtol=1e-6, atol=1e-9 * np.abs(found.values).max()
        )


def interpolate(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """The values given, kept, and others between."""
    found = ridgeform.interpolate(mesh, **given)
    _solution(mesh, given, found, sane)
    if sane:
        np.testing.assert_array_equal(found.values[given["indices"]], given["values"])
        _objective(mesh, given, found)


def vibration_modes(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """Orthonormal functions."""
    modes = ridgeform.vibration_modes(mesh, **given)
    finite(modes)
    if sane and not given.get("delaunay"):
        # In a unit of its own: a mesh of size 1e-160 has areas that are no numbers.
        used = np.unique(mesh.faces)
        exponent = np.frexp(np.abs(mesh.vertices[used]).max())[1]
        vertices = np.zeros_like(mesh.vertices)
        vertices[used] = np.ldexp(mesh.vertices[used], -exponent)
        mass, modes = ridgeform.voronoi_mass(ridgeform.Mesh(vertices, mesh.faces)), np.ldexp(modes, exponent)
        products = modes.T @ (mass[:, None] * modes)
        assert np.abs(products - np.eye(len(products))).max() < 1e-6


def stylize(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """Vertices near where they were; those that are fixed, and those without faces, where they were."""
    found = ridgeform.stylize(mesh, **given)
    near(found.vertices[np.unique(mesh.faces)], mesh)
    finite(found.energy, found.gap)
    assert (found.gap >= 0).all()
    assert len(found.gap) == found.iterations == len(found.energy) - 1
    still = np.ones(mesh.n_vertices, bool)
    still[mesh.faces] = False
    if sane and "fixed" in given:
        still |= given["fixed"]
    np.testing.assert_array_equal(found.vertices[still], mesh.vertices[still])


def segment(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """A label for every face that takes part, and nested ones."""
    found = ridgeform.segment(mesh, **given)
    finite(found.values, found.indicator, found.strengths, found.noise)
    assert found.n_segments == found.labels.max() + 1
    if sane and "faces" in given:
        np.testing.assert_array_equal(found.labels >= 0, given["faces"])
    fewest, most = found.range
    for count in {fewest, (fewest + most) // 2, most}:
        assert found.labels_at(count).max() + 1 == count


def facet(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """Flat polygons near the mesh; what was to stay keeps every bit; closed stays closed."""
    found = ridgeform.facet(mesh, **given)
    n, m = mesh.n_vertices, mesh.n_faces
    near(found.vertices, mesh)
    finite(found.planes, found.rms, found.largest)
    assert len(found.origins) == len(found.vertices)
    assert ((found.origins >= 0) & (found.origins < n)).all()
    for named in (found.polygon_vertices, found.faces):
        assert ((named >= 0) & (named < len(found.vertices))).all()
    assert len(found.face_facets) == len(found.faces)
    assert found.labels.shape == (m,)
    assert found.labels.max(initial=-1) < len(found.planes)
    starts = found.polygon_starts
    assert (np.diff(starts) >= 3).all()
    assert starts[0] == 0
    assert starts[-1] == len(found.polygon_vertices)
    assert found.status in ("solved", "stopped")
    if crowded(mesh.faces) == (0, 0) and not len(mesh.report.nonmanifold_vertices) and is_plain(mesh):
        assert crowded(found.faces) == (0, 0)
        if not ridgeform.boundary_loops(mesh):
            assert not ridgeform.boundary_loops(ridgeform.Mesh(found.vertices, found.faces))
    if sane and "faces" in given:
        # A face that names a vertex twice is no polygon, and is not kept.
        names_twice = (mesh.faces == np.roll(mesh.faces, 1, axis=1)).any(axis=1)
        still = np.unique(mesh.faces[~given["faces"] & ~names_twice])
        kept = found.vertices[np.isin(found.origins, still)]
        np.testing.assert_array_equal(kept, mesh.vertices[found.origins[np.isin(found.origins, still)]])
        # Of two vertices at the ends of a side of length 0 one is there.
        places = set(map(tuple, found.vertices.tolist()))
        assert all(tuple(place) in places for place in mesh.vertices[still].tolist()) or not is_plain(mesh)


def restore(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """Vertices no farther than they may move; those that are fixed, or of other faces, where they were."""
    found = ridgeform.restore(mesh, **given)
    near(found.vertices[np.unique(mesh.faces)], mesh)
    finite(found.noise)
    assert found.status in ("restored", "unsure", "stopped")
    assert found.labels.shape == (mesh.n_faces,)
    assert found.labels.max(initial=-1) < len(found.surfaces)
    still = np.ones(mesh.n_vertices, bool)
    still[mesh.faces] = False
    if sane and "fixed" in given:
        still |= given["fixed"]
    if sane and "faces" in given:
        still[mesh.faces[~given["faces"]]] = True
    np.testing.assert_array_equal(found.vertices[still], mesh.vertices[still])


def fill_holes(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """The mesh as it was, and patches that make nothing non-manifold."""
    found = ridgeform.fill_holes(mesh, **given)
    n, m = mesh.n_vertices, mesh.n_faces
    np.testing.assert_array_equal(found.vertices[:n].view(np.int64), mesh.vertices.view(np.int64))
    np.testing.assert_array_equal(found.faces[:m], mesh.faces)
    near(found.new_vertices, mesh)
    before, after = crowded(mesh.faces), crowded(found.faces)
    if ridgeform.orient(mesh.faces)[1].any():
        # Nothing runs against all faces of a rim that run against each other.
        before, after = before[:1], after[:1]
    assert after <= before, f"edges with many faces {before} -> {after}"
    for hole in found.holes:
        finite(hole.energy, hole.gap)
        assert hole.gap >= 0
        assert (hole.status == "refused") == (hole.reason is not None)


def remesh(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """Vertices on the mesh; what stays keeps every bit; manifold stays manifold."""
    found = ridgeform.remesh(mesh, **given)
    kept = found.origin >= 0
    # A vertex without a face may be fixed anywhere.
    near(found.vertices[~kept], mesh)
    np.testing.assert_array_equal(found.vertices[kept], mesh.vertices[found.origin[kept]])
    if crowded(mesh.faces) == (0, 0):
        assert crowded(found.faces) == (0, 0)
    finite(found.edge_length)


def diffusion_curves(mesh: ridgeform.Mesh, given: Given, sane: bool) -> None:
    """Colors within the range of those given, and curves that redraw them."""
    found = ridgeform.diffusion_curves(mesh, **given)
    finite(found.left, found.right, found.colors, found.corners, found.point_colors, found.error)
    assert found.error >= 0
    if sane and len(mesh.faces):
        used = np.unique(mesh.faces)
        low, high = given["colors"][used].min(axis=0) - 1e-9, given["colors"][used].max(axis=0) + 1e-9
        for colors in (found.left, found.right, found.corners, found.colors[used]):
            assert ((colors >= low) & (colors <= high)).all(), "a color outside of the range given"
        finite(ridgeform.smooth_curves(mesh, found.edges))
