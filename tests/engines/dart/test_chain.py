"""DART's chain rests, in hard contact, where MuJoCo's does: they differ by the contact's depth."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Beam, Case, InputError, Sweep, circle, named_case, polygon
from engines import find_engine
from mujoco_models import Settings, simulate_sweep
from tests.engines.needs import needs

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


def short(name: str, stations: int) -> Case:
    case = named_case(name)
    return replace(case, sweep=replace(case.sweep, stations=stations))


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
    turns = turn + 2 * np.pi * np.arange(6) / 6
    corners = np.column_stack([0.5 * np.cos(turns), 0.9 + 0.5 * np.sin(turns)])
    case = Case(profile=polygon(corners), sweep=Sweep(stations=15))
    # One station of 15 where a long link leans over a corner, by more than the sides there.
    check(case, Settings(segments=segments), 5e-4, doubted=int((turn, segments) == (0.8, 10)))


@pytest.mark.parametrize(
    ("case", "says"),
    [
        (named_case("rubbing"), "friction"),
        (named_case("pre-curved"), "natural_curvature"),
        (Case(Beam(radius=0.0), circle(1.0, (0.0, 0.4))), "cannot collide a line"),
    ],
)
def test_what_it_has_not_is_a_line(case, says):
    with pytest.raises(InputError, match=says):
        find_engine("dart").sweep(case, SMOOTH)
