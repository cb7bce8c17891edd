"""One run: every outcome has a name and a reason, and the numbers are those of the library."""

import time
from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    Beam,
    Case,
    InputError,
    Sweep,
    Whisk,
    catenary,
    find_events,
    named_case,
    reconstruct,
    relative_noise,
    solve_sweep,
)
from compare import compare
from compare.study.grid.study import SensorNoise
from compare.study.work import perform as running
from compare.study.work.perform import perform
from mujoco_models import Settings, simulate_sweep
from tests.compare.study.studies import ONE_SIMULATION, only


def test_a_row_holds_what_the_library_finds(plan_of):
    result = perform(*only(plan_of(ONE_SIMULATION)))
    row = result.row
    case = named(40)
    found = compare(
        solve_sweep(case), simulate_sweep(case, Settings(segments=10, contour_points=800))
    )
    assert row["outcome"] == "done"
    assert row["disagreement_moment_z_rms"] == found.disagreement["moment_z"].rms
    assert row["disagreement_force_x_max"] == found.disagreement["force_x"].max
    assert row["snap_off_difference"] == found.snap_off.difference
    begins = found.transitions["phase_b_start"]
    assert row["transition_phase_b_start_difference"] == begins.difference
    assert row["phase_agreement"] == min(found.phase_agreement().values())
    assert row["agrees"] == found.agrees
    assert row["stations_compared"] == found.alignment.counts["compared"]
    assert row["event_snap_off"] == find_events(case.profile, case.beam).snap_off.foot_x
    assert row["phase_b_exists"] is True
    assert set(result.readings) == {"analytic", "candidate"}


@pytest.mark.slow
def test_events_are_those_of_the_whole_case(plan_of):
    """They were those of the paper's vibrissa in a sweep to the left, whatever the case was."""
    plan = plan_of("""
        study = { case = "catenary", beams = [], record = ["events"] }
        beam.natural_curvature = -0.3
        support.rotational_stiffness = 8.0
        axes.contact.friction = [0.0, 0.2]
        axes.sweep.direction = ["left", "right"]
    """)
    for run in plan:
        row = perform(plan.study.recipe, run).row
        case = Case(
            Beam(natural_curvature=-0.3),
            catenary(0.5, -0.8),
            Sweep(2, direction=run.parameters["sweep.direction"]),
            clamp_stiffness=8.0,
            friction=run.parameters["contact.friction"],
        )
        assert (row["outcome"], row["reason"]) == ("done", "")
        for name, place in solve_sweep(case).provenance["events"].items():
            # Curved towards the object, as to the right, it touches twice, which has no column.
            if f"event_{name}" in row:
                expected = None if place is None else pytest.approx(place, rel=1e-9)
                assert row[f"event_{name}"] == expected
        assert row["phase_b_exists"]


def named(stations):
    case = Case(profile=catenary(0.5, -0.8))
    return replace(case, sweep=replace(case.sweep, stations=stations))


def test_reconstruction_is_exact_without_noise_and_gets_worse_with_it(plan_of):
    plan = plan_of("""
        study = { case = "catenary", beams = [], record = ["reconstruction"] }
        axes.noise.relative = [0.0, 1e-5, 1e-4, 1e-3]
    """)
    errors = [perform(plan.study.recipe, run).row["reconstruction_rms"] for run in plan]
    assert errors[0] < 1e-9
    assert (np.diff(errors) > 0).all()


@pytest.mark.slow
def test_a_study_of_whisks(plan_of):
    plan = plan_of("""
        study = { case = "whisk-circle", beams = ["chain"], record = ["events", "disagreement"] }
        axes.whisk.foot_x = [0.35, 0.45]
        axes.whisk.stop = [1.5]
        whisk.stations = 12
        mujoco = { segments = 10, contour_points = 400 }
    """)
    for run in plan:
        row = perform(plan.study.recipe, run).row
        assert (row["outcome"], row["reason"]) == ("done", "")
        way = Whisk(run.parameters["whisk.foot_x"], -0.55, 1.5, 12)
        exact = solve_sweep(replace(named_case("whisk-circle"), sweep=way))
        assert row["event_first_contact"] == exact.provenance["events"]["first_contact"]
        assert row["event_snap_off"] == exact.provenance["events"]["snap_off"]
        assert row["phase_b_exists"]
        assert 0 < row["disagreement_force_y_rms"] < 0.05


def test_a_study_of_whisks_has_no_sweep(plan_of):
    with pytest.raises(InputError, match=r"\[sweep\] beside \[whisk\]"):
        plan_of("""
            study = { case = "whisk-circle", record = ["events"] }
            axes.sweep.stations = [10, 20]
        """)


def test_bad_input_is_an_outcome(plan_of):
    recipe, run = only(plan_of('study = { case = "catenary", beams = [] }\nprofile.c = 0.5'))
    row = perform(recipe, run).row
    assert (row["outcome"], row["run"]) == ("bad-input", run.id)
    assert "raise" in row["reason"] or "lower" in row["reason"]


def test_whatever_else_goes_wrong_is_an_outcome(plan_of, monkeypatch):
    def broken(case):
        raise ArithmeticError("no state found")

    monkeypatch.setattr(running, "solve_sweep", broken)
    row = perform(*only(plan_of(ONE_SIMULATION))).row
    assert (row["outcome"], row["reason"]) == ("failed", "ArithmeticError: no state found")


@pytest.mark.parametrize("status", ["unsettled", "diverged"])
def test_a_simulation_that_does_not_trust_itself(plan_of, monkeypatch, status):
    def doubtful(case, settings, advance, keep):
        readings = simulate_sweep(case, settings, advance)
        table = readings.table
        table.loc[:9, "status"] = status
        return replace(readings, table=table)

    monkeypatch.setattr("compare.simulate.dispatch.simulate_sweep", doubtful)
    row = perform(*only(plan_of(ONE_SIMULATION))).row
    assert (row["outcome"], row["reason"]) == (status, f"10 of 40 stations {status}")


def test_a_slow_run_is_ended_between_stations(plan_of, monkeypatch):
    def slow(case, settings, advance, keep):
        while True:
            time.sleep(0.01)
            advance()

    monkeypatch.setattr("compare.simulate.dispatch.simulate_sweep", slow)
    row = perform(*only(plan_of(ONE_SIMULATION.replace("30", "0.1")))).row
    assert row["outcome"] == "timeout"
    assert row["seconds"] < 2


def test_noise_is_that_of_the_reconstruction(plan_of):
    exact = solve_sweep(named(2000))
    noisy = SensorNoise(relative=1e-2, seed=3).add_to(exact)
    for name, deviation in relative_noise(exact, 1e-2).items():
        assert np.std(noisy.values(name) - exact.values(name)) == pytest.approx(deviation, rel=0.05)
    assert reconstruct(noisy).shape == reconstruct(exact).shape
