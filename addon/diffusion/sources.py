# SPDX-License-Identifier: GPL-3.0-or-later
"""The colors of a mesh at its vertices: from a color attribute, or from the image of its material."""

from dataclasses import dataclass

import bpy
import numpy as np

from ..blender import attribute_io, mesh_io
from ..blender.attribute_names import COLORS, SHOWN
from ..blender.refusals import AttributeRefusedError

SUFFIX = "_diffused"
"""What the name of the rebuilt colors ends with."""
LINEAR_SPACES = {"Linear", "Linear Rec.709", "Non-Color", "Raw"}
"""Color spaces whose numbers are taken as they are."""
SRGB = "sRGB"
INSIDE = 0.75
"""Pixels by which a corner is drawn in: then its bilinear neighbors lie in the face, also on a diagonal."""


@dataclass
class Colors:
    """Linear colors of the vertices, and what to call them."""

    name: str
    values: np.ndarray
    """Colors (n, 4) float64."""
    notes: list[str]


def attribute_colors(obj: bpy.types.Object, name: str) -> Colors:
    """The colors of an attribute, the active one without a name; `AttributeRefusedError` if there is none.

    A vertex whose face corners have different colors takes one of them, not their mean: at a sharp border
    that would belong to neither side.
    """
    name = name or _default_name(obj.data)
    if name is None:
        raise AttributeRefusedError(
            f'"{obj.name}" has no color attribute: paint it in Vertex Paint, or take the colors of an image'
        )
    source = attribute_io.read_values(obj, name)
    if source.data_type not in COLORS:
        raise AttributeRefusedError(f'"{name}" of "{obj.name}" is not a color attribute')
    values = source.values.astype(np.float64)
    if not np.isfinite(values).all():
        raise AttributeRefusedError(f'"{name}" of "{obj.name}" has colors that are not finite numbers')
    mixed = int(source.mixed.sum())
    notes = [f"{mixed} vertices have several colors at their corners, one of them was used"] if mixed else []
    return Colors(name, values, notes)


def _default_name(mesh: bpy.types.Mesh) -> str | None:
    """The active color attribute, or the first; not what this add-on has made of another one."""
    names = [attribute.name for attribute in mesh.color_attributes if attribute.name != SHOWN]
    active = mesh.color_attributes.active_color
    ordered = ([active.name] if active is not None and active.name in names else []) + names
    for name in ordered:
        source = name.removesuffix(SUFFIX)
        if source == name or source not in names:
            return name
        return source
    return None


def image_colors(obj: bpy.types.Object) -> Colors:
    """The image of the active material at the vertices, by the active UV map.

    `AttributeRefusedError` if there is no material, image or UV map. The mean over the corners of a vertex
    counts, each taken a little inside its face: what lies beside the face in the image is not part of it.
    """
    image = _active_image(obj)
    layer = obj.data.uv_layers.active
    if layer is None:
        raise AttributeRefusedError(f'"{obj.name}" has no UV map: unwrap it first')
    pixels = _pixels(image)
    uv = np.empty(2 * len(layer.uv), np.float32)
    layer.uv.foreach_get("vector", uv)
    starts, vertices, _ = mesh_io.face_corners(obj.data)
    corners = sampled(pixels, drawn_in(uv.reshape(-1, 2).astype(np.float64), starts, pixels.shape[1::-1]))
    n = len(obj.data.vertices)
    count = np.maximum(np.bincount(vertices, minlength=n), 1)
    sums = [np.bincount(vertices, weights=channel, minlength=n) for channel in corners.T]
    notes = []
    space = image.colorspace_settings.name
    if space not in LINEAR_SPACES and space != SRGB:
        notes.append(f'the color space "{space}" of the image was assumed to be linear')
    return Colors(image.name, np.stack(sums, axis=1) / count[:, None], notes)


def _active_image(obj: bpy.types.Object) -> bpy.types.Image:
    material = obj.active_material
    if material is None or material.node_tree is None:
        raise AttributeRefusedError(
            f'"{obj.name}" has no material with nodes: give it one with an image texture'
        )
    nodes = [node for node in material.node_tree.nodes if node.type == "TEX_IMAGE" and node.image is not None]
    if not nodes:
        raise AttributeRefusedError(f'The material "{material.name}" of "{obj.name}" has no image texture')
    node = next((node for node in nodes if node == material.node_tree.nodes.active), None)
    image = (node or next((node for node in nodes if _feeds_base_color(node)), nodes[0])).image
    if image.source == "TILED":
        raise AttributeRefusedError(
            f'The image "{image.name}" has tiles (UDIM), which are not read: use one tile'
        )
    if min(image.size) == 0:
        raise AttributeRefusedError(f'The image "{image.name}" has no pixels: its file may be missing')
    return image


def _feeds_base_color(node: bpy.types.Node) -> bool:
    return any(link.to_socket.name == "Base Color" for socket in node.outputs for link in socket.links)


def _pixels(image: bpy.types.Image) -> np.ndarray:
    """The pixels (h, w, 4) float32, linear, the lowest row first."""
    width, height = image.size
    flat = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(flat)
    given = flat.reshape(height, width, image.channels)
    pixels = np.ones((height, width, 4), np.float32)
    used = min(image.channels, 4)
    if image.channels < 3:
        pixels[..., :3] = given[..., :1]
    else:
        pixels[..., :used] = given[..., :used]
    if image.colorspace_settings.name == SRGB and not image.is_float:
        low = pixels[..., :3] <= 0.04045
        pixels[..., :3] = np.where(low, pixels[..., :3] / 12.92, ((pixels[..., :3] + 0.055) / 1.055) ** 2.4)
    return pixels


def drawn_in(uv: np.ndarray, starts: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """Places (c, 2) of face corners, moved toward the middle of their face by `INSIDE` pixels."""
    counts = np.diff(np.append(starts, len(uv)))
    middle = np.repeat(np.add.reduceat(uv, starts, axis=0) / counts[:, None], counts, axis=0)
    way = middle - uv
    pixels = np.linalg.norm(way * size, axis=1, keepdims=True)
    return uv + way * np.minimum(1.0, INSIDE / np.maximum(pixels, 1e-9))


def sampled(pixels: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """The colors (k, 4) of pixels (h, w, 4) at places (k, 2), bilinear, the image repeated."""
    height, width = pixels.shape[:2]
    place = np.nan_to_num(uv) * (width, height) - 0.5
    low = np.floor(place)
    part = place - low
    columns = [(low[:, 0] + step).astype(np.int64) % width for step in (0, 1)]
    rows = [(low[:, 1] + step).astype(np.int64) % height for step in (0, 1)]
    along = [np.stack([1 - part[:, axis], part[:, axis]]) for axis in (0, 1)]
    result = np.zeros((len(uv), pixels.shape[2]))
    for i in (0, 1):
        for j in (0, 1):
            result += (along[0][i] * along[1][j])[:, None] * pixels[rows[j], columns[i]]
    return result
