"""The chain against the closed form, on every named case: what the project promises."""

import numpy as np
import pytest

from analytic import CLAMP_READINGS, named_case, solve_sweep
from compare import compare
from mujoco_models import Settings
from tests.conftest import simulated_sweep


def test_agrees(exact, simulated):
    found = compare(exact, simulated)
    assert found.agrees, found.failures
    for name in CLAMP_READINGS:
        # Observed at most 1.0e-3 (catenary, force_y), the discretisation's 2 / N^2.
        assert found.disagreement[name].rms < 1.2e-3, name
        assert found.disagreement[name].max < 5e-3, name
    assert min(found.phase_agreement().values()) >= 0.99
    # Observed at most 6e-5: the chain's own fold.
    assert abs(found.snap_off.difference) < 3e-4
    for place in found.transitions.values():
        assert place.agrees(3e-3)


@pytest.mark.slow
def test_agrees_four_times_better_with_twice_the_segments(case_name, exact):
    # Observed at most 2.3e-4 and 9.3e-4: a quarter of the above.
    found = compare(exact, simulated_sweep(case_name, Settings(segments=80)))
    for name in CLAMP_READINGS:
        assert found.disagreement[name].rms < 5e-4, name
        assert found.disagreement[name].max < 5e-3, name


def test_every_station_is_at_rest(simulated):
    assert (simulated.table["status"] == "ok").all()
    assert (simulated.table["residual"] < Settings().tolerance).all()


def test_clamp_balances_the_contact(simulated):
    """What the sensors at the foot say is what the contact, seen from there, asks for."""
    table = simulated.table[simulated.table["phase"] != "free"]
    moment = (
        table["force_y"] * (table["contact_x"] - table["foot_x"])
        - table["force_x"] * (table["contact_y"])
    )
    # Two beads in contact share the load; their mean position stands for both.
    assert np.abs(moment - table["moment_z"]).max() < 1e-4 * table["moment_z"].max()
    free = simulated.table[simulated.table["phase"] == "free"]
    assert (free[list(CLAMP_READINGS)].abs() < 1e-9).all(axis=None)


def test_the_naive_clamp_is_found_out():
    """A rigid first link makes the chain too stiff, by 1/N; the comparison must not let it pass."""
    name = "catenary"
    naive = simulated_sweep(name, Settings(clamp="naive"))
    found = compare(solve_sweep(named_case(name)), naive)
    assert not found.agrees
    assert all(found.disagreement[reading].rms > 1e-2 for reading in CLAMP_READINGS)


@pytest.mark.slow
@pytest.mark.parametrize("change", [{"contact_stiffness": 1e8}, {"tolerance": 1e-10}])
def test_snap_off_stays_when_the_relaxation_is_refined(change):
    rough = simulated_sweep("parabola")
    fine = simulated_sweep("parabola", Settings(**change))
    assert abs(fine.snap_off - rough.snap_off) < 1e-4


@pytest.mark.slow
def test_the_tip_is_not_pushed_out_through_the_top():
    """The mesh goes on beyond the reach of the tip; cut there, first contacts had -9e4 EI/L^2."""
    table = simulated_sweep("catenary", Settings(contour_points=12_800)).table
    exact = solve_sweep(named_case("catenary")).table
    assert (table["force_y"] - exact["force_y"]).abs().max() < 0.5
