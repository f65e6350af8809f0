"""Setting up on a machine that lacks something: one clear line, and nothing done."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).parents[1] / "scripts"


@pytest.fixture
def checkout(tmp_path):
    """A copy of the scripts in a folder of its own, where a set-up would leave its traces."""
    shutil.copytree(SCRIPTS, tmp_path / "scripts", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


def set_up(checkout, **environment):
    """Exit code and what was said."""
    command = [sys.executable, "-B", checkout / "scripts/setup_env.py"]
    done = subprocess.run(
        command, env=os.environ | environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert [path.name for path in checkout.iterdir()] == ["scripts"]
    return done.returncode, done.stdout + done.stderr


def test_no_rust(checkout):
    code, said = set_up(checkout, PATH="", RIDGEFORM_PYTHON=sys.executable)
    assert code == 1
    assert len(said.splitlines()) == 1
    assert "the Rust toolchain (`cargo` 1.88 or newer" in said
    assert "Python 3.11 or 3.13" not in said


def test_no_python_that_runs(checkout):
    code, said = set_up(checkout, RIDGEFORM_PYTHON="/nowhere/python3.11")
    assert code == 1
    assert len(said.splitlines()) == 1
    assert "Python 3.11 or 3.13 with its venv module" in said


def test_a_python_that_fails_is_passed_over(checkout):
    """A pyenv shim of a version that is not active exists, and fails when run."""
    shim = checkout / "scripts/python3.13"
    shim.write_text("#!/bin/sh\nexit 127\n", encoding="utf-8")
    shim.chmod(0o755)
    code, said = set_up(checkout, RIDGEFORM_PYTHON=str(shim))
    assert code == 1
    assert "Python 3.11 or 3.13 with its venv module" in said
