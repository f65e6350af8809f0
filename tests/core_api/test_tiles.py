"""Meshes in blocks come out as in one piece, without seams, whoever works on the blocks."""

import re
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes, tiled_city
from known_shapes.segment_shapes import adjusted_rand_index
from ridgeform import tiles

HALF = {"movement": 0.007, "flat_share": 0.5, "fidelity": 10**6.55, "scale": "area", "sharpness": 0.75}
"""The settings of the add-on at half strength."""

SMALL = {"max_vertices": 1200, "rings": 8}


@pytest.fixture(scope="module")
def noisy_cube():
    """A dense cube with noise of a fifth of an edge."""
    vertices, faces = shapes.cube(30)
    return shapes.add_noise(vertices, faces, 0.2), faces


@pytest.fixture(scope="module")
def in_blocks(noisy_cube):
    """What becomes of it in blocks."""
    return tiles.stylize(*noisy_cube, **HALF, **SMALL)


def off(vertices):
    return shapes.root_mean_square(shapes.distance_to_cube(vertices))


def test_a_noisy_cube_in_blocks_is_as_flat_as_in_one_piece(noisy_cube, in_blocks):
    whole = ridgeform.stylize(ridgeform.Mesh(*noisy_cube), coarse_to_fine=True, **HALF)
    assert in_blocks.n_blocks[0] > 3
    assert in_blocks.n_blocks[-1] == 1
    assert in_blocks.level_vertices[-2:].tolist() == [len(noisy_cube[0])] * 2
    assert len(in_blocks.energy) == len(in_blocks.level_vertices) + 1
    assert in_blocks.energy[0] == pytest.approx(whole.energy[0], rel=1e-2)
    assert in_blocks.energy[-1] < 1.1 * whole.energy[-1]
    assert off(in_blocks.vertices) < 1.25 * off(whole.vertices)


def test_no_seam_is_to_be_seen(noisy_cube, in_blocks):
    vertices, faces = noisy_cube
    labels = tiles._cut.bisect(vertices, in_blocks.n_blocks[0])
    crossing = (labels[faces] != labels[faces][:, :1]).any(axis=1)
    near = np.isin(faces, faces[crossing]).any(axis=1)
    mesh = ridgeform.Mesh(in_blocks.vertices, faces)
    areas = tiles._tasks.areas(in_blocks.vertices, faces)
    bend = ridgeform.hessian_norm(mesh, in_blocks.vertices) * areas
    density = [bend[where].sum() / areas[where].sum() for where in (near, ~near)]
    assert density[0] < 1.3 * density[1]


def test_one_block_is_the_whole_mesh(noisy_cube):
    given = {**HALF, "scale": 5.0}
    alone = tiles.stylize(*noisy_cube, **given)
    assert alone.n_blocks == [1]
    whole = ridgeform.stylize(ridgeform.Mesh(*noisy_cube), coarse_to_fine=False, **given)
    assert np.array_equal(alone.vertices, whole.vertices)
    assert alone.status == whole.status


def test_processes_leave_the_same_bits(noisy_cube, in_blocks, tmp_path):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        result = tiles.stylize(*noisy_cube, **HALF, **SMALL, executor=pool, folder=tmp_path)
    assert np.array_equal(result.vertices, in_blocks.vertices)
    assert np.array_equal(result.energy, in_blocks.energy)
    assert list(tmp_path.iterdir()) == []


def test_held_vertices_keep_every_bit_and_masks_hold_in_all_blocks(noisy_cube):
    vertices, faces = noisy_cube
    fixed = vertices[:, 0] > 0.1
    strength = np.where(vertices[:, 1] > 0.5, 0.0, 1.0)
    ridges = np.ones(len(faces))
    result = tiles.stylize(
        vertices, faces, **HALF, **SMALL, fixed=fixed, strength=strength, ridge_weights=ridges
    )
    still = fixed | (strength == 0.0)
    assert np.array_equal(result.vertices[still], vertices[still])
    assert (result.vertices[~still] != vertices[~still]).any(axis=1).mean() > 0.99
    by_index = tiles.stylize(vertices, faces, **HALF, **SMALL, fixed=np.flatnonzero(still))
    assert np.array_equal(by_index.vertices[still], vertices[still])


def test_segments_across_blocks_are_one():
    vertices, faces = shapes.cube(30)
    noisy = shapes.add_noise(vertices, faces, 0.05)
    found = tiles.segment(noisy, faces, **SMALL)
    assert found.n_blocks > 3
    assert found.n_segments == 6
    middle = vertices[faces].mean(axis=1)
    side = np.argmax(np.abs(middle), axis=1) * 2 + (
        np.take_along_axis(middle, np.argmax(np.abs(middle), axis=1)[:, None], 1)[:, 0] > 0
    )
    assert adjusted_rand_index(found.labels, side) > 0.98
    whole = ridgeform.segment(ridgeform.Mesh(noisy, faces), coarse_to_fine=False)
    assert found.noise == pytest.approx(whole.noise, rel=0.01)


