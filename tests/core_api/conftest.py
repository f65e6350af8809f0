"""What the tests of the wheel share: one Hypothesis profile, and a wish to stop."""

import pytest
import ridgeform
from hypothesis import settings

settings.register_profile("fixed", derandomize=True, deadline=None, max_examples=40)
settings.load_profile("fixed")


@pytest.fixture
def cancelled():
    """A handle that was cancelled: every call with it raises `Cancelled`."""
    progress = ridgeform.Progress()
    progress.cancel()
    return progress
