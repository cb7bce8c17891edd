"""How far two aligned sweeps are apart, by numbers that can be counted on one's fingers."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analytic import CLAMP_READINGS, Readings, named_case, solve_sweep
from compare import Tolerances, compare
from compare.measure.disagreement import Disagreement, Occurrence, before_snap_off, disagreements
from tests.compare.synthetic import BEAM

X = np.linspace(1.0, 0.0, 11)
# The largest magnitudes are 4, 8 and 2, of either sign; a station that is not trusted is larger.
REFERENCE = Readings(
    pd.DataFrame(
        {
            "foot_x": X,
            "force_x": np.append(np.linspace(0, -4, 10), 99.0),
            "force_y": np.append(np.linspace(0, 8, 10), 99.0),
            "moment_z": np.append(np.linspace(2, 0, 10), 99.0),
            "status": ["ok"] * 10 + ["unsettled"],
        }
    ),
    BEAM,
)
SCALES = {"force_x": 4.0, "force_y": 8.0, "moment_z": 2.0}
PHASE = np.array(["tip"] * 3 + ["tangent"] * 4 + ["tip"])
ERROR = np.array([0.1, -0.3, 0.0, 0.2, 0.2, -0.4, 0.1, 0.9])  # of the largest magnitude
NEVER = Occurrence(None, None)


def disagree(snap=NEVER, window=0.05, **errors: np.ndarray) -> dict[str, Disagreement]:
    columns = {"at": X[:8], "phase": PHASE, "contact_arc_length": 2 - X[:8]}
    for name in CLAMP_READINGS:
        columns[f"{name}_reference"] = REFERENCE.values(name)[:8]
        error = SCALES[name] * errors.get(name, np.zeros(8))
        columns[f"{name}_candidate"] = columns[f"{name}_reference"] + error
    table = pd.DataFrame(columns)
    return disagreements(REFERENCE, table, snap, window, table[:0])


@pytest.mark.parametrize("name", CLAMP_READINGS)
def test_each_reading_is_relative_to_its_own_largest_magnitude(name):
    """That of the trusted stations, whatever its sign."""
    found = disagree(**{name: ERROR})
    assert {n: d.scale for n, d in found.items()} == SCALES
    assert found[name].rms == pytest.approx(np.sqrt(1.16 / 8))
    assert all(found[n].rms == found[n].max == 0 for n in CLAMP_READINGS if n != name)


def test_the_whole_the_phases_and_the_worst_places():
    found = disagree(force_y=ERROR)["force_y"]
    assert (found.max, found.at, found.phase) == (pytest.approx(0.9), pytest.approx(0.3), "tip")
    assert found.rms_by_phase == pytest.approx(
        {"tip": np.sqrt(0.91 / 4), "tangent": np.sqrt(0.25 / 4)}
    )
    assert found.stations_by_phase == {"tip": 4, "tangent": 4}
    assert found.stations == 8
    worst = found.peaks["tangent"]
    assert (worst.size, worst.at, worst.arc_length) == pytest.approx((0.4, 0.5, 1.5))
    assert np.isnan(found.max_before_snap_off)


@pytest.mark.parametrize("snap", [Occurrence(0.3, 0.15), Occurrence(0.15, 0.3)])
def test_the_window_is_at_the_earlier_snap_off(snap):
    """To either side, of the sweep's length: of the two stations at 0.4 and 0.3 one is in it."""
    found = disagree(snap, 0.05, force_x=ERROR)["force_x"]
    assert found.stations == 7
    assert found.max_before_snap_off == pytest.approx(0.9)
    assert found.max == pytest.approx(0.4)
    wider = disagree(snap, 0.11, force_x=ERROR)["force_x"]
    assert wider.stations == 6
    assert wider.rms == pytest.approx(np.sqrt(0.34 / 6))
    assert wider.max_before_snap_off == pytest.approx(0.9)


def test_nothing_is_left_outside_the_window():
    found = disagree(Occurrence(0.5, None), 2.0, force_x=ERROR)["force_x"]
    assert np.isnan([found.rms, found.max, found.at]).all()
    assert (found.stations, found.phase, found.peaks) == (0, "", {})
    assert found.max_before_snap_off == pytest.approx(0.9)


@pytest.mark.parametrize(("way", "at"), [(1, 0.7), (-1, 0.3)])
def test_the_earlier_one_depends_on_the_direction(way, at):
    """Mirrored about 0.5, a sweep to the right comes to the other snap-off first."""
    reference = Readings(REFERENCE.table.assign(foot_x=X[::-way]), BEAM)
    x = np.array([0.25, 0.3, 0.35, 0.65, 0.7, 0.75])
    ends = Occurrence(0.3, 0.7)
    found = before_snap_off(reference, x, ends, 0.04)
    np.testing.assert_array_equal(found, np.isclose(x, 1 - at))
    assert not before_snap_off(reference, x, NEVER, 0.04).any()
    one_only = before_snap_off(reference, x, Occurrence(None, 0.7), 0.04)
    np.testing.assert_array_equal(one_only, np.isclose(x, 0.7))


def test_when_an_event_agrees():
    """Within the tolerance and what the stations resolve; or in neither sweep."""
    event = Occurrence(1.0, 0.75, uncertainty=0.125)
    assert event.difference == -0.25
    assert event.agrees(0.125)
    assert not event.agrees(0.1249)
    assert NEVER.agrees(0.0)
    assert NEVER.difference is None
    assert not Occurrence(1.0, None).agrees(9.0)
    assert not Occurrence(None, 1.0).agrees(9.0)


@pytest.mark.parametrize("by", [-2.5e-3, 2.5e-3])
def test_a_snap_off_as_early_or_late_as_it_may_be_excuses_what_it_does_next_to_it(by):
    """Of 250 random sweeps none was off by more than 0.7 of what is allowed there."""
    case, exact = named_case("parabola"), solve_sweep(named_case("parabola"))
    start, stop = case.foot_x[[0, -1]] + by
    moved = solve_sweep(replace(case, sweep=replace(case.sweep, start=start, stop=stop)))
    late = Readings(moved.table.assign(foot_x=exact.values("foot_x")), case.beam, "late")
    found = compare(exact, late, Tolerances(rms=0.02))
    assert found.disagreement["force_x"].max_before_snap_off > 0.02
    assert not any("next to the snap-off" in failure for failure in found.failures)
