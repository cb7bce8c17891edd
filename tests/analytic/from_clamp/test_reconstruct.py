"""The object and its phases from the clamp alone: exact readings, noisy ones, and none."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from analytic import (
    CASE_NAMES,
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Readings,
    Sweep,
    catenary,
    named_case,
    reconstruct,
    reconstruct_by_decision,
    relative_noise,
    require_beam,
    solve_sweep,
)
from analytic.checks.of_two import touches_twice
from analytic.from_clamp.phases import beyond_one_contact, judge_phases
from analytic.from_clamp.reconstruct import scatter_of_contacts
from tests.analytic.noisy import noisy
from tests.conftest import exact_sweep


def missed(found, table):
    return np.hypot(
        found["contact_x"] - table["contact_x"], found["contact_y"] - table["contact_y"]
    )


@pytest.mark.parametrize("method", [reconstruct, reconstruct_by_decision])
def test_exact_readings(exact, method):
    found = method(exact)
    assert missed(found, exact.table).max() < 1e-13
    assert (found["phase"] == exact.table["phase"]).all()
    error = found["contact_arc_length"] - exact.table["contact_arc_length"]
    assert error.abs().max() < 1e-13


def test_only_the_clamp_is_looked_at(exact):
    bare = Readings(exact.table[["foot_x", "force_x", "force_y", "moment_z"]], exact.beam)
    np.testing.assert_array_equal(reconstruct(bare)["contact_x"], reconstruct(exact)["contact_x"])


@pytest.mark.slow
@pytest.mark.parametrize("level", [1e-2, 1e-4])
def test_uncertainty_covers_the_error(exact, level):
    """95 % of the contacts of 30 noisy sweeps lie within what is stated: 5,000, so +-1 %."""
    noise = relative_noise(exact, level)
    covered = counted = 0
    for number in range(30):
        found = reconstruct(noisy(exact, noise, number), noise, number + 1000)
        sure = np.isfinite(found["uncertainty"]) & exact.table["contact_x"].notna()
        error = missed(found, exact.table)
        covered += int((error <= found["uncertainty"])[sure].sum())
        counted += int(sure.sum())
    assert counted > 4000
    assert 0.935 < covered / counted < 0.965


def test_no_contact_lies_beyond_the_vibrissa():
    """Readings in other units than the beam's: NaN with the reason, and the beam is asked for."""
    sweep = solve_sweep(named_case("catenary"))
    weak = {name: sweep.values(name) * 1e-4 for name in ("force_x", "force_y")}
    table = sweep.table.assign(**weak, moment_z=sweep.values("moment_z") * 1e-2)
    readings = Readings(table)
    found = reconstruct(readings)
    touching = (sweep.table["phase"] != "free").to_numpy()
    assert set(found["status"][touching]) == {"longer than the vibrissa"}
    assert (
        found.loc[touching, ["contact_x", "contact_y", "contact_arc_length"]].isna().all(axis=None)
    )
    with pytest.raises(InputError, match=r"rigidity 1: .*--beam FILE"):
        require_beam(found, readings)
    long = Readings(table, Beam(100.0, 1.0, 0.5))
    assert (reconstruct(long)["status"][touching] == "ok").all()
    require_beam(reconstruct(long), long)


@pytest.mark.slow
def test_samples_of_many_stations_take_little_memory():
    """As many stations as a rig writes; samples of all of them at once took 25 GB."""
    case = named_case("parabola")
    sweep = solve_sweep(replace(case, sweep=Sweep(stations=21_000)))
    tracemalloc.start()
    found = reconstruct(sweep, relative_noise(sweep, 1e-3))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1e9
    touching = found["phase"].isin(["tip", "tangent"])
    assert (found["uncertainty"][touching] > 0).all()


def test_gaps_and_odd_numbers():
    """NaN, repeated and whole-numbered positions, a moment next to nothing: never an exception."""
    readings = Readings.of(
        {
            "foot_x": [2, 1, 1, 0, -1],
            "force_x": [0, -1.921052132207935, np.nan, 1e-320, -0.5],
            "force_y": [0, 5.278047354836458, 1.0, 1.0, 1e300],
            "moment_z": [0, 3.249014421278077, 0.9, 1e-320, 1e-320],
        }
    )
    found = reconstruct(readings)
    assert found["status"].tolist()[:3] == ["free", "ok", "gap"]
    assert found["phase"].tolist()[:3] == ["free", "tangent", "gap"]
    length = found["contact_arc_length"].dropna()
    assert ((length >= 0) & (length <= 1.1)).all()


NUMBERS = st.floats(-1e6, 1e6) | st.floats(allow_infinity=False)


@seed(31)
@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(NUMBERS, NUMBERS, NUMBERS), min_size=2, max_size=8))
def test_any_numbers_give_a_contact_on_the_vibrissa_or_a_reason(rows):
    columns = dict(zip(("force_x", "force_y", "moment_z"), zip(*rows, strict=True), strict=True))
    with np.errstate(all="ignore"):
        found = reconstruct(Readings.of({"foot_x": range(len(rows)), **columns}))
    good = found["status"] == "ok"
    assert found.loc[good, "contact_arc_length"].between(0, 1.1).all()
    assert found.loc[~good, "contact_x"].isna().all()