def test_adjoining_tiles_stay_together_bit_by_bit(noisy_cube, tmp_path):
    vertices, faces = noisy_cube
    side = (vertices[faces].mean(axis=1)[:, 0] > 0.13).astype(int)
    (tmp_path / "in").mkdir()
    for i, kind in enumerate(("npz", "obj")):
        own = faces[side == i]
        used, corners = np.unique(own, return_inverse=True)
        corners = corners.reshape(-1, 3)
        if kind == "npz":
            np.savez(tmp_path / "in/a.npz", vertices=vertices[used], faces=corners, extra=np.arange(3))
            continue
        lines = ["mtllib city.mtl"] + [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices[used].tolist()]
        lines += [f"f {a}/1 {b}/1 {c}/1" for a, b, c in (corners + 1).tolist()]
        (tmp_path / "in/b.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
    city = tiles.read(tmp_path / "in")
    assert len(city.vertices) == len(vertices)
    assert len(city.faces) == len(faces)
    result = tiles.stylize(city.vertices, city.faces, **HALF, **SMALL)
    labels = np.arange(len(city.faces))
    written = city.write(tmp_path / "out", result.vertices, labels)
    assert [path.name for path in written] == ["a.npz", "b.obj"]
    again = tiles.read(tmp_path / "out")
    assert np.array_equal(again.vertices, result.vertices)
    assert np.array_equal(again.faces, city.faces)
    with np.load(written[0]) as kept:
        assert kept["extra"].tolist() == [0, 1, 2]
        assert np.array_equal(kept["labels"], labels[: city.starts[1]])
    assert written[1].read_text(encoding="utf-8").startswith("mtllib city.mtl\nv ")
    with pytest.raises(ridgeform.ArgumentError, match=r"a\.npz is there already"):
        city.write(tmp_path / "out", result.vertices)


def test_a_length_is_a_scale(noisy_cube):
    mesh = ridgeform.Mesh(*noisy_cube)
    longest = float(np.ptp(mesh.vertices, axis=0).max())
    one = ridgeform.stylize(mesh, iterations=1, scale="bounding_box", fidelity=1e5)
    other = ridgeform.stylize(mesh, iterations=1, scale=longest, fidelity=1e5)
    assert np.array_equal(one.vertices, other.vertices)
    assert one.fidelities.tolist() == [1e5]
    with pytest.raises(ridgeform.ArgumentError, match="scale: is -1"):
        ridgeform.stylize(mesh, scale=-1.0)
    with pytest.raises(TypeError, match="scale: expected a word or a length, got list"):
        ridgeform.stylize(mesh, scale=[1.0])


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"executor": 3}, r"executor: a int has no submit\(\)"),
        ({"max_vertices": 5}, "max_vertices: is 5; give a whole number of at least 100"),
        ({"rings": 0}, "rings: is 0"),
        ({"strength": [1.0]}, "strength: expected"),
        ({"fixed": [10**6]}, "fixed: index 1000000 is out of range"),
        ({"scale": "mile"}, 'scale: "mile" is not known here'),
        ({"folder": "/nowhere/at/all"}, "folder: /nowhere/at/all cannot be written to"),
    ],
)
def test_errors_name_the_culprit(noisy_cube, given, says):
    with pytest.raises(ridgeform.ArgumentError, match=says):
        tiles.stylize(*noisy_cube, **given)


def test_meshes_that_are_none_are_refused():
    triangle = np.eye(3)
    with pytest.raises(ridgeform.ArgumentError, match="faces: face 0 names vertices"):
        tiles.stylize(triangle, [[0, 1, 3]])
    with pytest.raises(ridgeform.ArgumentError, match="vertices: row 1 is not finite"):
        tiles.segment([[0, 0, 0], [np.nan, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    with pytest.raises(ridgeform.MeshError, match="no face of the mesh has an area"):
        tiles.segment(np.zeros((3, 3)), [[0, 1, 2]])
    with pytest.raises(ridgeform.MeshError, match="no faces"):
        tiles.stylize(triangle, np.zeros((0, 3), int))


def test_a_city_of_tiles_is_segmented_as_in_one_piece(tmp_path):
    made = tiled_city.city(2)
    tiled_city.write_tiles(made, tmp_path, 2)
    city = tiles.read(tmp_path)
    assert len(city.vertices) == len(made.vertices)
    truth = np.concatenate([np.load(path)["truth"] for path in city.paths])
    found = tiles.segment(city.vertices, city.faces, scale=30.0, max_vertices=5000)
    assert found.n_segments == len(np.unique(truth)) == 25
    assert adjusted_rand_index(found.labels, truth) > 0.99


def test_the_python_of_the_manual_runs(tmp_path, monkeypatch):
    """As it is written; of the two ways to several workers the one that needs no Dask."""
    page = Path(__file__).parents[2] / "docs/manual_tiles.md"
    code = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    monkeypatch.chdir(tmp_path)
    tiled_city.write_tiles(tiled_city.city(2), tmp_path / "city", 2)
    names = {}
    exec(code[0], names)
    assert sorted(path.name for path in (tmp_path / "city_flat").iterdir()) == [
        f"tile_{a}_{b}.npz" for a in range(2) for b in range(2)
    ]
    alone = names["result"].vertices
    assert "ProcessPoolExecutor(4)" in code[1]
    names["spawn"] = get_context("spawn")
    exec(code[1].replace("ProcessPoolExecutor(4)", "ProcessPoolExecutor(2, mp_context=spawn)"), names)
    np.testing.assert_array_equal(names["result"].vertices.shape, alone.shape)
    assert len(code) == 3 and "distributed" in code[2]
