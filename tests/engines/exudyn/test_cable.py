"""Exudyn's cable is the rod: as near to the closed form as its elements allow."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    Readings,
    circle,
    named_case,
    polygon,
    solve_sweep,
)
from compare import compare
from engines import find_engine
from mujoco_models import Settings
from tests.engines.needs import needs, regular

needs("exudyn")

SETTINGS = Settings(segments=40)
NAMES = ("catenary", "two-circles", "shallow-catenary", "tip-only")
COLUMNS = ("contact_x", "contact_y", "contact_arc_length", "contact_angle", "tip_angle")


def swept(case: Case, stations: int, segments: int = 40) -> tuple[Readings, Readings]:
    case = replace(case, sweep=replace(case.sweep, stations=stations))
    return solve_sweep(case), find_engine("exudyn").sweep(case, Settings(segments=segments))


def check(exact: Readings, found: Readings, rms: float) -> None:
    assert (found.table["status"] == "ok").all()
    assert (found.table["phase"] == exact.table["phase"]).mean() > 0.97
    disagreement = compare(exact, found).disagreement
    assert max(disagreement[name].rms for name in CLAMP_READINGS) < rms
    assert abs(found.snap_off - exact.snap_off) < 1e-4 * exact.beam.length


def faceted(name: str, vertices: int) -> Case:
    """A polygon inscribed in the part of a named case's contour that is within reach."""
    case = named_case(name)
    on = case.profile.at(np.linspace(*case.reach, vertices))
    roof = [on.xi.mean(), on.eta.max() + 3.0]
    return replace(case, profile=polygon([*np.column_stack([on.xi, on.eta]), roof]))


@pytest.mark.parametrize("name", ["catenary", "parabola"])
def test_forty_elements_are_the_rod_to_one_in_ten_thousand(name):
    """Cubic elements: of fourth order, with 8e-4 for 20 of them on the catenary."""
    exact, found = swept(named_case(name), 60)
    check(exact, found, 1e-4)
    for column in COLUMNS:
        np.testing.assert_allclose(found.table[column], exact.table[column], atol=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["two-circles", "shallow-catenary", "tip-only"])
def test_so_they_are_past_other_objects(name):
    check(*swept(named_case(name), 40), 1e-4)


@pytest.mark.parametrize(
    "name", ["parabola", *(pytest.param(x, marks=pytest.mark.slow) for x in NAMES)]
)
def test_so_they_are_on_the_polygon_itself(name):
    """400 vertices: the side touches at corners, the tip goes from edge to edge in jumps."""
    check(*swept(faceted(name, 400), 20), 1e-4)


@pytest.mark.parametrize(
    ("profile", "radius"),
    [
        (regular(3, 0.4, 0.9), 0.005),
        (regular(6, 0.5, 0.9), 0.0),
        (polygon([(-0.3, 0.6), (0.3, 0.6), (0.3, 1.4), (-0.3, 1.4)]), 0.005),
        pytest.param(regular(12, 0.4, 0.85), 0.0, marks=pytest.mark.slow),  # the side is first
        pytest.param(regular(5, 0.25, 0.6), 0.005, marks=pytest.mark.slow),
        pytest.param(circle(0.02, (0.0, 0.5)), 0.0, marks=pytest.mark.slow),
    ],
)
def test_so_they_are_past_sharp_corners(profile, radius):
    check(*swept(Case(Beam(radius=radius), profile), 15), 1e-4)


@pytest.mark.slow
def test_any_units_and_either_direction():
    beam = Beam(length=0.05, flexural_rigidity=2e-6, radius=0.00025, si=True)
    case = Case(beam, circle(0.05, (0.0, 0.02)))
    exact, found = swept(case, 40, 20)
    check(exact, found, 5e-4)
    mirrored_exact, mirrored = swept(case.mirrored(), 40, 20)
    check(mirrored_exact, mirrored, 5e-4)
    np.testing.assert_allclose(mirrored.values("force_x"), -found.values("force_x"), rtol=1e-9)


@pytest.mark.parametrize("name", ["tip-only", "parabola"])
def test_the_residual_is_the_cables_own_balance(name):
    """Force along the contour and moment about the contact; what stretches is 1e-5 of the load.

    The sliding joint's force goes through its point only when it slips no more, and only if Exudyn
    applies it to the element that is in it.
    """
    _, found = swept(named_case(name), 20, 20)
    assert 0 < found.values("residual").max() < 5e-5


@pytest.mark.parametrize(
    "case",
    [
        Case(Beam(natural_curvature=-0.5), regular(6, 0.5, 0.9)),
        Case(Beam(), regular(6, 0.5, 0.9), clamp_stiffness=5.0),
        Case(Beam(flexural_rigidity=lambda s: 1 - 0.5 * s), named_case("parabola").profile),
        pytest.param(named_case("pre-curved"), marks=pytest.mark.slow),
        pytest.param(named_case("soft-support"), marks=pytest.mark.slow),
    ],
    ids=["curved", "softly held", "softer to the tip", "pre-curved", "soft-support"],
)
def test_so_they_are_as_other_vibrissae(case):
    exact, found = swept(case, 15)
    check(exact, found, 1e-4)
    np.testing.assert_allclose(found.table["tip_angle"], exact.table["tip_angle"], atol=2e-4)


@pytest.mark.slow
def test_a_cable_that_would_touch_twice_is_not_ok():
    """Curved forward the free end goes into the object: no state with one contact is one."""
    case = replace(named_case("catenary"), beam=Beam(natural_curvature=0.5))
    exact, found = swept(case, 15)
    ok = found.trusted
    assert not (ok & ~exact.trusted).any()
