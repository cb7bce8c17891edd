"""Runs of pytest inside this process."""

# What such a run imports first is forgotten after it, and not all modules bear that: pint's imports
# put a finder of installed packages in the place of Python's.
import mujoco  # noqa: F401
import pint  # noqa: F401
import pytest

import compare.read.case
import compare.read.tables
import compare.testing.gates
import compare.testing.summary  # noqa: F401
from analytic import named_case, solve_sweep  # noqa: F401
from mujoco_models import simulate_sweep  # noqa: F401


@pytest.fixture(autouse=True)
def without_hypothesis(monkeypatch):
    """Its plugin would be compiled anew in every run, for a second each."""
    monkeypatch.setenv("PYTEST_ADDOPTS", "-p no:hypothesispytest")
