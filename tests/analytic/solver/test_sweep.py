"""Sweeps: events, scaling, limits; many at once are what each is alone."""

import copy
import itertools
import pickle
import tracemalloc
from dataclasses import fields, replace
from functools import partial

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analytic import (
    CLAMP_READINGS,
    COLUMNS,
    Beam,
    Case,
    Event,
    InputError,
    Profile,
    Readings,
    Sweep,
    Unsolved,
    catenary,
    circle,
    ellipse,
    find_events,
    named_case,
    parabola,
    polygon,
    solve_contact,
    solve_sweep,
    solve_sweeps,
    through_points,
    two_circles,
)
from analytic.problem.columns import SCHEMA, WORDS
from analytic.solver.sweep import solve_plain

HEIGHTS = st.floats(0.05, 0.8)
OBJECTS = st.one_of(
    st.builds(lambda a, low: catenary(a, low - 1), st.floats(0.2, 3), HEIGHTS),
    st.builds(parabola, st.floats(0.05, 3), HEIGHTS),
    st.builds(lambda r, low: circle(r, (0.3, low)), st.floats(0.02, 5), HEIGHTS),
    st.builds(
        lambda a, b, low: ellipse((a, b), (-1, low)), st.floats(0.1, 4), st.floats(0.1, 4), HEIGHTS
    ),
    st.builds(
        lambda r, q, low: two_circles(r, q, (0, low)), st.floats(0.1, 4), st.floats(0.1, 4), HEIGHTS
    ),
)


def test_a_column_is_in_all_places_that_make_it():
    assert {field.name for field in fields(Event)} == set(COLUMNS)
    assert set(COLUMNS) <= {*SCHEMA, *WORDS}  # what is not there keeps no unit


def test_table(case, exact):
    table = exact.table
    assert tuple(table.columns) == (*COLUMNS, "residual_boundary", "residual_moment")
    assert len(table) == case.sweep.stations == 200
    steps = np.diff(table["foot_x"])
    np.testing.assert_allclose(steps, steps[0], rtol=1e-9)
    assert steps[0] < 0
    assert (table["status"] == "ok").all()
    assert table["phase"].iloc[[0, -1]].tolist() == ["free", "free"]


def test_phases_follow_each_other(case_name, exact):
    phase = exact.table["phase"]
    order = phase[phase != phase.shift()].tolist()
    middle = ["tip"] if case_name == "tip-only" else ["tip", "tangent", "tip"]
    assert order == ["free", *middle, "free"]


def test_events_stand_where_the_sweep_has_them(case, exact):
    events = find_events(case.profile, case.beam)
    phase, foot_x = exact.table["phase"].to_numpy(), exact.values("foot_x")
    assert foot_x[phase != "free"].max() <= events.first_contact.foot_x
    assert foot_x[phase != "free"].min() >= exact.snap_off
    assert events.snap_off.foot_x == pytest.approx(exact.snap_off, rel=1e-15)
    located = exact.provenance["events"]
    for name in ("first_contact", "phase_b_start", "phase_b_end"):
        event = getattr(events, name)
        assert located[name] == (None if event is None else pytest.approx(event.foot_x, rel=1e-13))
    if events.phase_b_start is None:
        assert events.contact_length_minimum.contact_arc_length > 1
        return
    tangent = foot_x[phase == "tangent"]
    assert events.phase_b_end.foot_x < tangent.min()
    assert tangent.max() < events.phase_b_start.foot_x
    assert events.phase_b_start.contact_arc_length == pytest.approx(1, abs=1e-14)


