"""The accelerator for the paper's vibrissa against the general solver, which contains it."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import (
    CASE_NAMES,
    CLAMP_READINGS,
    Beam,
    Case,
    Sweep,
    catenary,
    circle,
    ellipse,
    named_case,
    polygon,
    solve_sweep,
    two_circles,
)
from analytic.problem.table import as_table
from analytic.solver.general import sweep as general

NUMBERS = (*CLAMP_READINGS, "contact_angle", "contact_arc_length", "contact_x", "contact_y")
# Next to an event readings change like the root of the distance from it; both solvers are good to
# some roundings of the foot position.
EXACT = 4e-13
NEAR = 1e-6  # L, from an event


def random_contour(kind, rng):
    low = rng.uniform(0.15, 0.75)
    if kind == "catenary":
        return catenary(rng.uniform(0.3, 2.0), low - 1)
    if kind == "circle":
        return circle(rng.uniform(0.1, 2.0), (rng.uniform(-1, 1), low))
    if kind == "ellipse":
        return ellipse(rng.uniform(0.2, 2.0, 2), (0.0, low))
    if kind == "two-circles":
        return two_circles(*rng.uniform(0.2, 2.0, 2), (0.0, low))
    angle = np.sort(rng.uniform(-np.pi, 0, 7))
    points = np.column_stack([np.cos(angle), 1 + np.sin(angle)]) * rng.uniform(0.3, 1.5)
    return polygon(np.vstack([points, [0.0, 3.0]]) + np.array([0.0, low]))


def compared(case):
    fast, solved = solve_sweep(case), general.solve(case)
    table, other = fast.table, as_table(solved.columns)
    assert (table["phase"] == other["phase"]).all()
    assert (table["status"] == other["status"]).all()
    events, length = dict(fast.provenance["events"]), case.beam.length
    del events["out_of_plane"]
    for name, place in events.items():
        where = solved.events[name]
        assert (place is None) == (where is None), name
        if place is not None:
            assert place / length == pytest.approx(where, abs=1e-11), name
    places = [place for place in events.values() if place is not None]
    apart = np.abs(case.foot_x[:, None] - places).min(axis=1) > NEAR * length
    return table[apart], other[apart]


@pytest.mark.parametrize("name", CASE_NAMES)
def test_named_cases(name):
    case = replace(named_case(name), sweep=Sweep(100))
    table, other = compared(case)
    for column in NUMBERS:
        size = np.nanmax(np.abs(table[column]))
        np.testing.assert_allclose(table[column], other[column], rtol=0, atol=EXACT * size)


@pytest.mark.parametrize("kind", ["catenary", "circle", "ellipse", "two-circles", "polygon"])
@pytest.mark.parametrize("seed", [0, 1, pytest.param(range(2, 20), marks=pytest.mark.slow)])
def test_random_contours(kind, seed):
    for each in np.atleast_1d(seed):
        rng = np.random.default_rng(each)
        beam = Beam(length=0.3, flexural_rigidity=2.0, radius=0.3 * rng.uniform(0, 0.02))
        contour = random_contour(kind, rng).scaled(beam.length)
        table, other = compared(Case(beam, contour, Sweep(40)))
        for column in NUMBERS:
            size = np.nanmax(np.abs(table[column]), initial=1e-9)
            np.testing.assert_allclose(table[column], other[column], rtol=0, atol=1e-10 * size)
