"""The object from the clamp alone: exact readings, noisy ones, and none."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from analytic import (
    Beam,
    InputError,
    Readings,
    Sweep,
    named_case,
    reconstruct,
    reconstruct_by_decision,
    relative_noise,
    require_beam,
    solve_sweep,
)
from analytic.from_clamp.reconstruct import scatter_of_contacts
from tests.analytic.noisy import noisy


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


def test_in_other_units():
    case = named_case("catenary")
    beam = Beam(50.0, 7.0, 0.25)
    large = solve_sweep(replace(case, beam=beam, profile=case.profile.scaled(50.0)))
    assert missed(reconstruct(large), large.table).max() < 50 * 1e-13


@pytest.mark.slow
@pytest.mark.parametrize("level", [1e-2, 1e-4])
def test_uncertainty_covers_the_error(exact, level):
    covers(exact, level)


def covers(exact, level):
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


def test_uncertainty_grows_with_the_noise(exact):
    small, large = (
        reconstruct(exact, relative_noise(exact, level))["uncertainty"] for level in (1e-4, 1e-3)
    )
    both = np.isfinite(small) & np.isfinite(large)
    assert np.median((large / small)[both]) == pytest.approx(10, rel=0.1)


def test_readings_that_no_elastica_has():
    """A moment too large for its force is reported, not hidden."""
    sweep = solve_sweep(named_case("parabola"))
    found = reconstruct(Readings(sweep.table.assign(moment_z=100.0), sweep.beam))
    touching = sweep.table["phase"] != "free"
    assert (found["phase"][touching] == "unexplained").all()
    assert found["contact_x"].isna().all()


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