@pytest.mark.slow
@settings(max_examples=30, deadline=None)
@given(OBJECTS, st.floats(1e-3, 1e3), st.floats(1e-6, 1e6))
def test_results_scale(profile, length, rigidity):
    """Lengths scale with L, forces with EI/L^2, moments with EI/L, and nothing else changes."""
    one = Case(profile=profile, sweep=Sweep(stations=40))
    beam = Beam(length, rigidity, 0.005 * length)
    other = Case(beam, profile.scaled(length), one.sweep)
    a, b = solve_sweep(one).table, solve_sweep(other).table
    assert (a["phase"] == b["phase"]).all()
    units = dict.fromkeys(("foot_x", "contact_arc_length", "contact_x", "contact_y"), length)
    units |= dict.fromkeys(("force_x", "force_y"), beam.force_unit)
    units |= {"moment_z": beam.moment_unit, "contact_angle": 1.0, "tip_angle": 1.0}
    for column, unit in units.items():
        scale = np.nanmax(np.abs(a[column])) * unit
        # Close to the fold a rounding of foot_x grows like the root of its distance.
        np.testing.assert_allclose(b[column], a[column] * unit, rtol=1e-6, atol=1e-9 * scale)


def test_thickness_is_the_parallel_curve():
    thick = Beam(radius=0.02)
    profile = ellipse((1.3, 0.8), (0.1, 0.3))
    angles = np.linspace(-0.6, 0.9, 16)
    a = solve_contact(profile, angles, thick)
    b = solve_contact(profile.offset(0.02), angles, Beam(radius=0.0))
    columns = ["foot_x", *CLAMP_READINGS, "contact_arc_length", "tip_angle"]
    pd.testing.assert_frame_equal(a[columns], b[columns], rtol=1e-14)
    np.testing.assert_allclose(a["contact_x"], profile.xi(angles), rtol=1e-14)
    np.testing.assert_allclose(a["contact_y"], profile.eta(angles), rtol=1e-14)


def test_a_profile_of_callables_is_as_good_as_a_family():
    family = catenary(0.5, -0.8)
    plain = Profile(xi=family.xi, eta=family.eta, alpha_range=(-1.2, 1.2))
    case = named_case("catenary")
    a, b = solve_sweep(case).table, solve_sweep(replace(case, profile=plain)).table
    # Its radius of curvature comes from differences, good to 1e-10; the fold feels its square.
    np.testing.assert_allclose(
        a[list(CLAMP_READINGS)].to_numpy(), b[list(CLAMP_READINGS)].to_numpy(), atol=1e-9
    )


CORNERS = [(-1.5, 1.2), (-0.6, 0.5), (-0.1, 0.35), (0.2, 0.34), (0.8, 0.6), (1.2, 1.3)]
STIFF = Beam(length=50.0, flexural_rigidity=2e3, radius=0.2)


def own_xi(radius, alpha):
    return np.dot(radius, np.sin(alpha))


def own_eta(radius, alpha):
    return 0.4 + np.dot(radius, 1 - np.cos(alpha))


def mixed():
    """Contours, vibrissae, stations and directions of every kind."""
    yield named_case("catenary")
    yield Case(STIFF, catenary(0.5, -0.8).scaled(50.0), Sweep(70))
    yield Case(profile=catenary(0.3, -0.7), sweep=Sweep(40, direction="right"))
    yield named_case("two-circles")
    yield Case(profile=two_circles(1.0, 0.3, (0.1, 0.6)), sweep=Sweep(31))
    yield Case(profile=polygon(CORNERS), sweep=Sweep(90))
    yield named_case("rubbing")
    yield Case(Beam(natural_curvature=-0.3), circle(1.0, (0.0, 0.4)), Sweep(20))
    yield Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(50, start=2.0, stop=0.9))
    yield Case(Beam(radius=0.0), circle(0.6, (3.0, 0.5)), Sweep(50))
    yield Case(profile=ellipse((1.0, 0.3), (0.0, 0.5)), sweep=Sweep(60, direction="right"))
    yield Case(profile=parabola(0.5, 0.5), sweep=Sweep(2))
    yield named_case("tip-only")
    for low in (0.4, 0.3):
        points = [(x, low + x * x / 3) for x in np.linspace(-2, 2, 15)]
        yield Case(profile=through_points(points))
    for radius in (0.9, 1.3):  # a user's own family, which takes one number at a time
        xi, eta = partial(own_xi, radius), partial(own_eta, radius)
        yield Case(profile=Profile(xi=xi, eta=eta, alpha_range=(-1.1, 1.3)), sweep=Sweep(30))


