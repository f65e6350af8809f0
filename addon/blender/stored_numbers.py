# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of faces and edges that tools keep on a mesh, as attributes by name."""

import bpy
import numpy as np

_KINDS = {"INT": np.int32, "FLOAT": np.float32}


def read_ints(mesh: bpy.types.Mesh, name: str, domain: str, default: int) -> np.ndarray:
    """Values int32 of an attribute; the default everywhere if none has this name, type and domain."""
    n = len(mesh.polygons) if domain == "FACE" else len(mesh.edges)
    values = np.full(n, default, np.int32)
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.data_type, attribute.domain) == ("INT", domain):
        attribute.data.foreach_get("value", values)
    return values


def write_numbers(mesh: bpy.types.Mesh, name: str, data_type: str, domain: str, values: np.ndarray) -> None:
    """Store numbers in an attribute of this name; one of another type or domain is replaced."""
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.data_type, attribute.domain) != (data_type, domain):
        mesh.attributes.remove(attribute)
        attribute = None
    attribute = attribute or mesh.attributes.new(name, data_type, domain)
    attribute.data.foreach_set("value", np.ascontiguousarray(values, _KINDS[data_type]))
