"""Install the built extension into an empty Blender profile, and give every test an empty file.

The tests see the extension as a user does: `bl_ext.user_default.ridgeform` and the wheels bundled in the zip.
Installing happens when pytest loads this file, so that test modules may import both at their top.
`make test` names the zip in RIDGEFORM_EXTENSION; without it, the one built last is taken.
"""

import atexit
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from blender_profile import empty_profile, install_extension

PROFILE = empty_profile()

import bpy  # noqa: E402
import numpy as np  # noqa: E402

EXIT_CODE = pytest.StashKey[int]()
BUILT = Path(__file__).parents[2] / ".ridgeform/extension"


def _built_extension() -> Path:
    named = os.environ.get("RIDGEFORM_EXTENSION")
    built = [Path(named)] if named else sorted(BUILT.glob("*.zip"), key=lambda path: path.stat().st_mtime)
    if not built or not built[-1].is_file():
        raise pytest.UsageError("No extension to test: run `make extension`, or set RIDGEFORM_EXTENSION")
    return built[-1]


EXTENSION_ZIP = _built_extension()
install_extension(EXTENSION_ZIP, PROFILE)


@pytest.fixture(scope="session")
def extension_zip() -> Path:
    """The zip that is installed."""
    return EXTENSION_ZIP


@pytest.fixture(scope="session")
def profile() -> Path:
    """The folder that Blender takes for the user's."""
    return PROFILE


@pytest.fixture(autouse=True)
def empty_file() -> None:
    """Start every test in an empty file, the extension enabled."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)


@pytest.fixture
def add_mesh() -> Callable[..., bpy.types.Object]:
    """A function that makes a mesh object, selected and active, from vertices (n,3) and faces of any size."""

    def add(vertices: np.ndarray, faces: Sequence[Sequence[int]], name: str = "Mesh") -> bpy.types.Object:
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(np.asarray(vertices, float).tolist(), [], [list(map(int, face)) for face in faces])
        mesh.validate()
        obj = bpy.data.objects.new(name, mesh)
        bpy.context.collection.objects.link(obj)
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
        return obj

    return add


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Keep the exit code for the end."""
    session.config.stash[EXIT_CODE] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """End as the batch command does, before Python takes itself apart.

    Blender 4.2 as a module crashes in that where anything still refers to it, say a thread's last error, and
    the exit code would be the crash's. That the extension itself leaves nothing behind, a Blender of its own
    shows in `test_extension_install.py`.
    """
    if EXIT_CODE in config.stash:
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(config.stash[EXIT_CODE])
