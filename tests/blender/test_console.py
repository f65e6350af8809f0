"""The progress bar of the batch command."""

import importlib.util
import io

import pytest
from bl_ext.user_default.ridgeform.framework.console import ProgressBar


class Terminal(io.StringIO):
    """What is written to a terminal, or to a file."""

    encoding = "utf-8"

    def __init__(self, is_terminal):
        """Begin empty."""
        super().__init__()
        self._is_terminal = is_terminal

    def isatty(self):
        """Whether this plays a terminal."""
        return self._is_terminal


def shown(monkeypatch, is_terminal):
    stream = Terminal(is_terminal)
    monkeypatch.setattr("sys.stderr", stream)
    with ProgressBar("box.obj") as bar:
        for fraction in (0.0, 0.5, 1.0):
            bar.show(fraction)
    return stream.getvalue()


@pytest.mark.parametrize("with_tqdm", [False, True])
def test_a_terminal_sees_the_percentage(monkeypatch, with_tqdm):
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("LINES", "24")
    find = importlib.util.find_spec
    if not with_tqdm:
        monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "tqdm" else find(name))
    text = shown(monkeypatch, is_terminal=True)
    assert "box.obj:   0" in text
    assert "100" in text
    assert text.endswith("\n")


def test_a_file_sees_nothing(monkeypatch):
    assert shown(monkeypatch, is_terminal=False) == ""
