"""What the tests of the wheel share: one Hypothesis profile."""

from hypothesis import settings

settings.register_profile("fixed", derandomize=True, deadline=None, max_examples=40)
settings.load_profile("fixed")
