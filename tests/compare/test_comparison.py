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
    polygon,
    solve_sweep,
)
from compare import classify, compare
from compare.sense.transitions import locate_transitions


def test_other_stations_of_the_same_sweep_agree(case, exact):
    """Interpolation within a phase: only the spline's own error, 1e-4 beside the snap-off."""
    other = solve_sweep(replace(case, sweep=Sweep(stations=333)))
    found = compare(exact, other)
    assert found.agrees, found.failures
    assert found.disagreement["moment_z"].rms_by_phase.get("tangent", 0) < 1e-6
    assert found.alignment.counts["between_phases"] <= 8


@pytest.mark.parametrize("seed", [0, 4, 6, 27, 51])
def test_other_stations_past_corners_agree(seed):
    """Of 60 such polygons 29 disagreed with themselves, by up to 9 %: splines went over jumps."""
    draw = np.random.default_rng(seed)
    angle = np.sort(draw.uniform(-2.9, -0.2, draw.integers(4, 8)))
    low = np.column_stack([0.5 * np.cos(angle), 0.4 * np.sin(angle)])
    points = np.vstack([low, low[-1] + [0, 1.0], low[0] + [0, 1.0]])
    profile = polygon(points - [0, low[:, 1].min() - 0.5])
    case = Case(profile=profile)
    ends = case.foot_x[0], case.foot_x[-1]
    exact, other = solve_sweep(case), solve_sweep(replace(case, sweep=Sweep(137, *ends)))
    found = compare(exact, other)
    assert found.agrees, found.failures
    assert found.alignment.counts["between_phases"] < 16


def test_a_limit_says_how_far_it_may_be_off_where_there_are_two_stretches_of_phase_b():
    """At 200 stations the one is longer, at 137 the other; and past a corner the contact jumps."""
    points = [(-0.709, 0.686), (0.126, 0.565), (0.453, 0.606), (0.527, 0.623), (0.622, 0.652)]
    case = Case(Beam(radius=1e-3), polygon([*points, (0.808, 0.743)]))
    ends = case.foot_x[0], case.foot_x[-1]
    exact, other = solve_sweep(case), solve_sweep(replace(case, sweep=Sweep(137, *ends)))
    end = compare(exact, other).events["phase_b_end"]
    assert abs(end.difference) > 0.2 and end.agrees(0.01)
    one = locate_transitions(exact, classify(exact))["phase_b_end"]
    assert 0.2 < one[1] < 0.4


def test_transitions_lie_where_the_events_are(case, exact):
    """Between stations 0.012 to 0.05 L apart: observed 2e-5 L for Phase B."""
    events = find_events(case.profile, case.beam)
    found = {name: at for name, (at, _) in locate_transitions(exact, classify(exact)).items()}
    step = abs(np.diff(exact.values("foot_x"))[0])
    for name in ("phase_b_start", "phase_b_end"):
        event = getattr(events, name)
        if event is None:
            assert found[name] is None
        else:
            assert found[name] == pytest.approx(event.foot_x, abs=5e-5)
    assert found["first_contact"] == pytest.approx(events.first_contact.foot_x, abs=step / 4)


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


def test_a_reference_that_is_too_coarse_is_noted():
    """Past an octagon, where readings bend; one of 200 stations says nothing of its snap-off."""
    turn = 0.2 + 2 * np.pi * np.arange(8) / 8
    octagon = polygon(np.column_stack([0.4 * np.cos(turn), 0.8 + 0.4 * np.sin(turn)]))
    for profile, stations, noted in ((octagon, 61, True), (circle(1.0, (0.0, 0.5)), 200, False)):
        case = Case(profile=profile, sweep=Sweep(stations))
        finer = solve_sweep(replace(case, sweep=Sweep(333)))
        found = compare(solve_sweep(case), finer)
        assert found.agrees and found.alignment.counts["reference_coarse"]
        assert any("smaller steps" in one for one in found.remarks) == noted


@pytest.mark.parametrize(("rows", "agrees"), [(range(40, 55), False), (range(95, 99), True)])
def test_rows_that_are_not_there_amid_contact_are_no_agreement(rows, agrees):
    """Fifteen of a hundred; the last ones are of a vibrissa that is free."""
    exact = solve_sweep(Case(profile=circle(1.0, (0.0, 0.5)), sweep=Sweep(100)))
    table = exact.table.drop(index=list(rows)).reset_index(drop=True)
    found = compare(exact, Readings(table[["foot_x", *CLAMP_READINGS]]))
    assert found.agrees == agrees
    assert agrees or "15 rows are not there" in found.likely


@pytest.mark.parametrize("kept", [slice(95), slice(12), slice(45, None)])
def test_a_sweep_that_is_cut_off_in_contact_is_no_agreement(kept):
    """Not even where no event lies beyond the cut: of the first rows alone little shows."""
    exact = solve_sweep(Case(profile=circle(0.8, (0.0, 0.4)), sweep=Sweep(100, stop=-0.6)))
    table = exact.table[kept].reset_index(drop=True)
    found = compare(exact, Readings(table[["foot_x", *CLAMP_READINGS]]))
    assert not found.agrees and "stretch" in [one.name for one in found.exceeded]
    assert found.likely.startswith("too short a sweep")
    coarse = exact.table[::9].reset_index(drop=True)
    assert compare(exact, Readings(coarse[["foot_x", *CLAMP_READINGS]])).agrees


@pytest.mark.parametrize("ahead", [1.5, 2.0])
def test_a_station_that_is_ahead_past_a_smooth_contour_is_not_excused(ahead):
    """As one on another branch, whose readings and contact belong together."""
    exact = solve_sweep(Case(profile=circle(1.0, (0.0, 0.5)), sweep=Sweep(100)))
    table, at = exact.table.copy(), 40
    for name in (*CLAMP_READINGS, "contact_angle"):
        step = table[name][at + 1] - table[name][at]
        table.loc[at, name] += ahead * step
    found = compare(exact, replace(exact, table=table))
    assert found.alignment.counts["beside_jump"] == 0 and not found.agrees
