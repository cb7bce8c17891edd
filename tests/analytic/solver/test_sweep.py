"""The sweep as a whole: balance, scaling, continuity, reconstruction, and where it ends."""

from dataclasses import fields, replace

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
    Profile,
    Sweep,
    catenary,
    circle,
    ellipse,
    find_events,
    named_case,
    parabola,
    solve_contact,
    solve_sweep,
    two_circles,
)
from analytic.problem.columns import SCHEMA, WORDS

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
