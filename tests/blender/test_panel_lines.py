"""What the panel says of the last run: in full, in as many lines as it takes."""

from itertools import pairwise

import addon_kit as kit
import bpy
import layout_kit
import pytest
from bl_ext.user_default.ridgeform import registry
from bl_ext.user_default.ridgeform.framework import job, sidebar, wrapping

SENTENCE = "hardly anything became flat: choose the finish Facets, or subdivide it first"


def labels(tool):
    layout = layout_kit.Layout()
    panel = type("Panel", (), {"layout": layout, "tool": tool, "section": ""})()
    sidebar._ToolPanel.draw_all(panel, bpy.context)
    return layout.labels


@pytest.mark.parametrize("width", [0, 5, 20, 30, 1000])
def test_no_line_is_wider_than_it_may_be_and_no_word_is_lost(width):
    lines = wrapping.wrapped(SENTENCE, width, len)
    assert " ".join(lines) == SENTENCE
    assert all(len(line) <= width or " " not in line for line in lines)
    # No word would have had room in the line above.
    assert all(len(f"{a} {b.split()[0]}") > width for a, b in pairwise(lines))


def test_nothing_is_no_line():
    assert wrapping.wrapped("", 10.0, len) == []


@pytest.mark.parametrize("tool", registry.TOOLS, ids=lambda tool: tool.name)
def test_every_tool_says_what_was_noticed(tool, monkeypatch):
    uid = kit.bumpy_box().session_uid
    monkeypatch.setattr(tool.run, "lines", classmethod(lambda cls, entry: [entry["name"]]))
    entry = {"tool": tool.run.name, "name": "Box", "status": "solved", "warnings": [SENTENCE]}
    job.store_summary([entry], [uid])
    said = labels(tool)
    assert said[said.index("Box") + 1] == SENTENCE[0].upper() + SENTENCE[1:]


def test_a_torus_that_hardly_changes_says_in_the_panel_what_helps():
    bpy.ops.mesh.primitive_torus_add()
    bpy.ops.ridgeform.stylize(use_fidelity=True, steps=2)
    stylize = next(tool for tool in registry.TOOLS if tool.name == "stylize")
    assert any(text.startswith("Hardly anything became flat") for text in labels(stylize))


def test_an_object_that_takes_the_name_of_another_does_not_take_its_line():
    stylize = next(tool for tool in registry.TOOLS if tool.name == "stylize")
    bpy.ops.mesh.primitive_uv_sphere_add()
    bpy.ops.ridgeform.stylize(steps=1)
    assert any("facets" in text for text in labels(stylize))
    bpy.data.objects.remove(bpy.context.object)
    bpy.ops.mesh.primitive_uv_sphere_add()
    assert bpy.context.object.name == "Sphere"
    assert not any("facets" in text for text in labels(stylize))


@pytest.mark.parametrize(("kind", "word"), [("FACES", "segment"), ("PARTS", "part")])
def test_parts_are_called_parts(kind, word):
    kit.bumpy_box()
    assert bpy.ops.ridgeform.segment(kind=kind, mode="COUNT", count=3) == {"FINISHED"}
    segment = next(tool for tool in registry.TOOLS if tool.name == "segment")
    (entry,) = job.last_summary()
    words = (*segment.run.lines(entry), *segment.run.phrases([entry]), *entry["warnings"])
    other = {"segment": "part", "part": "segment"}[word]
    assert any(word in said for said in words)
    assert not any(other in said.lower() for said in words)
