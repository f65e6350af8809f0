"""The numbers with a check box of all tools, for tests that take each."""

import pytest
from bl_ext.user_default.ridgeform import registry

OPTIONAL = [
    (tool, name)
    for tool in registry.TOOLS
    for name, setting in tool.settings.declared.items()
    if setting.optional
]
every_optional_number = pytest.mark.parametrize(
    ("tool", "name"), OPTIONAL, ids=[f"{tool.key}-{name}" for tool, name in OPTIONAL]
)
