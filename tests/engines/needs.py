"""What tests of engines share; those of what is not installed are a line.

What is installed and cannot be imported fails.
"""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Case, named_case, polygon
from analytic.problem.contours.polygon import Polygon
from engines.found import installed


def needs(distribution: str) -> None:
    """Skip a test, or the rest of a module."""
    trouble = installed(distribution)[1]
    if trouble is not None:
        pytest.skip(trouble, allow_module_level=True)


def short(name: str, stations: int) -> Case:
    case = named_case(name)
    return replace(case, sweep=replace(case.sweep, stations=stations))


def regular(corners: int, radius: float, height: float, turn: float = 0.1) -> Polygon:
    turns = turn + 2 * np.pi * np.arange(corners) / corners
    return polygon(np.column_stack([radius * np.cos(turns), height + radius * np.sin(turns)]))
