"""The example of the README runs as it stands."""

import re
from pathlib import Path

import numpy as np

README = Path(__file__).parents[2] / "README.md"


def test_the_example_of_the_readme_runs(capsys):
    (example,) = re.findall(
        r"^```python\n(.*?)^```", README.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    names = {}
    exec(example, names)
    flat, smooth, true = names["flat"], names["smooth"], names["vertices"][:, 2]
    assert len(capsys.readouterr().out.splitlines()) == 3
    assert flat.status == "finished"
    assert flat.energy[-1] < flat.energy[0]
    assert smooth.status == "solved"
    error = [np.sqrt(np.mean((values - true) ** 2)) for values in (names["noisy"], smooth.values)]
    assert error[1] < 0.5 * error[0]
