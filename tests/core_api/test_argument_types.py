"""Every error about the type of an argument begins with its name: all functions, all arguments."""

import inspect

import numpy as np
import pytest
import ridgeform
from known_shapes import shapes

MESH = ridgeform.Mesh(*shapes.icosphere(1))
N, M = MESH.n_vertices, MESH.n_faces

# A valid value of every argument without a default.
VALID = {
    "n_vertices": 2,
    "mesh": MESH,
    "tool": "stylize",
    "vertices": MESH.vertices,
    "faces": MESH.faces,
    "values": np.ones(N),
    "indices": [0, 1],
    "fidelity": 1.0,
    "count": 1,
    "colors": np.ones(N),
    "edges": MESH.faces[:1, :2],
    "left": np.ones((1, 2)),
    "right": np.ones((1, 2)),
    "points": MESH.vertices[:2],
}
FUNCTIONS = {
    name: getattr(ridgeform, name)
    for name in ridgeform.__all__
    if inspect.isfunction(getattr(ridgeform, name))
}
CASES = [
    (name, argument)
    for name, function in FUNCTIONS.items()
    for argument in inspect.signature(function).parameters
]


def arguments_of(name):
    """Valid values of the arguments that have no default."""
    parameters = inspect.signature(FUNCTIONS[name]).parameters.values()
    given = {p.name: VALID[p.name] for p in parameters if p.default is p.empty}
    if name == "interpolate":
        given["values"] = np.ones(2)
    return given


class Odd:
    """Nothing that any argument could be."""

    def __len__(self):
        """As long as nothing else."""
        raise TypeError("has no length")


@pytest.mark.parametrize(("name", "argument"), CASES, ids=[f"{n}-{a}" for n, a in CASES])
def test_a_wrong_type_is_named(name, argument):
    # The last is what Python makes of a file name that is not UTF-8.
    for wrong in (Odd(), b"bytes", 3 + 4j, "\udcff"):
        with pytest.raises((TypeError, ridgeform.ArgumentError)) as caught:
            FUNCTIONS[name](**{**arguments_of(name), argument: wrong})
        assert str(caught.value).startswith(f"{argument}: "), str(caught.value)


def test_functions_are_found_and_keep_their_signatures():
    assert len(FUNCTIONS) >= 18
    assert len(CASES) > 100
    signature = inspect.signature(ridgeform.stylize)
    assert signature.parameters["iterations"].default == 20
    assert "piecewise flat" in ridgeform.stylize.__doc__
    assert ridgeform.stylize.__module__ == "ridgeform"


def test_numbers_past_every_machine_word_are_named():
    for argument in ("iterations", "threads", "max_iterations", "memory_limit"):
        with pytest.raises(ridgeform.ArgumentError, match=f"^{argument}: the number is too large"):
            ridgeform.stylize(MESH, **{argument: 2**200})


def test_other_mistakes_in_a_call_are_as_python_says_them():
    with pytest.raises(TypeError, match="unexpected keyword argument 'sharpnes'"):
        ridgeform.stylize(MESH, sharpnes=1.0)
    with pytest.raises(TypeError, match="mesh"):
        ridgeform.stylize()


@pytest.mark.parametrize(
    ("call", "argument"),
    [
        (lambda: ridgeform.Mesh.from_edge_lengths(MESH.faces, MESH.edge_lengths, "x"), "n_vertices"),
        (lambda: ridgeform.segment(MESH).labels_at("x"), "n_segments"),
        (lambda: ridgeform.Mesh("x", MESH.faces), "vertices"),
        (lambda: ridgeform.Mesh(MESH.vertices, "x"), "faces"),
    ],
)
def test_methods_name_their_arguments(call, argument):
    with pytest.raises((TypeError, ridgeform.ArgumentError)) as caught:
        call()
    assert argument in "\n".join([str(caught.value), *getattr(caught.value, "__notes__", [])])
