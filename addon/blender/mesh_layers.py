# SPDX-License-Identifier: GPL-3.0-or-later
"""The border between Blender and NumPy for all that lies on a mesh: carrying attributes over to new faces."""

from dataclasses import dataclass, field

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from .surface_map import SurfaceMap

# Blender's name of the value, its type, and how many of it one element has. Text has no fast access and is
# left out.
ATTRIBUTE_KINDS = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "INT32_2D": ("value", np.int32, 2),
    "QUATERNION": ("value", np.float32, 4),
    "FLOAT4X4": ("value", np.float32, 16),
}
MIXED = {"FLOAT", "FLOAT2", "FLOAT_VECTOR", "FLOAT_COLOR", "BYTE_COLOR"}
"""Types whose values can be mixed; of others one is taken."""
# Custom normals are stored relative to the faces that they were made for.
_TOPOLOGY = {"position", "custom_normal", ".edge_verts", ".corner_vert", ".corner_edge"}
SEAMS = {".uv_seam", "uv_seam"}
"""The edge attribute of UV seams, in older and newer versions of Blender."""
MARKS = SEAMS | {"sharp_edge", "crease_edge", "bevel_weight_edge", "freestyle_edge"}
"""The attributes of edges that are marks: of those that stay, an edge has just what it had."""
_HIDDEN = SEAMS | {".sculpt_face_set", ".sculpt_mask"}
ON_MARK = 0.15
"""A new edge takes a mark if ends and middle lie this close to marked edges, in parts of its length."""


@dataclass
class Layer:
    """One attribute: its values (k, components), and how Blender names and stores it."""

    name: str
    data_type: str
    domain: str
    values: np.ndarray


@dataclass
class Group:
    """One vertex group: name, whether it is locked, weights (n,) with NaN where a vertex is not in it."""

    name: str
    locked: bool
    weights: np.ndarray


@dataclass
class Layers:
    """All that lies on a mesh: attributes, vertex groups, and which layers are active."""

    attributes: list[Layer]
    groups: list[Group] = field(default_factory=list)
    active: dict[str, str | int] = field(default_factory=dict)

    def same_as(self, other: "Layers") -> bool:
        """Whether attributes and vertex groups are the same, and their values too."""
        named = [
            [(layer.name, layer.domain, layer.data_type, layer.values) for layer in layers.attributes]
            + [(group.name, "", "", group.weights) for group in layers.groups]
            for layers in (self, other)
        ]
        return len(named[0]) == len(named[1]) and all(
            # Bytes, not numbers: NaN is the same as itself.
            one[:3] == two[:3] and one[3].tobytes() == two[3].tobytes()
            for one, two in zip(*named, strict=True)
        )

    def uv_layers(self) -> list[np.ndarray]:
        """The UV maps (c, 2)."""
        return [
            layer.values
            for layer in self.attributes
            if layer.domain == "CORNER" and layer.data_type == "FLOAT2"
        ]


@dataclass
class Triangulation:
    """The loop triangles (m, 3), their corners (m, 3) and faces (m,), edges (k, 2) and coordinates (n, 3)."""

    triangles: np.ndarray
    corners: np.ndarray
    faces: np.ndarray
    edges: np.ndarray
    coordinates: np.ndarray


@dataclass
class Anchors:
    """What is known of new triangles (q, 3) and their edges beside where they lie."""

    triangle: np.ndarray
    """An old triangle (q,) on the chart that each is on."""
    ends: np.ndarray
    """The ends (c, 2) of edges that were edges of the mesh before, or are in the place of several."""
    edge: np.ndarray
    """Which of them (c,), -1 for none."""


def read_layers(obj: bpy.types.Object) -> Layers:
    """Read all but coordinates and faces from the mesh of an object in Object Mode."""
    return Layers(
        read_attributes(obj.data),
        _read_groups(obj),
        active_layers(obj.data) | {"group": obj.vertex_groups.active_index},
    )


