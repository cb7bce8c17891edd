"""The fastest motion with a wanted error, of sweeps with planted errors."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, InputError, Readings, Sweep, named_case, solve_sweep
from compare.simulate.target import find_fastest
from mujoco_models import DivergedError

EXACT = solve_sweep(replace(named_case("catenary"), sweep=Sweep(60)))
BASE = 0.1


def swept(speed, at_rest=1e-3, chatters_above=10.0):
    """The exact sweep, off by a share of each reading: at rest, and in proportion to the speed."""
    table = EXACT.table.copy()
    for name in CLAMP_READINGS:
        table[name] += (at_rest + 0.1 * speed) * np.nanmax(np.abs(table[name]))
    if speed > chatters_above:
        table.loc[10:40, "status"] = "chattering"
    about = {"motion": {"speed": speed}, "seconds": 1.0 / speed}
    return Readings(table, EXACT.beam, "planted", about)


def runs(**planted):
    names = {"base": 1.0, "half": 0.5, "quarter": 0.25}
    found = {name: swept(BASE * share, **planted) for name, share in names.items()}
    return {**found, "rest": swept(1e-12, **planted)}


@pytest.mark.parametrize("target", [2e-3, 6e-3, 1.05e-2, 5e-2])
def test_it_is_found_to_a_tenth(target):
    found = find_fastest(EXACT, runs(), swept, target)
    assert 0.85 < found.speed / ((target - 1e-3) / 0.1) < 1 + 1e-9
    assert found.error <= target
    assert found.error == pytest.approx(1e-3 + 0.1 * found.speed)
    assert found.at_rest == pytest.approx(1e-3)
    assert len(found.tried) <= 3 + 8


def test_what_is_there_at_rest_cannot_be_outrun():
    with pytest.raises(InputError, match=r"1.0e-03 left at rest") as caught:
        find_fastest(EXACT, runs(), swept, 5e-4)
    assert "\n" not in str(caught.value)


def test_a_sweep_that_chatters_or_diverges_is_none():
    found = find_fastest(EXACT, runs(), lambda v: swept(v, chatters_above=0.15), 5e-2)
    assert 0.13 < found.speed <= 0.15

    def wild(speed):
        if speed > 0.2:
            raise DivergedError("thrown")
        return swept(speed)

    assert 0.18 < find_fastest(EXACT, runs(), wild, 5e-2).speed <= 0.2
