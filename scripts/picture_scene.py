"""A throw-away Blender scene that draws one picture: engine, camera, colored mesh, image files."""

from __future__ import annotations

import ctypes.util
import os
import struct
import sys
import tempfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]

CYCLES_SAMPLES = 32


def pick_engine(name: str) -> str:
    """The engine to draw with: for "AUTO", Workbench where the machine has EGL, else Cycles."""
    if name != "AUTO":
        return name
    return "BLENDER_WORKBENCH" if ctypes.util.find_library("EGL") else "CYCLES"


@contextmanager
def picture_scene(width: int, height: int, engine: str) -> Iterator[bpy.types.Scene]:
    """Empty scene set up for one picture; on leaving, it and everything in it are removed."""
    scene = bpy.data.scenes.new("picture")
    scene.render.engine = engine
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = True
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.image_settings.compression = 30
    scene.render.dither_intensity = 0
    scene.view_settings.view_transform = "Standard"
    if engine == "CYCLES":
        scene.cycles.samples = CYCLES_SAMPLES
        scene.cycles.use_denoising = False
    else:
        _set_up_workbench(scene)
    try:
        yield scene
    finally:
        data = [(obj, obj.data) for obj in scene.collection.objects]
        bpy.data.scenes.remove(scene)
        for obj, block in data:
            materials = list(getattr(block, "materials", ()))
            bpy.data.objects.remove(obj)
            bpy.data.batch_remove([block, *materials])


def _set_up_workbench(scene: bpy.types.Scene) -> None:
    shading = scene.display.shading
    shading.light = "FLAT"
    shading.color_type = "VERTEX"
    shading.show_object_outline = False
    shading.show_cavity = True
    shading.cavity_type = "BOTH"
    shading.cavity_ridge_factor, shading.cavity_valley_factor = 0.0, 1.2
    shading.curvature_ridge_factor, shading.curvature_valley_factor = 0.3, 0.5
    # 8 samples take 0.5 s a picture on two cores with software OpenGL, 16 take 0.9 s and look alike.
    scene.display.render_aa = "8"


def colored_mesh(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], colors: NDArray[np.float64]
) -> bpy.types.Mesh:
    """Mesh data with flat faces and one linear color per face."""
    mesh = bpy.data.meshes.new("picture")
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", vertices.astype(np.float32).ravel())
    mesh.loops.add(3 * len(faces))
    mesh.loops.foreach_set("vertex_index", faces.astype(np.int32).ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(faces), 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.zeros(len(faces), dtype=bool))
    layer = mesh.color_attributes.new("Color", "FLOAT_COLOR", "CORNER")
    rgba = np.concatenate([colors, np.ones((len(colors), 1))], axis=1).astype(np.float32)
    layer.data.foreach_set("color", np.repeat(rgba, 3, axis=0).ravel())
    mesh.color_attributes.active_color = layer
    mesh.update(calc_edges=True)
    return mesh


def link(scene: bpy.types.Scene, data: bpy.types.ID) -> bpy.types.Object:
    """Put data into the scene as an object."""
    obj = bpy.data.objects.new("picture", data)
    scene.collection.objects.link(obj)
    return obj


def add_camera(
    scene: bpy.types.Scene, axes: NDArray[np.float64], eye: NDArray[np.float64], scale: float, far: float
) -> None:
    """Orthographic camera at `eye`, axes in the rows of `axes`; `scale` is the longer side of the picture."""
    camera = bpy.data.cameras.new("picture")
    camera.type, camera.sensor_fit, camera.ortho_scale = "ORTHO", "AUTO", scale
    camera.clip_start, camera.clip_end = far * 1e-4, far
    scene.camera = link(scene, camera)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = axes.T, eye
    scene.camera.matrix_world = Matrix(pose)


def emission_material(occlusion_distance: float | None) -> bpy.types.Material:
    """Cycles: the mesh's colors as they are, darkened in cavities as Workbench would."""
    material = bpy.data.materials.new("picture")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    color, emission = nodes.new("ShaderNodeVertexColor"), nodes.new("ShaderNodeEmission")
    color.layer_name = "Color"
    output = nodes.new("ShaderNodeOutputMaterial")
    links.new(emission.outputs[0], output.inputs["Surface"])
    links.new(color.outputs["Color"], emission.inputs["Color"])
    if occlusion_distance is not None:
        occlusion = nodes.new("ShaderNodeAmbientOcclusion")
        occlusion.samples = 1  # per camera sample: the 32 of those are enough
        occlusion.inputs["Distance"].default_value = occlusion_distance
        links.new(occlusion.outputs["AO"], emission.inputs["Strength"])
    return material


def draw(scene: bpy.types.Scene) -> Pixels:
    """Render the scene on a transparent background; what Blender prints is shown only if it fails."""
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.png")
        with _output_to(Path(folder) / "output"):
            bpy.ops.render.render(write_still=True, scene=scene.name)
        return load_png(scene.render.filepath)


@contextmanager
def _output_to(path: Path) -> Iterator[None]:
    """Collect what the process prints, at the level of file descriptors; passed on when the body raises."""
    sys.stdout.flush()
    sys.stderr.flush()
    saved = os.dup(1), os.dup(2)
    with path.open("w") as log:
        os.dup2(log.fileno(), 1)
        os.dup2(log.fileno(), 2)
    failed = True
    try:
        yield
        failed = False
    finally:
        for target, copy in zip((1, 2), saved, strict=True):
            os.dup2(copy, target)
            os.close(copy)
        if failed:
            print(path.read_text(), file=sys.stderr)


def save_png(path: str | Path, pixels: Pixels) -> None:
    """Save `(height, width, 4)` sRGB bytes, top row first, as PNG."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new("sheet", width, height, alpha=True)
    try:
        image.pixels.foreach_set((pixels[::-1].astype(np.float32) / 255).ravel())
        image.filepath_raw = str(Path(path).resolve())
        image.file_format = "PNG"
        image.save()
    finally:
        bpy.data.images.remove(image)


def save_small_png(path: str | Path, pixels: Pixels, shades: int) -> None:
    """Save opaque sRGB bytes `(height, width, 4)`, top row first, as PNG with so many shades a channel."""
    height, width = pixels.shape[:2]
    step = 255 / (shades - 1)
    values = np.rint(np.rint(pixels[..., :3] / step) * step).astype(np.uint8)
    # Every row without a filter: differences of few shades repeat less than the shades themselves.
    rows = np.concatenate([np.zeros((height, 1), np.uint8), values.reshape(height, -1)], axis=1)
    chunks = {
        b"IHDR": struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0),
        b"IDAT": zlib.compress(rows.tobytes(), 9),
        b"IEND": b"",
    }
    with Path(path).open("wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for name, data in chunks.items():
            file.write(
                struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
            )


def load_png(path: str | Path) -> Pixels:
    """Read an image file as `(height, width, 4)` sRGB bytes, top row first."""
    image = bpy.data.images.load(str(Path(path).resolve()))
    try:
        values = np.empty(4 * image.size[0] * image.size[1], dtype=np.float32)
        image.pixels.foreach_get(values)
        pixels = np.rint(values * 255).astype(np.uint8).reshape(image.size[1], image.size[0], 4)
        return np.ascontiguousarray(pixels[::-1])
    finally:
        bpy.data.images.remove(image)
