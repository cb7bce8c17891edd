"""Exudyn's cable is the rod: as near to the closed form as its elements and its penalty allow."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Readings,
    circle,
    named_case,
    polygon,
    solve_sweep,
)
from compare import compare
from mujoco_models import Settings

pytest.importorskip("exudyn", reason="Exudyn is an extra: pip install '.[exudyn]'")

from engines import find_engine

SETTINGS = Settings(segments=40)


def swept(case: Case, stations: int, segments: int = 40) -> tuple[Readings, Readings]:
    case = replace(case, sweep=replace(case.sweep, stations=stations))
    return solve_sweep(case), find_engine("exudyn").sweep(case, Settings(segments=segments))


def check(exact: Readings, found: Readings, rms: float) -> None:
    assert (found.table["status"] == "ok").all()
    assert (found.table["phase"] == exact.table["phase"]).mean() > 0.97
    disagreement = compare(exact, found).disagreement
    assert max(disagreement[name].rms for name in CLAMP_READINGS) < rms
    assert abs(found.snap_off - exact.snap_off) < 5e-4 * exact.beam.length


@pytest.mark.parametrize("name", ["catenary", "parabola"])
def test_forty_elements_are_within_the_fourth_digit(name):
    """The penalty and the straight pieces that touch leave 1e-4, whatever the elements' size."""
    exact, found = swept(named_case(name), 60)
    check(exact, found, 1.5e-4)
    table, own = exact.table, found.table
    for column in ("contact_x", "contact_y", "contact_arc_length", "contact_angle", "tip_angle"):
        np.testing.assert_allclose(own[column], table[column], atol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["two-circles", "shallow-catenary", "tip-only"])
def test_so_they_are_past_other_objects(name):
    check(*swept(named_case(name), 40), 2e-4)


@pytest.mark.slow
def test_any_units_and_either_direction():
    beam = Beam(length=0.05, flexural_rigidity=2e-6, radius=0.00025, si=True)
    case = Case(beam, circle(0.05, (0.0, 0.02)))
    exact, found = swept(case, 40, 20)
    check(exact, found, 5e-4)
    mirrored_exact, mirrored = swept(case.mirrored(), 40, 20)
    check(mirrored_exact, mirrored, 5e-4)
    np.testing.assert_allclose(mirrored.values("force_x"), -found.values("force_x"), rtol=1e-9)


def test_the_residual_is_the_cables_own_balance():
    """Force along the contour and moment about the contact, which both should vanish."""
    _, found = swept(named_case("tip-only"), 20, 20)
    assert 0 < found.values("residual").max() < 1e-4


@pytest.mark.parametrize(
    ("case", "says"),
    [
        (Case(profile=polygon([(-0.5, 0.8), (0.0, 0.5), (0.5, 0.8)])), "with corners"),
        (named_case("pre-curved"), "exudyn"),
        (named_case("rubbing"), "exudyn"),
        (named_case("soft-support"), "exudyn"),
    ],
)
def test_what_the_cable_is_not_is_a_line(case, says):
    with pytest.raises(InputError, match=says):
        find_engine("exudyn").sweep(case, SETTINGS)
