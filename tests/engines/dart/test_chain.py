"""DART's chain rests, in hard contact, where MuJoCo's does: they differ by the contact's depth."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Case, Sweep
from engines import find_engine
from mujoco_models import Settings, simulate_sweep
from tests.engines.needs import needs, regular, short

needs("dartpy")

SMOOTH = Settings(obstacle="primitive", segments=20)


def check(case: Case, settings: Settings, apart: float, doubted: int = 0) -> None:
    """Rest is known to 1e-5 of the largest moment, the contact's place to 1e-5 L."""
    dart, mujoco = find_engine("dart").sweep(case, settings), simulate_sweep(case, settings)
    assert (~dart.trusted).sum() <= doubted
    assert (dart.table["phase"] == mujoco.table["phase"]).mean() > 0.9
    for name in CLAMP_READINGS:
        off = dart.values(name) - mujoco.values(name)
        assert np.sqrt((off**2).mean()) < apart * np.abs(mujoco.values(name)).max(), name
    assert abs(dart.snap_off - mujoco.snap_off) < 2e-4 * case.beam.length


@pytest.mark.parametrize("name", ["parabola", "tip-only"])
def test_it_rests_where_mujocos_does(name):
    check(short(name, 8), replace(SMOOTH, segments=10), 1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("segments", [10, 40])
@pytest.mark.parametrize("name", ["catenary", "parabola", "tip-only"])
def test_so_it_does_with_links_of_any_size(name, segments):
    check(short(name, 20), replace(SMOOTH, segments=segments), 1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("segments", [10, 20])
@pytest.mark.parametrize("turn", [0.0, 0.1, np.pi / 6, 0.8])  # a corner to the right, or a side
def test_so_it_does_past_a_hexagon(turn, segments):
    case = Case(profile=regular(6, 0.5, 0.9, turn), sweep=Sweep(stations=15))
    # One station of 15 where a long link leans over a corner, by more than the sides there.
    check(case, Settings(segments=segments), 5e-4, doubted=int((turn, segments) == (0.8, 10)))
