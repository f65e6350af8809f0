"""One short example for every function of the package, in cells: `python api.py`, or run them one by one.

The API page of the documentation shows each cell beside the function that it is about.
"""

# %% prelude
import threading

import numpy as np
import ridgeform

n = 31
x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij"))
vertices = np.column_stack([x, y, 0.5 * np.abs(x)])  # a valley along the line x = 0
corner = (n * np.arange(n - 1)[:, None] + np.arange(n - 1)).ravel()
faces = np.concatenate(
    [np.stack([corner, corner + n, corner + n + 1], 1), np.stack([corner, corner + n + 1, corner + 1], 1)]
)
random = np.random.default_rng(0)

# %% Mesh
mesh = ridgeform.Mesh(vertices, faces)
print(mesh.n_vertices, mesh.n_faces, mesh.report.n_components)
flat = ridgeform.Mesh.from_edge_lengths(mesh.faces, mesh.edge_lengths)  # no positions needed for operators

# %% stylize
bumpy = ridgeform.Mesh(vertices + random.normal(scale=0.01, size=vertices.shape), faces)
result = ridgeform.stylize(bumpy, iterations=5, fidelity=1e4, scale="area")
print(result.status, result.energy[0], result.energy[-1], result.vertices.shape)

# %% segment
found = ridgeform.segment(mesh)
print(found.n_segments, np.bincount(found.labels))  # the two sides of the valley

# %% parts
limbs = ridgeform.parts(mesh, n_parts=2)
print(limbs.n_parts, limbs.range, limbs.labels_at(1).max())

# %% facet
low_poly = ridgeform.facet(mesh, facets=2)
print(low_poly.n_facets, low_poly.planes[:, :3].round(2), low_poly.at(error=0.1).n_facets)

# %% restore
part = ridgeform.restore(bumpy, regularize=2.0)
print(part.status, [surface["kind"] for surface in part.surfaces], part.n_folded)

# %% find_holes
middle = (np.abs(vertices[corner, :2]) < 0.3).all(axis=1)
open_mesh = ridgeform.Mesh(vertices, faces[~np.tile(middle, 2)])
for hole in ridgeform.find_holes(open_mesh):
    print(len(hole.vertices), hole.is_outer_border, hole.refusal)

# %% fill_holes
filled = ridgeform.fill_holes(open_mesh)
print(len(filled.new_faces), [hole.status for hole in filled.holes])

# %% weld
soup = vertices[faces].reshape(-1, 3)  # as STL files have it: three vertices of its own for every triangle
joined, joined_faces, index = ridgeform.weld(soup, np.arange(len(soup)).reshape(-1, 3))
print(len(soup), len(joined), np.array_equal(joined_faces, index.reshape(-1, 3)))

# %% orient
turned = np.where(random.random((len(faces), 1)) < 0.1, faces[:, [0, 2, 1]], faces)
oriented, flipped = ridgeform.orient(turned)
print(flipped.sum(), np.array_equal(oriented, faces))

# %% memory_available
print(f"{ridgeform.memory_available() / 1e9:.1f} GB are free for this process")

# %% memory_estimate
needed = ridgeform.memory_estimate("stylize", (10**6, 2 * 10**6))
print(f"stylizing a million vertices takes {needed / 1e9:.1f} GB")

# %% denoise
noisy = np.abs(y) + random.normal(scale=0.05, size=len(y))
smooth = ridgeform.denoise(mesh, noisy, fidelity=1e3)
print(smooth.status, smooth.gap, np.abs(smooth.values - np.abs(y)).max())

# %% interpolate
known = random.choice(mesh.n_vertices, 40, replace=False)
spread = ridgeform.interpolate(mesh, known, np.abs(y)[known])
print(spread.status, spread.values.shape)

# %% vibration_modes
modes = ridgeform.vibration_modes(mesh, 4)
print(modes.shape)  # a function in each column, the one that bends least first

# %% diffusion_curves
colors = np.where(x[:, None] < 0, [1.0, 0.8, 0.2], [0.1, 0.3, 0.6])
curves = ridgeform.diffusion_curves(mesh, colors)
print(len(curves.polylines), curves.psnr, curves.n_numbers, curves.n_numbers_before)

# %% redraw
dark = ridgeform.redraw(mesh, curves.edges, 0.5 * curves.left, 0.5 * curves.right, sides=curves.sides)
print(dark.colors.shape, dark.corners.shape)

# %% smooth_curves
ends = ridgeform.smooth_curves(mesh, curves.edges)
print(ends.shape)  # where to draw both ends of each edge

# %% trace_curves
line = np.column_stack([np.linspace(-0.9, 0.9, 5), np.full(5, 0.2), np.zeros(5)])
path, starts, places = ridgeform.trace_curves(mesh, line)
print(len(path))  # vertices along the edges that keep closest to the line

# %% coarsen
fewer = ridgeform.coarsen(mesh, 100, kept=np.flatnonzero(x == 0))  # the valley's line stays
at = fewer.vertices[fewer.faces[fewer.places]]  # for every vertex the corners of its place
print(len(fewer.vertices), np.abs(np.einsum("ij,ijk->ik", fewer.weights, at) - vertices).max() < 1e-9)

# %% remesh
even = ridgeform.remesh(mesh, edge_length=0.1)
print(even.vertices.shape, even.faces.shape, even.edge_length)

# %% hessian
matrix = ridgeform.hessian(mesh)  # (4m, n): a 2 x 2 matrix for each face
print(matrix.shape, np.abs(matrix @ np.ones(mesh.n_vertices)).max())

# %% hessian_norm
bent = ridgeform.hessian_norm(mesh, np.abs(y))
print(bent.shape, (bent > 1e-9).sum())  # one number for each face: how much the function bends there

# %% energy
print(ridgeform.energy(mesh, np.abs(y)), ridgeform.energy(mesh, np.abs(y), kind="l2_hessian"))

# %% voronoi_mass
print(ridgeform.voronoi_mass(mesh).sum())  # the area of the surface

# %% cotangent_laplacian
print(np.abs(ridgeform.cotangent_laplacian(mesh) @ np.ones(mesh.n_vertices)).max())

# %% intrinsic_delaunay
print(ridgeform.intrinsic_delaunay(mesh).n_faces)

# %% boundary_loops
print([len(loop) for loop in ridgeform.boundary_loops(open_mesh)])

# %% SparseMatrix
print(matrix.nnz, matrix.indptr.shape, matrix.indices.shape, matrix.data.shape)
scipy_matrix = matrix.to_scipy()  # needs SciPy

# %% Progress
progress = ridgeform.Progress()
call = threading.Thread(target=ridgeform.stylize, args=(mesh,), kwargs={"progress": progress})
call.start()
while call.is_alive():
    call.join(timeout=0.1)
    print(f"{progress.stage}: {100 * progress.fraction:.0f} %")
