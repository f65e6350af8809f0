"""Shapes whose answers are known, and how results are measured against them, for all that tests or draws."""
