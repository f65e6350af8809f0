"""Formatting and lints of Rust and Python.

python scripts/setup_env.py scripts/lint.py
"""

import sys

from workspace import run_all

CLIPPY = ["cargo", "clippy", "--release", "--locked", "--all-targets", "--quiet", "--", "-D", "warnings"]

if __name__ == "__main__":
    run_all(
        {
            "Rust formatting": (["cargo", "fmt", "--all", "--check"], {}),
            "Python lints": ([sys.executable, "-m", "ruff", "check", "."], {}),
            "Python formatting": ([sys.executable, "-m", "ruff", "format", "--check", "."], {}),
            "Rust lints": (CLIPPY, {"PYO3_PYTHON": sys.executable}),
        }
    )
