"""Blocks on a Dask cluster: a worker that is killed loses nothing, and the bits are those of one process.

`make test-dask` has an environment with the package distributed.
"""

import os
import re
import signal
import threading
import types
from pathlib import Path

import numpy as np
import pytest
from known_shapes import shapes
from ridgeform import tiles

distributed = pytest.importorskip("distributed", reason="`make test-dask` runs it")

pytestmark = pytest.mark.skipif(os.name == "nt", reason="Windows has no such signals")

HALF = {"movement": 0.007, "flat_share": 0.5, "fidelity": 10**6.55, "scale": "area", "sharpness": 0.75}
SMALL = {"max_vertices": 1200, "rings": 8, "threads": 1}


@pytest.fixture
def client():
    """Two workers of one thread."""
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, memory_limit=None, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as made,
    ):
        yield made


def killed_during(client, stage, work):
    """What `work` returns with a report that kills a worker once blocks of a stage are done."""
    workers = client.run(os.getpid)
    assert len(workers) == 2
    gone = threading.Event()

    def report(now, done, total):
        if not gone.is_set() and now == stage and 0 < done < total:
            os.kill(next(iter(workers.values())), signal.SIGKILL)
            gone.set()

    found = work(report)
    assert gone.is_set()
    client.wait_for_workers(2, timeout=30)
    assert set(client.run(os.getpid).values()) != set(workers.values())
    return found


def test_a_worker_that_is_killed_loses_nothing(client, tmp_path):
    vertices, faces = shapes.cube(30)
    noisy = shapes.add_noise(vertices, faces, 0.2)
    alone = tiles.stylize(noisy, faces, **HALF, **SMALL)
    given = {"executor": client, "folder": tmp_path, **HALF, **SMALL}
    result = killed_during(
        client, "moving level 0", lambda report: tiles.stylize(noisy, faces, report=report, **given)
    )
    assert np.array_equal(result.vertices, alone.vertices)
    assert np.array_equal(result.energy, alone.energy)
    assert list(tmp_path.iterdir()) == []


def test_segments_are_the_same_as_well(client):
    vertices, faces = shapes.cube(30)
    noisy = shapes.add_noise(vertices, faces, 0.05)
    alone = tiles.segment(noisy, faces, **SMALL)
    result = killed_during(
        client,
        "segmenting",
        lambda report: tiles.segment(noisy, faces, report=report, executor=client, **SMALL),
    )
    assert np.array_equal(result.labels, alone.labels)
    assert result.n_segments == alone.n_segments == 6


def test_the_python_of_the_manual_runs(client, tmp_path):
    """As it is written, but for the address and the folder."""
    page = (Path(__file__).parents[2] / "docs/manual_tiles.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"^```python\n(from distributed.*?)^```", page, re.MULTILINE | re.DOTALL)
    code = code.replace("tcp://scheduler:8786", client.scheduler.address)
    vertices, faces = shapes.cube(8)
    names = {"tiles": tiles, "city": types.SimpleNamespace(vertices=vertices, faces=faces)}
    exec(code.replace("/shared/work", str(tmp_path)), names)
    assert names["result"].vertices.shape == vertices.shape
