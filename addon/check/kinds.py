# SPDX-License-Identifier: GPL-3.0-or-later
"""What can be wrong with a mesh for these tools, and what the tools do about each."""

from dataclasses import dataclass, field
from enum import Enum

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


KINDS = (
    Kind(
        name="refused",
        label="Not Editable",
        one="reason why no tool can start",
        many="reasons why no tool can start",
        severity=Severity.STOPS,
        tools="No tool can start",
    ),
    Kind(
        name="not_finite",
        label="Not Finite",
        one="vertex without a finite place",
        many="vertices without a finite place",
        severity=Severity.STOPS,
        tools="No tool can start: move or delete them",
        domain=Domain.VERTEX,
    ),
    Kind(
        name="nonmanifold_edges",
        label="Non-Manifold Edges",
        one="edge with more than two faces",
        many="edges with more than two faces",
        severity=Severity.LIMITS,
        tools="Count as borders: no ridge follows them",
        domain=Domain.EDGE,
        cure="Split",
        cure_text="Leave the two faces together that continue each other best, and part the others from them",
    ),
    Kind(
        name="nonmanifold_vertices",
        label="Non-Manifold Vertices",
        one="vertex where surfaces touch",
        many="vertices where surfaces touch",
        severity=Severity.LIMITS,
        tools="The surfaces move together there",
        domain=Domain.VERTEX,
        cure="Split",
        cure_text="Give each surface a vertex of its own",
    ),
    Kind(
        name="t_junctions",
        label="T-Junctions",
        one="vertex on the open edge of another face",
        many="vertices on open edges of other faces",
        severity=Severity.LIMITS,
        tools="The surface counts as open there",
        domain=Domain.VERTEX,
        cure="Join",
        cure_text="Cut the edges at these vertices, and join both",
    ),
    Kind(
        name="duplicate_faces",
        label="Duplicate Faces",
        one="face in the place of another",
        many="faces in the place of others",
        severity=Severity.LIMITS,
        tools="Their edges count as borders",
        domain=Domain.FACE,
        cure="Remove",
        cure_text="Remove all but the first of the faces in one place",
    ),
    Kind(
        name="doubled_faces",
        label="Overlapping Faces",
        one="face that lies on another",
        many="faces that lie on others",
        severity=Severity.LIMITS,
        tools="Their edges count as borders: delete one of two",
        domain=Domain.FACE,
    ),
    Kind(
        name="one_sided",
        label="One-Sided",
        one="edge where a surface has no outside",
        many="edges where surfaces have no outside",
        severity=Severity.LIMITS,
        tools="Count as borders: no ridge follows them",
        domain=Domain.EDGE,
    ),
    Kind(
        name="uneven_scale",
        label="Uneven Scale",
        one="uneven scale",
        many="uneven scales",
        severity=Severity.LIMITS,
        tools="Facets will look stretched",
        cure="Apply",
        cure_text="Apply the object's scale to its mesh (Object ▸ Apply ▸ Scale)",
    ),
    Kind(
        name="far_away",
        label="Far From the Origin",
        one="mesh far from its origin",
        many="meshes far from their origins",
        severity=Severity.LIMITS,
        tools="Rounded: Object ▸ Set Origin ▸ Origin to Geometry",
    ),
    Kind(
        name="modifiers",
        label="Modifiers",
        one="modifier that changes the result",
        many="modifiers that change the result",
        severity=Severity.LIMITS,
        tools="Tools see the mesh below the modifiers",
    ),
    Kind(
        name="shape_keys",
        label="Shape Keys",
        one="shape key that does not show",
        many="shape keys that do not show",
        severity=Severity.LIMITS,
        tools="It is what tools read and write",
    ),
    Kind(
        name="uneven_ngons",
        label="Uneven N-Gons",
        one="n-gon that is not planar",
        many="n-gons that are not planar",
        severity=Severity.HANDLED,
        tools="Computed as the triangles that are drawn",
        domain=Domain.FACE,
    ),
    Kind(
        name="seams",
        label="Duplicate Vertices",
        one="vertex in the place of another",
        many="vertices in the places of others",
        severity=Severity.HANDLED,
        tools="Computed as one",
        domain=Domain.VERTEX,
        cure="Weld",
        cure_text="Make one vertex of those on open edges that are in one place, up to rounding",
    ),
    Kind(
        name="flipped_faces",
        label="Flipped Faces",
        one="face turned against its neighbors",
        many="faces turned against their neighbors",
        severity=Severity.HANDLED,
        tools="Computed as if turned back",
        domain=Domain.FACE,
        cure="Turn",
        cure_text="Turn the smaller part of each surface over, so that all its faces agree",
    ),
    Kind(
        name="degenerate_faces",
        label="Degenerate Faces",
        one="face without area",
        many="faces without area",
        severity=Severity.HANDLED,
        tools="Computed with a little area",
        domain=Domain.FACE,
    ),
    Kind(
        name="loose_edges",
        label="Loose Edges",
        one="edge without a face",
        many="edges without a face",
        severity=Severity.HANDLED,
        tools="Not computed, and dropped by Low Poly",
        domain=Domain.EDGE,
        cure="Remove",
        cure_text="Remove the edges without a face, and their vertices that are in no other edge",
    ),
    Kind(
        name="loose_vertices",
        label="Loose Vertices",
        one="vertex without an edge",
        many="vertices without an edge",
        severity=Severity.HANDLED,
        tools="Not computed, and dropped by Low Poly",
        domain=Domain.VERTEX,
        cure="Remove",
        cure_text="Remove the vertices without an edge",
    ),
)
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
