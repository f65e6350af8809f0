# SPDX-License-Identifier: GPL-3.0-or-later
"""One run of a tool over some meshes: what all tools share from reading a mesh to reporting on it."""

import contextlib
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import bpy
import ridgeform

from ..blender import mesh_io
from ..blender.mesh_backup import MeshBackup
from ..blender.mesh_state import ChangedError, MeshState
from ..blender.reading import reading_once
from ..blender.refusals import RefusedError
from ..blender.selection import MOVES
from .job import Job, Task, store_summary
from .preflight import reason_too_large
from .settings import Settings

NOT_BEGUN = "not begun"
FAILED = "failed"
NO_RESULT = {NOT_BEGUN, FAILED}
"""What a summary says the status of a mesh is that has no result."""


@dataclass
class Part:
    """One mesh of a run."""

    object: bpy.types.Object
    task: Task
    n_vertices: int
    warnings: list[str] = field(default_factory=list)
    state: MeshState | None = field(default=None, init=False)
    """What the mesh was like when it was read or last written."""


class Run(ABC):
    """Some meshes and one tool: prepare, let `job` run, then `apply` or `restore`.

    The three that write (`preview`, `restore`, `apply`) look first whether the meshes are still what was
    read: a mesh that was changed meanwhile is never written, `ChangedError` says so.

    `skipped` are sentences on objects that do not take part. Meshes that cannot be worked on are added to it,
    unless none is left: then `RefusedError` is raised.
    """

    name: ClassVar[str]
    """The tool's name, in the summary as well."""
    # No `ClassVar`: `typing` keeps what is in one until Python ends, which Blender 4.2 then cannot without a
    # crash (`properties_of`).
    takes: type[Settings]
    """The settings that it is given values of."""
    call: ClassVar[str | None] = None
    """The call of the package whose memory is asked for before a run; `None` if it takes little more than the
    mesh does."""
    counted: ClassVar[str] = "iterations"
    """What the panel calls the steps of the summary."""
    sums: ClassVar[tuple[str, str, str] | None] = None
    """A figure that the batch command adds up over the meshes of a file: its name, what it counts, and what
    became of that."""
    needs = MOVES
    """What it needs of a mesh."""
    in_object_mode: ClassVar[bool] = True
    """Whether meshes in Edit Mode leave it while they are read; a tool with a live preview stays in it."""

    def __init__(
        self, objects: Sequence[bpy.types.Object], settings: object, skipped: Sequence[str] = ()
    ) -> None:
        """Read the meshes of the objects and prepare one task each."""
        self.settings = settings
        self.skipped = list(skipped)
        self.parts: list[Part] = []
        self._refusal: RefusedError | None = None
        self._in_edit_mode = bpy.context.mode == "EDIT_MESH"
        with reading_once():
            with mesh_io.object_mode() if self.in_object_mode else contextlib.nullcontext():
                self._prepare_all(objects)
            if not self.parts:
                reason = self.skipped[-1] if self.skipped else "Select a mesh object"
                raise self._refusal or RefusedError(reason)
            for part in self.parts:
                part.state = MeshState(part.object)
        self.job = Job([part.task for part in self.parts])
        self.summary: list[dict[str, object]] = []
        self.is_writing = False
        """Whether writing the results has begun: from then on only undo takes them back, or `unapply`."""
        self.keeps_original = False
        """Whether what writing replaces is kept, so that `unapply` can put it back."""
        self._backups: list[MeshBackup] = []
        self.before: Run | None = None
        """The run whose result this one replaces, starting again from its original."""

    def _prepare_all(self, objects: Sequence[bpy.types.Object]) -> None:
        for obj in objects:
            try:
                reason = None if self.call is None else reason_too_large(obj, self.call)
                if reason is not None:
                    raise RefusedError(reason)
                self.parts.append(self.prepare(obj))
            except RefusedError as refusal:
                self.skipped.append(str(refusal))
                self._refusal = refusal

    @abstractmethod
    def prepare(self, obj: bpy.types.Object) -> Part:
        """Read one mesh and make its task; `RefusedError` if the tool has no use for it."""

    @abstractmethod
    def write(self, parts: Sequence[Part]) -> None:
        """Write the results of those parts that have one."""

    @abstractmethod
    def figures(self, part: Part) -> dict[str, object]:
        """What the summary says of a part that has a result: energies, gap, steps, status."""

    @abstractmethod
    def headline(self, done: Sequence[dict[str, object]]) -> str:
        """The first words of the report on the summaries of the parts that are done."""

    @classmethod
    def lines(cls, entry: dict[str, object]) -> list[str]:
        """What the panel says of a mesh that is done, given its summary."""
        if entry["energy_after"] is None:
            return [f"{entry['name']}: {entry['seconds']:.1f} s"]
        return [f"{entry['name']}: {entry['steps']} {cls.counted}, {entry['seconds']:.1f} s"]

    @classmethod
    def numbers(cls, entry: dict[str, object]) -> list[str]:
        """What the subpanel Expert says of it: energy and gap, where the tool has any."""
        if entry["energy_after"] is None:
            return []
        before = "" if entry["energy_before"] is None else f"{entry['energy_before']:.4g} → "
        gap = "" if entry["gap"] is None else f", gap {entry['gap']:.1g}"
        return [f"{entry['name']}: energy {before}{entry['energy_after']:.4g}{gap}"]

    @classmethod
    def phrases(cls, done: Sequence[dict[str, object]]) -> list[str]:
        """What the batch command says of a file beside vertices, energies and gap, given the summaries."""
        if cls.sums is None or not done:
            return []
        figure, what, done_to_it = cls.sums
        return [counted(total(done, figure), what) + done_to_it]

    def kept_settings(self) -> dict[str, object]:
        """Settings that a redo repeats with other values than those asked for."""
        return {}

    def show(self) -> bool:
        """Show how far the job is; whether there was something new."""
        return False

    def check(self, part: Part) -> None:  # noqa: B027
        """`ChangedError` if a mesh is no longer what was read in what else the result was made of."""

    def put_back(self, part: Part) -> None:  # noqa: B027
        """Put a mesh back as it was; nothing to do for a tool that writes at the end only."""

    def clear(self) -> None:  # noqa: B027
        """Take away what is shown beside the meshes."""

    def replaces_faces(self, part: Part) -> bool:
        """Whether writing the result of a part makes other faces."""
        return False

    def watch(self) -> None:
        """What is due at every event, and takes no time: `ChangedError` as said above."""
        self.check_meshes(thorough=False)

    def preview(self) -> bool:
        """Show how far the job is; whether there was something new. `ChangedError` as said above."""
        self.watch()
        return self.show()

    def restore(self) -> list[str]:
        """Put everything back as it was; a sentence for each mesh that was changed meanwhile and stays so.

        What was there is the result of the run before, for one that started again from its original. Once
        results are being written nothing is put back: the meshes are no longer what was read.
        """
        self.clear()
        if self.is_writing:
            return []
        left = self.rewind()
        if self.before is not None and not left:
            self.before.write_again()
        return left

    def rewind(self) -> list[str]:
        """Put the meshes back as they were read; the same sentences."""
        left = []
        for part in self.parts:
            try:
                part.state.check()
                self.put_back(part)
            except ChangedError as change:
                left.append(str(change))
        return left

    def hide(self) -> None:
        """Put the meshes back as they were read until the next preview. `ChangedError` as said above."""
        self.check_meshes()
        for part in self.parts:
            self.put_back(part)
            part.state.take_coordinates()

    def unapply(self) -> None:
        """Put the meshes back as they were read, after `apply`. `ChangedError` as said above."""
        self.check_meshes()
        for part, backup in zip(self.parts, self._backups, strict=True):
            backup.put_back()
            self.put_back(part)

    def write_again(self) -> None:
        """Write the results once more, after `unapply`."""
        self.write(self.done)
        self._take_states()

    def remember(self) -> None:  # noqa: B027
        """Keep what a run with other settings could use."""

    def forget(self) -> None:
        """Let go of what was kept to start again from."""
        self._backups.clear()

    def _take_states(self) -> None:
        for part in self.parts:
            part.state = MeshState(part.object)

    def check_meshes(self, thorough: bool = True) -> None:
        """`ChangedError` if a mesh is not what was read or last written."""
        for part in self.parts:
            part.state.check(thorough)

    @property
    def done(self) -> list[Part]:
        """The parts that have a result."""
        return [part for part in self.parts if part.task.result is not None]

    @property
    def errors(self) -> list[str]:
        """A sentence for each mesh that failed."""
        return [
            f'"{part.object.name}": {part.task.error}' for part in self.parts if part.task.error is not None
        ]

    def back_up(self) -> bool:
        """Keep what writing will replace, if it is to be kept and is not yet; whether that was done."""
        if not self.keeps_original or self._backups:
            return False
        self._backups = [MeshBackup(part.object, self.replaces_faces(part)) for part in self.parts]
        return True

    def apply(self) -> None:
        """Write the results; parts that failed or were never begun stay as they were.

        `ChangedError` as said above. An error that is not the wheel's own is a fault of the program: all is
        restored, and it is raised.
        """
        for part in self.parts:
            if part.task.error is not None and not isinstance(part.task.error, ridgeform.RidgeformError):
                self.restore()
                raise part.task.error
        self.check_meshes()
        for part in self.parts:
            self.check(part)
        self.is_writing = True
        self.back_up()
        self.write(self.done)
        if self.keeps_original:
            self._take_states()
            self.remember()
        self.summary = [self._summary_of(part) for part in self.parts]
        store_summary(self.summary, [part.object.session_uid for part in self.parts])

    def report(self) -> str:
        """What happened, in one line, with what was skipped and why."""
        done = [entry for entry in self.summary if entry["status"] not in NO_RESULT]
        notes = [f'"{entry["name"]}": {note}' for entry in self.summary for note in entry["warnings"]]
        idle = [f'"{entry["name"]}" was not begun' for entry in self.summary if entry["status"] == NOT_BEGUN]
        return "; ".join([self.headline(done), *notes, *idle, *self.skipped, *self.errors])

    def _summary_of(self, part: Part) -> dict[str, object]:
        error = part.task.error
        entry = {
            "tool": self.name,
            "name": part.object.name,
            "vertices": part.n_vertices,
            "faces": len(part.object.data.polygons),
            "energy_before": None,
            "energy_after": None,
            "gap": None,
            "steps": 0,
            "status": NOT_BEGUN if error is None else FAILED,
            "seconds": part.task.seconds,
            "warnings": list(part.warnings),
            "error": None if error is None else str(error),
        }
        return entry if part.task.result is None else entry | self.figures(part)


def counted(number: int, word: str) -> str:
    """A number of things, the word in the plural where there is not one."""
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def percent(share: float) -> str:
    """A share in percent, to two digits."""
    return f"{100.0 * share:.2g} %"


def panel_lines(entry: dict[str, object], what: str, how: str) -> list[str]:
    """What the panel says of a mesh, given its summary: what came out, and how, with the time."""
    return [f"{entry['name']}: {what}", f"{how}, {entry['seconds']:.1f} s"]


def total(done: Sequence[dict[str, object]], figure: str) -> float:
    """The sum of a figure over the summaries of meshes."""
    return sum(entry[figure] for entry in done)


def most(done: Sequence[dict[str, object]], figure: str) -> float:
    """The largest of a figure over the summaries of meshes; 0 without any."""
    return max((entry[figure] for entry in done), default=0.0)


def meshes_phrase(done: Sequence[dict[str, object]]) -> str:
    """The name of the one mesh that is done, or how many there are."""
    return f'"{done[0]["name"]}"' if len(done) == 1 else f"{len(done)} meshes"
