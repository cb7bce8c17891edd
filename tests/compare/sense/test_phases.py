"""The phases that the comparison judges by are those of the reconstruction."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    Sweep,
    circle,
    ellipse,
    parabola,
    reconstruct,
    solve_sweep,
)
from compare import classify, compare
from compare.sense import transitions
from compare.sense.noise import with_noise
from compare.sense.phases import confusion

SIZES = st.floats(0.1, 3.0)
PROFILES = st.one_of(
    st.builds(lambda r, h: circle(r, (0.0, h)), SIZES, st.floats(0.1, 0.9)),
    st.builds(lambda a, h: parabola(a, h), SIZES, st.floats(0.1, 0.9)),
    st.builds(lambda a, b, h: ellipse((a, b), (0.0, h)), SIZES, SIZES, st.floats(0.1, 0.9)),
)


@seed(11)
@settings(max_examples=25, deadline=None)
@given(PROFILES, st.integers(20, 80), st.sampled_from([0.0, 1e-4, 1e-3, 1e-2]))
def test_reconstruction_and_comparison_judge_alike(profile, stations, level):
    exact = solve_sweep(Case(profile=profile, sweep=Sweep(stations=stations)))
    sweep = with_noise(exact, dict.fromkeys(CLAMP_READINGS, level), stations)
    found = reconstruct(sweep)
    explained = (found["phase"] != "unexplained").to_numpy() & sweep.trusted
    judged = classify(sweep).phase
    np.testing.assert_array_equal(found["phase"][explained], judged[explained])
    right = (judged == exact.table["phase"])[sweep.trusted]
    assert right.all() if level == 0 else right.mean() > 0.7


def test_untrusted_stations_have_no_phase():
    exact = solve_sweep(Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(stations=40)))
    status = exact.table["status"].where(exact.table.index != 20, "unsettled")
    exact = replace(exact, table=exact.table.assign(status=status))
    assert classify(exact).phase[20] == ""
    assert reconstruct(exact)["phase"][20] == exact.table["phase"][20]


def test_untrusted_stations_beside_contact_move_neither_end_of_it():
    """The first one was called 0.08 rad apart of two sweeps that touch alike."""
    case = Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(stations=60))
    exact, other = solve_sweep(case), solve_sweep(case)
    touching = np.flatnonzero(exact.table["phase"] != "free")
    near = [*touching[:2], *touching[-2:]]
    table = other.table
    table.loc[near, "status"] = "unsettled"
    table.loc[near, "phase"] = "tip"
    other = replace(other, table=table)
    other.provenance["events"]["snap_off"] = None
    found = compare(exact, other)
    first, last = found.events["first_contact"], found.events["snap_off"]
    step = float(np.abs(np.diff(exact.values("foot_x"))).max())
    assert abs(first.difference) < step / 2
    assert last.uncertainty == pytest.approx(1.5 * step) and abs(last.difference) < 1.5 * step
    assert not any("first_contact" in f or "snap" in f for f in map(str, found.failures))


@pytest.mark.parametrize("apart", [1e-16, 1e-12, 1e-3])
def test_two_values_that_are_one_to_rounding_are_no_fault(apart):
    """No polynomial goes through them; the limit is between the two stations all the same."""
    foot_x, values = np.arange(3.0), np.array([-1.0, -1.0 + apart, 1.0])
    assert 1 <= transitions._zero(foot_x, values, np.arange(3), 1, 2) <= 2


@pytest.mark.parametrize(
    ("criterion", "off"), [((0.05, 0.15, 0.25), 0.0), ((0.4, 0.41, 0.42), 0.25)]
)
def test_a_limit_at_which_the_contact_jumps_says_how_far_it_may_be_off(criterion, off):
    """From inside it comes to zero half-way, from outside there, or never: at the last station."""
    judged = SimpleNamespace(
        criterion=np.array([0, 0, 0, *criterion]), shortfall=np.array([0.25, 0.15, 0.05, 0, 0, 0])
    )
    at, tip, tangent = np.arange(6.0), np.arange(3, 6), np.arange(3)[::-1]
    place, may_be = transitions._limit(at, judged, tip, tangent)
    assert (place, may_be) == (pytest.approx(2.5 - off), pytest.approx(off, abs=1e-12))


@pytest.mark.parametrize(("kept", "agrees"), [(0, True), (3, False)])
def test_a_tip_that_holds_for_less_than_a_station_may_be_missed(kept, agrees):
    """Between the last station that touches and the snap-off; more stations would show it."""
    exact = solve_sweep(Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(stations=80)))
    tip = np.flatnonzero(exact.table["phase"] == "tip")
    last = tip[tip > np.flatnonzero(exact.table["phase"] == "tangent")[-1]]
    table = exact.table.drop(index=last[: len(last) - kept])
    other = replace(exact, table=table.reset_index(drop=True))
    judged = classify(other)
    judged.phase[judged.phase == "tip"] = "tangent"
    place = transitions.locate_transitions(exact, classify(exact))["phase_b_end"]
    assert transitions.shows_beyond("phase_b_end", *place, other, judged) is not agrees
    assert transitions.shows_beyond("phase_b_end", *place, exact, classify(exact))


def test_a_second_contact_that_one_sweep_lacks_is_found():
    """By the source's own events; of readings without these, between stations."""
    case = Case(Beam(natural_curvature=1.2), circle(1.0, (0.0, 0.4)), Sweep(stations=30))
    exact, other = solve_sweep(case), solve_sweep(case)
    assert compare(exact, other).events["second_contact_start"].difference == 0
    step = float(np.abs(np.diff(exact.values("foot_x"))).max())
    events = other.provenance.pop("events")
    found = compare(exact, other)
    second = found.events["second_contact_start"]
    assert found.agrees and second.uncertainty == pytest.approx(step / 2, rel=1e-6)
    del events["second_contact_start"]  # who could not locate it says nothing of it
    other.provenance["events"] = events
    known = compare(exact, other).events
    assert "second_contact_start" not in known and known["second_contact_end"].difference == 0
    alone = [name for name in exact.table if not name.startswith("second_contact")]
    other = replace(other, table=other.table[alone])
    del events["second_contact_end"]  # nor does who does not look for one
    assert "second_contact_end" not in compare(exact, other).events
    events["second_contact_start"] = None  # and who does, and finds none, does
    assert any("second_contact_start" in failure for failure in compare(exact, other).failures)