def read_attributes(mesh: bpy.types.Mesh) -> list[Layer]:
    """The attributes of a mesh in Object Mode, without coordinates and faces and what is Blender's own."""
    attributes = []
    for attribute in mesh.attributes:
        hidden = attribute.name.startswith(".") and attribute.name not in _HIDDEN
        if hidden or attribute.name in _TOPOLOGY or attribute.data_type not in ATTRIBUTE_KINDS:
            continue
        prop, dtype, size = ATTRIBUTE_KINDS[attribute.data_type]
        values = np.empty(len(attribute.data) * size, dtype)
        attribute.data.foreach_get(prop, values)
        attributes.append(
            Layer(attribute.name, attribute.data_type, attribute.domain, values.reshape(-1, size))
        )
    return attributes


def _read_groups(obj: bpy.types.Object) -> list[Group]:
    n = len(obj.data.vertices)
    groups = [
        Group(group.name, group.lock_weight, np.full(n, np.nan, np.float32)) for group in obj.vertex_groups
    ]
    for vertex in obj.data.vertices if groups else ():
        for element in vertex.groups:
            groups[element.group].weights[vertex.index] = element.weight
    return groups


def _write_groups(obj: bpy.types.Object, groups: list[Group], active: int) -> None:
    for group in groups:
        made = obj.vertex_groups.new(name=group.name)
        made.lock_weight = group.locked
        for vertex in np.flatnonzero(~np.isnan(group.weights)).tolist():
            made.add([vertex], float(group.weights[vertex]), "REPLACE")
    if groups:
        obj.vertex_groups.active_index = active


def carried(
    source: Layers,
    old: Triangulation,
    surface: SurfaceMap,
    points: np.ndarray,
    faces: np.ndarray,
    *,
    anchors: Anchors,
) -> Layers:
    """The layers of new points (p, 3) and triangles (q, 3), each value from the nearest old place.

    For faces and corners that is on the chart of the face, and marks are those of the anchors.
    """
    middle = points[faces].mean(axis=1)
    face_triangle, _ = surface.nearest_on_chart_of(anchors.triangle, middle)
    point_triangle, point_weights = surface.nearest(points)
    corner_triangle, corner_weights = surface.nearest_on_chart_of(
        np.repeat(face_triangle, 3), points[faces.ravel()]
    )
    ends = edges_of(faces)
    attributes = []
    for layer in source.attributes:
        if layer.domain == "FACE":
            values = layer.values[old.faces[face_triangle]]
        elif layer.domain == "POINT":
            values = _mixed(layer, old.triangles[point_triangle], point_weights)
        elif layer.domain == "CORNER":
            values = _mixed(layer, old.corners[corner_triangle], corner_weights)
        elif layer.name in MARKS:
            values = _anchored(layer, anchors, ends)
        else:
            values = _marks(layer, old, points, ends)
        attributes.append(Layer(layer.name, layer.data_type, layer.domain, values))
    groups = [
        Group(
            group.name,
            group.locked,
            _mixed_group(group.weights, old.triangles[point_triangle], point_weights),
        )
        for group in source.groups
    ]
    return Layers(attributes, groups, source.active)


def edges_of(faces: np.ndarray) -> np.ndarray:
    """The edges (k, 2) of triangles (q, 3), each once."""
    return numbered_edges(faces)[0]


