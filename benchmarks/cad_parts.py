"""Parametric CAD parts for `cad.py`: what is made of them by a CAD kernel. Needs `requirements-cad.txt`.

Every function makes one part. Sizes are in millimeters; parts are some 20 to 100 of them across.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import cadquery as cq
import matplotlib as mpl

Solid = cq.Workplane
FONT = Path(mpl.get_data_path()) / "fonts/ttf/DejaVuSans.ttf"
"""The same on every machine."""


def plane(name: str = "XY") -> Solid:
    """An empty workplane."""
    return cq.Workplane(name)


def box(x: float, y: float, z: float) -> Solid:
    """A box about the origin."""
    return plane().box(x, y, z)


def revolved(points: list[tuple[float, float]]) -> Solid:
    """The polygon of radii and heights turned about the axis z."""
    return plane("XZ").polyline(points).close().revolve(360, (0, 0, 0), (0, 1, 0))


def circle_at(radius: float, height: float) -> cq.Selector:
    """The circle about the axis z with that radius at that height."""

    class At(cq.Selector):
        def filter(self, objects: list) -> list:
            return [
                edge
                for edge in objects
                if edge.geomType() == "CIRCLE"
                and abs(edge.radius() - radius) < 1e-6
                and abs(edge.Center().z - height) < 1e-6
            ]

    return At()


def bracket(fillet: float) -> Solid:
    """An angle of two legs with a fillet in its corner and another outside, and two bores."""
    legs = [(0, 0), (40, 0), (40, 6), (6, 6), (6, 30), (0, 30)]
    body = plane("XZ").polyline(legs).close().extrude(24)
    body = body.edges(cq.selectors.NearestToPointSelector((6, -12, 6))).fillet(fillet)
    body = body.edges(cq.selectors.NearestToPointSelector((0, -12, 0))).fillet(fillet + 2)
    body = body.faces(">Z").workplane(centerOption="CenterOfMass").hole(3)
    return body.faces(">X").workplane(centerOption="CenterOfMass").hole(3)


def beam(fillet: float) -> Solid:
    """A beam with the profile of an I, its corners filleted."""
    half = [(15, 0), (15, 5), (3, 5), (3, 25), (15, 25), (15, 30)]
    profile = half + [(-x, y) for x, y in reversed(half)]
    return plane("XZ").polyline(profile).close().extrude(60).edges("|Y").fillet(fillet)


def bottle() -> Solid:
    """A bottle: arcs and lines extruded, filleted, with a neck, hollow."""
    base = plane().moveTo(-20, 0).vLine(6).threePointArc((0, 12), (20, 6)).vLine(-6)
    body = base.mirrorX().extrude(50).edges("|Z").fillet(3).edges(">Z or <Z").fillet(2)
    body = body.faces(">Z").workplane(centerOption="CenterOfMass").circle(5).extrude(8)
    return body.faces(">Z").shell(1.2)


def bolt() -> Solid:
    """A hexagonal head, chamfered round, and a shank with a filleted foot and a chamfered tip."""
    cap = revolved([(0, -8), (12, -8), (12, -3), (9.5, 0), (0, 0)])
    head = plane().workplane(offset=-8).polygon(6, 22).extrude(8).intersect(cap)
    shank = plane().workplane(offset=-40).circle(5).extrude(32).faces("<Z").chamfer(1)
    body = head.union(shank)
    return body.edges(circle_at(5, -8)).fillet(1)


def nut() -> Solid:
    """A hexagon, chamfered round on both sides, with a countersunk bore."""
    cap = revolved([(0, 0), (9.5, 0), (12, 2.5), (12, 7.5), (9.5, 10), (0, 10)])
    return plane().polygon(6, 22).extrude(10).intersect(cap).faces(">Z").workplane().cskHole(8, 11, 82)


def tee(fillet: float) -> Solid:
    """Two pipes that meet; filleted where they do, if asked."""
    body = plane("XY").circle(10).extrude(60, both=True).union(plane("XZ").circle(7).extrude(40))
    if fillet:
        seam = cq.selectors.BoxSelector((-9, -12, -9), (9, -3, 9), boundingbox=True)
        body = body.edges(seam).fillet(fillet)
    return body


def ribbed(thickness: float) -> Solid:
    """A base and a wall, held by triangular ribs."""
    body = box(50, 40, 5).translate((0, 0, 2.5)).union(box(50, 5, 30).translate((0, -17.5, 15)))
    for x in (-18, 0, 18):
        rib = plane("YZ").polyline([(-15, 5), (12, 5), (-15, 26)]).close().extrude(thickness, both=True)
        body = body.union(rib.translate((x, 0, 0)))
    return body


def pocketed(fillet: float) -> Solid:
    """A plate with a rounded pocket, its floor filleted."""
    body = box(60, 40, 14).faces(">Z").workplane().rect(44, 26).cutBlind(-9)
    body = body.edges("|Z").edges(cq.selectors.BoxSelector((-23, -14, -3), (23, 14, 6)))
    body = body.fillet(fillet + 3)
    return body.edges(cq.selectors.BoxSelector((-23, -14, -3), (23, 14, -1))).fillet(fillet)


def flange(fillet: float) -> Solid:
    """A disk with a neck, filleted where they meet, a bore, and a circle of holes."""
    body = plane().circle(30).extrude(8).faces(">Z").workplane().circle(15).extrude(20)
    body = body.edges(circle_at(15, 8)).fillet(fillet)
    body = body.faces(">Z").workplane().hole(18)
    return body.faces("<Z").workplane().polarArray(23, 0, 360, 6).hole(6)


def shaft(steps: list[tuple[float, float]], fillet: float) -> Solid:
    """Cylinders one on another, filleted where they meet, chamfered at both ends."""
    body, top = None, 0.0
    for radius, height in steps:
        piece = plane().workplane(offset=top).circle(radius).extrude(height)
        body = piece if body is None else body.union(piece)
        top += height
    body = body.faces("<Z").chamfer(1).faces(">Z").chamfer(1)
    top = 0.0
    for (radius, height), (after, _) in pairwise(steps):
        top += height
        body = body.edges(circle_at(min(radius, after), top)).fillet(fillet)
    return body


def capsule() -> Solid:
    """A cylinder with hemispheres, tangent to it."""
    profile = plane("XZ").moveTo(0, -25).threePointArc((7.0711, -22.0711), (10, -15)).lineTo(10, 15)
    profile = profile.threePointArc((7.0711, 22.0711), (0, 25)).close()
    return profile.revolve(360, (0, 0, 0), (0, 1, 0))


def pulley(depth: float) -> Solid:
    """A wheel with a round groove, a hub on either side, and a bore."""
    far = 36 - depth
    groove = plane("XZ").moveTo(far, 0).circle(6).revolve(360, (-far, 0, 0), (-far, 1, 0))
    body = plane().circle(30).extrude(7, both=True).cut(groove)
    return body.union(plane().circle(12).extrude(12, both=True)).faces(">Z").workplane().hole(10)


def torus(major: float, minor: float) -> Solid:
    """A torus."""
    return cq.Workplane(obj=cq.Solid.makeTorus(major, minor))


def elbow() -> Solid:
    """A pipe that goes straight, round a corner and straight again, with a flange at its end."""
    path = plane("XZ").lineTo(0, 25).threePointArc((5.8579, 39.1421), (20, 45)).lineTo(45, 45)
    body = plane().circle(8).sweep(path).union(plane().circle(15).extrude(5))
    return body


def sphere_cut() -> Solid:
    """A block with a spherical dimple and a spherical knob."""
    body = box(40, 24, 16).cut(plane().sphere(9).translate((-9, 0, 12)))
    return body.union(plane().sphere(8).translate((9, 0, 8)))


def clevis(radius: float) -> Solid:
    """A fork with round ends and a bore through both arms."""
    arm = plane("XZ").moveTo(-10, 0).lineTo(-10, 30).threePointArc((0, 40), (10, 30)).lineTo(10, 0).close()
    arm = arm.extrude(5)
    body = arm.translate((0, -5, 0)).union(arm.translate((0, 10, 0)))
    body = body.union(box(20, 20, 10).translate((0, 0, -5)))
    body = body.cut(plane("XZ").circle(4).extrude(40, both=True).translate((0, 0, 30)))
    return body.edges("<Z").fillet(radius)


def hub() -> Solid:
    """A cone with a bore and a keyway."""
    body = plane().circle(20).workplane(offset=30).circle(10).loft().faces(">Z").workplane().hole(8)
    return body.cut(box(3, 12, 80).translate((0, 3, 0)))


def vase() -> Solid:
    """A smooth profile turned: no surface of a simple kind, but the ends."""
    points = [(10, 0), (16, 12), (9, 28), (12, 40)]
    outline = plane("XZ").moveTo(0, 0).lineTo(*points[0]).spline(points[1:], includeCurrent=True)
    return outline.lineTo(0, 40).close().revolve(360, (0, 0, 0), (0, 1, 0))


def star(fillet: float) -> Solid:
    """A star with blunted edges."""
    spikes = [(22 if k % 2 == 0 else 11, k * math.pi / 5) for k in range(10)]
    points = [(r * math.cos(a), r * math.sin(a)) for r, a in spikes]
    return plane().polyline(points).close().extrude(10).edges("|Z").fillet(fillet)


def counterbored(depth: float) -> Solid:
    """A plate with four stepped bores and round corners."""
    body = box(60, 40, 14).edges("|Z").fillet(6)
    return body.faces(">Z").workplane().rect(42, 22, forConstruction=True).vertices().cboreHole(5, 10, depth)


def countersunk() -> Solid:
    """A plate with four countersunk bores."""
    body = box(60, 40, 10)
    return body.faces(">Z").workplane().rect(40, 20, forConstruction=True).vertices().cskHole(5, 12, 90)


def cup(fillet: float) -> Solid:
    """A hollow cylinder with rounded foot and lip."""
    body = plane().circle(18).extrude(40).faces("<Z").edges().fillet(fillet).faces(">Z").shell(-3)
    return body.faces(">Z").edges().fillet(1.2)


def text(words: str, height: float) -> Solid:
    """A plate with letters that stand on it, or (negative) are sunk into it."""
    top = box(60, 22, 6).faces(">Z").workplane()
    return top.text(words, 16, height, combine=True if height > 0 else "cut", fontPath=str(FONT))


def slots() -> Solid:
    """A plate with slots, each two planes and two half cylinders, tangent to each other."""
    body = box(70, 40, 8).edges("|Z").fillet(5).faces(">Z").workplane()
    body = body.pushPoints([(0, 11), (0, -11)]).slot2D(40, 8).cutThruAll()
    return body.faces(">Z").edges("%LINE").chamfer(0.8)


def barb() -> Solid:
    """Cones one on another, and a collar."""
    profile = [(3, 0), (6, 0), (8, 8), (6, 8), (8, 16), (6, 16), (8, 24), (12, 24), (12, 30), (3, 30)]
    return revolved(profile)


def funnel() -> Solid:
    """A cone that runs into a cylinder by an arc, tangent to both."""
    outline = plane("XZ").moveTo(5, 0).lineTo(5, 14).threePointArc((6.1418, 19.7403), (9.3934, 24.6066))
    outline = outline.lineTo(25, 40.2132).lineTo(27.8284, 37.3848).lineTo(12.2218, 21.7782)
    outline = outline.threePointArc((9.8377, 18.2092), (9, 14)).lineTo(9, 0).close()
    return outline.revolve(360, (0, 0, 0), (0, 1, 0))


def lofted(kind: str) -> Solid:
    """A body between two outlines."""
    base = plane().rect(40, 30)
    if kind == "circle":
        return base.workplane(offset=30).circle(9).loft()
    if kind == "rounded":
        rounded = plane().sketch().rect(40, 30).vertices().fillet(5).finalize()
        return rounded.placeSketch(
            cq.Sketch().rect(40, 30).vertices().fillet(5),
            cq.Sketch().rect(20, 16).vertices().fillet(3).moved(cq.Location(cq.Vector(0, 0, 30))),
        ).loft()
    return base.workplane(offset=30).rect(20, 12).loft()


def handle() -> Solid:
    """A bent bar between two feet."""
    path = plane("XZ").moveTo(-25, 0).lineTo(-25, 15).tangentArcPoint((10, 10)).lineTo(15, 25)
    path = path.tangentArcPoint((10, -10)).lineTo(25, 0)
    bar = plane().center(-25, 0).circle(4).sweep(path)
    feet = plane().pushPoints([(-25, 0), (25, 0)]).rect(16, 16).extrude(-4)
    return bar.union(feet)


def boss(fillet: float) -> Solid:
    """A block with a boss, filleted where it stands and at its top."""
    body = box(44, 44, 10).edges("|Z").fillet(4).faces(">Z").workplane().circle(11).extrude(16)
    body = body.edges(circle_at(11, 5)).fillet(fillet)
    return body.faces(">Z").edges().fillet(fillet / 2)


def housing() -> Solid:
    """A hollow rounded block, open below, with a filleted rim and a bore through its side."""
    body = box(50, 36, 24).edges("|Z").fillet(7).faces(">Z").edges().fillet(4).faces("<Z").shell(-3)
    return body.cut(plane("XZ").circle(5).extrude(60))


def cross_bored() -> Solid:
    """A ball with three bores, one along each axis."""
    body = plane().sphere(16)
    for name in ("XY", "YZ", "XZ"):
        body = body.cut(plane(name).circle(5).extrude(40, both=True))
    return body


def wedge(fillet: float) -> Solid:
    """A ramp, the edge at its top rounded."""
    body = plane("XZ").polyline([(0, 0), (50, 0), (50, 8), (20, 26), (0, 26)]).close().extrude(24)
    return body.edges(cq.selectors.NearestToPointSelector((20, -12, 26))).fillet(fillet)


def gear(teeth: int) -> Solid:
    """A wheel with straight teeth and a bore."""
    points = []
    for k in range(teeth):
        for share, radius in ((0.0, 20), (0.22, 20), (0.35, 25), (0.65, 25), (0.78, 20)):
            angle = 2 * math.pi * (k + share) / teeth
            points.append((radius * math.cos(angle), radius * math.sin(angle)))
    return plane().polyline(points).close().extrude(9).faces(">Z").workplane().hole(12)


def twisted() -> Solid:
    """A square that turns while it rises."""
    return plane().rect(20, 20).twistExtrude(30, 60)


PARTS: dict[str, Callable[[], Solid]] = {
    "box, edges filleted 2": lambda: box(40, 30, 20).edges().fillet(2),
    "box, edges filleted 6": lambda: box(40, 30, 20).edges().fillet(6),
    "box, uprights filleted": lambda: box(40, 30, 20).edges("|Z").fillet(5),
    "box, top filleted": lambda: box(40, 30, 20).faces(">Z").edges().fillet(4),
    "box, edges chamfered": lambda: box(40, 30, 20).edges().chamfer(3),
    "angle bracket": lambda: bracket(5),
    "I-beam": lambda: beam(2),
    "ribbed wall": lambda: ribbed(2),
    "wedge": lambda: wedge(12),
    "pocketed plate": lambda: pocketed(3),
    "counterbored plate": lambda: counterbored(6),
    "countersunk plate": countersunk,
    "slotted plate": slots,
    "boss, fillets 3": lambda: boss(3),
    "boss, fillets 6": lambda: boss(6),
    "flange": lambda: flange(5),
    "shaft": lambda: shaft([(8, 20), (14, 15), (10, 25)], 2),
    "capsule": capsule,
    "torus": lambda: torus(20, 7),
    "pulley": lambda: pulley(4),
    "barb": barb,
    "funnel": funnel,
    "hub": hub,
    "bolt": bolt,
    "nut": nut,
    "tee": lambda: tee(0),
    "filleted tee": lambda: tee(3),
    "elbow": elbow,
    "handle": handle,
    "clevis": lambda: clevis(4),
    "block with balls": sphere_cut,
    "bored ball": cross_bored,
    "cup": lambda: cup(6),
    "bottle": bottle,
    "housing": housing,
    "vase": vase,
    "square to circle": lambda: lofted("circle"),
    "square to square": lambda: lofted("square"),
    "rounded loft": lambda: lofted("rounded"),
    "twisted bar": twisted,
    "star": lambda: star(2),
    "gear": lambda: gear(16),
    "raised text": lambda: text("Rfg", 3),
    "sunk text": lambda: text("8Q", -2),
}
"""By their names in the table."""
