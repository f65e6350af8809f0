"""Reducing triangles: borders, marks, borders of materials and UV islands, and held vertices stay."""

import addon_kit as kit
import bmesh
import bpy
import fast_simplification
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io, rebuilding
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.stylize import curves, reduction, simplify
from bl_ext.user_default.ridgeform.stylize.collapse import Fans
from known_shapes import limbs, shapes
from mirror_kit import half_ball, open_edges

N = 24


def sheet(name="Sheet", x0=0.0, n=N, height=0.08):
    """A hilly sheet of triangles over a unit square, whose corner is at (x0, 0)."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    x, y = x.ravel() + x0, y.ravel()
    rough = 0.004 * np.random.default_rng(1).normal(size=len(x))
    z = height * np.sin(6 * x) * np.cos(5 * y) + np.where(
        (y > 0) & (y < 1) & (x > x0) & (x < x0 + 1), rough, 0
    )
    a = ((n + 1) * np.arange(n)[:, None] + np.arange(n)).ravel()
    b, c, d = a + n + 1, a + n + 2, a + 1
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return kit.add_object(name, np.stack([x, y, z], axis=1), faces.tolist())


def hold(obj, free):
    """A mask that lets only the vertices `free` (n,) bool move."""
    obj.vertex_groups.new(name="Free").add(np.flatnonzero(free).tolist(), 1.0, "REPLACE")
    return {"strength_group": "Free"}


def reduce(obj, ratio=0.2, **settings):
    """Reduce an object that hardly moves otherwise; returns its coordinates (p, 3) and triangles (q, 3)."""
    given = {"steps": 1, "strength": 0.0, "marks": set()} | settings
    assert bpy.ops.ridgeform.stylize(finish="LOW_POLY", reduce_ratio=ratio, **given) == {"FINISHED"}
    return kit.coordinates(obj), mesh_io.triangles(obj.data)


def edges_where(obj, inside):
    """Which edges (e,) bool have both ends and the middle where a function says so."""
    ends = mesh_io.edges(obj.data)
    places = kit.coordinates(obj)[ends]
    return inside(places[:, 0]) & inside(places[:, 1]) & inside(places.mean(axis=1))


def border(triangles):
    """The vertices of edges with one triangle."""
    ends = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    edges, count = np.unique(ends, axis=0, return_counts=True)
    return edges[count == 1]


def rows_of(places):
    return {tuple(row) for row in places.tolist()}


def on_rim(places, x0=0.0):
    x, y = places[:, 0] - x0, places[:, 1]
    return (np.abs(x) < 1e-6) | (np.abs(x - 1) < 1e-6) | (y < 1e-6) | (y > 1 - 1e-6)


def test_neighboring_tiles_still_meet():
    seams = []
    for x0 in (0.0, 1.0):
        kit.empty_scene()
        obj = sheet(x0=x0)
        before = kit.coordinates(obj)
        places, triangles = reduce(obj, **hold(obj, ~on_rim(before, x0)))
        rim = places[np.unique(border(triangles))]
        assert rows_of(before[on_rim(before, x0)]) == rows_of(rim)
        seams.append(rows_of(rim[np.abs(rim[:, 0] - 1.0) < 1e-6]))
    assert seams[0] == seams[1] and len(seams[0]) == N + 1


def test_a_straight_border_only_loses_vertices_on_its_lines():
    obj = sheet(height=0.0)
    before = kit.coordinates(obj)
    made = reduction.reduce(rebuilding.read(obj), before, 0.1, np.zeros(len(before), bool))
    outline = made.points[border(made.faces.corners.reshape(-1, 3))]
    assert on_rim(outline.reshape(-1, 3)).all() and on_rim(outline.mean(axis=1)).all()
    assert len(outline) < 0.5 * 4 * N
    far = np.abs(before[:, :2] - 0.5).min(axis=1) > 0.49
    assert rows_of(before[far].astype(float)) <= rows_of(made.points)
    lengths = np.linalg.norm(outline[:, 0] - outline[:, 1], axis=1)
    assert lengths.sum() == pytest.approx(4.0, abs=1e-6)
    # They are spread, not left in a heap.
    assert lengths.max() < 0.3


def test_vertices_without_mask_stay_in_every_bit():
    obj = sheet()
    before, triangles = kit.coordinates(obj), mesh_io.triangles(obj.data)
    free = np.linalg.norm(before[:, :2] - 0.5, axis=1) > 0.2
    free[[5 * (N + 1) + 4, 20 * (N + 1) + 20]] = False
    inside = {tuple(sorted(map(tuple, before[t].tolist()))) for t in triangles if not free[t].any()}
    places, triangles = reduce(obj, **hold(obj, free))
    assert rows_of(before[~free]) <= rows_of(places)
    assert inside <= {tuple(sorted(map(tuple, places[t].tolist()))) for t in triangles}
    assert len(places) < 0.5 * len(before)


MARKS = [("use_seam", True), ("use_edge_sharp", True), ("crease_edge", 0.75), ("bevel_weight_edge", 0.5)]


def read_marks(obj, name):
    mesh = obj.data
    values = np.zeros(len(mesh.edges), np.float32)
    if name.startswith("use"):
        flags = np.zeros(len(mesh.edges), bool)
        mesh.edges.foreach_get(name, flags)
        return flags.astype(np.float32)
    mesh.attributes[name].data.foreach_get("value", values)
    return values


@pytest.mark.parametrize(("name", "value"), MARKS)
def test_marks_stay_where_they_are(name, value):
    obj = sheet()
    marked = edges_where(obj, lambda p: (np.abs(p[:, 0] - 0.5) < 1e-6) & (p[:, 1] > 0.2))
    if name.startswith("use"):
        obj.data.edges.foreach_set(name, marked)
    else:
        values = np.where(marked, value, 0.0).astype(np.float32)
        obj.data.attributes.new(name, "FLOAT", "EDGE").data.foreach_set("value", values)
    before = kit.coordinates(obj)
    places, _ = reduce(obj)
    values = read_marks(obj, name)
    assert set(np.unique(values).tolist()) == {0.0, float(value)}
    ends = places[mesh_io.edges(obj.data)[values > 0]]
    # From the same end to the same end, along a part of the same vertices.
    lengths = np.linalg.norm(np.diff(ends[:, :, :2], axis=1)[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(marked.sum() / N, abs=0.01)
    assert 3 < len(lengths) < marked.sum()
    assert np.abs(ends[:, :, 0] - 0.5).max() < 0.01
    assert len(places) < 0.35 * len(before)


@pytest.mark.parametrize(("share", "stays"), [(1.0, False), (0.7, False), (0.1, True)])
def test_edges_that_are_mostly_sharp_are_flat_shading(share, stays):
    """As importers mark them where a file has a normal for each face."""
    obj = sheet()
    ends = mesh_io.edges(obj.data)
    sharp = np.random.default_rng(5).random(len(ends)) < share
    obj.data.edges.foreach_set("use_edge_sharp", sharp)
    before = len(mesh_io.triangles(obj.data))
    _, triangles = reduce(obj)
    assert (len(triangles) > 0.35 * before) is stays


def test_materials_keep_their_border():
    obj = sheet()
    for name in ("Field", "Road", "Pond"):
        obj.data.materials.append(bpy.data.materials.new(name))
    triangles = mesh_io.triangles(obj.data)
    middle = kit.coordinates(obj)[triangles].mean(axis=1)
    index = (
        np.where(middle[:, 0] > 0.5, 1, 0) + (np.linalg.norm(middle[:, :2] - [0.25, 0.5], axis=1) < 0.12) * 2
    )
    obj.data.polygons.foreach_set("material_index", index.astype(np.int32))
    before = np.array([area(kit.coordinates(obj)[triangles[index == k]]) for k in range(3)])
    places, triangles = reduce(obj, ratio=0.15)
    now = np.empty(len(triangles), np.int32)
    obj.data.polygons.foreach_get("material_index", now)
    assert np.allclose([area(places[triangles[now == k]]) for k in range(3)], before, atol=0.01)
    road = places[triangles[now == 1]]
    assert road[:, :, 0].min() > 0.49 and places[triangles[now != 1]][:, :, 0].max() < 0.51
    pond = border(triangles[now == 2])
    assert len(pond) == len(np.unique(pond)) >= 3


def area(corners):
    """The area of triangles (q, 3, 3) seen from above."""
    a, b = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    return float(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2)


@pytest.mark.parametrize("place", ["line", "patch"])
def test_islands_keep_their_shape_and_texture_does_not_smear(place):
    obj = sheet()
    mesh = obj.data
    triangles = mesh_io.triangles(mesh)
    middle = kit.coordinates(obj)[triangles].mean(axis=1)
    off = np.linalg.norm(middle[:, :2] - 0.5, axis=1)
    island = middle[:, 0] > 0.5 if place == "line" else off < 0.3
    flat = kit.coordinates(obj)[triangles.ravel()][:, :2]
    layout = flat * 0.4 + np.repeat(island, 3)[:, None] * [0.5, 0.3]
    mesh.uv_layers.new(name="UV").data.foreach_set("uv", layout.astype(np.float32).ravel())
    places, triangles = reduce(obj)
    layout = np.empty(6 * len(triangles), np.float32)
    mesh.uv_layers["UV"].data.foreach_get("uv", layout)
    layout = layout.reshape(-1, 3, 2)
    offset = layout - 0.4 * places[triangles][:, :, :2]
    first = np.round(offset[:, :1] / [0.5, 0.3])
    assert np.abs(offset - first * [0.5, 0.3]).max() < 0.01
    assert {tuple(row) for row in first.reshape(-1, 2).tolist()} == {(0.0, 0.0), (1.0, 1.0)}
    of_island = first[:, 0, 0] > 0
    truth = area(flat.reshape(-1, 3, 2)[island])
    assert area(places[triangles[of_island]]) == pytest.approx(truth, abs=0.01)


def test_half_a_mirrored_mesh_stays_closed():
    obj, before = half_ball()
    places, triangles = reduce(obj, ratio=0.2, steps=3, strength=0.5)
    rim = places[np.unique(border(triangles))]
    assert (rim[:, 0] == 0.0).all() and 8 < len(rim) <= (before[:, 0] == 0.0).sum()
    assert open_edges(obj) == 0


def test_without_anything_to_keep_it_is_plain_simplification():
    vertices, faces = shapes.icosphere(3)
    vertices = shapes.add_noise(vertices, faces, 0.1, seed=2)
    obj = kit.add_object("Ball", vertices, faces.tolist())
    wanted = round(0.3 * len(faces))
    places, triangles = reduce(obj, ratio=0.3, **hold(obj, np.arange(len(vertices)) >= 0))
    assert len(triangles) == wanted
    given = kit.add_object("Again", vertices, faces.tolist())
    points, made = fast_simplification.simplify(
        kit.coordinates(given).astype(float), faces.astype(np.int32), target_count=wanted
    )
    # The ball itself has moved a little before.
    assert len(made) == wanted and abs(len(points) - len(places)) <= 2


def test_where_many_holes_must_stay_a_hill_does_too():
    n = 60
    x, y = (np.indices((n + 1, n + 1)).reshape(2, -1)) / n
    height = 0.4 * np.exp(-50.0 * ((x - 0.5) ** 2 + (y - 0.5) ** 2))
    i, j = (part.ravel() for part in np.indices((n, n)))
    is_hole = (np.maximum(np.abs(i - n // 2), np.abs(j - n // 2)) > n // 3) & (i % 4 > 1) & (j % 4 > 1)
    a = ((n + 1) * i + j)[~is_hole]
    faces = np.concatenate([np.stack([a, a + n + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + 1], 1)])
    obj = kit.add_object("Sheet", np.stack([x, y, height], axis=1), faces.tolist())
    points, left = reduce(obj, ratio=0.05)
    # Fewer triangles than the rims of the holes need were asked for.
    assert 0.05 * len(faces) < len(left) < 0.3 * len(faces)
    assert points[:, 2].max() > 0.3


def test_what_cannot_be_reduced_is_said():
    obj = sheet()
    free = np.zeros(len(obj.data.vertices), bool)
    free[(N + 1) * 12 + 12] = True
    reduce(obj, **hold(obj, free))
    assert "all of their vertices must stay" in job.last_summary()[0]["warnings"][-1]
    kit.empty_scene()
    obj = sheet()
    obj.data.edges.foreach_set("use_seam", np.ones(len(obj.data.edges), bool))
    reduce(obj)
    assert "were asked for" in job.last_summary()[0]["warnings"][-1] or len(obj.data.polygons) == 2 * N * N


def test_locked_vertices_are_found_again():
    vertices, faces = shapes.icosphere(3)
    points = vertices + 5.0
    locked = np.random.default_rng(3).random(len(points)) < 0.2
    new, made, number = simplify.decimate(points, faces.astype(np.int64), locked, len(faces) // 3)
    assert np.array_equal(new[number[locked]], points[locked])
    assert (number[~locked] == -1).all()
    assert len(np.unique(number[locked])) == locked.sum() and set(np.unique(made)) == set(range(len(new)))


@pytest.mark.parametrize(
    ("vertices", "faces", "target"),
    [(*shapes.torus(64, 16, 1.0, 0.15), 20), (*limbs.ball_with_limbs()[:2], 20)],
)
def test_what_is_apart_is_not_tied_together(vertices, faces, target):
    as_given = fast_simplification.simplify(vertices, faces.astype(np.int32), target_count=target)
    locked = np.zeros(len(vertices), bool)
    locked[::400] = True
    points, triangles, number = simplify.decimate(vertices, faces.astype(np.int64), locked, target)
    assert tied(*as_given) > 0
    assert tied(points, triangles) == 0
    assert len(triangles) <= 3 * target
    assert np.array_equal(points[number[locked]], vertices[locked])
    halves = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    _, count = np.unique(np.sort(halves, axis=1), axis=0, return_counts=True)
    assert (count == 2).all()


def lattice(n=12, wall=2, gap=5, thickness=0.03):
    """The thin sides of a box with windows: what a reduction ties together in many places."""
    bpy.ops.mesh.primitive_cube_add(size=2)
    obj = bpy.context.object
    box = bmesh.new()
    box.from_mesh(obj.data)
    bmesh.ops.subdivide_edges(box, edges=box.edges, cuts=n - 1, use_grid_fill=True)

    def is_window(face):
        cells = sorted(face.calc_center_median(), key=abs)[:2]
        return all(wall <= (cell := int((x + 1) / 2 * n)) < n - wall and cell % gap >= wall for x in cells)

    bmesh.ops.delete(box, geom=[face for face in box.faces if is_window(face)], context="FACES")
    box.to_mesh(obj.data)
    box.free()
    obj.modifiers.new("Thick", "SOLIDIFY").thickness = thickness
    bpy.ops.object.modifier_apply(modifier="Thick")
    return kit.coordinates(obj).astype(float), mesh_io.triangles(obj.data)


@pytest.mark.parametrize(("ratio", "share"), [(0.12, 0.4), (0.05, 0.4)])
def test_what_must_stay_in_one_place_is_not_paid_for_in_another(ratio, share):
    thin, around = lattice()
    ball, triangles = shapes.icosphere(3)
    points = np.concatenate([thin, np.add(ball, [4.0, 0.0, 0.0])])
    faces = np.concatenate([around, triangles + len(thin)]).astype(np.int64)
    target = round(ratio * len(faces))
    free = np.zeros(len(points), bool)
    assert tied(*fast_simplification.simplify(points, faces.astype(np.int32), target_count=target)) > 0
    made, left, _ = simplify.decimate(points, faces, free, target)
    assert tied(made, left) == 0
    # The ball has its part of the triangles, although the lattice keeps more than it was to have.
    of_ball = made[left][:, :, 0].mean(axis=1) > 2.0
    assert of_ball.sum() >= share * ratio * len(triangles)
    assert np.abs(np.linalg.norm(made[left[of_ball]] - [4.0, 0.0, 0.0], axis=2) - 1.0).max() < 0.15
    area = (
        np.linalg.norm(np.cross(*np.diff(made[left[of_ball]], axis=1).transpose(1, 0, 2)), axis=1).sum() / 2
    )
    assert area == pytest.approx(4.0 * np.pi, rel=0.25)


def tied(points, triangles):
    """How many edges and vertices are none of a surface, and triangles twice there."""
    report = ridgeform.Mesh(points, triangles.astype(np.int32)).report
    return len(report.nonmanifold_edges) + len(report.nonmanifold_vertices) + len(report.duplicate_faces)


def test_a_collapse_must_not_fold_or_pinch():
    #  2---3---4     A strip of four triangles with two tips.
    #   \ / \ / \
    #    0---1---5
    points = np.array([[0, 0, 0], [1, 0, 0], [-0.5, 1, 0], [0.5, 1, 0], [1.5, 1, 0], [2, 0, 0]], float)
    faces = np.array([[0, 3, 2], [0, 1, 3], [1, 4, 3], [1, 5, 4]])
    assert not Fans(points, faces).collapse(0, 4)
    assert not Fans(points, faces).collapse(3, 1)
    fans = Fans(points, faces)
    assert fans.collapse(1, 0)
    assert [face for face in fans.faces if face is not None] == [[0, 3, 2], [0, 4, 3], [0, 5, 4]]
    tetrahedron = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    assert not Fans(np.eye(4)[:, :3], tetrahedron).collapse(0, 1)
    bent = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [1.5, 0.1, 0], [1.4, 0.9, 0]], float)
    assert not Fans(bent, np.array([[0, 1, 4], [1, 3, 4], [1, 2, 3]])).collapse(1, 2)


def test_weights_are_those_of_douglas_and_peucker():
    line = np.stack([np.arange(5.0), [0.0, 0.1, 1.0, 0.1, 0.0], np.zeros(5)], axis=1)
    weights = curves._weights(line)
    assert weights[[0, 4]].tolist() == [np.inf, np.inf]
    assert weights[2] == pytest.approx(1.0, abs=1e-5)
    assert weights[1] == weights[3] < 0.5
    straight = np.outer(np.linspace(0, 1, 9), [1.0, 2.0, 3.0])
    assert np.argsort(-curves._weights(straight)[1:-1], kind="stable")[:3].tolist() == [3, 1, 5]
    assert curves._weights(straight)[1:-1].max() <= curves.EXACT
