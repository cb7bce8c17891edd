"""What failed is named with the number that failed it, and why that much is allowed."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Readings
from compare import Limit, Tolerances, compare
from compare.sense.noise import with_noise
from compare.show.verdict import verdict
from tests.conftest import exact_sweep, simulated_sweep


def lost(sweep: Readings, rows: slice) -> Readings:
    table = sweep.table.copy()
    table.loc[rows, list(CLAMP_READINGS)] = np.nan
    return replace(sweep, table=table.drop(columns="phase"))


def test_the_headline_names_what_failed():
    """Under noise that is given, force_x passes; thirty rows without a number do not."""
    exact = exact_sweep("parabola")
    noisy = with_noise(exact, dict.fromkeys(CLAMP_READINGS, 5e-3), 1)
    found = compare(exact, lost(noisy, slice(90, 119)), noise=5e-3)
    assert [failure.name for failure in found.exceeded] == ["stations"]
    assert "30 of 200 are not to be trusted (30 of them lack a number)" in verdict(found)
    assert "force_x" not in verdict(found)
    assert found.likely == "30 of 200 rows lack a number"


def test_zeros_amid_contact_are_stations_that_lack_a_reading():
    """Also under limits that everything else meets; where both sweeps are free they are none."""
    exact = exact_sweep("parabola")
    noisy = with_noise(exact, dict.fromkeys(CLAMP_READINGS, 3e-3), 1)
    table = noisy.table.drop(columns="phase")
    table.loc[np.arange(60, 120, 6), list(CLAMP_READINGS)] = 0.0
    dropped = replace(noisy, table=table)
    found = compare(exact, dropped, noise=3e-3)
    assert [failure.name for failure in found.exceeded] == ["stations"]
    assert "10 of them are filled with zeros amid contact" in verdict(found)
    assert found.likely == "10 of 200 rows are filled with zeros amid contact"
    assert found.phases_alike() > 0.97
    assert compare(dropped, dropped).alignment.counts["dropped"] == 0


def test_a_missing_snap_off_is_named():
    exact = exact_sweep("parabola")
    short = replace(exact, table=exact.table.iloc[:150].reset_index(drop=True), provenance={})
    found = compare(exact, short)
    assert "snap_off (only in the reference, at -1.24" in verdict(found)
    assert "beyond the stretch that the candidate covers" in found.failures[-1]
    assert found.likely is not None
    assert found.likely.startswith("too short a sweep: it covers foot_x = ")


def test_the_headline_is_the_limit_that_is_exceeded_most():
    exact = exact_sweep("parabola")
    wrong = exact.table.assign(force_y=1.03 * exact.table["force_y"])
    found = compare(exact, replace(exact, table=wrong))
    assert found.worst is not None
    assert found.worst.name == "force_y"
    assert found.worst.excess == max(failure.excess for failure in found.exceeded)
    assert ": force_y (" in verdict(found)


@pytest.mark.parametrize("late", [False, True])
def test_max_is_never_below_rms(late):
    """Both are over the same stations, also where one sweep lets go much later than the other."""
    exact = exact_sweep("catenary")
    other = exact_sweep("shallow-catenary")
    other = replace(other, provenance={}) if late else other
    for d in compare(exact, other).disagreement.values():
        assert d.max >= d.rms
        assert d.stations == sum(d.stations_by_phase.values())


def test_reasons_fit_the_source():
    exact = exact_sweep("catenary")
    rig = Readings(exact.table.assign(force_y=1.02 * exact.table["force_y"]), exact.beam, "rig")
    said = " ".join(compare(exact, rig).failures)
    assert "segments" not in said
    assert "convention" not in said
    assert repr(compare(exact, rig)).count("convention for this source") == 1
    simulated = simulated_sweep("catenary")
    assert "3/N^2" in compare(exact, simulated).to_dict()["tolerance_reasons"]["rms"]
    cornered = replace(
        simulated, provenance={**simulated.provenance, "contour": [[-1, 0, 1], [1, 0.5, 1]]}
    )
    assert "3/N^2" not in compare(exact, cornered).to_dict()["tolerance_reasons"]["rms"]
    mine = Tolerances(rms=Limit(1e-3, "the force that is used"))
    assert (
        compare(exact, rig, mine).to_dict()["tolerance_reasons"]["rms"] == "the force that is used"
    )
