"""Names the argument in errors about types: the native module leaves the name in a note."""

import functools
import re
from collections.abc import Callable
from typing import Any

from .errors import ArgumentError

NOTE = re.compile(r"while processing '(\w+)'")


def named(function: Callable[..., Any]) -> Callable[..., Any]:
    """`function`, with errors about the type of an argument that begin with its name, as all others do.

    Raises TypeError for a wrong type, ArgumentError for a whole number that no machine word holds and for
    text with half a character, as a file name that is not UTF-8 has it in Python.
    """

    @functools.wraps(function)
    def call(*positional: Any, **keywords: Any) -> Any:
        try:
            return function(*positional, **keywords)
        except (TypeError, OverflowError, UnicodeEncodeError) as error:
            found = NOTE.fullmatch(getattr(error, "__notes__", [""])[-1])
            if found is None:
                raise
            name, problem = found[1], error
        # Outside of the handler: the error that it stands for would only say the same again.
        if isinstance(problem, OverflowError):
            raise ArgumentError(f"{name}: the number is too large")
        if isinstance(problem, UnicodeEncodeError):
            raise ArgumentError(f"{name}: got {problem.object!a}, which is no text")
        raise TypeError(f"{name}: {problem}")

    call.__module__ = "ridgeform"
    return call
