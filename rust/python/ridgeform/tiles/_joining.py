"""One segmentation of segmentations of blocks that overlap."""

from pathlib import Path

import numpy as np

from ._store import Array, block_file, get, read

MOST = 0.5
"""Two segments are one only if they have this part of what the smaller has of the faces of both blocks: a
segment that goes on behind the line has next to all, one that begins there a few faces along its border."""


class Union:
    """Sets that become one, named by their least member."""

    def __init__(self, n: int) -> None:
        """Every member alone."""
        self.parent = np.arange(n)

    def root(self, i: int) -> int:
        """The name of the set of `i`."""
        while self.parent[i] != i:
            self.parent[i] = self.parent[self.parent[i]]
            i = int(self.parent[i])
        return i

    def unite(self, i: int, j: int) -> None:
        """Makes the sets of both one."""
        i, j = self.root(i), self.root(j)
        self.parent[max(i, j)] = min(i, j)


def joined(level: Path, n_blocks: int) -> tuple[Array, int]:
    """The labels of all faces, from 0 in the order of their first faces, and how many there are.

    Each face has the label that its own block gives it.
    """
    owner, faces = get(level, "owner"), get(level, "faces")
    labels = np.full(len(faces), -1, np.int64)
    first = np.zeros(n_blocks + 1, np.int64)
    for block in range(n_blocks):
        found, given = load(level, block)
        labels[found["faces"][found["owned"]]] = first[block] + given[found["owned"]]
        first[block + 1] = first[block] + given.max(initial=-1) + 1
    union = Union(int(first[-1]))
    for block in range(n_blocks):
        found, given = load(level, block)
        for other in np.unique(owner[found["faces"]]):
            if other > block:
                theirs, their_labels = load(level, int(other))
                pair = (found, given + first[block]), (theirs, their_labels + first[other])
                for a, b in agreed(owner, pair, (block, int(other))):
                    union.unite(a, b)
    names = np.array([union.root(i) for i in range(int(first[-1]))], np.int64)
    roots = names[labels]
    _, index, inverse = np.unique(roots, return_index=True, return_inverse=True)
    order = np.argsort(np.argsort(index))
    return order[inverse].astype(np.int32), len(index)


def load(level: Path, block: int) -> tuple[dict[str, Array], Array]:
    """A block, and the labels of its faces."""
    return read(block_file(level, "block", block)), read(block_file(level, "segments", block))[
        "labels"
    ].astype(np.int64)


def agreed(
    owner: Array, pair: tuple[tuple[dict[str, Array], Array], ...], blocks: tuple[int, int]
) -> list[tuple[int, int]]:
    """The pairs of segments of two blocks that are one."""
    (one, of_one), (other, of_other) = pair
    both, at_one, at_other = np.intersect1d(
        one["faces"], other["faces"], assume_unique=True, return_indices=True
    )
    if len(both) == 0:
        return []
    a, b = of_one[at_one], of_other[at_other]
    common, share = counted(a, b)
    of_a = dict(zip(*np.unique(a, return_counts=True), strict=True))
    of_b = dict(zip(*np.unique(b, return_counts=True), strict=True))
    alike = {
        tuple(ends)
        for ends, count in zip(common.tolist(), share, strict=True)
        if count >= MOST * min(of_a[ends[0]], of_b[ends[1]])
    }
    # Edges along the line: a face that the one block owns beside one of the other.
    here = {int(face): i for i, face in enumerate(both)}
    f, g = neighbors(one["corners"], one["faces"])
    between = (owner[f] == blocks[0]) & (owner[g] == blocks[1]) & np.isin(f, both) & np.isin(g, both)
    swapped = (owner[f] == blocks[1]) & (owner[g] == blocks[0]) & np.isin(f, both) & np.isin(g, both)
    mine = np.concatenate([f[between], g[swapped]])
    theirs = np.concatenate([g[between], f[swapped]])
    if len(mine) == 0:
        return []
    mine = np.array([here[int(face)] for face in mine])
    theirs = np.array([here[int(face)] for face in theirs])
    votes = (a[mine] == a[theirs]).astype(int) + (b[mine] == b[theirs]) - 1
    contacts, inverse = np.unique(np.stack([a[mine], b[theirs]], 1), axis=0, return_inverse=True)
    sums = np.bincount(inverse.ravel(), votes, minlength=len(contacts))
    found = zip(contacts.tolist(), sums, strict=True)
    return [(ends[0], ends[1]) for ends, votes in found if votes > 0 and tuple(ends) in alike]


def counted(a: Array, b: Array) -> tuple[Array, Array]:
    """The pairs that occur, (k,2), and how often."""
    pairs, counts = np.unique(np.stack([a, b], 1), axis=0, return_counts=True)
    return pairs, counts


def neighbors(corners: Array, faces: Array) -> tuple[Array, Array]:
    """The faces at each edge of two."""
    tails, heads = corners[:, [1, 2, 0]].ravel(), corners[:, [2, 0, 1]].ravel()
    n = int(corners.max(initial=0)) + 1
    key = np.minimum(tails, heads).astype(np.int64) * n + np.maximum(tails, heads)
    order = np.argsort(key, kind="stable")
    first = np.flatnonzero(key[order][1:] == key[order][:-1])
    return faces[order[first] // 3], faces[order[first + 1] // 3]
