"""Pictures of triangle meshes, without a window, in the bpy of Blender 4.2 and later.

    render(vertices, faces, "bunny.png", view=(0.6, -1, 0.4))
    sheet("bunny_sheet.png", [[before, after]], columns=["before", "after"], rows=["bunny"])

or from the shell, one row of captioned pictures: `python scripts/pictures.py a.obj b.blend -o row.png`.

Facets are colored by lights fixed to the camera and drawn by Workbench (with cavity shading) or, where the
machine has no EGL, by Cycles. Every call works in a scene of its own and removes it afterwards.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import ArrayLike, NDArray
from picture_geometry import (
    CLAY,
    Lines,
    Mark,
    camera_axes,
    face_normals,
    facet_colors,
    ridge_edges,
)
from picture_scene import (
    Pixels,
    add_camera,
    colored_mesh,
    draw,
    emission_material,
    link,
    pick_engine,
    picture_scene,
    save_png,
    save_small_png,
)

Vector = tuple[float, float, float]

VIEW: Vector = (0.6, -1.0, 0.4)
UP: Vector = (0.0, 0.0, 1.0)
TEXT_COLOR = (0.015, 0.017, 0.022)
OCCLUSION_DISTANCE = 0.08
"""Reach of the cavity shading, as a share of the picture's longer side."""


def render(
    vertices: ArrayLike,
    faces: ArrayLike,
    path: str | Path | None = None,
    *,
    view: Vector = VIEW,
    up: Vector = UP,
    size: int | tuple[int, int] = 512,
    frame: ArrayLike | None = None,
    margin: float = 0.05,
    background: Vector | None = (1.0, 1.0, 1.0),
    color: ArrayLike = CLAY,
    lit: bool = True,
    ridges: float | None = None,
    marks: Sequence[Mark] = (),
    engine: str = "AUTO",
) -> Pixels:
    """Draw a triangle mesh flat-shaded: `(height, width, 4)` sRGB bytes, saved as PNG if `path` is given.

    `view` points from the object to the camera (orthographic, `up` upwards). The bounding box of `frame`
    (default: `vertices`) fills the picture up to `margin`; give the same `frame` to pictures to be compared.
    `background` is sRGB, None for transparent. `color` is linear RGB, one or one per face `(m, 3)`.
    `lit` False draws the colors as they are, without light and shadow. `ridges` draws dark lines along edges
    that bend by more than so many degrees (-1: all edges); `marks` are lines and dots over the surface.
    `engine` is "BLENDER_WORKBENCH", "CYCLES" or "AUTO".
    """
    vertices = np.asarray(vertices, dtype=float)
    faces = np.asarray(faces, dtype=np.int64)
    width, height = (size, size) if isinstance(size, int) else size
    axes = camera_axes(view, up)
    seen = (vertices if frame is None else np.asarray(frame, dtype=float)) @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    extent = (high - low)[:2] / (1 - 2 * margin)
    units_per_pixel = max(extent[0] / width, extent[1] / height) or 1.0
    if lit:
        colors = facet_colors(face_normals(vertices, faces), axes, color)
    else:
        colors = np.array(np.broadcast_to(np.asarray(color, dtype=float), (len(faces), 3)))
    if ridges is not None:
        marks = [Lines(vertices[ridge_edges(vertices, faces, ridges)]), *marks]
    for mark in marks:
        strips, strip_faces = mark.drawn(axes, units_per_pixel)
        faces = np.concatenate([faces, strip_faces + len(vertices)])
        vertices = np.concatenate([vertices, strips])
        colors = np.concatenate([colors, np.tile(mark.color, (len(strip_faces), 1))])
    depth = vertices @ axes[2]
    thickness = float(np.ptp(depth)) or 1.0
    eye = axes.T @ [*(0.5 * (low + high))[:2], depth.max() + thickness]
    with picture_scene(width, height, pick_engine(engine)) as scene:
        scene.display.shading.show_cavity = lit
        scene.display.matcap_ssao_distance = OCCLUSION_DISTANCE * units_per_pixel * max(width, height)
        mesh = colored_mesh(vertices, faces, colors)
        if scene.render.engine == "CYCLES":
            mesh.materials.append(emission_material(scene.display.matcap_ssao_distance if lit else None))
        link(scene, mesh)
        add_camera(scene, axes, eye, max(width, height) * units_per_pixel, 3 * thickness)
        pixels = draw(scene)
    if background is not None:
        pixels = _over(pixels, np.broadcast_to(np.rint(255 * np.array([*background, 1.0])), pixels.shape))
    if path is not None:
        save_png(path, pixels)
    return pixels


