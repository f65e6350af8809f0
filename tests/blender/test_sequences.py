"""Random sequences over all tools: a few here, in Blender 4.2 and 5.2; `make fuzz` makes many more.

RIDGEFORM_FUZZ_SEED and RIDGEFORM_FUZZ_COUNT say which and how many; how much was done is then appended to the
file RIDGEFORM_FUZZ_COUNTS.
"""

import json
import os
from pathlib import Path

from hypothesis import HealthCheck, Phase, seed, settings
from hypothesis.stateful import run_state_machine_as_test
from sequences import Sequences, counts

SEED = int(os.environ.get("RIDGEFORM_FUZZ_SEED", "1"))
COUNT = int(os.environ.get("RIDGEFORM_FUZZ_COUNT", "40"))
STEPS = 40


def test_no_sequence_ends_in_a_fault(tmp_path, monkeypatch):
    # Some operators write files, under whatever names they are given.
    monkeypatch.chdir(tmp_path)
    chosen = settings(
        max_examples=COUNT,
        stateful_step_count=STEPS,
        deadline=None,
        database=None,
        derandomize=False,
        phases=(Phase.generate, Phase.shrink),
        suppress_health_check=list(HealthCheck),
        print_blob=True,
    )
    run_state_machine_as_test(seed(SEED)(Sequences), settings=chosen)
    report = os.environ.get("RIDGEFORM_FUZZ_COUNTS")
    if report:
        with Path(report).open("a", encoding="utf-8") as stream:
            print(json.dumps(counts), file=stream)
    assert counts["sequences"] >= COUNT
