"""Meshes that are too large for the memory that is free are refused before a run, in words."""

import re

import addon_kit as kit
import bpy
import modal_kit
import pytest
import ridgeform
from bl_ext.user_default.ridgeform.framework import preflight
from bl_ext.user_default.ridgeform.framework.run import RefusedError


@pytest.mark.parametrize("tool", modal_kit.TOOLS)
def test_every_tool_says_what_it_needs_and_what_would_fit(tool, monkeypatch):
    obj = modal_kit.open_box(cuts=8)
    before = modal_kit.state(obj)
    kind, settings, given = modal_kit.TOOLS[tool]
    size = len(obj.data.vertices), len(obj.data.loops) - 2 * len(obj.data.polygons)
    call = kind([obj], modal_kit.defaults_of(settings, **given)).call
    needed = ridgeform.memory_estimate(call, size)
    monkeypatch.setattr(ridgeform, "memory_available", lambda: int(0.7 * needed))
    with pytest.raises(RefusedError, match=r'"Box" needs about .* GB of memory, .* GB are free') as refusal:
        kind([obj], modal_kit.defaults_of(settings, **given))
    (fits,) = re.findall(r"about (\d+) vertices", str(refusal.value))
    assert 0 < int(fits) < size[0]
    assert modal_kit.state(obj) == before
    monkeypatch.undo()
    assert preflight.reason_too_large(obj, call) is None


def test_parts_are_asked_for_what_they_take(monkeypatch):
    obj = modal_kit.open_box(cuts=8)
    kind, settings, _ = modal_kit.TOOLS["segment"]
    size = len(obj.data.vertices), len(obj.data.loops) - 2 * len(obj.data.polygons)
    monkeypatch.setattr(
        ridgeform, "memory_available", lambda: int(1.5 * ridgeform.memory_estimate("parts", size))
    )
    kind([obj], modal_kit.defaults_of(settings, kind="PARTS"))
    with pytest.raises(RefusedError, match=r'"Box" needs about .* GB of memory'):
        kind([obj], modal_kit.defaults_of(settings))


def test_a_mesh_of_any_size_has_its_small_holes_filled_and_a_long_one_refused(monkeypatch):
    obj = modal_kit.open_box(cuts=8)
    before = modal_kit.state(obj)
    kind, settings, given = modal_kit.TOOLS["fill_holes"]
    whole = ridgeform.memory_estimate("fill_holes", (1000, 2000))
    monkeypatch.setattr(ridgeform, "memory_available", lambda: whole)
    kind([obj], modal_kit.defaults_of(settings, **given))
    left = iter([10**12, 10])
    monkeypatch.setattr(ridgeform, "memory_available", lambda: next(left))
    with pytest.raises(RefusedError, match=r"GB are free: cut its hole of \d+ edges in two"):
        kind([obj], modal_kit.defaults_of(settings, **given))
    assert modal_kit.state(obj) == before


def test_the_operator_reports_it(monkeypatch):
    obj = kit.bumpy_box()
    before = kit.coordinates(obj)
    monkeypatch.setattr(ridgeform, "memory_available", lambda: 1000)
    with pytest.raises(RuntimeError, match='Error: "Box" needs about'):
        bpy.ops.ridgeform.stylize(steps=1)
    assert kit.same_bits(kit.coordinates(obj), before)
