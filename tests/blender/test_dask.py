"""Files on a Dask cluster: a worker that is killed loses nothing, and nothing is done twice.

`make test-dask` has an environment with the package distributed.
"""

import os
import signal
import threading

import batch_kit
import pytest
from bl_ext.user_default.ridgeform.framework import batch
from test_overnight import entries

distributed = pytest.importorskip("distributed", reason="`make test-dask` runs it")


pytestmark = pytest.mark.skipif(os.name == "nt", reason="Windows has no such signals")


@pytest.fixture
def cluster(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, memory_limit=None, dashboard_address=None
    ) as made:
        yield made


def test_a_worker_that_is_killed_loses_nothing_and_nothing_is_done_twice(tmp_path, capfd, cluster):
    sources, out = batch_kit.boxes(tmp_path / "in", 12), tmp_path / "out"
    with distributed.Client(cluster, set_as_default=False) as client:
        workers = client.run(os.getpid)
        assert len(workers) == 2
        begun = {}

        def kill_one():
            batch_kit.until(lambda: "done" in entries(out).values())
            begun.update(batch_kit.inodes(out))
            os.kill(next(iter(workers.values())), signal.SIGKILL)

        killer = threading.Thread(target=kill_one)
        killer.start()
        # Named as a person would, relative to where the command is given.
        names = [path.relative_to(tmp_path) for path in sources]
        options = (*batch_kit.STEPS, "--dask", cluster.scheduler_address, "--report", "page.html")
        code, records = batch_kit.run(capfd, "stylize", *names, "-o", "out", *options)
        killer.join()
        assert code == 0, records
        assert len(records) == 12
        assert workers != client.run(os.getpid)
    after = batch_kit.state_of(out)
    assert set(after) == {path.name for path in sources}
    assert begun
    assert {name: after[name] for name in begun} == begun
    assert set(entries(out).values()) == {"done"}
    outputs = [
        line for line in (tmp_path / "out.ridgeform/used").read_text().splitlines() if "output" in line
    ]
    assert len(outputs) == len(set(outputs)) == 12
    assert (tmp_path / "page.html").read_text().count("data:image/png") == 24
    code, _ = batch_kit.run(capfd, "stylize", *sources, "-o", tmp_path / "alone", *batch_kit.STEPS)
    assert all((tmp_path / "alone" / name).read_bytes() == (out / name).read_bytes() for name in after)


def test_a_cluster_that_is_not_there(tmp_path, capfd, monkeypatch):
    (source,) = batch_kit.boxes(tmp_path / "in", 1)
    command = ["stylize", str(source), "-o", str(tmp_path / "out"), "--dask", "tcp://127.0.0.1:9"]
    monkeypatch.setattr(batch.driver.dask_cluster, "CONNECT_SECONDS", 1.0)
    assert batch.main(command) == 1
    assert "there is no Dask scheduler at tcp://127.0.0.1:9" in capfd.readouterr().err
    assert batch.main([*command, "--jobs", "2"]) == 2
