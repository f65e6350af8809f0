"""Cubic stylization (Liu and Jacobson 2019) by MeshLab: GIVEN.npz MADE.npz CUBENESS."""

import sys

import numpy as np
import pymeshlab

given, made, cubeness = sys.argv[1:]
with np.load(given) as data:
    mesh = pymeshlab.Mesh(vertex_matrix=data["vertices"], face_matrix=data["faces"])
meshes = pymeshlab.MeshSet()
meshes.add_mesh(mesh)
meshes.apply_coord_cubic_stylization(lcubeness=float(cubeness))
np.savez(made, vertices=meshes.current_mesh().vertex_matrix(), faces=meshes.current_mesh().face_matrix())
