"""Tiles that adjoin, each a file of its own, as one mesh."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import ArgumentError, MeshError
from . import _obj
from ._store import Array

KINDS = (".npz", ".obj")
"""What tiles are read from: arrays `vertices` and `faces`, or Wavefront OBJ."""


@dataclass(frozen=True)
class Tiles:
    """What `tiles.read` returns: one mesh, and which of it is which tile's.

    vertices : (n,3) float64
    faces : (m,3) int32, those of the tiles one after the other
    paths : the files, in the order of their names
    places : for each tile the vertices of the mesh that its own are, int32
    starts : the first face of each tile, and m, (tiles + 1,) int64
    """

    vertices: Array
    faces: Array
    paths: list[Path]
    places: list[Array]
    starts: Array

    def write(self, folder: str | Path, vertices: Array, labels: Array | None = None) -> list[Path]:
        """Write every tile again with new positions, (n,3), and with a label for each face, (m,), if given.

        All else that the files hold stays: other arrays of .npz, and UVs, materials, and groups of .obj.
        Where tiles adjoin, both files have the same bits. Labels are the array `labels` in .npz, and a file
        `NAME.labels.npy` beside .obj, for its triangles in their order.

        Returns the paths. Raises ArgumentError for arrays of another shape, and for files that are there
        already: nothing is overwritten.
        """
        if np.shape(vertices) != self.vertices.shape:
            raise ArgumentError(f"vertices: expected shape {self.vertices.shape}, got {np.shape(vertices)}")
        if labels is not None and np.shape(labels) != (len(self.faces),):
            raise ArgumentError(f"labels: expected shape ({len(self.faces)},), got {np.shape(labels)}")
        out = Path(folder)
        targets = [out / path.name for path in self.paths]
        taken = [target for target in targets if target.exists()]
        if taken:
            raise ArgumentError(f"folder: {taken[0]} is there already; give an empty folder")
        out.mkdir(parents=True, exist_ok=True)
        for i, (path, target) in enumerate(zip(self.paths, targets, strict=True)):
            points = np.asarray(vertices)[self.places[i]]
            own = None if labels is None else np.asarray(labels)[self.starts[i] : self.starts[i + 1]]
            if path.suffix.lower() == ".obj":
                _obj.write(path, target, points)
                if own is not None:
                    np.save(target.with_suffix(".labels.npy"), own)
                continue
            with np.load(path) as found:
                kept = {name: found[name] for name in found.files}
            kept["vertices"] = points
            if own is not None:
                kept["labels"] = own
            np.savez(target, **kept)
        return targets


def read(folder: str | Path) -> Tiles:
    """Read a folder of tiles as one mesh: all its .npz (arrays `vertices`, `faces`) and .obj files.

    Vertices on open borders that are at the same place, bit by bit, become one, in whichever tiles they are.

    Returns
    -------
    Tiles

    Raises
    ------
    ArgumentError for a folder without tiles, and for files that are none
    """
    paths = sorted(path for path in Path(folder).glob("*") if path.suffix.lower() in KINDS)
    if not paths:
        raise ArgumentError(f"folder: {folder} has no tiles; they are files named {' or '.join(KINDS)}")
    points, corners, borders = [], [], []
    for path in paths:
        vertices, faces = _obj.read(path) if path.suffix.lower() == ".obj" else arrays(path)
        if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
            raise MeshError(f"{path}: a face names a vertex that is not there")
        points.append(vertices)
        corners.append(faces)
        borders.append(border_vertices(faces))
    first = np.cumsum([0] + [len(vertices) for vertices in points])
    at = np.concatenate([begin + border for begin, border in zip(first, borders, strict=False)])
    places = np.concatenate([vertices[border] for vertices, border in zip(points, borders, strict=True)])
    # Zero has two signs.
    _, index, inverse = np.unique(places + 0.0, axis=0, return_index=True, return_inverse=True)
    name = np.arange(first[-1])
    name[at] = at[index[inverse.ravel()]]
    is_kept = name == np.arange(first[-1])
    number = (np.cumsum(is_kept) - 1)[name].astype(np.int32)
    own = [number[first[i] : first[i + 1]] for i in range(len(paths))]
    return Tiles(
        vertices=np.concatenate(points)[is_kept],
        faces=np.concatenate([place[faces] for place, faces in zip(own, corners, strict=True)]),
        paths=paths,
        places=own,
        starts=np.cumsum([0] + [len(faces) for faces in corners]),
    )


def arrays(path: Path) -> tuple[Array, Array]:
    """The mesh in a file of arrays."""
    try:
        with np.load(path) as found:
            vertices, faces = np.asarray(found["vertices"], np.float64), np.asarray(found["faces"])
    except (KeyError, ValueError, OSError) as error:
        raise ArgumentError(f"folder: {path} has no arrays vertices and faces: {error}") from error
    if vertices.shape[1:] != (3,) or faces.shape[1:] != (3,) or faces.dtype.kind not in "iu":
        raise ArgumentError(f"folder: {path} needs vertices of shape (n, 3) and faces (m, 3), whole numbers")
    return vertices, faces.astype(np.int32)


def border_vertices(faces: Array) -> Array:
    """The vertices of edges that have one face."""
    tails, heads = faces[:, [1, 2, 0]].ravel(), faces[:, [2, 0, 1]].ravel()
    n = int(faces.max(initial=0)) + 1
    key = np.minimum(tails, heads).astype(np.int64) * n + np.maximum(tails, heads)
    edges, counts = np.unique(key, return_counts=True)
    open_edges = edges[counts == 1]
    return np.unique(np.concatenate([open_edges // n, open_edges % n]))
