"""Label the faces of all meshes of a folder by the facets of trimesh; needs `requirements-segments.txt`.

python benchmarks/segments_peer.py FOLDER
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import trimesh


def main(folder: Path) -> None:
    """Write K.labels.npy beside every K.npz."""
    for path in sorted(folder.glob("*.npz")):
        given = np.load(path)
        mesh = trimesh.Trimesh(given["vertices"], given["faces"], process=False)
        labels = np.full(len(mesh.faces), -1)
        for k, facet in enumerate(mesh.facets):
            labels[facet] = k
        alone = labels < 0
        labels[alone] = len(mesh.facets) + np.arange(alone.sum())
        np.save(path.with_suffix(".labels.npy"), labels)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
