"""Half a minute of `make fuzz`: the seeds that are kept, and some more, always the same."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
import ridgeform

FUZZ = Path(__file__).resolve().parents[1] / "fuzz"
KEPT = [(int(line), 200) for line in (FUZZ / "seeds.txt").read_text().split()]


@pytest.mark.parametrize(("seed", "calls"), [*KEPT, *[(seed, 250) for seed in range(4)]])
def test_calls_of_a_seed(seed, calls):
    site = Path(ridgeform.__file__).parents[1]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(site), str(FUZZ.parent)])}
    command = [sys.executable, "-m", "fuzz.worker", str(seed), str(calls)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=500, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    counted = json.loads(done.stdout.splitlines()[-1])
    # No call of a fuzzer that draws nothing sound would find anything.
    assert counted["calls"] >= 0.8 * calls
    assert counted["ends"]["answer"] > 0.2 * counted["calls"]
