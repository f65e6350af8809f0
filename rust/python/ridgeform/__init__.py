"""Ridgeform: the L1 surface Hessian as a modeler's tool."""

from ._native import __version__

__all__ = ["__version__"]
