"""The public surface: every name is there, documented, and has the signature that the type stubs promise."""

import ast
import inspect
from pathlib import Path

import pytest
import ridgeform

STUBS = sorted(Path(ridgeform.__file__).parent.glob("*.pyi"))
NODES = [node for path in STUBS for node in ast.parse(path.read_text()).body]
FUNCTIONS = {node.name: node for node in NODES if isinstance(node, ast.FunctionDef)}
CLASSES = {node.name: node for node in NODES if isinstance(node, ast.ClassDef)}


def parameters_of_stub(node):
    """(name, keyword-only, default) of every parameter that a stub declares."""
    arguments = node.args
    missing = [None] * (len(arguments.args) - len(arguments.defaults))
    positional = zip(arguments.args, [*missing, *arguments.defaults], strict=True)
    keyword = zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
    listed = [(a.arg, only, d) for only, group in ((False, positional), (True, keyword)) for a, d in group]
    empty = inspect.Parameter.empty
    return [(name, only, empty if d is None else ast.literal_eval(d)) for name, only, d in listed]


def parameters_of(function):
    """The same of the function itself."""
    return [
        (p.name, p.kind is inspect.Parameter.KEYWORD_ONLY, p.default)
        for p in inspect.signature(function).parameters.values()
    ]


def test_stubs_name_what_the_package_exports():
    exceptions = {
        "ArgumentError",
        "Cancelled",
        "MemoryLimitError",
        "MeshError",
        "RidgeformError",
        "SolveError",
    }
    assert set(ridgeform.__all__) == exceptions | set(FUNCTIONS) | set(CLASSES) | {"__version__"}
    assert (Path(ridgeform.__file__).parent / "py.typed").exists()


@pytest.mark.parametrize("name", FUNCTIONS)
def test_signatures_are_those_of_the_stubs(name):
    assert parameters_of(getattr(ridgeform, name)) == parameters_of_stub(FUNCTIONS[name])


@pytest.mark.parametrize("name", CLASSES)
def test_classes_have_the_members_of_the_stubs(name):
    declared = {
        node.name if isinstance(node, ast.FunctionDef) else ast.unparse(node.target)
        for node in CLASSES[name].body
    }
    public = {member for member in vars(getattr(ridgeform, name)) if not member.startswith("_")}
    assert {member for member in declared if not member.startswith("_")} == public


@pytest.mark.parametrize("name", [n for n in ridgeform.__all__ if n != "__version__"])
def test_everything_public_is_documented_and_lives_in_the_package(name):
    thing = getattr(ridgeform, name)
    assert len(inspect.getdoc(thing) or "") > 30
    if inspect.isclass(thing):
        assert thing.__module__.startswith("ridgeform")
        for member, value in vars(thing).items():
            assert member.startswith("_") or inspect.getdoc(value), member


def test_exceptions_share_one_base():
    for error in (ridgeform.MeshError, ridgeform.ArgumentError, ridgeform.SolveError, ridgeform.Cancelled):
        assert issubclass(error, ridgeform.RidgeformError)
    assert issubclass(ridgeform.ArgumentError, ValueError)
    assert not issubclass(ridgeform.MeshError, ValueError)
    assert issubclass(ridgeform.RidgeformError, Exception)
