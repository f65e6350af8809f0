"""Which faces of a CAD part are fillets or chamfers; needs `requirements-cad.txt`."""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.GeomAPI import GeomAPI_ProjectPointOnSurf

SAME = 1e-5
"""Points lie on a surface within so many millimeters."""
SAMPLES = 4
"""Points of a face in either direction."""

Shape = cq.occ_impl.shapes.Mixin3D


class Fillets:
    """While entered, remembers what surfaces fillets and chamfers make, and how far shells offset them."""

    def __init__(self) -> None:
        """None yet."""
        self._faces: list[cq.Face] = []
        self._offsets = [0.0]
        self._kept = {name: getattr(Shape, name) for name in ("fillet", "chamfer")}
        self._shell = cq.Workplane.shell

    def __enter__(self) -> Fillets:
        """Begin."""
        for name, method in self._kept.items():
            setattr(Shape, name, self._remembering(method))

        def shell(part: cq.Workplane, thickness: float, *given: object) -> cq.Workplane:
            self._offsets.append(abs(thickness))
            return self._shell(part, thickness, *given)

        cq.Workplane.shell = shell
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End."""
        for name, method in self._kept.items():
            setattr(Shape, name, method)
        cq.Workplane.shell = self._shell

    def _remembering(self, method: Callable) -> Callable:
        def made(solid: cq.Shape, *given: object, **named: object) -> cq.Shape:
            result = method(solid, *given, **named)
            before = solid.Faces()
            self._faces += [
                face for face in result.Faces() if not any(_is_along(face, other, [0.0]) for other in before)
            ]
            return result

        return made

    def have(self, face: cq.Face) -> bool:
        """Whether a face is of a fillet or chamfer, or the other side of its shell."""
        return any(_is_along(face, other, self._offsets) for other in self._faces)


def _is_along(face: cq.Face, other: cq.Face, offsets: list[float]) -> bool:
    """Whether a face lies on the surface of another, or beside it by one of the offsets."""
    u0, u1, v0, v1 = face._uvBounds()
    surface, other_surface = (BRep_Tool.Surface_s(side.wrapped) for side in (face, other))
    shares = (np.arange(SAMPLES) + 0.5) / SAMPLES
    offsets = np.array(offsets)
    for u in u0 + shares * (u1 - u0):
        for v in v0 + shares * (v1 - v0):
            onto = GeomAPI_ProjectPointOnSurf(surface.Value(float(u), float(v)), other_surface)
            # Tori may run through themselves, so that the nearest point is not the one beside.
            distances = np.array([onto.Distance(k + 1) for k in range(onto.NbPoints())])
            offsets = offsets[(np.abs(distances[:, None] - offsets) < SAME).any(axis=0)]
            if not len(offsets):
                return False
    return True