def numbered_edges(faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same, and the number (3 q,) of the edge that leads from each corner to the next."""
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    size = int(ends.max(initial=0)) + 1
    # Single numbers: NumPy takes several times as long for pairs.
    keys, number = np.unique(ends.astype(np.int64) @ [size, 1], return_inverse=True)
    return np.stack(np.divmod(keys, size), axis=1).astype(np.int32), number.reshape(-1)


def replace_faces(obj: bpy.types.Object, points: np.ndarray, faces: np.ndarray, layers: Layers) -> np.ndarray:
    """Give the mesh of an object new points (p, 3), triangles (q, 3) and layers; its materials stay.

    Edge values are in the order of `edges_of(faces)`; returned is the row there (k,) of each edge.
    """
    mesh = obj.data
    mesh.clear_geometry()
    mesh.vertices.add(len(points))
    mesh.loops.add(3 * len(faces))
    mesh.polygons.add(len(faces))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(points, np.float32).ravel())
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(faces), 3, dtype=np.int32))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(faces, np.int32).ravel())
    mesh.update(calc_edges=True)
    edge_rows = _edge_rows(mesh, edges_of(faces))
    for layer in layers.attributes:
        values = layer.values[edge_rows] if layer.domain == "EDGE" else layer.values
        attribute = mesh.attributes.get(layer.name)
        if attribute is None:
            attribute = mesh.attributes.new(layer.name, layer.data_type, layer.domain)
        attribute.data.foreach_set(ATTRIBUTE_KINDS[layer.data_type][0], np.ascontiguousarray(values).ravel())
    _write_groups(obj, layers.groups, layers.active["group"])
    set_active_layers(mesh, layers.active)
    if mesh.validate():
        edge_rows = _edge_rows(mesh, edges_of(faces))
    mesh.update()
    return edge_rows


def _edge_rows(mesh: bpy.types.Mesh, ends: np.ndarray) -> np.ndarray:
    """The row in `ends`, which are sorted, of each edge of the mesh: Blender numbers edges as it likes."""
    made = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", made)
    keys = (
        rows[:, 0].astype(np.int64) * len(mesh.vertices) + rows[:, 1]
        for rows in (ends, np.sort(made.reshape(-1, 2)))
    )
    return np.searchsorted(*keys)


def _mixed(layer: Layer, elements: np.ndarray, weights: np.ndarray) -> np.ndarray:
    values = layer.values[elements]
    if layer.data_type in MIXED:
        return np.einsum("ijk,ij->ik", values, weights).astype(layer.values.dtype)
    return values[np.arange(len(elements)), weights.argmax(axis=1)]


def _mixed_group(group: np.ndarray, elements: np.ndarray, weights: np.ndarray) -> np.ndarray:
    values = group[elements]
    mixed = (np.nan_to_num(values) * weights).sum(axis=1)
    member = ~np.isnan(values[np.arange(len(elements)), weights.argmax(axis=1)])
    return np.where(member, mixed, np.nan)


def _anchored(layer: Layer, anchors: Anchors, ends: np.ndarray) -> np.ndarray:
    """The values of marks on edges `ends` (k, 2), which are sorted."""
    values = np.zeros((len(ends), layer.values.shape[1]), layer.values.dtype)
    known = anchors.edge >= 0
    n = int(ends.max(initial=0)) + 1
    keys = np.sort(anchors.ends[known], axis=1).astype(np.int64) @ [n, 1]
    rows = np.searchsorted(ends.astype(np.int64) @ [n, 1], keys)
    values[rows] = layer.values[anchors.edge[known]]
    return values


def _marks(layer: Layer, old: Triangulation, points: np.ndarray, ends: np.ndarray) -> np.ndarray:
    marked = np.flatnonzero(layer.values.any(axis=1))
    values = np.zeros((len(ends), layer.values.shape[1]), layer.values.dtype)
    if len(marked) == 0:
        return values
    lines = [(a, b, b) for a, b in old.edges[marked].tolist()]
    tree = BVHTree.FromPolygons(old.coordinates.tolist(), lines, all_triangles=True)
    lengths = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    middles = points[ends].mean(axis=1)
    for row, (a, b) in enumerate(ends.tolist()):
        reach = ON_MARK * lengths[row]
        hits = [tree.find_nearest(place.tolist(), reach) for place in (points[a], points[b], middles[row])]
        if all(hit[0] is not None for hit in hits):
            values[row] = layer.values[marked[hits[2][2]]]
    return values


def active_layers(mesh: bpy.types.Mesh) -> dict[str, str]:
    """The names of the active UV maps and colors of a mesh, in use and for rendering."""
    colors = mesh.color_attributes
    shown = colors.render_color_index
    render_uv = next((layer.name for layer in mesh.uv_layers if layer.active_render), "")
    return {
        "uv": mesh.uv_layers.active.name if mesh.uv_layers.active else "",
        "uv_render": render_uv,
        "color": colors.active_color_name,
        "color_render": colors[shown].name if 0 <= shown < len(colors) else "",
    }


def set_active_layers(mesh: bpy.types.Mesh, active: dict[str, str | int]) -> None:
    """Make UV maps and colors active again, those that are there."""
    if active["uv"] in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[active["uv"]]
    if active["uv_render"] in mesh.uv_layers:
        mesh.uv_layers[active["uv_render"]].active_render = True
    if active["color"] in mesh.color_attributes:
        mesh.color_attributes.active_color_name = active["color"]
    if active["color_render"] in mesh.color_attributes:
        mesh.color_attributes.render_color_index = mesh.color_attributes.find(active["color_render"])
