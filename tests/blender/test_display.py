"""Results are seen at once: viewport colors, the color-ramp material, and colors as they are."""

import addon_kit as kit
import bpy
import numpy as np
from bl_ext.user_default.ridgeform.blender import ramp
from bl_ext.user_default.ridgeform.blender.attribute_names import SHOWN


def heated_box(name="Box", scale=1.0):
    obj = kit.bumpy_box(name)
    values = scale * kit.coordinates(obj)[:, 2]
    obj.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set("value", values)
    return obj


def colors_of(obj, name=SHOWN):
    data = obj.data.attributes[name].data
    values = np.empty(4 * len(data), np.float32)
    data.foreach_get("color", values)
    return values.reshape(-1, 4)


def result_of(obj):
    values = np.empty(len(obj.data.vertices), np.float32)
    obj.data.attributes["heat_denoised"].data.foreach_get("value", values)
    return values


def views():
    return [area.spaces.active for area in bpy.context.screen.areas if area.type == "VIEW_3D"]


def test_viewport_colors_follow_the_values():
    obj = heated_box()
    bpy.ops.ridgeform.denoise_attribute(attribute="heat")
    values = result_of(obj)
    places = (values - values.min()) / np.ptp(values)
    assert np.allclose(colors_of(obj), ramp.colors_at(ramp.SEQUENTIAL, places), atol=1e-5)
    assert obj.data.color_attributes.active_color_name == SHOWN
    assert len(obj.data.materials) == 0
    assert views()
    assert all(view.shading.color_type == "VERTEX" and view.shading.type == "SOLID" for view in views())


def test_objects_of_one_run_share_the_range():
    first, second = heated_box("A"), heated_box("B", scale=3.0)
    first.select_set(True)
    bpy.ops.ridgeform.denoise_attribute(attribute="heat")
    low, high = result_of(second).min(), result_of(second).max()
    places = (result_of(first) - low) / (high - low)
    assert np.allclose(colors_of(first), ramp.colors_at(ramp.SEQUENTIAL, places), atol=1e-5)


def test_the_material_is_made_once_and_kept_up_to_date():
    obj = heated_box()
    for strength, bands in ((0.3, 0), (0.6, 8), (0.6, 0), (0.6, 32)):
        bpy.ops.ridgeform.denoise_attribute(
            attribute="heat", strength=strength, display="MATERIAL", bands=bands
        )
        assert [material.name for material in bpy.data.materials] == ["Ridgeform heat_denoised"]
        assert [material.name for material in obj.data.materials] == ["Ridgeform heat_denoised"]
        nodes = bpy.data.materials[0].node_tree.nodes
        (place,) = [node for node in nodes if node.bl_idname == "ShaderNodeMapRange"]
        limits = [place.inputs[f"From {end}"].default_value for end in ("Min", "Max")]
        assert np.allclose(limits, [result_of(obj).min(), result_of(obj).max()])
        (coloring,) = [node for node in nodes if node.bl_idname == "ShaderNodeValToRGB"]
        elements = coloring.color_ramp.elements
        assert len(elements) == (bands or len(ramp.SEQUENTIAL))
        assert coloring.color_ramp.interpolation == ("CONSTANT" if bands else "LINEAR")
        expected = np.arange(bands) / bands if bands else np.linspace(0, 1, len(elements))
        assert np.allclose([element.position for element in elements], expected, atol=1e-6)
    assert all(view.shading.type == "MATERIAL" for view in views())


def test_the_users_materials_are_left_alone():
    obj = heated_box()
    theirs = bpy.data.materials.new("Ridgeform heat_denoised")
    theirs.diffuse_color = (1, 0, 0, 1)
    obj.data.materials.append(theirs)
    for _ in range(2):
        bpy.ops.ridgeform.denoise_attribute(attribute="heat", display="MATERIAL")
    assert obj.data.materials[0] == theirs
    assert tuple(theirs.diffuse_color) == (1, 0, 0, 1)
    assert [slot.name for slot in obj.data.materials] == [theirs.name, "Ridgeform heat_denoised.001"]
    assert {face.material_index for face in obj.data.polygons} == {0}


def test_colors_are_shown_as_they_are():
    obj = kit.bumpy_box()
    paint = obj.data.attributes.new("paint", "BYTE_COLOR", "CORNER")
    vertices = np.array([loop.vertex_index for loop in obj.data.loops])
    stored = np.random.default_rng(0).random((len(obj.data.vertices), 4))[vertices].astype(np.float32)
    paint.data.foreach_set("color", stored.ravel())
    bpy.ops.ridgeform.denoise_attribute(attribute="paint", display="MATERIAL")
    assert obj.data.color_attributes.active_color_name == "paint_denoised"
    assert len(bpy.data.materials) == 0
    assert SHOWN not in obj.data.attributes


def test_nothing_is_touched_if_nothing_is_to_be_shown():
    obj = heated_box()
    for view in views():
        view.shading.color_type = "OBJECT"
    bpy.ops.ridgeform.denoise_attribute(attribute="heat", display="NONE")
    assert SHOWN not in obj.data.attributes
    assert len(bpy.data.materials) == 0
    assert all(view.shading.color_type == "OBJECT" for view in views())


def test_ranges_leave_out_what_is_not_finite():
    assert ramp.value_range([np.array([1.0, np.nan, 3.0]), np.array([-2.0])], signed=False) == (-2.0, 3.0)
    assert ramp.value_range([np.array([1.0, -3.0])], signed=True) == (-3.0, 3.0)
    assert ramp.value_range([], signed=False) == (0.0, 1.0)


def test_ramps_go_from_end_to_end():
    for colors in (ramp.SEQUENTIAL, ramp.DIVERGING):
        assert np.allclose(ramp.colors_at(colors, np.array([0.0, 1.0]))[:, :3], colors[[0, -1]])