def test_mixed_cases_are_what_each_is_alone():
    cases = list(mixed())
    for case, found in zip(cases, solve_sweeps(cases), strict=True):
        assert isinstance(found, Readings)
        alone = solve_sweep(case)
        assert found.beam == alone.beam
        assert found.source == alone.source
        events, expected = (dict(x.provenance["events"]) for x in (found, alone))
        assert events.keys() == expected.keys()
        for name, place in expected.items():
            assert events[name] == (None if place is None else pytest.approx(place, rel=1e-12))
        for readings in (found, alone):
            assert readings.provenance["digest"] == case.digest
        columns = [name for name in alone.table if not name.startswith("residual")]
        pd.testing.assert_frame_equal(
            # Near a fold readings change like the root of the foot position's rounding.
            found.table[columns], alone.table[columns], rtol=1e-10, atol=1e-12 * case.beam.length,
        )  # fmt: skip


@pytest.mark.parametrize("error", [ArithmeticError, AttributeError, RuntimeWarning])
def test_a_case_that_fails_says_why_and_stops_no_other(error):
    calls = itertools.count()

    def broken(alpha):
        if next(calls) > 200:
            raise error("this contour is not known here")
        return 1.5 - np.cos(alpha)

    profile = Profile(xi=np.sin, eta=broken, alpha_range=(-1.2, 1.2))
    sound = named_case("catenary")
    bad = Case(profile=profile, sweep=Sweep(30))
    calls = itertools.count(1000)
    first, failed, other, last = solve_sweeps([sound, bad, "catenary", sound])
    assert isinstance(first, Readings)
    assert isinstance(last, Readings)
    assert isinstance(failed, Unsolved)
    assert failed.case is bad
    assert isinstance(failed.error, error)
    assert failed.reason == "this contour is not known here"
    assert isinstance(other, Unsolved)
    assert isinstance(other.error, InputError)


def test_a_bug_of_the_batch_itself_is_seen(monkeypatch):
    """It is no case's, so that no case can say it."""

    def broken(cases):
        if len(cases) > 1:
            raise TypeError("of many")
        return solve_plain(cases)

    monkeypatch.setattr("analytic.solver.sweep.solve_plain", broken)
    assert next(iter(solve_sweeps([named_case("catenary")]))).source == "analytic"
    with pytest.raises(TypeError, match="of many"):
        list(solve_sweeps([named_case("catenary"), named_case("parabola")]))


@pytest.mark.slow
def test_cases_are_taken_as_they_are_needed():
    """And the memory is that of a batch, however many there are."""
    taken = 0

    def endless():
        nonlocal taken
        for radius in itertools.cycle(np.linspace(0.5, 2.0, 7)):
            taken += 1
            yield Case(profile=circle(float(radius), (0.0, 0.4)), sweep=Sweep(400))

    found = solve_sweeps(endless())
    assert taken == 0
    tracemalloc.start()
    try:
        for _ in itertools.islice(found, 50):
            pass
        few = tracemalloc.get_traced_memory()[1]
        for _ in itertools.islice(found, 200):
            pass
        assert tracemalloc.get_traced_memory()[1] < 1.3 * few
    finally:
        tracemalloc.stop()
    assert taken < 350


def test_the_table_of_solved_readings_survives_a_copy_before_it_is_asked_for() -> None:
    for copied in (copy.copy, copy.deepcopy, lambda found: pickle.loads(pickle.dumps(found))):
        fresh = solve_sweep(named_case("catenary"))
        again = copied(fresh)
        assert again.snap_off == fresh.snap_off
        pd.testing.assert_frame_equal(again.table, fresh.table)
    with pytest.raises(AttributeError, match="chart"):
        fresh.chart  # noqa: B018
