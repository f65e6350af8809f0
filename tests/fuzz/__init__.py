"""Structured fuzzing of the wheel: meshes that nobody modeled, and what holds of every answer."""
