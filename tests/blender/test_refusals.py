"""When the tools on attributes are disabled or refuse, why, and that they change nothing then."""

import addon_kit as kit
import bpy
import numpy as np
import pytest
from bl_ext.user_default.ridgeform.attributes.denoise import Denoising
from bl_ext.user_default.ridgeform.attributes.interpolate import Interpolation
from bl_ext.user_default.ridgeform.blender import selection


def heated_box(**kind):
    """A box with noise and an attribute with random values."""
    obj = kit.bumpy_box()
    attribute = obj.data.attributes.new("heat", kind.get("data_type", "FLOAT"), kind.get("domain", "POINT"))
    if attribute.data_type == "FLOAT":
        attribute.data.foreach_set("value", np.random.default_rng(0).random(len(attribute.data)))
    return obj


def traces(obj):
    """What the tools could change on a mesh."""
    mesh = obj.data
    values = {}
    for attribute in mesh.attributes:
        if attribute.data_type == "FLOAT":
            read = np.empty(len(attribute.data), np.float32)
            attribute.data.foreach_get("value", read)
            values[attribute.name] = read.tobytes()
    names = [attribute.name for attribute in mesh.attributes if not attribute.name.startswith(".")]
    groups = [[(g.group, g.weight) for g in v.groups] for v in mesh.vertices]
    return values, sorted(names), groups, obj.vertex_groups.keys(), kit.coordinates(obj).tobytes()


def refused(operator="denoise_attribute", **settings):
    """The message with which a tool refuses; the mesh must not have changed."""
    obj = bpy.context.object
    before = traces(obj)
    with pytest.raises(RuntimeError) as refusal:
        getattr(bpy.ops.ridgeform, operator)(**settings)
    assert traces(obj) == before
    return str(refusal.value)


def test_no_attribute_at_all():
    kit.bumpy_box()
    assert "has no attribute of decimal numbers or colors" in refused()


def test_unknown_attribute_and_groups():
    heated_box()
    assert 'has no attribute or vertex group "cold"' in refused(attribute="cold")
    assert 'has no vertex group "nose"' in refused(attribute="heat", ridge_group="nose")
    assert 'has no vertex group "nose"' in refused(
        "interpolate_attribute", attribute="heat", known="GROUP", known_group="nose"
    )
    assert "Choose the vertex group" in refused("interpolate_attribute", attribute="heat", known="GROUP")


@pytest.mark.parametrize(
    ("data_type", "domain", "words"),
    [
        ("INT", "POINT", "convert it to Float"),
        ("BOOLEAN", "POINT", "convert it to Float"),
        ("FLOAT", "EDGE", "stored on edges: convert it to the domain Vertex"),
        ("FLOAT", "FACE", "stored on faces: convert it to the domain Vertex"),
        ("FLOAT", "CORNER", "stored on face corners: convert it to the domain Vertex"),
        ("FLOAT2", "CORNER", "stored on face corners: convert it to the domain Vertex"),
    ],
)
def test_other_types_and_domains_name_the_cure(data_type, domain, words):
    heated_box(data_type=data_type, domain=domain)
    assert words in refused(attribute="heat")


def test_positions_are_left_to_stylize():
    heated_box()
    assert "use Stylize Flat" in refused(attribute="position")


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_non_finite_values_name_the_vertex(bad):
    obj = heated_box()
    obj.data.attributes["heat"].data[17].value = bad
    assert '"heat" of "Box" is not a finite number at vertex 17 (1 in all)' in refused(attribute="heat")
    known = np.zeros(len(obj.data.vertices), bool)
    known[10:20] = True
    kit.select_only(obj, known)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert "at vertex 17" in refused("interpolate_attribute", attribute="heat")


def test_non_finite_coordinates_name_the_vertex():
    obj = heated_box()
    values = kit.coordinates(obj)
    values[17, 1] = np.nan
    kit.set_coordinates(obj, values)
    assert 'Vertex 17 of "Box" has a coordinate that is not a finite number' in refused(attribute="heat")


