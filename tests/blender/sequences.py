"""Random sequences of what a user, a script and a second window do, over all tools, as a state machine.

After every step: no mesh that `validate()` would correct, no run left over, finite coordinates; a tool that
refuses leaves everything as it is, Esc gives everything back, and undo and redo return every bit.
"""

import contextlib
import functools
import json
import os
import random
from pathlib import Path

import addon_kit as kit
import bpy
import modal_kit
import numpy as np
from bl_ext.user_default.ridgeform.blender import selection
from bl_ext.user_default.ridgeform.framework import modal
from bl_ext.user_default.ridgeform.framework.run import RefusedError
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule
from mesh_changes import CHANGES, HARMLESS, delete, delete_faces
from sequence_meshes import KINDS, NAMES

OPERATORS = sorted(name for name in dir(bpy.ops.ridgeform) if not name.endswith(("_svg", "_preset_add")))
WORDS = ["", "heat", "paint", "group", "Key", "nothing of this name"]
BOUNDS = {"steps": 4, "count": 6, "max_iterations": 300, "bands": 8}
"""What makes a call long is bounded: sequences are to be many."""
MODES = ["OBJECT", "EDIT", "SCULPT", "WEIGHT_PAINT", "VERTEX_PAINT"]
MOST = 4
"""Objects at a time."""
ALL_CHANGES = (
    *CHANGES,
    *HARMLESS,
    delete,
    *(lambda obj, name=name: setattr(obj, "name", name) for name in NAMES),
)
TRAIL = os.environ.get("RIDGEFORM_FUZZ_TRAIL")
counts = {"sequences": 0, "steps": 0, "operators": 0, "runs": 0, "finished": 0, "changes": 0, "undos": 0}
"""How much was done in this process."""


def drawn_settings(operator, choice):
    """Some properties of an operator at random: numbers that a slider gives, all choices of enums."""
    properties = [
        each
        for each in getattr(bpy.ops.ridgeform, operator).get_rna_type().properties
        if not each.is_readonly and not each.is_hidden and each.identifier != "rna_type"
    ]
    chosen = choice.sample(properties, min(len(properties), choice.randrange(4)))
    settings = {each.identifier: drawn_value(each, choice) for each in chosen}
    return {"steps": 3, **settings} if operator == "stylize" else settings


def drawn_value(kind, choice):
    """A value of one property: of a color or a vector as many numbers as it has."""
    if kind.type == "STRING":
        return choice.choice(WORDS)
    if kind.type == "ENUM":
        names = [item.identifier for item in kind.enum_items]
        if kind.is_enum_flag:
            return {name for name in names if choice.random() < 0.4}
        return choice.choice(names)
    if kind.type == "BOOLEAN":
        draw = functools.partial(choice.choice, [False, True])
    elif kind.type == "INT":
        high = min(kind.soft_max, BOUNDS.get(kind.identifier, 30))
        draw = functools.partial(choice.randint, kind.soft_min, max(high, kind.soft_min))
    else:
        draw = functools.partial(choice.uniform, kind.soft_min, kind.soft_max)
    return [draw() for _ in range(kind.array_length)] if kind.is_array else draw()


def note(*words):
    """Keep what is done next, since a crash leaves no traceback of the steps before."""
    if TRAIL:
        with Path(TRAIL).open("a", encoding="utf-8") as stream:
            print(json.dumps(words), file=stream)


def only_if(condition):
    """A rule that does nothing unless a condition holds.

    Not as a precondition: that would decide which rules can be drawn, and whether a run is still on depends
    on the moment.
    """

    def guarded(step):
        @functools.wraps(step)
        def checked(self, *args, **kwargs):
            if condition(self):
                step(self, *args, **kwargs)

        return checked

    return guarded


