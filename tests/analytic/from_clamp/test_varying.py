"""Contacts from the clamp of vibrissae that vary: exact readings give them back."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analytic import (
    Beam,
    Case,
    Sweep,
    circle,
    deflected_shapes,
    named_case,
    reconstruct,
    relative_noise,
    solve_sweep,
)
from tests.analytic.noisy import noisy

CATENARY = named_case("catenary").profile


def found_back(case):
    """The largest error of the contacts of a sweep [L]; all phases must be right."""
    readings = solve_sweep(case)
    table, found = readings.table, reconstruct(readings)
    there = ((table["status"] == "ok") & (table["phase"] != "free")).to_numpy()
    assert there.sum() > 5
    assert (found["phase"] == table["phase"])[there].all()
    misses = [found[n] - table[n] for n in ("contact_x", "contact_y", "contact_arc_length")]
    return float(np.abs(np.array(misses))[:, there].max())


def test_contacts_of_a_cone():
    assert found_back(Case(Beam(radius=0.01, tip_radius=0.004), CATENARY, Sweep(20))) < 1e-12


@pytest.mark.slow
@settings(max_examples=4, deadline=None)
@given(
    ratio=st.floats(0.2, 1.0),
    curvature=st.floats(-0.6, 0.3),
    friction=st.floats(0, 0.4),
    compliance=st.floats(0, 0.2),
    rightward=st.booleans(),
)
def test_contacts_are_those_of_the_sweep(ratio, curvature, friction, compliance, rightward):
    beam = Beam(radius=0.01, tip_radius=0.01 * ratio, natural_curvature=curvature)
    stiffness = 1 / compliance if compliance > 0.01 else np.inf
    case = Case(beam, CATENARY, Sweep(40), clamp_stiffness=stiffness, friction=friction)
    if rightward:
        case = replace(case, beam=beam.mirrored(), sweep=Sweep(40, direction="right"))
    assert found_back(case) < 1e-12  # L; observed 2e-15


@pytest.mark.parametrize(
    "beam",
    [
        pytest.param(Beam(radius=0.01, tip_radius=0.0005), marks=pytest.mark.slow),
        Beam(radius=0.005, flexural_rigidity=lambda s: 1 / (1 + 2 * s**2)),
        Beam(radius=0.005, natural_curvature=((0.0, 0.0), (0.6, -0.3), (1.0, -0.8))),
    ],
    ids=["nearly sharp", "graded", "bowed at its end"],
)
def test_other_forms(beam):
    assert found_back(Case(beam, CATENARY, Sweep(40))) < 1e-11  # L; observed 4e-15


def test_shapes_go_through_the_contacts():
    for beam in (Beam(radius=0.01, tip_radius=0.004),
                 Beam(radius=0.01, natural_curvature=((0.0, 0.0), (1.0, -0.8)))):  # fmt: skip
        readings = solve_sweep(Case(beam, circle(0.3, (0, 0.5)), Sweep(40)))
        there = (readings.table["phase"] != "free").to_numpy()
        x, y = (path[there] for path in deflected_shapes(readings))
        table = readings.table[there]
        radius = beam.radius_at(table["contact_arc_length"].to_numpy())
        angle = table["contact_angle"].to_numpy()
        axis_x = table["contact_x"] + radius * np.sin(angle)
        axis_y = table["contact_y"] - radius * np.cos(angle)
        # Runge-Kutta in 64 steps; observed 5e-9.
        distance = np.hypot(x - axis_x.to_numpy()[:, None], y - axis_y.to_numpy()[:, None])
        assert distance.min(axis=1).max() < 1e-6
        length = np.hypot(np.diff(x), np.diff(y)).sum(axis=1)
        assert np.allclose(length, 1, atol=1e-3)  # of chords


@pytest.mark.parametrize(
    ("times", "least"),
    [
        pytest.param(1, 0.86, marks=pytest.mark.slow),
        pytest.param(3, 0.90, marks=pytest.mark.trial),
    ],
)
def test_noise_covers_the_contact(times, least):
    """95 % of contacts of noisy readings lie within the stated uncertainty.

    A sweep has some 55 contacts: three standard deviations are 0.09, of three sweeps 0.05. Half the
    uncertainty would hold two thirds of them.
    """
    beam = Beam(radius=0.01, tip_radius=0.004)
    exact = solve_sweep(Case(beam, CATENARY, Sweep(60)))
    noise, draw = relative_noise(exact, 0.003), np.random.default_rng(4)
    covered = []
    for _ in range(times):
        found = reconstruct(noisy(exact, noise, draw), noise)
        there = ((exact.table["phase"] != "free") & (found["status"] == "ok")).to_numpy()
        miss = np.hypot(*(found[n] - exact.table[n] for n in ("contact_x", "contact_y")))
        covered += list((miss <= found["uncertainty"])[there])
    assert len(covered) > 50 * times
    assert np.mean(covered) > least