def test_corner_colors_that_differ_at_a_vertex():
    obj = kit.bumpy_box()
    attribute = obj.data.attributes.new("paint", "FLOAT_COLOR", "CORNER")
    attribute.data[5].color = (1.0, 0.0, 0.0, 1.0)
    message = refused(attribute="paint")
    assert 'The face corners of "Box" have different "paint" at vertex' in message
    assert "Convert Attribute" in message


def test_the_same_value_everywhere():
    obj = heated_box()
    obj.data.attributes["heat"].data.foreach_set("value", np.full(len(obj.data.vertices), 3.0))
    assert "has the same value everywhere" in refused(attribute="heat")


@pytest.mark.parametrize(
    ("known", "chosen", "words"),
    [
        ("SELECTED", False, "is known: select the vertices whose values are known"),
        ("SELECTED", True, "is known: select fewer vertices"),
        ("UNSELECTED", False, "is known: select the vertices to be filled in"),
        ("UNSELECTED", True, "is known: select only the vertices to be filled in"),
    ],
)
def test_nothing_known_or_everything(known, chosen, words):
    obj = heated_box()
    kit.select_only(obj, np.full(len(obj.data.vertices), chosen))
    bpy.ops.object.mode_set(mode="OBJECT")
    assert words in refused("interpolate_attribute", attribute="heat", known=known)


def test_locked_group():
    obj = heated_box()
    group = obj.vertex_groups.new(name="paint")
    group.add([1, 2, 3], 0.5, "REPLACE")
    group.lock_weight = True
    assert '"paint" of "Box" is locked' in refused(attribute="paint", output="IN_PLACE")
    assert bpy.ops.ridgeform.denoise_attribute(attribute="paint") == {"FINISHED"}


def test_objects_without_the_attribute_are_skipped_and_named():
    heated_box()
    kit.bumpy_box("Cold", seed=3)
    bpy.data.objects["Box"].select_set(True)
    assert bpy.ops.ridgeform.denoise_attribute(attribute="heat") == {"FINISHED"}
    assert "heat_denoised" in bpy.data.objects["Box"].data.attributes
    assert "heat_denoised" not in bpy.data.objects["Cold"].data.attributes


def test_what_each_tool_needs():
    obj = heated_box()
    obj.modifiers.new("Multires", "MULTIRES")
    assert selection.reason_disabled(bpy.context) is not None
    assert bpy.ops.ridgeform.denoise_attribute.poll()
    kit.select_only(obj, np.zeros(len(obj.data.vertices), bool))
    assert selection.reason_disabled(bpy.context, Denoising.needs).startswith("Nothing is selected")
    assert not bpy.ops.ridgeform.denoise_attribute.poll()
    assert selection.reason_disabled(bpy.context, Interpolation.needs) is None
    assert bpy.ops.ridgeform.interpolate_attribute.poll()


@pytest.mark.parametrize(("vertices", "faces"), kit.BAD_MESHES.values(), ids=kit.BAD_MESHES)
@pytest.mark.parametrize("operator", ["denoise_attribute", "interpolate_attribute"])
def test_bad_meshes_end_finite_or_refused(operator, vertices, faces):
    obj = kit.add_object("Bad", vertices, faces)
    obj.data.attributes.new("heat", "FLOAT", "POINT").data.foreach_set(
        "value", np.arange(len(vertices)) ** 2.0
    )
    obj.data.vertices.foreach_set("select", np.arange(len(vertices)) < 2)
    try:
        getattr(bpy.ops.ridgeform, operator)(attribute="heat")
    except RuntimeError as refusal:
        assert str(refusal).startswith("Error: ")
    else:
        suffix = operator.split("_")[0].removesuffix("e") + "ed"
        values = np.empty(len(vertices), np.float32)
        obj.data.attributes[f"heat_{suffix}"].data.foreach_get("value", values)
        assert np.isfinite(values).all()