def test_a_phase_is_not_misjudged_where_two_places_touch():
    """Neither phase's condition holds there."""
    case = Case(Beam(natural_curvature=1.2), circle(1.0, (0.0, 0.4)), Sweep(stations=60))
    exact = solve_sweep(case)
    two = exact.table["second_contact_x"].notna()
    assert two.sum() > 5
    table = confusion(classify(exact), exact).to_numpy()
    assert np.trace(table) == table.sum() == len(exact.table) - two.sum()


def rung(sweep, held=0):
    """As a loop of steps writes it: without events, ringing where it is free.

    What is held keeps the last contact's readings instead, and chatters from half to twice them.
    """
    table, free = sweep.table.copy(), np.flatnonzero(sweep.table["phase"] == "free")
    last = int(np.flatnonzero(sweep.table["phase"] != "free")[-1])
    after = free[free > last]
    swing = np.cos(np.linspace(1.0, 40.0, len(after))) * np.exp(-np.linspace(0, 4, len(after)))
    chatter = 1.25 + 0.75 * np.cos(2.0 * np.arange(len(after)))
    for name, share in zip(CLAMP_READINGS, (0.3, 0.05, -0.3), strict=True):
        size = float(np.abs(table[name]).max())
        table.loc[after, name] = chatter * table[name][last] if held else share * size * swing
        table.loc[0, name] = 0.02 * share * size
    provenance = {k: v for k, v in sweep.provenance.items() if k != "events"}
    return replace(sweep, table=table, provenance=provenance)


@pytest.mark.parametrize("stations", [80, 200, 800])
def test_ringing_hides_no_release_and_chatter_is_none(stations):
    sweep = Sweep(stations, start=0.9)
    exact = solve_sweep(Case(profile=circle(0.8, (0.0, 0.4)), sweep=sweep))
    found = compare(exact, rung(exact))
    step = float(np.abs(np.diff(exact.values("foot_x"))).max())
    for name in ("first_contact", "snap_off"):
        assert abs(found.events[name].difference) <= step
    assert compare(exact, rung(exact, held=1)).snap_off.candidate is None
