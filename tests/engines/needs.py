"""Tests of what is not installed are a line; what is installed and cannot be imported fails."""

import pytest

from engines.found import installed


def needs(distribution: str) -> None:
    """Skip a test, or the rest of a module."""
    trouble = installed(distribution)[1]
    if trouble is not None:
        pytest.skip(trouble, allow_module_level=True)
