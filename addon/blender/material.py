# SPDX-License-Identifier: GPL-3.0-or-later
"""The material that turns the values of an attribute into colors."""

import bpy
import numpy as np

from . import ramp

MARK = "ridgeform_attribute"
"""A custom property by which a material of ours is told from one of the same name."""
ROUGHNESS = 0.8
"""Dull, so that highlights do not pass for values."""
COLUMN_WIDTH = 280


def ramp_material(
    attribute: str, is_vector: bool, limits: tuple[float, float], colors: np.ndarray, bands: int
) -> bpy.types.Material:
    """The material for an attribute, made once and brought up to date afterwards.

    `limits` are the values, or lengths of vectors, at the ends of the ramp of linear colors (k, 3), evenly
    spaced. With `bands` above 0 there are so many steps of one color each, whose borders are isolines.
    """
    material = next((item for item in bpy.data.materials if item.get(MARK) == attribute), None)
    if material is None or material.library is not None:
        material = bpy.data.materials.new(f"Ridgeform {attribute}")
        material[MARK] = attribute
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    value = tree.nodes.new("ShaderNodeAttribute")
    value.attribute_name = attribute
    number = value.outputs["Fac"]
    nodes = [value]
    if is_vector:
        length = tree.nodes.new("ShaderNodeVectorMath")
        length.operation = "LENGTH"
        tree.links.new(value.outputs["Vector"], length.inputs[0])
        number = length.outputs["Value"]
        nodes.append(length)
    place = tree.nodes.new("ShaderNodeMapRange")
    place.inputs["From Min"].default_value, place.inputs["From Max"].default_value = limits
    coloring = tree.nodes.new("ShaderNodeValToRGB")
    _fill(coloring.color_ramp, colors, bands)
    surface = tree.nodes.new("ShaderNodeBsdfPrincipled")
    surface.inputs["Roughness"].default_value = ROUGHNESS
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    for column, node in enumerate([*nodes, place, coloring, surface, output]):
        node.location = (COLUMN_WIDTH * column, 0)
    tree.links.new(number, place.inputs["Value"])
    tree.links.new(place.outputs["Result"], coloring.inputs["Fac"])
    tree.links.new(coloring.outputs["Color"], surface.inputs["Base Color"])
    tree.links.new(surface.outputs["BSDF"], output.inputs["Surface"])
    return material


def _fill(color_ramp: bpy.types.ColorRamp, colors: np.ndarray, bands: int) -> None:
    if bands:
        places = np.arange(bands) / bands
        stops = ramp.colors_at(colors, places + 0.5 / bands)
    else:
        places = np.linspace(0.0, 1.0, len(colors))
        stops = ramp.colors_at(colors, places)
    color_ramp.interpolation = "CONSTANT" if bands else "LINEAR"
    elements = color_ramp.elements
    while len(elements) > 1:
        elements.remove(elements[-1])
    # A ramp keeps its elements sorted by place.
    elements[0].position = 0.0
    for place in places[1:]:
        elements.new(float(place))
    for element, color in zip(elements, stops, strict=True):
        element.color = color
