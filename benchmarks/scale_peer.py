"""MeshLib's denoising by normals on the mesh of `scale.py`: VERTICES NOISE."""

import json
import sys
import time

from meshlib import mrmeshnumpy, mrmeshpy
from scale_shapes import ring


def main(size: int, noise: float) -> dict[str, float]:
    """Processor time of one call with default settings."""
    mesh = mrmeshnumpy.meshFromFacesVerts(*reversed(ring(size, noise)))
    begun = time.process_time()
    mrmeshpy.meshDenoiseViaNormals(mesh, mrmeshpy.DenoiseViaNormalsSettings())
    return {"processor": time.process_time() - begun}


if __name__ == "__main__":
    print(json.dumps(main(int(sys.argv[1]), float(sys.argv[2]))))
