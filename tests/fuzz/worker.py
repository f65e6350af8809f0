"""One batch of fuzzed calls in a process of its own: what dies or hangs takes only the batch along.

python -m fuzz.worker SEED CALLS    (prints a line of JSON: calls, and how they ended)
"""

import collections
import faulthandler
import json
import sys

from hypothesis import HealthCheck, Phase, given, seed, settings

from fuzz.calls import Call, calls


def main(first: int, count: int) -> None:
    """Make `count` calls that follow from the seed `first`; the first fault is shrunk and raised."""
    faulthandler.enable()
    ends: collections.Counter[str] = collections.Counter()

    @seed(first)
    @settings(
        max_examples=count,
        database=None,
        deadline=None,
        phases=[Phase.generate, Phase.shrink],
        suppress_health_check=list(HealthCheck),
        print_blob=False,
    )
    @given(calls())
    def run(call: Call) -> None:
        ends[call.check()] += 1

    run()
    print(json.dumps({"calls": ends.total(), "ends": ends}))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
