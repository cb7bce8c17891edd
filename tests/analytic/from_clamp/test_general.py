"""The contact from the clamp with friction, an elastic clamp and a natural curvature."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

from analytic import (
    Beam,
    Case,
    InputError,
    Sweep,
    catenary,
    circle,
    curvatures,
    deflected_shapes,
    ellipse,
    parabola,
    polygon,
    reconstruct,
    relative_noise,
    solve_sweep,
)
from analytic.checks.of_two import touches_twice
from tests.analytic.noisy import noisy

OBJECTS = {
    "circle": lambda size, height: circle(size, lowest=(0.1, height)),
    "parabola": lambda size, height: parabola(1 / size, height),
    "catenary": lambda size, height: catenary(1 / size, height - 1),
    "ellipse": lambda size, height: ellipse((size, 0.7), lowest=(0, height)),
    "square": lambda size, height: polygon(
        [(-size, height + 0.05), (size, height), (size, 2.5), (-size, 2.5)]
    ),
}
REAL = Case(
    Beam(natural_curvature=-0.4),
    circle(1.0, lowest=(0, 0.4)),
    Sweep(80),
    clamp_stiffness=6.0,
    friction=0.25,
)


def with_readings(readings):
    there = np.isfinite(readings.values("contact_x")) & np.isfinite(readings.values("force_x"))
    return (
        there & (np.hypot(readings.values("force_x"), readings.values("force_y")) > 1e-9)
    ) & ~touches_twice(readings.table)


def missed(found, readings):
    x, y = (found[name] - readings.values(name) for name in ("contact_x", "contact_y"))
    return np.hypot(x, y)[with_readings(readings)]


def assert_exact(readings):
    """Point, arc length and angle are right, and the phase is that of the sweep."""
    there = with_readings(readings)
    found = reconstruct(readings)[there]
    table = readings.table[there]
    for name in ("contact_x", "contact_y", "contact_arc_length", "contact_angle"):
        assert np.abs(found[name] - table[name]).max() < 1e-12 * readings.beam.length
    # At the limit of the phases, and next to first contact, both conditions are met.
    assert (found["phase"] == table["phase"]).mean() > 0.95
    assert set(found["status"]) == {"ok"}


@pytest.mark.slow
@settings(max_examples=15, deadline=None, phases=[Phase.explicit, Phase.reuse, Phase.generate])
@given(
    natural=st.floats(-1.2, 1.2),
    compliance=st.floats(0, 1),
    friction=st.floats(0, 0.7),
    radius=st.sampled_from([0.0, 0.005, 0.02]),
    height=st.floats(0.25, 0.6),
    size=st.floats(0.5, 2),
    kind=st.sampled_from(sorted(OBJECTS)),
    direction=st.sampled_from(["left", "right"]),
)
def test_exact_readings(natural, compliance, friction, radius, height, size, kind, direction):
    stiffness = 1 / compliance if compliance > 1e-3 else math.inf
    beam = Beam(radius=radius, natural_curvature=natural)
    sweep = Sweep(24, direction=direction)
    try:
        case = Case(
            beam, OBJECTS[kind](size, height), sweep, clamp_stiffness=stiffness, friction=friction
        )
    except InputError:
        assume(False)
    readings = solve_sweep(case)
    assume(with_readings(readings).any())
    assert_exact(readings)


def test_in_other_units_and_to_the_right():
    beam = Beam(0.05, 2e-6, 0.25e-3, natural_curvature=8.0)
    case = Case(
        beam,
        REAL.profile.scaled(0.05),
        Sweep(60, direction="right"),
        clamp_stiffness=6 * beam.moment_unit,
        friction=0.25,
    )
    assert_exact(solve_sweep(case))


def test_the_moment_says_nothing_where_the_vibrissa_is_square_to_the_force():
    """A vibrissa curved towards the object passes that place: the contact is its tip all along."""
    case = Case(Beam(natural_curvature=1.2), circle(1.0, lowest=(0, 0.4)), Sweep(2000))
    readings = solve_sweep(case)
    tip = (readings.table["phase"] == "tip").to_numpy() & with_readings(readings)
    square = readings.values("tip_angle") - np.arctan2(
        -readings.values("force_x"), readings.values("force_y")
    )
    assert np.abs(square[tip] - np.pi / 2).min() < 1e-3
    assert missed(reconstruct(readings), readings).max() < 1e-12


def test_a_reader_who_knows_of_no_friction_finds_the_points_but_not_the_angles():
    """Exactly so for a thin vibrissa: the force is as dead as without friction."""
    readings = solve_sweep(replace(REAL, beam=Beam(radius=0.0), clamp_stiffness=math.inf))
    provenance = {k: v for k, v in readings.provenance.items() if k != "support"}
    found = reconstruct(replace(readings, provenance=provenance))
    assert missed(found, readings).max() < 1e-13
    turned = found["contact_angle"] - readings.values("contact_angle")
    np.testing.assert_allclose(turned[with_readings(readings)], math.atan(0.25), atol=1e-13)
    tangent = (readings.table["phase"] == "tangent").to_numpy()
    f = np.hypot(readings.values("force_x"), readings.values("force_y"))
    criterion = (readings.values("force_y") - readings.values("moment_z") ** 2 / 2)[tangent]
    np.testing.assert_allclose(criterion / f[tangent], -math.sin(math.atan(0.25)), atol=1e-13)


@pytest.mark.slow
def test_uncertainty_covers_the_error():
    exact = solve_sweep(REAL)
    noise = relative_noise(exact, 1e-2)
    rng = np.random.default_rng(0)
    covered = counted = 0
    for _ in range(20):
        found = reconstruct(noisy(exact, noise, rng), noise)
        sure = np.isfinite(found["uncertainty"]).to_numpy() & with_readings(exact)
        error = np.hypot(
            found["contact_x"] - exact.values("contact_x"),
            found["contact_y"] - exact.values("contact_y"),
        )
        covered += int((error <= found["uncertainty"])[sure].sum())
        counted += int(sure.sum())
    assert counted > 1000
    assert 0.93 < covered / counted < 0.97


@pytest.mark.parametrize("direction", ["left", "right"])
def test_drawn_shapes_are_curved_and_pass_through_the_contact(direction):
    case = replace(REAL, sweep=Sweep(40, direction=direction), beam=Beam(natural_curvature=-0.8))
    readings = solve_sweep(case)
    x, y = deflected_shapes(readings)
    steps = np.hypot(np.diff(x), np.diff(y)).sum(axis=1)
    np.testing.assert_allclose(steps, 1.0, atol=1e-3)  # chords
    free = (readings.table["phase"] == "free").to_numpy()
    angle = readings.values("tip_angle")
    shown = np.arctan2(y[:, 64] - y[:, 63], x[:, 64] - x[:, 63])
    assert np.abs(shown - angle)[free].max() < 0.02
    alpha = readings.values("contact_angle")
    centre = np.column_stack(
        [
            readings.values("contact_x") + 0.005 * np.sin(alpha),
            readings.values("contact_y") - 0.005 * np.cos(alpha),
        ]
    )
    # Point 64 is the contact.
    gap = np.hypot(x[:, 64] - centre[:, 0], y[:, 64] - centre[:, 1])
    assert gap[with_readings(readings)].max() < 1e-7
    kappa = curvatures(readings, x, y)
    np.testing.assert_array_equal(kappa[:, 65:], -0.8)
    np.testing.assert_allclose(kappa[free, :], -0.8)
