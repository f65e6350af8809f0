"""Turn a mesh file into flat facets, without Blender.

    python stylize_obj.py statue.obj faceted.obj [strength]

Reads and writes triangles of OBJ files; everything but the positions and the faces is ignored.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import ridgeform


def read_obj(path):
    """Vertices (n,3) and triangles (m,3); polygons are cut into fans."""
    vertices, faces = [], []
    for line in Path(path).read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            corners = [c - 1 if c > 0 else len(vertices) + c for c in corners]
            faces += [[corners[0], b, c] for b, c in pairwise(corners[1:])]
    return np.array(vertices), np.array(faces)


def write_obj(path, vertices, faces):
    """Write triangles."""
    lines = ["v {} {} {}".format(*vertex) for vertex in vertices.tolist()]
    lines += ["f {} {} {}".format(*face) for face in (faces + 1).tolist()]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


source, target = sys.argv[1:3]
strength = float(sys.argv[3]) if len(sys.argv) > 3 else 0.5

mesh = ridgeform.Mesh(*read_obj(source))
# The slider of the add-on: even steps are even factors of the fidelity, in units of the surface area.
result = ridgeform.stylize(mesh, fidelity=10 ** (9.25 - 4 * strength), scale="area", sharpness=0.75)
write_obj(target, result.vertices, mesh.faces)
print(f"{result.iterations} steps, energy {result.energy[0]:.2f} → {result.energy[-1]:.2f}, {result.status}")
