"""The exceptions of this package: catch `RidgeformError` for all of them."""


class RidgeformError(Exception):
    """Any failure of this package; raised itself only where an internal check failed."""


class MeshError(RidgeformError):
    """The mesh cannot be used as it is; the message names the face or vertex and the cure."""


class ArgumentError(RidgeformError, ValueError):
    """An argument has a wrong value, type or shape; the message begins with its name."""


class SolveError(RidgeformError):
    """The numerical problem has no answer: contradictory constraints or a singular system."""


class MemoryLimitError(SolveError, MemoryError):
    """A call needs more memory than it may take; the message says how much, and what would fit."""


class Cancelled(RidgeformError):  # noqa: N818 - the caller's own decision, not an error
    """`Progress.cancel` was called: nothing is returned."""
