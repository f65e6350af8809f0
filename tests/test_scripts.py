"""The scripts behind the make targets load with the paths that `setup_env.py` sets, and no others."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LOAD = """
import importlib, sys
for name in sys.argv[1:]:
    importlib.import_module(name)
"""


def test_every_script_loads():
    scripts = [
        path.stem
        for path in sorted((ROOT / "scripts").glob("*.py"))
        if '__name__ == "__main__"' in path.read_text(encoding="utf-8")
    ]
    assert "fuzz" in scripts
    paths = os.pathsep.join(str(ROOT / folder) for folder in ("tests", "scripts"))
    done = subprocess.run(
        [sys.executable, "-P", "-c", LOAD, *scripts],
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
