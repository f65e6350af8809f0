"""Numbers with a check box, which 0 stood for before, and the angle of segments."""

import bpy
import layout_kit
import pytest
from bl_ext.user_default.ridgeform.framework import former, rows
from bl_ext.user_default.ridgeform.framework.settings import chosen, defaults_of, switch_of
from bl_ext.user_default.ridgeform.segments.settings import SegmentSettings, segment_options
from optional_kit import every_optional_number


def panel_of(tool):
    return getattr(bpy.context.scene, tool.scene_property)


@every_optional_number
def test_an_optional_number_has_a_check_box_in_its_row(tool, name):
    setting, box = tool.settings.declared[name], tool.settings.declared[switch_of(name)]
    assert (box.label, box.section) == (setting.label, setting.section)
    assert box.default is setting.used
    assert setting.default > 0
    layout = layout_kit.Layout()
    rows.draw_setting(layout, defaults_of(tool.settings), name, setting, None)
    assert layout.rows == [switch_of(name), name]
    assert chosen(defaults_of(tool.settings), name) == (setting.default if setting.used else None)
    assert chosen(defaults_of(tool.settings, **{name: 3}), name) == 3
    assert chosen(defaults_of(tool.settings, **{name: 0}), name) is None
    assert chosen(defaults_of(tool.settings, **{name: 3, switch_of(name): False}), name) is None


@every_optional_number
def test_a_number_that_is_given_to_a_panel_counts_until_its_check_box_says_otherwise(tool, name):
    panel = panel_of(tool)
    for value, counts in ((1, True), (0, False)):
        for each in (name, switch_of(name)):
            panel.property_unset(each)
        assert not former.is_due(panel, tool.settings)
        setattr(panel, name, value)
        assert former.is_due(panel, tool.settings)
        former.take_all()
        assert getattr(panel, switch_of(name)) is counts
        assert not former.is_due(panel, tool.settings)
    setattr(panel, switch_of(name), False)
    setattr(panel, name, 1)
    former.take_all()
    assert getattr(panel, switch_of(name)) is False


def test_the_angle_of_segments_is_what_border_cost_stood_for():
    options = segment_options(defaults_of(SegmentSettings))
    assert options["length_weight"] == 0.5
    for weight in (0.2, 0.5, 1.2):
        settings = defaults_of(SegmentSettings, length_weight=weight)
        assert segment_options(settings)["length_weight"] == pytest.approx(weight, abs=1e-6)
        settings.angle, settings.source = 1.0, "ATTRIBUTE"
        assert segment_options(settings)["length_weight"] == weight
