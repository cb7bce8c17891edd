"""What failed is named with the number that failed it, and why that much is allowed."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Case,
    Sweep,
    circle,
    named_case,
    solve_sweep,
)
from compare import Limit, Tolerances, compare
from compare.sense.noise import with_noise
from compare.show.verdict import verdict
from tests.compare.synthetic import changed, scaled, sensed
from tests.conftest import exact_sweep, simulated_sweep


@pytest.mark.parametrize(
    ("rows", "value", "level", "said"),
    [
        (np.arange(90, 120), np.nan, 5e-3, "30 of {} lack a number"),
        (np.arange(60, 120, 6), 0.0, 3e-3, "10 of {} are filled with zeros amid contact"),
    ],
)
def test_the_headline_names_what_failed(rows, value, level, said):
    """Under noise that is given all else passes; where both sweeps are free zeros are none."""
    exact = exact_sweep("parabola")
    noisy = with_noise(exact, dict.fromkeys(CLAMP_READINGS, level), 1)
    table = noisy.table.drop(columns="phase")
    table.loc[rows, list(CLAMP_READINGS)] = value
    spoilt = replace(noisy, table=table)
    found = compare(exact, spoilt, noise=level)
    assert [failure.name for failure in found.exceeded] == ["stations"]
    assert f"{len(rows)} of 200 are not to be trusted ({said.format('them')})" in verdict(found)
    assert "force_x" not in verdict(found)
    assert found.likely == said.format("200 rows")
    if value == 0:
        assert found.phases_alike() > 0.97
        assert compare(spoilt, spoilt).alignment.counts["dropped"] == 0


def test_stations_that_are_not_trusted_are_not_called_without_a_load():
    """All but one of those in contact chattered, and the clamp was said to read no load there."""
    exact = exact_sweep("parabola")
    touching = (exact.table["phase"] != "free").to_numpy()
    idle = np.arange(200) == touching.argmax()
    status = np.where(touching & ~idle, "chattering", "ok")
    table = exact.table.drop(columns="phase").assign(status=status)
    table.loc[idle, [*CLAMP_READINGS]] = 0.0
    found = compare(exact, replace(exact, table=table, provenance={}))
    assert "no station in contact in both" in found.worst.found


def test_a_missing_snap_off_is_named():
    exact = exact_sweep("parabola")
    short = replace(exact, table=exact.table.iloc[:150].reset_index(drop=True), provenance={})
    found = compare(exact, short)
    assert "snap_off (only in the reference, at -1.24" in verdict(found)
    assert any("beyond the stretch that the candidate covers" in one for one in found.failures)
    assert found.likely.startswith("too short a sweep: it covers foot_x = ")
    few = compare(exact, changed(short, slice(None, None, 20)))
    assert few.likely.startswith("too short a sweep: it covers foot_x = ")


def test_a_snap_off_beyond_both_sweeps_is_asked_of_neither():
    case = named_case("parabola")
    exact = solve_sweep(replace(case, sweep=replace(case.sweep, stop=-0.5)))
    found = compare(exact, sensed(exact))
    assert found.agrees, found.failures
    assert found.snap_off.reference < -0.5
    assert found.likely is None


def test_what_a_verdict_rests_on_is_said_where_that_is_little():
    steep = Case(profile=circle(1.0, (0.0, 0.05)), sweep=Sweep(8))
    exact = solve_sweep(steep)
    strain = steep.beam.radius * np.abs(exact.values("moment_z")).max()
    few, bent = compare(exact, exact).remarks
    assert few.endswith(f": {(exact.table['phase'] != 'free').sum()}")
    assert f"a strain of {strain:.0%}" in bent
    assert not compare(exact_sweep("catenary"), exact_sweep("catenary")).remarks


def test_reasons_fit_the_source():
    exact, simulated = exact_sweep("catenary"), simulated_sweep("catenary")
    rig = sensed(scaled(exact, force_y=1.02))
    assert repr(compare(exact, rig)).count("convention for this source") == 1
    contour = {**simulated.provenance, "contour": [[-1, 0, 1], [1, 0.5, 1]]}
    cornered = replace(simulated, provenance=contour)
    for candidate, by_segments in ((rig, False), (simulated, True), (cornered, False)):
        reasons = compare(exact, candidate).to_dict()["tolerance_reasons"]
        assert ("3/N^2" in reasons["rms"]) == by_segments
    mine = Tolerances(rms=Limit(1e-3, "the force that is used"))
    reasons = compare(exact, rig, mine).to_dict()["tolerance_reasons"]
    assert reasons["rms"] == "the force that is used"
