"""Meshes larger than memory: cut into blocks that overlap, worked on one by one or by many, and joined.

`stylize` and `segment` do what those of the package do. Only what belongs to the block at work is in memory;
everything else is in files. Blocks are worked on in this process, or by an `executor`: any of
`concurrent.futures`, or the client of a Dask cluster, whose workers see the same files. Whichever works, the
same bits come out. `read` takes a folder of tiles that adjoin, as models of cities and photogrammetry come,
for one mesh.
"""

from ._adjoining import Tiles, read
from ._segment import Segmented, segment
from ._stylize import Stylized, stylize

__all__ = ["Segmented", "Stylized", "Tiles", "read", "segment", "stylize"]
