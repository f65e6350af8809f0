"""Denoising and interpolating attributes: every type and domain gives what the wheel gives."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.attributes.denoise import fidelity_for
from bl_ext.user_default.ridgeform.attributes.settings import (
    ENERGIES,
    DenoiseSettings,
    InterpolateSettings,
    solve_options,
)
from bl_ext.user_default.ridgeform.blender import attribute_io, mesh_io
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.framework.settings import defaults_of
from bl_ext.user_default.ridgeform.framework.shared_settings import ridge_weights_of

KINDS = [
    ("FLOAT", "POINT"),
    ("FLOAT2", "POINT"),
    ("FLOAT_VECTOR", "POINT"),
    ("FLOAT_COLOR", "POINT"),
    ("FLOAT_COLOR", "CORNER"),
    ("BYTE_COLOR", "POINT"),
    ("BYTE_COLOR", "CORNER"),
    ("GROUP", "POINT"),
]
BYTE = 1.0 / 255.0
ENERGY_NAMES = [name for name, *_ in ENERGIES]


def add_values(obj, data_type, domain, name="heat", seed=0):
    """Give a mesh values with a crease and noise; returns them as stored, a row a vertex."""
    x = kit.coordinates(obj).astype(float)
    noise = np.random.default_rng(seed).normal(scale=0.05, size=(len(x), 4))
    base = np.stack([np.abs(x[:, 0]), x[:, 1], np.maximum(x[:, 2], 0), np.abs(x[:, 2])], axis=1)
    values = np.clip(0.3 + 0.2 * base + noise, 0.01, 0.99)
    if data_type == "GROUP":
        group = obj.vertex_groups.new(name=name)
        for vertex, weight in enumerate(values[:, 0]):
            group.add([vertex], weight, "REPLACE")
    else:
        prop, _, size = attribute_io.ATTRIBUTE_KINDS[data_type]
        values = values[:, :size]
        if size == 4:
            values[:, 3] = 1.0
        stored = values[corner_vertices(obj.data)] if domain == "CORNER" else values
        attribute = obj.data.attributes.new(name, data_type, domain)
        attribute.data.foreach_set(prop, stored.astype(np.float32).ravel())
    return attribute_io.read_values(obj, name).values


def corner_vertices(mesh):
    return np.array([loop.vertex_index for loop in mesh.loops])


def values_of(obj, name):
    return attribute_io.read_values(obj, name).values


def mesh_of(obj):
    return ridgeform.Mesh(kit.coordinates(obj).astype(np.float64), mesh_io.triangles(obj.data))


def float32_settings(cls, **changes):
    """Settings with the numbers as Blender stores them in operators."""
    settings = defaults_of(cls, **changes)
    for name, value in vars(settings).items():
        if isinstance(value, float):
            setattr(settings, name, float(np.float32(value)))
    return settings


def denoised(mesh, values, **changes):
    """What the wheel makes of values (n, k) with the settings of the operator; alpha 1 stays 1."""
    solve = {key: changes.pop(key) for key in ("fixed", "face_weights") if key in changes}
    settings = float32_settings(DenoiseSettings, **changes)
    columns = (values != values[0]).any(axis=0)
    given = values[:, columns].astype(np.float64)
    fidelity = (
        settings.fidelity
        if settings.use_fidelity
        else fidelity_for(mesh, given, settings.strength, settings.energy)
    )
    solution = ridgeform.denoise(
        mesh,
        given if given.shape[1] > 1 else given[:, 0],
        fidelity=fidelity,
        **solve,
        **solve_options(settings),
    )
    result = values.copy()
    result[:, columns] = solution.values.reshape(given.shape)
    return result


def interpolated(mesh, values, known, **changes):
    """What the wheel makes of the known rows of values (n, k)."""
    settings = float32_settings(InterpolateSettings, **changes)
    columns = (values[known] != values[known][0]).any(axis=0)
    given = values[known][:, columns].astype(np.float64)
    solution = ridgeform.interpolate(
        mesh, np.flatnonzero(known), given if given.shape[1] > 1 else given[:, 0], **solve_options(settings)
    )
    result = np.repeat(values[known][:1], len(values), axis=0)
    result[:, columns] = solution.values.reshape(len(values), -1)
    return result


def select_in_object_mode(obj, mask):
    kit.select_only(obj, mask)
    bpy.ops.object.mode_set(mode="OBJECT")


def box_with_selection(data_type, domain, axis, above):
    """A box in Edit Mode with values, these, and which vertices are selected: those above a coordinate."""
    obj = kit.bumpy_box()
    before = add_values(obj, data_type, domain)
    chosen = kit.coordinates(obj)[:, axis] > above
    kit.select_only(obj, chosen)
    return obj, before, chosen


def found_in_edit_mode(obj, outcome):
    """The values once an operator has ended in Edit Mode, which it leaves the object in."""
    assert outcome == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    return values_of(obj, "heat")


def close(data_type, found, expected):
    """Equal bits, but for bytes, which Blender rounds in the space of the screen."""
    if data_type == "BYTE_COLOR":
        return np.abs(found - expected).max() < 3 * BYTE
    return kit.same_bits(found, np.clip(expected, 0, 1).astype(np.float32))


@pytest.mark.parametrize(("data_type", "domain"), KINDS)
def test_denoising_gives_what_the_wheel_gives(data_type, domain):
    obj = kit.bumpy_box()
    before = add_values(obj, data_type, domain)
    assert bpy.ops.ridgeform.denoise_attribute(attribute="heat", strength=0.7) == {"FINISHED"}
    expected = denoised(mesh_of(obj), before, strength=0.7)
    found = values_of(obj, "heat_denoised")
    assert close(data_type, found, expected)
    assert np.abs(found - before).max() > 0.01
    assert kit.same_bits(values_of(obj, "heat"), before)
    if data_type != "GROUP":
        made = obj.data.attributes["heat_denoised"]
        assert (made.data_type, made.domain) == (data_type, domain)


@pytest.mark.parametrize(("data_type", "domain"), KINDS)
def test_interpolating_from_the_selection(data_type, domain):
    obj = kit.bumpy_box()
    before = add_values(obj, data_type, domain)
    known = np.random.default_rng(5).random(len(before)) < 0.2
    select_in_object_mode(obj, known)
    assert bpy.ops.ridgeform.interpolate_attribute(attribute="heat") == {"FINISHED"}
    expected = interpolated(mesh_of(obj), before, known)
    found = values_of(obj, "heat_interpolated")
    assert kit.same_bits(found[known], before[known])
    assert close(data_type, found[~known], expected[~known])
    assert kit.same_bits(values_of(obj, "heat"), before)


@pytest.mark.parametrize(("data_type", "domain"), KINDS)
def test_filling_the_selection_in_edit_mode(data_type, domain):
    obj, before, hole = box_with_selection(data_type, domain, axis=2, above=0.8)
    outcome = bpy.ops.ridgeform.interpolate_attribute(
        attribute="heat", known="UNSELECTED", output="IN_PLACE", sharpness=0.5
    )
    found = found_in_edit_mode(obj, outcome)
    assert kit.same_bits(found[~hole], before[~hole])
    assert close(data_type, found[hole], interpolated(mesh_of(obj), before, ~hole, sharpness=0.5)[hole])
    assert np.abs(found[hole] - before[hole]).max() > 0.01
    assert (mesh_io.selected_vertices(obj.data) == hole).all()


@pytest.mark.parametrize(("data_type", "domain"), KINDS)
def test_denoising_the_selection_in_edit_mode(data_type, domain):
    obj, before, chosen = box_with_selection(data_type, domain, axis=0, above=0.1)
    found = found_in_edit_mode(obj, bpy.ops.ridgeform.denoise_attribute(attribute="heat", output="IN_PLACE"))
    assert kit.same_bits(found[~chosen], before[~chosen])
    assert close(data_type, found[chosen], denoised(mesh_of(obj), before, fixed=~chosen)[chosen])
    assert (found[chosen] != before[chosen]).any()


@pytest.mark.parametrize("energy", ENERGY_NAMES)
def test_every_energy_reaches_the_wheel(energy):
    obj = kit.bumpy_box()
    before = add_values(obj, "FLOAT_VECTOR", "POINT")
    known = np.random.default_rng(5).random(len(before)) < 0.2
    select_in_object_mode(obj, known)
    # What an energy does not have is left out for it, not refused.
    chosen = {"energy": energy, "sharpness": 0.5, "dual": "circumcentric", "solver": "fast", "delaunay": True}
    for operator in (bpy.ops.ridgeform.denoise_attribute, bpy.ops.ridgeform.interpolate_attribute):
        assert operator(attribute="heat", **chosen) == {"FINISHED"}
    expected = denoised(mesh_of(obj), before, **chosen)
    assert kit.same_bits(values_of(obj, "heat_denoised"), expected.astype(np.float32))
    expected = np.where(known[:, None], before, interpolated(mesh_of(obj), before, known, **chosen))
    assert kit.same_bits(values_of(obj, "heat_interpolated"), expected.astype(np.float32))


def test_known_points_are_the_members_of_a_group():
    obj = kit.bumpy_box()
    before = add_values(obj, "FLOAT", "POINT")
    known = np.arange(len(before)) % 7 == 0
    obj.vertex_groups.new(name="pins").add(np.flatnonzero(known).tolist(), 0.0, "REPLACE")
    bpy.ops.ridgeform.interpolate_attribute(attribute="heat", known="GROUP", known_group="pins")
    expected = interpolated(mesh_of(obj), before, known)
    assert close("FLOAT", values_of(obj, "heat_interpolated"), np.where(known[:, None], before, expected))


def test_a_group_is_spread_from_its_own_members():
    obj = kit.bumpy_box()
    x = kit.coordinates(obj)
    group = obj.vertex_groups.new(name="paint")
    low, high = np.flatnonzero(x[:, 2] < -0.8), np.flatnonzero(x[:, 2] > 0.8)
    group.add(low.tolist(), 0.2, "REPLACE")
    group.add(high.tolist(), 0.9, "REPLACE")
    assert bpy.ops.ridgeform.interpolate_attribute(known="GROUP", output="IN_PLACE") == {"FINISHED"}
    found = attribute_io.read_values(obj, "paint")
    assert found.member.all()
    assert np.allclose(found.values[low], 0.2)
    middle = (x[:, 2] > -0.5) & (x[:, 2] < 0.5)
    assert ((found.values[middle] > 0.15) & (found.values[middle] < 0.95)).all()


def test_settings_and_ridge_paint_reach_the_wheel():
    obj = kit.bumpy_box()
    before = add_values(obj, "FLOAT_VECTOR", "POINT")
    painted = np.flatnonzero(kit.coordinates(obj)[:, 1] > 0.3)
    obj.vertex_groups.new(name="ridges").add(painted.tolist(), 1.0, "REPLACE")
    chosen = {
        "use_fidelity": True, "fidelity": 70.0, "sharpness": 0.5, "coupling": "separate",
        "dual": "circumcentric", "solver": "fast", "tolerance": 0.01,
    }  # fmt: skip
    bpy.ops.ridgeform.denoise_attribute(attribute="heat", ridge_group="ridges", avoid_ridges=True, **chosen)
    paint = np.isin(np.arange(len(before)), painted).astype(float)
    weights = ridge_weights_of(paint, mesh_io.triangles(obj.data), avoid=True)
    expected = denoised(mesh_of(obj), before, face_weights=weights, **chosen)
    assert kit.same_bits(values_of(obj, "heat_denoised"), expected.astype(np.float32))


@pytest.mark.parametrize("energy", ENERGY_NAMES)
def test_strength_means_the_same_for_every_size_and_unit(energy):
    obj = kit.bumpy_box()
    before = add_values(obj, "FLOAT", "POINT")
    bpy.ops.ridgeform.denoise_attribute(attribute="heat", energy=energy)
    small = values_of(obj, "heat_denoised")
    kit.set_coordinates(obj, 100 * kit.coordinates(obj))
    obj.data.attributes["heat"].data.foreach_set("value", (1000 * before).ravel())
    bpy.ops.ridgeform.denoise_attribute(attribute="heat", energy=energy)
    assert np.allclose(values_of(obj, "heat_denoised"), 1000 * small, rtol=1e-3)


@pytest.mark.parametrize("energy", ENERGY_NAMES)
def test_more_strength_smooths_more(energy):
    obj = kit.bumpy_box()
    before = add_values(obj, "FLOAT", "POINT")
    moved = []
    for strength in (0.0, 0.3, 0.5, 0.7, 1.0):
        bpy.ops.ridgeform.denoise_attribute(attribute="heat", strength=strength, energy=energy)
        moved.append(float(np.abs(values_of(obj, "heat_denoised") - before).mean()))
    assert moved == sorted(moved)
    assert moved[0] < 1e-3
    assert moved[-1] > 0.02


def test_denoising_comes_closer_to_the_truth():
    obj = kit.bumpy_box(cuts=15, noise=0.0)
    truth = np.abs(kit.coordinates(obj)[:, :1].astype(float))
    noisy = truth + np.random.default_rng(2).normal(scale=0.2 * truth.std(), size=truth.shape)
    obj.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set(
        "value", noisy.astype(np.float32).ravel()
    )
    bpy.ops.ridgeform.denoise_attribute(attribute="heat")
    off = np.abs(values_of(obj, "heat_denoised") - truth).mean()
    assert off < 0.4 * np.abs(noisy - truth).mean()


def test_the_active_attribute_is_taken_and_results_are_no_sources():
    obj = kit.bumpy_box()
    add_values(obj, "FLOAT", "POINT", "first")
    before = add_values(obj, "FLOAT", "POINT", "second", seed=4)
    obj.data.attributes.active_index = obj.data.attributes.find("second")
    for _ in range(2):
        bpy.ops.ridgeform.denoise_attribute()
        assert job.last_summary()[0]["attribute"] == "second"
    names = {attribute.name for attribute in obj.data.attributes}
    assert "second_denoised" in names
    assert "second_denoised_denoised" not in names
    assert kit.same_bits(values_of(obj, "second"), before)


def test_several_objects_and_linked_duplicates():
    first, second = kit.bumpy_box("A", seed=1), kit.bumpy_box("B", seed=2)
    third = kit.bumpy_box("C", seed=3)
    first.select_set(True)
    second.select_set(True)
    kit.link(bpy.data.objects.new("Twin", first.data))
    for obj in (first, second):
        add_values(obj, "FLOAT", "POINT", seed=len(obj.name))
    assert bpy.ops.ridgeform.denoise_attribute(attribute="heat") == {"FINISHED"}
    assert {entry["name"] for entry in job.last_summary()} <= {"A", "B", "Twin"}
    assert len(job.last_summary()) == 2
    for obj in (first, second):
        assert close("FLOAT", values_of(obj, "heat_denoised"), denoised(mesh_of(obj), values_of(obj, "heat")))
    assert "heat_denoised" not in third.data.attributes


def test_seams_are_held_together():
    vertices = np.array([[x, y, 0.0] for x in range(5) for y in range(5)], float)
    quads = [[5 * x + y, 5 * x + 5 + y, 5 * x + 6 + y, 5 * x + 1 + y] for x in range(4) for y in range(4)]
    split = np.concatenate([vertices, vertices[10:15]])
    left = [[v + 15 if 10 <= v < 15 else v for v in quad] if min(quad) >= 10 else quad for quad in quads]
    obj = kit.add_object("Split", split, left)
    values = np.random.default_rng(0).random(30)
    values[25:] = values[10:15]
    obj.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", values.astype(np.float32))
    bpy.ops.ridgeform.denoise_attribute(attribute="heat", strength=0.8)
    found = values_of(obj, "heat_denoised")
    assert kit.same_bits(found[25:], found[10:15])
    assert np.abs(found[:, 0] - values).max() > 0.05


def test_parts_without_a_known_value_stay():
    box = kit.bumpy_box()
    vertices, faces = kit.coordinates(box), [list(face.vertices) for face in box.data.polygons]
    n = len(vertices)
    obj = kit.add_object(
        "Two",
        np.concatenate([vertices, vertices + 5, [[9, 9, 9]]]),
        faces + [[v + n for v in f] for f in faces],
    )
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    before = add_values(obj, "FLOAT", "POINT")
    known = np.zeros(2 * n + 1, bool)
    known[[0, 30, 77, 101]] = True
    select_in_object_mode(obj, known)
    bpy.ops.ridgeform.interpolate_attribute(attribute="heat")
    found = values_of(obj, "heat_interpolated")
    assert kit.same_bits(found[n:], before[n:])
    assert (found[:n] != before[:n]).any()
    assert job.last_summary()[0]["warnings"] == ["1 connected parts without a known value stay as they are"]


def test_a_value_that_is_to_be_filled_in_may_be_anything():
    obj = kit.bumpy_box()
    add_values(obj, "FLOAT", "POINT")
    hole = kit.coordinates(obj)[:, 2] > 0.8
    values = values_of(obj, "heat")
    values[hole] = np.nan
    obj.data.attributes["heat"].data.foreach_set("value", values.ravel())
    select_in_object_mode(obj, hole)
    bpy.ops.ridgeform.interpolate_attribute(attribute="heat", known="UNSELECTED")
    assert np.isfinite(values_of(obj, "heat_interpolated")).all()


def test_values_beyond_the_range_of_weights_are_limited_and_said():
    obj = kit.bumpy_box()
    x = kit.coordinates(obj)
    group = obj.vertex_groups.new(name="paint")
    known = (x[:, 2] > -0.3) & (x[:, 2] < 0.3)
    for vertex in np.flatnonzero(known).tolist():
        group.add([vertex], float(np.clip(0.5 + 1.5 * x[vertex, 2], 0, 1)), "REPLACE")
    bpy.ops.ridgeform.interpolate_attribute(known="GROUP", output="IN_PLACE")
    weights = values_of(obj, "paint")
    assert weights.min() == 0.0
    assert weights.max() == 1.0
    assert "were clamped to their valid range" in job.last_summary()[0]["warnings"][0]


def test_long_names_find_their_result_again():
    obj = kit.bumpy_box()
    name = "ü" * 30
    add_values(obj, "FLOAT", "POINT", name)
    for _ in range(2):
        bpy.ops.ridgeform.denoise_attribute(attribute=name)
    made = [a.name for a in obj.data.attributes if a.name.endswith("_denoised")]
    assert made == ["ü" * 27 + "_denoised"]