class Sequences(RuleBasedStateMachine):
    """One sequence."""

    def __init__(self):
        """Begin with nothing."""
        super().__init__()
        self.session, self.at_start = None, None
        self.steps, self.place = [], 0
        # Changes that no undo step knows of: Blender itself crashes when one is undone across them.
        self.is_ahead = False

    @initialize(kind=st.sampled_from(list(KINDS)))
    def begin(self, kind):
        """An empty file with one object."""
        kit.empty_scene()
        bpy.context.preferences.edit.use_global_undo = True
        counts["sequences"] += 1
        note("begin")
        self._restart()
        self.add(kind)

    # What a user does.

    @rule(kind=st.sampled_from(list(KINDS)))
    @only_if(lambda self: len(meshes()) < MOST and bpy.context.mode == "OBJECT")
    def add(self, kind):
        """Add an object."""
        note("add", kind)
        KINDS[kind]()
        self._push()

    @rule(mask=st.integers(1, 2**MOST - 1), active=st.integers(0, MOST - 1))
    @only_if(lambda self: meshes() and bpy.context.mode == "OBJECT")
    def select(self, mask, active):
        """Select some objects."""
        note("select", mask, active)
        found = meshes()
        for index, obj in enumerate(found):
            obj.select_set(bool(mask >> index & 1))
        bpy.context.view_layer.objects.active = found[active % len(found)]
        self._push()

    @rule(mode=st.sampled_from(MODES))
    @only_if(lambda self: bpy.context.object is not None and bpy.ops.object.mode_set.poll())
    def switch(self, mode):
        """Switch the mode."""
        note("switch", mode)
        bpy.ops.object.mode_set(mode=mode)
        self._push()

    @rule(seed=st.integers(0, 99), all_of=st.booleans())
    @only_if(lambda self: bpy.context.mode == "EDIT_MESH" and self.session is None)
    def select_vertices(self, seed, all_of):
        """Select all or some vertices in Edit Mode."""
        note("select_vertices", seed, all_of)
        bpy.ops.mesh.select_all(action="SELECT" if all_of else "DESELECT")
        if not all_of:
            bpy.ops.mesh.select_random(ratio=0.5, seed=seed)

    @rule(operator=st.sampled_from(OPERATORS), seed=st.integers(0, 2**32))
    def operate(self, operator, seed):
        """Run an operator at once."""
        note("operate", operator, seed)
        before = self._everything()
        call = getattr(bpy.ops.ridgeform, operator)
        if not call.poll():
            return
        counts["operators"] += 1
        try:
            outcome = call(**drawn_settings(operator, random.Random(seed)))
        except RuntimeError as refusal:
            assert str(refusal).startswith("Error: "), refusal
            assert "Traceback" not in str(refusal), refusal
            assert "Stopped: " not in str(refusal), refusal
            outcome = {"CANCELLED"}
        counts["finished"] += outcome == {"FINISHED"}
        if outcome == {"CANCELLED"} and before is not None and self.session is None:
            assert self._everything() == before, f"{operator} changed what it refused"
        self._push()

    # A run while Blender goes on drawing.

    @rule(tool=st.sampled_from(list(modal_kit.TOOLS)), long=st.booleans())
    @only_if(lambda self: self.session is None and meshes() and bpy.context.mode in selection.MODES)
    def begin_run(self, tool, long):
        """Begin a run on what is selected."""
        note("begin_run", tool, long)
        kind = modal_kit.TOOLS[tool][0]
        chosen = selection.usable(selection.mesh_objects(bpy.context), kind.needs)
        self.at_start = self._everything()
        try:
            self.session = modal_kit.Session(
                tool, chosen.objects, **({"steps": 200} if long and tool == "stylize" else {})
            )
        except RefusedError:
            assert self._everything() == self.at_start
        else:
            counts["runs"] += 1

    @rule(key=st.sampled_from(["TIMER", "TIMER", "ESC", "RET", "MIDDLEMOUSE"]))
    @only_if(lambda self: self.session is not None)
    def send(self, key):
        """Hand an event to the run."""
        note("send", key)
        outcome = self.session.send(key)
        if outcome <= {"FINISHED", "CANCELLED"}:
            if key == "ESC" and self.at_start is not None:
                assert self._everything() == self.at_start, "Esc did not give everything back"
            self._end()

    @rule()
    @only_if(lambda self: self.session is not None)
    def finish(self):
        """Wait for the end of the run."""
        note("finish")
        counts["finished"] += self.session.finish() == {"FINISHED"}
        self._end()

    # What scripts, timers and other windows do, also while a run is on.

    @rule(change=st.sampled_from(ALL_CHANGES), index=st.integers(0, MOST - 1))
    @only_if(lambda self: meshes() and bpy.context.mode == "OBJECT")
    def change(self, change, index):
        """Change a mesh by another hand."""
        self._change(change, index)
        self._push()

    @rule(
        tool=st.sampled_from(list(modal_kit.TOOLS)),
        polls=st.integers(0, 3),
        change=st.sampled_from((None, *ALL_CHANGES)),
        index=st.integers(0, MOST - 1),
        key=st.sampled_from(["TIMER", "ESC", "RET"]),
    )
    @only_if(lambda self: self.session is None and meshes() and bpy.context.mode in selection.MODES)
    def run_with_a_change(self, tool, polls, change, index, key):
        """A run from beginning to end, with a change in the middle."""
        self.begin_run(tool, True)
        for _ in range(polls):
            if self.session is not None:
                self.send("TIMER")
        if self.session is not None and change is not None and meshes():
            self.at_start = None
            self._change(change, index)
            self.is_ahead = True
        if self.session is not None:
            self.send(key)
        if self.session is not None:
            self.finish()

    def _change(self, change, index):
        obj = meshes()[index % len(meshes())]
        # Blender 4.2 itself: where a script deletes faces of a mesh with shape keys while it is painted on,
        # also without this extension, the next switch to Sculpt Mode reads past the end of the keys.
        is_painted = obj.mode != "OBJECT" and obj.data.shape_keys is not None
        if bpy.app.version < (5, 0) and is_painted and change is delete_faces:
            return
        counts["changes"] += 1
        note("_change", ALL_CHANGES.index(change), index)
        # There may be no such layer, no vertex, or the mode cannot be switched.
        with contextlib.suppress(KeyError, IndexError, RuntimeError, ValueError):
            change(obj)

    @rule(forth=st.booleans())
    def undo(self, forth):
        """Undo or redo, and compare every bit."""
        note("undo", forth)
        target = self.place + (1 if forth else -1)
        if self.is_ahead or bpy.context.mode != "OBJECT" or not 0 <= target < len(self.steps):
            return
        counts["undos"] += 1
        bpy.ops.ed.redo() if forth else bpy.ops.ed.undo()
        bpy.context.view_layer.update()
        self.place = target
        self.at_start = None
        assert everything() == self.steps[target], "redo" if forth else "undo"
        self._end_if_gone()

    @rule(chance=st.integers(0, 3))
    def open_file(self, chance):
        """Begin a new file, now and then."""
        if chance:
            return
        note("open_file", chance)
        kit.empty_scene()
        bpy.context.preferences.edit.use_global_undo = True
        self._restart()
        self._end_if_gone()

    # What is always true.

    @invariant()
    def meshes_are_sound(self):
        """No mesh is one that Blender would correct, and no coordinate is lost."""
        counts["steps"] += 1
        for obj in meshes():
            if obj.mode == "EDIT":
                continue
            copy = obj.data.copy()
            corrected = copy.validate()
            bpy.data.meshes.remove(copy)
            assert not corrected, obj.name
            assert np.isfinite(kit.coordinates(obj)).all(), obj.name

    @invariant()
    def no_run_is_left_over(self):
        """A run is there as long as its operator."""
        if self.session is None:
            assert modal._running == []

    def teardown(self):
        """End the run."""
        if self.session is not None:
            self.session.send("ESC")
            self.session.check_ended()

    def _push(self):
        """An undo step, in Object Mode; while a run is on Blender makes none.

        None either of an object in Edit Mode that is no longer active: its mode would not come back.
        """
        edited = any(obj.mode == "EDIT" for obj in bpy.data.objects)
        if self.session is None and bpy.context.mode == "OBJECT" and not edited:
            bpy.ops.ed.undo_push(message=str(self.place))
            self.steps = [*self.steps[: self.place + 1], everything()]
            self.place = len(self.steps) - 1
            self.is_ahead = False
        if self.session is not None:
            self.at_start = None
            self.is_ahead = True

    def _restart(self):
        self.at_start = None
        bpy.ops.ed.undo_push(message="start")
        self.steps, self.place, self.is_ahead = [everything()], 0, False

    def _end(self):
        self.session.check_ended()
        self.session = None
        self._push()

    def _end_if_gone(self):
        if self.session is not None and self.session.run not in modal._running:
            assert self.session.send("TIMER") == {"CANCELLED"}
            self.session.check_ended()
            self.session = None

    def _everything(self):
        return everything() if bpy.context.mode == "OBJECT" else None


def meshes():
    """The mesh objects of the view layer."""
    # One that was removed stays in the view layer, as None, until that is brought up to date; so does one
    # that was unlinked.
    return [
        obj for obj in bpy.context.view_layer.objects if obj and obj.type == "MESH" and obj.users_collection
    ]


def everything():
    """All that tools could change, of all objects."""
    found = {
        obj.name: obj.mode if obj.mode == "EDIT" else modal_kit.state(obj)
        for obj in bpy.data.objects
        if obj.type == "MESH"
    }
    return found, sorted(obj.name for obj in bpy.data.objects), sorted(bpy.context.view_layer.objects.keys())