def triangles(objects: Sequence[bpy.types.Object]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Evaluated triangles of mesh objects in world space, joined: `(n, 3)` vertices, `(m, 3)` faces."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    vertices, faces, n = [], [], 0
    for obj in objects:
        evaluated = obj.evaluated_get(depsgraph)
        mesh = evaluated.to_mesh()
        mesh.calc_loop_triangles()
        co = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        tri = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.vertices.foreach_get("co", co)
        mesh.loop_triangles.foreach_get("vertices", tri)
        evaluated.to_mesh_clear()
        world = np.array(obj.matrix_world)
        vertices.append(co.reshape(-1, 3) @ world[:3, :3].T + world[:3, 3])
        faces.append(tri.reshape(-1, 3) + n)
        n += len(vertices[-1])
    return np.concatenate(vertices), np.concatenate(faces)


def sheet(
    path: str | Path,
    pictures: Sequence[Sequence[Pixels | None]],
    *,
    columns: Sequence[str] | None = None,
    rows: Sequence[str] | None = None,
    captions: Sequence[Sequence[str]] | None = None,
    title: str | None = None,
    text_pixels: int = 18,
    shades: int | None = None,
) -> Pixels:
    """Put rows of pictures of one size on one white labeled page and save it as PNG to `path`.

    `columns` are written above, `rows` at the left, `captions` (one per picture) below; None leaves a gap.
    With `shades`, the file has so many of each channel, and is a half or a third of its size.
    """
    height, width = next(p.shape[:2] for row in pictures for p in row if p is not None)
    line = round(1.6 * text_pixels)
    n_columns = max(len(row) for row in pictures)
    left = round(0.6 * text_pixels * (max(map(len, rows)) + 2)) if rows else 0
    top = (line if columns else 0) + (line if title else 0)
    step = height + (line if captions else 0)
    page = np.full((top + step * len(pictures), left + width * n_columns, 4), 255, dtype=np.uint8)
    texts = [(left + width * n_columns / 2, line / 2, title)] if title else []
    texts += [(left + width * (j + 0.5), top - line / 2, text) for j, text in enumerate(columns or ())]
    texts += [(left / 2, top + step * i + height / 2, text) for i, text in enumerate(rows or ())]
    for i, row in enumerate(pictures):
        for j, picture in enumerate(row):
            if picture is not None:
                _paste(page, picture, top + step * i, left + width * j)
            if captions:
                texts.append((left + width * (j + 0.5), top + step * i + height + line / 2, captions[i][j]))
    if texts:
        strips = _text_strips([text for _, _, text in texts], text_pixels, line)
        for (x, y, _), strip in zip(texts, strips, strict=True):
            _paste(page, strip, round(y - strip.shape[0] / 2), round(x - strip.shape[1] / 2))
    if shades is None:
        save_png(path, page)
    else:
        save_small_png(path, page, shades)
    return page


def _paste(page: Pixels, picture: Pixels, top: int, left: int) -> None:
    """Composite `picture` over `page` with its corner at `(top, left)`, cut off at the page's border."""
    height, width = picture.shape[:2]
    y, x = max(top, 0), max(left, 0)
    target = page[y : top + height, x : left + width]
    target[:] = _over(picture[y - top :, x - left :][: target.shape[0], : target.shape[1]], target)


def _over(front: Pixels, back: Pixels) -> Pixels:
    """Composite straight-alpha `front` over opaque `back`."""
    alpha = front[..., 3:] / 255.0
    mixed = np.rint(front[..., :3] * alpha + back[..., :3] * (1 - alpha)).astype(np.uint8)
    return np.concatenate([mixed, np.full_like(mixed[..., :1], 255)], axis=-1)


def _text_strips(texts: list[str], pixels: int, line: int) -> list[Pixels]:
    """Every text in dark letters centered on a transparent strip `line` pixels high: one render for all."""
    width = round(0.75 * pixels * max(map(len, texts)) + pixels)
    height = line * len(texts)
    with picture_scene(width, height, pick_engine("AUTO")) as scene:
        scene.display.shading.color_type = "SINGLE"
        scene.display.shading.single_color = TEXT_COLOR
        scene.display.shading.show_cavity = False
        for k, text in enumerate(texts):
            curve = bpy.data.curves.new("picture", "FONT")
            curve.body, curve.size, curve.align_x, curve.align_y = text, pixels, "CENTER", "CENTER"
            link(scene, curve).location = (0, height / 2 - (k + 0.5) * line, 0)
            if scene.render.engine == "CYCLES":
                curve.materials.append(emission_material(None))
        add_camera(scene, np.eye(3), np.array([0, 0, 1.0]), max(width, height), 2.0)
        return np.split(draw(scene), len(texts))


def _load_triangles(path: Path) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """All mesh objects of a file in a format Blender reads (.blend .obj .ply .stl), joined."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    if path.suffix == ".blend":
        bpy.ops.wm.open_mainfile(filepath=str(path))
    else:
        getattr(bpy.ops.wm, f"{path.suffix[1:]}_import")(filepath=str(path))
    return triangles([obj for obj in bpy.context.scene.objects if obj.type == "MESH"])


def main(arguments: Sequence[str]) -> None:
    """Draw files side by side, captioned with their names."""
    parser = argparse.ArgumentParser(prog="pictures.py", description=main.__doc__)
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--view", nargs=3, type=float, default=VIEW, metavar=("X", "Y", "Z"))
    parser.add_argument("--up", nargs=3, type=float, default=UP, metavar=("X", "Y", "Z"))
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument(
        "--ridges", type=float, help="dark lines along edges that bend by more degrees than this"
    )
    options = parser.parse_args(arguments)
    look = {"view": options.view, "up": options.up, "size": options.size, "ridges": options.ridges}
    pictures = [render(*_load_triangles(path), **look) for path in options.files]
    sheet(options.output, [pictures], captions=[[path.stem for path in options.files]])


if __name__ == "__main__":
    main(sys.argv[1:])
