"""The notebooks run as they stand, and show what they promise."""

import notebook_pages
import numpy as np


def run(name):
    """The pictures of a notebook, and what its cells have named."""
    names = {}
    done = notebook_pages.run(notebook_pages.NOTEBOOKS / f"{name}.ipynb", names)
    pictures = [value._repr_svg_() for *_, value in done if value is not None]
    for picture in pictures:
        assert picture.count("<polygon") > 100
        assert "nan" not in picture.lower()
        # A page of the documentation holds a few of them.
        assert len(picture) < 1_000_000
    return pictures, names


def test_facets():
    pictures, names = run("facets")
    assert len(pictures) == 3
    moved = [abs(flow.vertices - names["vertices"]).max() for flow in names["flows"]]
    assert moved == sorted(moved)
    np.testing.assert_allclose([made.n_facets for made in names["counts"]], [30, 80, 200], rtol=0.01)
    off = [made.rms for made in names["counts"]]
    assert off == sorted(off, reverse=True)


def test_noise():
    pictures, names = run("noise")
    assert len(pictures) == 2
    noisy, flat, restored = names["offs"]
    assert restored < flat < noisy
    assert len(names["part"].surfaces) == 6
    _, sharp, smooth = names["errors"]
    assert sharp < 0.8 * smooth


def test_every_notebook_is_tested():
    assert {path.stem for path in notebook_pages.NOTEBOOKS.glob("*.ipynb")} == {"facets", "noise"}
