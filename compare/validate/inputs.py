"""The inputs of a case that may be uncertain."""

import math

from analytic import CLAMP_READINGS, Case
from analytic.problem.quantities import QUANTITIES

GAINS = tuple(f"gain_{name}" for name in CLAMP_READINGS)
"""Of each reading's sensor, relative: its calibration."""

INPUTS = {name: one for name, one in QUANTITIES.items() if name != "clamp_compliance"}
"""By name; of a clamp it is the stiffness that is stated."""


def nominal(case: Case, name: str) -> float:
    """An input's value in a case; not finite if the case has no such number."""
    if name == "tip_radius" and case.beam.tip_radius is None:
        return math.nan
    return INPUTS[name].value(case)


def possible(case: Case, name: str, error: float) -> float:
    """An input's error that it can have: what would be negative has the other sign.

    So friction that is 0 by the case and uncertain is at most as large as stated.
    """
    if name in GAINS or not INPUTS[name].positive:
        return error
    value = nominal(case, name)
    return abs(value + error) - value
