"""The operator `ridgeform.stylize` in Object and Edit Mode: what it moves and what it leaves alone."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.blender import mesh_io
from bl_ext.user_default.ridgeform.framework import job
from bl_ext.user_default.ridgeform.framework.shared_settings import ridge_weights_of
from bl_ext.user_default.ridgeform.stylize import tool
from bl_ext.user_default.ridgeform.stylize.settings import default_settings, stylize_options

STEPS = 3


def api_result(coordinates, triangles, **options):
    """What the wheel makes of a mesh with the settings that the tests use."""
    mesh = ridgeform.Mesh(coordinates.astype(np.float64), triangles)
    shared = stylize_options(default_settings(steps=STEPS))
    return ridgeform.stylize(mesh, **(shared | options))


@pytest.mark.parametrize("make", [kit.bumpy_box, kit.ngon_prism])
def test_operator_gives_what_the_wheel_gives(make):
    obj = make()
    before, triangles = kit.coordinates(obj), mesh_io.triangles(obj.data)
    faces = [tuple(face.vertices) for face in obj.data.polygons]
    assert bpy.ops.ridgeform.stylize(steps=STEPS) == {"FINISHED"}
    expected = api_result(before, triangles).vertices.astype(np.float32)
    assert kit.same_bits(kit.coordinates(obj), expected)
    assert not np.array_equal(expected, before)
    assert [tuple(face.vertices) for face in obj.data.polygons] == faces


def test_paper_numbers_reach_the_wheel():
    obj = kit.bumpy_box()
    before, triangles = kit.coordinates(obj), mesh_io.triangles(obj.data)
    paper = {"fidelity": 800.0, "scale": "max_edge", "coupling": "separate", "dual": "circumcentric"}
    bpy.ops.ridgeform.stylize(
        steps=STEPS, sharpness=0.25, use_fidelity=True, solver="fast", tolerance=0.01, **paper
    )
    # Blender stores the numbers of operators as float32.
    expected = api_result(
        before,
        triangles,
        movement=None,
        flat_share=None,
        sharpness=0.25,
        solver="fast",
        tolerance=float(np.float32(0.01)),
        **paper,
    )
    assert kit.same_bits(kit.coordinates(obj), expected.vertices.astype(np.float32))


def test_delaunay_reaches_the_wheel():
    obj = kit.bumpy_box()
    before, triangles = kit.coordinates(obj), mesh_io.triangles(obj.data)
    bpy.ops.ridgeform.stylize(steps=STEPS, delaunay=True)
    expected = api_result(before, triangles, delaunay=True).vertices.astype(np.float32)
    assert kit.same_bits(kit.coordinates(obj), expected)
    assert not kit.same_bits(expected, api_result(before, triangles).vertices.astype(np.float32))


def test_edit_mode_moves_the_selection_only():
    obj = kit.bumpy_box()
    before, triangles = kit.coordinates(obj), mesh_io.triangles(obj.data)
    chosen = before[:, 2] > 0.1
    kit.select_only(obj, chosen)
    assert bpy.ops.ridgeform.stylize(steps=STEPS) == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    after = kit.coordinates(obj)
    assert kit.same_bits(after[~chosen], before[~chosen])
    expected = api_result(before, triangles, fixed=~chosen).vertices.astype(np.float32)
    assert kit.same_bits(after[chosen], expected[chosen])
    assert (after[chosen] != before[chosen]).any()


def test_several_objects_in_edit_mode():
    first, second = kit.bumpy_box("A", seed=1), kit.bumpy_box("B", seed=2)
    first.select_set(True)
    before = [kit.coordinates(obj) for obj in (first, second)]
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.ridgeform.stylize(steps=STEPS) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    for obj, old in zip((first, second), before, strict=True):
        assert not np.array_equal(kit.coordinates(obj), old)
    assert {entry["name"] for entry in job.last_summary()} == {"A", "B"}


def test_several_objects_each_by_itself():
    first, second = kit.bumpy_box("A", seed=1), kit.bumpy_box("B", seed=2)
    first.select_set(True)
    cases = [(obj, kit.coordinates(obj), mesh_io.triangles(obj.data)) for obj in (first, second)]
    assert bpy.ops.ridgeform.stylize(steps=STEPS) == {"FINISHED"}
    for obj, before, triangles in cases:
        expected = api_result(before, triangles).vertices.astype(np.float32)
        assert kit.same_bits(kit.coordinates(obj), expected)


def test_linked_duplicates_are_stylized_once():
    obj = kit.bumpy_box()
    before, triangles = kit.coordinates(obj), mesh_io.triangles(obj.data)
    kit.link(bpy.data.objects.new("Twin", obj.data))
    assert bpy.ops.ridgeform.stylize(steps=STEPS) == {"FINISHED"}
    assert len(job.last_summary()) == 1
    assert kit.same_bits(kit.coordinates(obj), api_result(before, triangles).vertices.astype(np.float32))


def test_mask_holds_what_is_not_in_it():
    obj = kit.bumpy_box()
    before, triangles = kit.coordinates(obj), mesh_io.triangles(obj.data)
    weights = np.where(before[:, 0] > 0.2, 0.5, np.where(before[:, 0] > -0.2, 1.0, 0.0))
    group = obj.vertex_groups.new(name="where")
    for weight in (0.5, 1.0):
        group.add(np.flatnonzero(weights == weight).tolist(), weight, "REPLACE")
    assert bpy.ops.ridgeform.stylize(steps=STEPS, strength_group="where") == {"FINISHED"}
    after, held = kit.coordinates(obj), weights == 0
    assert kit.same_bits(after[held], before[held])
    expected = api_result(before, triangles, strength=weights, fixed=held).vertices.astype(np.float32)
    assert kit.same_bits(after[~held], expected[~held])
    assert (after[weights == 0.5] != before[weights == 0.5]).any()


@pytest.mark.parametrize("avoid", [False, True])
def test_ridge_group_weighs_the_faces(avoid):
    obj = kit.bumpy_box()
    before, triangles = kit.coordinates(obj), mesh_io.triangles(obj.data)
    painted = np.flatnonzero(before[:, 1] > 0.3)
    obj.vertex_groups.new(name="ridges").add(painted.tolist(), 1.0, "REPLACE")
    bpy.ops.ridgeform.stylize(steps=STEPS, ridge_group="ridges", avoid_ridges=avoid)
    weights = ridge_weights_of(np.isin(np.arange(len(before)), painted).astype(float), triangles, avoid)
    expected = api_result(before, triangles, ridge_weights=weights)
    assert kit.same_bits(kit.coordinates(obj), expected.vertices.astype(np.float32))


def test_paint_makes_ridges_cheaper_and_no_paint_is_neutral():
    triangles = np.array([[0, 1, 2], [3, 4, 5]])
    painted = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    assert np.allclose(ridge_weights_of(painted, triangles, avoid=False), [0.1, 1.0])
    assert np.allclose(ridge_weights_of(painted, triangles, avoid=True), [10.0, 1.0])


def test_everything_on_the_mesh_stays():
    obj = kit.bumpy_box()
    mesh = obj.data
    rng = np.random.default_rng(3)
    mesh.materials.append(bpy.data.materials.new("one"))
    mesh.materials.append(bpy.data.materials.new("two"))
    mesh.polygons.foreach_set("material_index", rng.integers(0, 2, len(mesh.polygons)).astype(np.int32))
    mesh.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", rng.random(len(mesh.vertices)))
    mesh.attributes.new("tint", "FLOAT_COLOR", "CORNER").data.foreach_set(
        "color", rng.random(4 * len(mesh.loops))
    )
    mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", rng.random(len(mesh.edges)))
    obj.vertex_groups.new(name="bone").add(list(range(20)), 0.7, "REPLACE")

    def snapshot():
        taken = {}
        for name, prop, size in (
            ("UVMap", "vector", 2), ("heat", "value", 1), ("tint", "color", 4), ("crease_edge", "value", 1),
            ("material_index", "value", 1),
        ):  # fmt: skip
            data = mesh.attributes[name].data
            values = np.empty(len(data) * size, np.int32 if name == "material_index" else np.float32)
            data.foreach_get(prop, values)
            taken[name] = values.tobytes()
        taken["bone"] = [tuple((g.group, g.weight) for g in v.groups) for v in mesh.vertices]
        taken["slots"] = [material.name for material in mesh.materials]
        return taken

    before = snapshot()
    bpy.ops.ridgeform.stylize(steps=STEPS)
    assert snapshot() == before


def test_seams_do_not_tear():
    vertices = np.array(
        [[x, y, 0.3 * np.sin(1.3 * x) * np.cos(0.9 * y)] for x in range(5) for y in range(5)], float
    )
    quads = [[5 * x + y, 5 * x + 5 + y, 5 * x + 6 + y, 5 * x + 1 + y] for x in range(4) for y in range(4)]
    split = np.concatenate([vertices, vertices[10:15]])
    left = [[v + 15 if 10 <= v < 15 else v for v in quad] if min(quad) >= 10 else quad for quad in quads]
    obj = kit.add_object("Split", split, left)
    whole = kit.add_object("Whole", vertices, quads)
    bpy.ops.ridgeform.stylize(steps=STEPS, strength=1.0)
    assert kit.same_bits(kit.coordinates(obj)[25:], kit.coordinates(obj)[10:15])
    obj.select_set(True)
    assert np.abs(kit.coordinates(whole) - vertices).max() > 1e-3


def test_running_twice_from_the_same_state_gives_the_same_bits():
    results = []
    for _ in range(2):
        kit.empty_scene()
        obj = kit.bumpy_box()
        bpy.ops.ridgeform.stylize(steps=STEPS)
        results.append(kit.coordinates(obj))
    assert kit.same_bits(*results)


def test_summary_holds_what_happened():
    obj = kit.bumpy_box()
    bpy.ops.ridgeform.stylize(steps=STEPS)
    (entry,) = job.last_summary()
    assert entry["name"] == "Box"
    assert entry["vertices"] == len(obj.data.vertices)
    assert entry["faces"] == len(obj.data.polygons)
    assert entry["steps"] == STEPS
    assert 0 < entry["energy_after"] < entry["energy_before"]
    assert entry["gap"] >= 0
    assert entry["error"] is None


def test_fault_of_the_program_is_raised_and_the_mesh_restored(monkeypatch):
    first, second = kit.bumpy_box("A", seed=1), kit.bumpy_box("B", seed=2)
    first.select_set(True)
    before = [kit.coordinates(obj) for obj in (first, second)]
    run = tool.Stylization([first, second], default_settings(steps=1))
    monkeypatch.setattr(run.parts[1].task, "call", lambda _progress: 1 / 0)
    run.job.run()
    with pytest.raises(ZeroDivisionError):
        run.apply()
    for obj, old in zip((first, second), before, strict=True):
        assert kit.same_bits(kit.coordinates(obj), old)


def test_error_of_the_wheel_spares_the_other_meshes(monkeypatch):
    first, second = kit.bumpy_box("A", seed=1), kit.bumpy_box("B", seed=2)
    before = [kit.coordinates(obj) for obj in (first, second)]

    def fail(_progress):
        raise ridgeform.MeshError("Face 3 is bad.")

    run = tool.Stylization([first, second], default_settings(steps=1))
    monkeypatch.setattr(run.parts[1].task, "call", fail)
    run.job.run()
    run.apply()
    assert not np.array_equal(kit.coordinates(first), before[0])
    assert kit.same_bits(kit.coordinates(second), before[1])
    assert run.errors == ['"B": Face 3 is bad.']
    assert run.report().endswith('"B": Face 3 is bad.')


def test_uneven_scale_is_told():
    obj = kit.bumpy_box()
    obj.scale = (1, 1, 3)
    bpy.context.view_layer.update()
    bpy.ops.ridgeform.stylize(steps=1)
    assert any("scale is uneven" in note for note in job.last_summary()[0]["warnings"])