def test_passes_there_and_back_scatter_by_direction():
    """At one foot position a sweep to the left and one to the right touch different places."""
    left = solve_sweep(named_case("catenary"))
    passes = [left, left.mirrored(), left]
    assert scatter_of_contacts(passes, [reconstruct(one) for one in passes]) == 0


# Shares of right stations as published for the default sweeps, less what one seed may miss.
RIGHT = {0.0: 1.0, 1e-4: 0.995, 1e-3: 0.98, 1e-2: 0.9}


@pytest.mark.parametrize("level", RIGHT)
def test_each_phase_is_found_in_spite_of_noise(exact, level):
    """Whether the noise is stated or not; what drowns in it is free, at first contact most."""
    sweep = noisy(exact, relative_noise(exact, level), 1)
    true = exact.table["phase"].to_numpy(str)
    for noise in (None, relative_noise(exact, level)):
        found = reconstruct(sweep, noise)["phase"].to_numpy(str)
        assert (found == true).mean() >= RIGHT[level]
        for phase in ("tip", "tangent"):
            mistaken = ~np.isin(found, (phase, "free"))[true == phase]
            assert not mistaken.size or mistaken.mean() < 0.1


@pytest.mark.parametrize("stations", [2, 5, 8, 12])
@pytest.mark.parametrize("name", CASE_NAMES)
def test_few_stations_are_no_noise(name, stations):
    """Neighbours that differ much are no reason to lose a contact or mistake its phase."""
    exact = solve_sweep(replace(named_case(name), sweep=Sweep(stations=stations)))
    for level in (0.0, 1e-3):
        found = reconstruct(noisy(exact, relative_noise(exact, level), 1))
        touching = (exact.table["phase"] != "free").to_numpy()
        assert found["contact_x"].notna()[touching].all()
        wrong = (found["phase"] != exact.table["phase"])[touching].sum()
        assert wrong <= (1 if level else 0)


def test_nothing_is_found_where_there_is_only_noise(exact):
    rng = np.random.default_rng(5)
    still = {name: 1e-3 * rng.standard_normal(len(exact.table)) for name in CLAMP_READINGS}
    found = reconstruct(replace(exact, table=exact.table.assign(**still)))
    assert (found["phase"] == "free").mean() > 0.99


@pytest.mark.parametrize(
    ("noise", "named"),
    [
        (0.01, "noise = 0.01"),
        ({"force": 0.01}, "noise = 'force'"),
        ({"force_x": -1.0}, "noise of force_x"),
        ({"force_x": float("nan")}, "noise of force_x"),
    ],
)
def test_noise_is_a_standard_deviation_by_column(exact, noise, named):
    with pytest.raises(InputError, match=named):
        reconstruct(exact, noise)


@pytest.mark.parametrize("level", [-0.1, 1.0, float("nan"), True])
def test_relative_noise_is_a_share(exact, level):
    with pytest.raises(InputError, match="noise = "):
        relative_noise(exact, level)


def test_jumps_amid_contact_hide_no_touch_if_free_stations_are_silent():
    """As of a coarse chain past corners: readings jump there, and are nothing without contact."""
    exact = exact_sweep("catenary")
    touching = np.flatnonzero((exact.table["phase"] != "free").to_numpy())
    size = relative_noise(exact, 0.002)
    jumps = np.zeros((3, len(exact.table)))
    jumps[:, touching[5:]] = np.random.default_rng(3).standard_normal((3, len(touching) - 5))
    columns = {n: exact.values(n) + s * j for (n, s), j in zip(size.items(), jumps, strict=True)}
    readings = replace(exact, table=exact.table.assign(**columns))
    assert (judge_phases(readings).phase[touching[:5]] != "free").all()
    # What is stated as noise hides them still.
    assert judge_phases(readings, size).phase[touching[0]] == "free"


def test_zeros_amid_noise_are_no_silence():
    """A sensor's dropouts before the touch, filled with zeros, do not make contacts of noise."""
    exact = exact_sweep("catenary")
    free = (exact.table["phase"] == "free").to_numpy()
    assert free.sum() > 5
    size = relative_noise(exact, 0.01)
    readings = noisy(exact, size, 3)
    table = readings.table
    table.loc[np.flatnonzero(free)[1:4], list(size)] = 0.0
    assert (judge_phases(replace(readings, table=table)).phase[free] == "free").all()


@pytest.mark.parametrize(("noise", "least"), [(1e-5, 30.0), (1e-4, 4.0)])
def test_what_one_contact_does_not_explain(noise, least):
    """Of two contacts a vibrissa that is curved towards the object shows this much."""
    beam = Beam(natural_curvature=0.5)
    exact = solve_sweep(Case(beam, catenary(0.5, -0.8), Sweep(200)))
    stated = relative_noise(exact, noise)
    two = touches_twice(exact.table)
    one = ~two & (exact.table["phase"] != "free").to_numpy()
    draws = np.random.default_rng(1).normal(size=(3, 200))
    table = exact.table.assign(
        **{n: exact.values(n) + stated[n] * x for n, x in zip(CLAMP_READINGS, draws, strict=True)}
    )
    missed = beyond_one_contact(replace(exact, table=table), stated)
    assert np.nanmax(missed[one]) < 4
    assert np.median(missed[two]) > least
