"""Formatting and lints of Rust and Python.

python scripts/setup_env.py scripts/lint.py
"""

import sys

from workspace import run

CHECKS = {
    "Rust formatting": ["cargo", "fmt", "--all", "--check"],
    "Python lints": [sys.executable, "-m", "ruff", "check", "."],
    "Python formatting": [sys.executable, "-m", "ruff", "format", "--check", "."],
    "Rust lints": [
        "cargo",
        "clippy",
        "--release",
        "--locked",
        "--all-targets",
        "--quiet",
        "--",
        "-D",
        "warnings",
    ],
}

if __name__ == "__main__":
    for what, command in CHECKS.items():
        run(command, what)
