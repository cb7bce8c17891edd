"""The comparison finds what was planted, and nothing else."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    Readings,
    Sweep,
    circle,
    find_events,
    solve_sweep,
)
from analytic.from_clamp.noise import reading_noise
from compare import Tolerances, classify, compare
from compare.sense.noise import with_noise
from compare.sense.phases import confusion
from compare.sense.transitions import locate_transitions
from tests.compare.synthetic import changed


def noisy(sweep: Readings, level: float) -> Readings:
    return with_noise(sweep, dict.fromkeys(CLAMP_READINGS, level), 1)


def test_a_sweep_agrees_with_itself(exact):
    found = compare(exact, exact)
    assert found.agrees
    assert all(d.rms == d.max == 0 for d in found.disagreement.values())
    assert found.snap_off.difference == 0
    assert sum(found.alignment.counts.values()) == len(exact.table)


def test_other_stations_of_the_same_sweep_agree(case, exact):
    """Interpolation within a phase: only the spline's own error, 1e-4 beside the snap-off."""
    other = solve_sweep(replace(case, sweep=Sweep(stations=333)))
    found = compare(exact, other)
    assert found.agrees, found.failures
    assert found.disagreement["moment_z"].rms_by_phase.get("tangent", 0) < 1e-6
    assert found.alignment.counts["between_phases"] <= 8


def test_nothing_is_interpolated_across_the_snap_off(case, exact):
    """A reference with a gap around its snap-off has nothing to say there."""
    near = np.abs(exact.values("foot_x") - exact.snap_off) < 0.1
    gap = Readings(exact.table[~near].reset_index(drop=True), exact.beam, "gap", exact.provenance)
    found = compare(gap, exact)
    compared = found.alignment.table["at"].to_numpy()
    assert (np.abs(compared - exact.snap_off) >= 0.1 - 1e-12).all()
    left_out = found.alignment.counts["between_phases"] + found.alignment.counts["outside"]
    assert left_out >= near.sum()
    assert found.disagreement["force_x"].max < 1e-9


def test_stations_that_did_not_settle_are_left_out(exact):
    status = exact.table["status"].copy()
    status.iloc[50:53] = "unsettled"
    force = exact.table["force_y"].copy()
    force.iloc[50:53] = 1e3
    found = compare(exact, changed(exact, status=status, force_y=force))
    assert found.alignment.counts["untrusted"] == 3
    assert found.disagreement["force_y"].max == 0
    assert any("stations" in line for line in found.failures)
    loose = compare(exact, changed(exact, status=status), Tolerances(untrusted=0.02))
    assert loose.agrees, loose.failures


def test_an_early_release_is_found(exact):
    early = exact.values("foot_x") < exact.snap_off + 0.05
    columns = {name: np.where(early, 0.0, exact.values(name)) for name in CLAMP_READINGS}
    released = Readings(exact.table.assign(**columns), exact.beam, "early")
    found = compare(exact, released)
    assert any(line.startswith("snap_off") for line in found.failures)
    assert found.alignment.counts["one_free"] > 0


@pytest.mark.parametrize(("level", "share"), [(1e-4, 0.99), (1e-3, 0.98), (1e-2, 0.91)])
def test_phases_of_noisy_readings(exact, level, share):
    """Observed: 1, 0.99, 0.925. At 1 % the first stations' force drowns, and transitions blur."""
    table = confusion(classify(noisy(exact, level)), exact).to_numpy()
    assert np.trace(table) / table.sum() >= share


def test_noise_is_estimated(exact):
    for level in (1e-4, 1e-2):
        found = reading_noise(noisy(exact, level))
        for name in CLAMP_READINGS:
            scale = np.abs(exact.values(name)).max()
            assert found[name] / scale == pytest.approx(level, rel=0.25)


def test_transitions_lie_where_the_events_are(case, exact):
    """Between stations 0.012 to 0.05 L apart: observed 2e-5 L for Phase B."""
    events = find_events(case.profile, case.beam)
    found = locate_transitions(exact, classify(exact))
    step = abs(np.diff(exact.values("foot_x"))[0])
    for name in ("phase_b_start", "phase_b_end"):
        event = getattr(events, name)
        if event is None:
            assert found[name] is None
        else:
            assert found[name] == pytest.approx(event.foot_x, abs=5e-5)
    assert found["first_contact"] == pytest.approx(events.first_contact.foot_x, abs=step / 4)


def test_comparison_as_json(exact, simulated):
    import json

    found = json.loads(json.dumps(compare(exact, simulated).to_dict(), allow_nan=False))
    for reading in CLAMP_READINGS:
        assert {"rms", "max"} <= set(found["disagreement"][reading])
    assert {"agreement", "transitions"} <= set(found["phases"])
    assert set(found["snap_off"]) >= {"reference", "candidate", "difference"}
    assert found["verdict"] == "agrees"


def test_sweeps_in_other_units_compare_alike(case):
    small = replace(case, sweep=Sweep(stations=80))
    beam = Beam(50.0, 7.0, 0.25)
    large = Case(beam, case.profile.scaled(50.0), Sweep(stations=80))
    a = noisy(solve_sweep(small), 1e-3)
    b = noisy(solve_sweep(large), 1e-3)
    one = compare(solve_sweep(small), a)
    other = compare(solve_sweep(large), b)
    for name in CLAMP_READINGS:
        assert one.disagreement[name].rms == pytest.approx(other.disagreement[name].rms, rel=1e-6)


def test_readings_with_friction_that_do_not_say_so_are_read_as_the_reference_is():
    case = Case(
        Beam(natural_curvature=-0.4),
        circle(1.0, lowest=(0, 0.4)),
        Sweep(60),
        clamp_stiffness=6.0,
        friction=0.25,
    )
    exact = solve_sweep(case)
    sensed = exact.table[["foot_x", "force_x", "force_y", "moment_z"]]
    found = compare(exact, Readings(sensed, case.beam))
    assert found.agrees
    assert found.phases_alike() == 1.0
    assert found.confusion["reference"].to_numpy().trace() == 60
