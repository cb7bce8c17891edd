"""What oscillates as the contact passes from segment to segment is no part of the limit."""

import numpy as np
import pytest

from compare.explain.oscillation import without_oscillation

STATIONS = np.arange(120)
CONTACT = 0.7 + 0.3 * np.cos(STATIONS / 38)  # from the tip down to 0.4 L, and back
TANGENT = STATIONS > 5
JOINTS = [(np.arange(n) + 0.5) / n for n in (40, 80, 160)]
POWER = 4.0 ** -np.arange(3)
LIMIT = np.stack([np.sin(STATIONS / 50), np.cos(STATIONS / 40), STATIONS / 120])


def slope_error(joints, contact):
    """Of a chain whose load of 1 is at the contact: its joints' turns less the exact turn."""
    h = joints[1] - joints[0]
    turns = h * (contact - joints[joints <= contact]).sum()
    return turns - contact**2 / 2


def sweeps(oscillations: bool):
    """Of second order, with a part in proportion to the error of the slope at the contact."""
    sizes = np.stack([1 + STATIONS / 60, np.exp(-STATIONS / 80), -2 + STATIONS / 100])
    found = []
    for joints in JOINTS:
        h = joints[1] - joints[0]
        slope = np.array([slope_error(joints, c) for c in CONTACT])
        found.append(LIMIT + 3 * h**2 + oscillations * np.where(TANGENT, sizes * slope, 0.0))
    return found


def extrapolated(runs):
    return runs[2] + (runs[2] - runs[1]) / 3


def test_the_limit_is_found_though_all_sweeps_swing():
    """The slope's error is summed joint by joint; 1.4e-5 of the limit without, 2e-9 with."""
    runs = sweeps(oscillations=True)
    assert np.abs(extrapolated(runs) - LIMIT).max() > 1e-5
    still = without_oscillation(runs, JOINTS, CONTACT, TANGENT, POWER)
    np.testing.assert_allclose(extrapolated(still), LIMIT, rtol=0, atol=1e-7)


def test_an_error_that_no_segment_makes_is_not_taken_for_swing():
    """A bump that all sweeps share stays in the limit to the last digit."""
    bump = 1e-3 * np.exp(-(((STATIONS - 60) / 5) ** 2))
    runs = sweeps(oscillations=True)
    with_bump = [run + bump for run in runs]
    one, other = (
        extrapolated(without_oscillation(some, JOINTS, CONTACT, TANGENT, POWER))
        for some in (runs, with_bump)
    )
    np.testing.assert_allclose(other - one, np.tile(bump, (3, 1)), rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("swings", "tangent", "atol"),
    [(False, TANGENT, 1e-12), (True, STATIONS < 0, 0.0), (True, STATIONS < 19, 0.0)],
)
def test_what_does_not_swing_or_is_too_short_to_see_it_stays(swings, tangent, atol):
    runs = sweeps(oscillations=swings)
    still = without_oscillation(runs, JOINTS, CONTACT, tangent, POWER)
    np.testing.assert_allclose(still, runs, rtol=0, atol=atol)
