"""Denoising and interpolating values that jump: both sides stay apart, each as if the other was not there."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import attribute_io, mesh_io
from bl_ext.user_default.ridgeform.framework import job

N = 24


def sheet():
    x, y = np.meshgrid(np.linspace(0, 1, N + 1), np.linspace(0, 1, N + 1), indexing="ij")
    a = ((N + 1) * np.arange(N)[:, None] + np.arange(N)).ravel()
    b, c, d = a + N + 1, a + N + 2, a + 1
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return kit.add_object("Sheet", np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1), faces.tolist())


def paint(obj, truth, noise, data_type="FLOAT"):
    """Store values (n, c) with noise in an attribute "Paint"."""
    prop, dtype, size = attribute_io.ATTRIBUTE_KINDS[data_type]
    noisy = truth + noise * np.random.default_rng(0).normal(size=truth.shape)
    if size == 4:
        noisy = np.concatenate([np.clip(noisy, 0, 1), np.ones((len(noisy), 1))], axis=1)
    obj.data.attributes.new("Paint", data_type, "POINT").data.foreach_set(prop, noisy.astype(dtype).ravel())


def denoised(obj, **settings):
    given = {"attribute": "Paint", "display": "NONE", "strength": 0.6} | settings
    assert bpy.ops.ridgeform.denoise_attribute(**given) == {"FINISHED"}
    return attribute_io.read_values(obj, "Paint_denoised").values


def error(values, truth):
    return float(np.sqrt(((values[:, : truth.shape[1]] - truth) ** 2).mean()))


SHAPES = {
    "line": lambda x, y: x > 0.52,
    "disk": lambda x, y: np.hypot(x - 0.5, y - 0.5) < 0.3,
    "corner": lambda x, y: (x > 0.4) & (y > 0.6),
    "stripes": lambda x, y: np.floor(4 * x) % 2 > 0,
    "slope beside it": lambda x, y: np.where(x > 0.52, 1.5, 0.4 * y),
}


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("energy", ["l1_hessian", "l2_hessian"])
def test_the_sides_of_a_jump_stay_apart(shape, energy):
    obj = sheet()
    x, y, _ = kit.coordinates(obj).astype(float).T
    truth = SHAPES[shape](x, y).astype(float)[:, None]
    paint(obj, truth, 0.05)
    without = error(denoised(obj, energy=energy), truth)
    kept = error(denoised(obj, energy=energy, use_jumps=True, jump=0.4), truth)
    assert kept < (0.025 if energy == "l1_hessian" else 0.035) and kept < 0.5 * without
    assert "kept apart" in job.last_summary()[0]["warnings"][0]


@pytest.mark.parametrize("data_type", ["FLOAT_COLOR", "BYTE_COLOR"])
def test_colors_stay_apart(data_type):
    obj = sheet()
    x, _, _ = kit.coordinates(obj).astype(float).T
    truth = np.where(x[:, None] > 0.5, [0.8, 0.2, 0.1], [0.1, 0.3, 0.8])
    paint(obj, truth, 0.03, data_type)
    without = error(denoised(obj), truth)
    kept = error(denoised(obj, use_jumps=True), truth)
    assert kept < 0.02 and kept < 0.5 * without


def test_each_side_is_denoised_as_if_the_other_was_not_there():
    obj = sheet()
    x, _, _ = kit.coordinates(obj).astype(float).T
    paint(obj, (x > 0.52).astype(float)[:, None], 0.05)
    noisy = attribute_io.read_values(obj, "Paint").values[:, 0].astype(float)
    values = denoised(obj, use_fidelity=True, fidelity=1000.0, use_jumps=True)[:, 0]
    triangles = mesh_io.triangles(obj.data)
    side = x > 0.52
    left = triangles[(side[triangles] == side[triangles][:, :1]).all(axis=1)]
    mesh = ridgeform.Mesh(kit.coordinates(obj).astype(float), left)
    wanted = ridgeform.denoise(mesh, noisy, fidelity=1000.0).values
    assert np.array_equal(values, wanted.astype(np.float32))


def test_vertices_with_jumps_all_around_keep_their_values():
    obj = sheet()
    values = np.zeros((len(obj.data.vertices), 1))
    values[12 * (N + 1) + 12] = 1.0
    paint(obj, values, 0.01)
    before = attribute_io.read_values(obj, "Paint").values
    after = denoised(obj, use_jumps=True)
    assert after[12 * (N + 1) + 12] == before[12 * (N + 1) + 12]


def test_jumps_everywhere_and_nowhere_are_said():
    obj = sheet()
    x, _, _ = kit.coordinates(obj).astype(float).T
    paint(obj, x[:, None], 0.0)
    denoised(obj, use_jumps=True)
    assert "jump nowhere" in job.last_summary()[0]["warnings"][0]
    with pytest.raises(RuntimeError, match="jumps everywhere"):
        denoised(obj, use_jumps=True, jump=0.001)


def interpolated(obj, unknown, **settings):
    kit.select_only(obj, unknown)
    bpy.ops.object.mode_set(mode="OBJECT")
    given = {"attribute": "Paint", "display": "NONE", "known": "UNSELECTED"} | settings
    assert bpy.ops.ridgeform.interpolate_attribute(**given) == {"FINISHED"}
    return attribute_io.read_values(obj, "Paint_interpolated").values


@pytest.mark.parametrize("energy", ["l1_hessian", "l2_curved_hessian"])
def test_what_is_filled_in_beside_a_jump_does_not_see_the_other_side(energy):
    obj = sheet()
    x, y, _ = kit.coordinates(obj).astype(float).T
    side = x > 0.52
    truth = np.where(side, 1.5 + 0.3 * y, 0.4 * y)[:, None]
    paint(obj, truth, 0.0)
    # One row of vertices is left of the right side, beside the jump.
    hole = (x > 0.56) & (x < 0.8) & (np.abs(y - 0.5) < 0.2)
    triangles = mesh_io.triangles(obj.data)
    left = triangles[(side[triangles] == side[triangles][:, :1]).all(axis=1)]
    known = np.flatnonzero(~hole)
    mesh = ridgeform.Mesh(kit.coordinates(obj).astype(float), left)
    noted = attribute_io.read_values(obj, "Paint").values[:, 0].astype(float)
    options = {"energy": energy, "tolerance": float(np.float32(0.001))}
    wanted = ridgeform.interpolate(mesh, known, noted[known], **options).values
    values = interpolated(obj, hole, energy=energy, use_jumps=True)
    assert np.array_equal(values[:, 0], wanted.astype(np.float32))
    assert error(values[hole], truth[hole]) < 0.01
    assert error(values[hole], truth[hole]) < 0.5 * error(
        interpolated(obj, hole, energy=energy)[hole], truth[hole]
    )


def test_a_gap_across_a_jump_is_filled_from_both_sides():
    obj = sheet()
    x, y, _ = kit.coordinates(obj).astype(float).T
    paint(obj, (x > 0.52).astype(float)[:, None], 0.0)
    hole = np.hypot(x - 0.5, y - 0.5) < 0.15
    values = interpolated(obj, hole, use_jumps=True)
    assert np.isfinite(values).all()
    assert values.min() > -0.1 and values.max() < 1.1
    assert np.array_equal(values[~hole], attribute_io.read_values(obj, "Paint").values[~hole])


def test_only_known_values_jump():
    obj = sheet()
    x, _, _ = kit.coordinates(obj).astype(float).T
    truth = x[:, None].copy()
    hole = np.hypot(*(kit.coordinates(obj)[:, :2].astype(float) - 0.5).T) < 0.2
    truth[hole] = np.nan
    paint(obj, truth, 0.0)
    interpolated(obj, hole, use_jumps=True)
    assert "jump nowhere" in job.last_summary()[0]["warnings"][0]
