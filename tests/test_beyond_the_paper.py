"""Who cannot take friction, an elastic clamp or a natural curvature into account says so."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic import (
    REAL_CASE_NAMES,
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    certify,
    circle,
    deflected_shapes,
    estimate_friction,
    find_events,
    named_case,
    reconstruct,
    reconstruct_by_decision,
    sideways_stiffness,
    slip_off,
    solve_contact,
    solve_sweep,
    with_friction,
)
from compare import compare
from docs.figures.paper import contact_length

OBJECT = circle(1.0, lowest=(0, 0.4))
BEYOND = {
    "beam.natural_curvature": {"beam": Beam(natural_curvature=-0.2)},
    "clamp_stiffness": {"clamp_stiffness": 5.0},
    "friction": {"friction": 0.1},
    "beam.tip_radius": {"beam": Beam(tip_radius=0.002)},
    "beam.flexural_rigidity": {"beam": Beam(flexural_rigidity=lambda s: 1 - s / 2)},
    "beam.natural_curvature ": {"beam": Beam(natural_curvature=lambda s: -s / 2)},
}


@cache
def beyond(name):
    return Case(profile=OBJECT, sweep=Sweep(20), **BEYOND[name])


@cache
def swept(name):
    return solve_sweep(beyond(name))


@pytest.mark.parametrize("name", BEYOND)
@pytest.mark.parametrize(
    "ask",
    [
        lambda name: with_friction(beyond(name), 0.1),
        lambda name: reconstruct(swept(name), method="kaneko"),
        lambda name: reconstruct(swept(name), method="decision"),
        lambda name: reconstruct_by_decision(swept(name)),
        lambda name: sideways_stiffness(swept(name)),
        lambda name: contact_length(beyond(name)),
    ],
)
def test_refused_in_one_line(name, ask):
    with pytest.raises(
        InputError, match=f"^{name.strip()} = .*cannot take it into account"
    ) as error:
        ask(name)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow if name == "beam.tip_radius" else ())
        for name in BEYOND
        if BEYOND[name].get("beam", Beam()).varies
    ],
)
def test_a_vibrissa_that_varies_is_compared_and_its_friction_found(name):
    readings = swept(name)
    assert "ok" in set(readings.table["status"])
    assert compare(readings, readings).agrees
    assert np.isfinite(deflected_shapes(readings)[0][readings.trusted]).all()
    assert "ok" in set(reconstruct(readings)["status"])
    assert abs(estimate_friction(readings.with_friction(0.0)).coefficient) < 1e-10


def test_a_tilted_clamp_is_the_straight_vibrissas():
    with pytest.raises(InputError, match=r"beam\.natural_curvature"):
        slip_off(OBJECT, 0.01, Beam(natural_curvature=0.1))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Beam(2.0, natural_curvature=1.6), "foot line"),
        (lambda: Case(Beam(natural_curvature=2.0), OBJECT), "at most 1.5708 rad"),
        (lambda: Case(Beam(natural_curvature=1.5), circle(1, lowest=(0, 0.9))), "tip of the vibri"),
        (lambda: Case(Beam(natural_curvature=0.3), circle(0.2, lowest=(0, 0.5))), "upper side"),
        (lambda: Case(profile=OBJECT, clamp_stiffness=0.0), "clamp_stiffness = 0.0"),
        (lambda: Case(profile=OBJECT, clamp_stiffness=float("nan")), "clamp_stiffness = nan"),
        (lambda: solve_contact(OBJECT, 0.1, friction=1.5), "between -1 and 1"),
        (lambda: find_events(OBJECT, clamp_stiffness=-1.0), "clamp_stiffness = -1.0"),
    ],
)
def test_bad_input_is_one_line(make, says):
    with pytest.raises(InputError) as error:
        make()
    assert says in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("support", ["soft", {"friction": "much"}, {"lubricant": 1.0}, [0.1]])
def test_provenance_that_says_nothing_of_the_clamp_is_refused(support):
    exact = solve_sweep(named_case("catenary"))
    with pytest.raises(InputError, match=r"provenance\.support"):
        certify(Readings(exact.table, provenance={"support": support}))


def test_defaults_are_the_papers_vibrissa():
    case = named_case("catenary")
    same = Case(Beam(natural_curvature=0), case.profile, clamp_stiffness=float("inf"), friction=0)
    assert same.digest == case.digest and same.is_plain
    assert "support" not in solve_sweep(same).provenance
    rough = Case(profile=case.profile, friction=0.1)
    assert rough.digest != case.digest


@pytest.mark.parametrize("name", REAL_CASE_NAMES)
def test_named_cases_are_solved_all_the_way(name):
    case = replace(named_case(name), sweep=Sweep(60))
    readings = solve_sweep(case, certified=True)
    assert not case.is_plain and set(readings.table["status"]) == {"ok"}
    assert readings.snap_off is not None
