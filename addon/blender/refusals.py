# SPDX-License-Identifier: GPL-3.0-or-later
"""What is raised for a mesh, an attribute or curves that cannot be used.

Nothing is imported here, for `attribute_names` imports it.
"""


class RefusedError(Exception):
    """Something of the modeler's that cannot be worked on; the message says why, and what to do about it."""


class NothingToDoError(RefusedError):
    """Something that is as it should be already: no fault of anybody's.

    `figures` are what a script reads of it, as of a mesh that was worked on.
    """

    def __init__(self, message: str, figures: dict[str, object]) -> None:
        """Keep both."""
        super().__init__(message)
        self.figures = figures


class AttributeRefusedError(RefusedError):
    """An attribute that cannot be used."""


class CurvesRefusedError(RefusedError):
    """Curves that cannot be used."""
