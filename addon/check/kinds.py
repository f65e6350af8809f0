# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be wrong with a mesh for these tools, and what the tools do about each."""

import tomllib
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path

import numpy as np


class Severity(Enum):
    """What a fault means for a run."""

    STOPS = "stops"
    """No tool can start."""
    LIMITS = "limits"
    """Tools run, and the result is not what it could be."""
    HANDLED = "handled"
    """Tools take care of it themselves; other programs may not."""


class Domain(Enum):
    """The elements of a mesh that a fault is about, as Blender's select modes call them."""

    NONE = "none"
    VERTEX = "VERT"
    EDGE = "EDGE"
    FACE = "FACE"


@dataclass(frozen=True, kw_only=True)
class Kind:
    """One kind of fault."""

    name: str
    label: str
    """What it is called in lists."""
    one: str
    """What is counted, in the singular."""
    many: str
    """And in the plural."""
    severity: Severity
    tools: str
    """What the tools do about it, or what it means for them."""
    domain: Domain = Domain.NONE
    cure: str = ""
    """What the button says that cures it; empty where no cure is safe."""
    cure_text: str = ""
    """What that button does."""


def _read(name: str, row: dict[str, object]) -> Kind:
    one, many = row.pop("counted")
    severity, domain = Severity(row.pop("severity")), Domain(row.pop("domain", Domain.NONE))
    return Kind(name=name, one=one, many=many, severity=severity, domain=domain, **row)


_TABLE = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
KINDS = tuple(_read(name, row) for name, row in _TABLE.items())
"""All kinds, those first that matter most."""
KIND = {kind.name: kind for kind in KINDS}


@dataclass
class Finding:
    """What was found of one kind in one mesh."""

    kind: Kind
    count: int
    elements: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    """The vertices, edges or faces, ascending."""
    notes: list[str] = field(default_factory=list)
    """More that is to be said."""

    @property
    def text(self) -> str:
        """What was found, with its number."""
        return f"{self.count} {self.kind.one if self.count == 1 else self.kind.many}"

    def as_dict(self) -> dict[str, object]:
        """Plain values that JSON can hold."""
        return {
            "kind": self.kind.name,
            "count": self.count,
            "text": self.text,
            "severity": self.kind.severity.value,
            "tools": self.kind.tools,
            "notes": list(self.notes),
            "cure": self.kind.cure or None,
        }


@dataclass
class Report:
    """What is wrong with the mesh of one object."""

    name: str
    vertices: int
    faces: int
    findings: list[Finding]
    seconds: float = 0.0

    def __getitem__(self, kind: str) -> Finding | None:
        """The finding of a kind, if there is one."""
        return next((found for found in self.findings if found.kind.name == kind), None)

    def count(self, severity: Severity) -> int:
        """How many kinds of this severity were found."""
        return sum(found.kind.severity is severity for found in self.findings)

    @property
    def sentence(self) -> str:
        """All that was found, in one line."""
        if not self.findings:
            return f'"{self.name}": nothing wrong'
        return f'"{self.name}": ' + ", ".join(
            "; ".join(found.notes) if found.kind.domain is Domain.NONE and found.notes else found.text
            for found in self.findings
        )

    def as_dict(self) -> dict[str, object]:
        """Plain values that JSON can hold."""
        return {
            "name": self.name,
            "vertices": self.vertices,
            "faces": self.faces,
            "findings": [found.as_dict() for found in self.findings],
            "seconds": round(self.seconds, 3),
        }
