"""What varies along a vibrissa: functions and tables of arc length as values."""

import json
import pickle
from dataclasses import asdict

import numpy as np
import pytest
from scipy.integrate import quad

from analytic import Beam, Case, circle
from tests.analytic.problem.given import refusal

S = np.linspace(0, 1, 1001)
OBJECT = circle(1.0, lowest=(0, 0.4))


def stiff(rigidity) -> Beam:
    return Beam(flexural_rigidity=rigidity)


def knee(s):
    return 1 + np.abs(s - 0.3)


def step(s):
    return np.where(s < 0.4, 1.0, 0.5)


def segments(s):
    return np.interp(s, [0, 0.2, 0.5, 0.7, 1], [1, 0.9, 0.3, 0.3, 0.1])


def bump(s):
    return 1 + np.exp(-(((s - 0.6) / 0.05) ** 2))


@pytest.mark.parametrize("function", [np.cosh, knee, step, segments, bump])
def test_function_is_kept_to_rounding(function):
    beam = Beam(flexural_rigidity=function)
    s = S[np.abs(S - 0.4) > 1e-9]  # where the step is, either value is right
    np.testing.assert_allclose(beam.rigidity_at(s), function(s), rtol=1e-13)
    assert beam.varies and beam.base_rigidity == pytest.approx(function(0.0), rel=1e-14)


@pytest.mark.parametrize(
    ("function", "pieces"),
    [(knee, 2), (segments, 4), (lambda s: 2e-309 * (s**2 - 0.3) + 0.0, 8)],
)
def test_a_kink_costs_one_piece(function, pieces):
    """Subnormal numbers have few digits, and are not rough for that."""
    assert len(Beam(natural_curvature=function).natural_curvature.series) <= pieces


def test_beam_is_a_value():
    one, other = (Beam(flexural_rigidity=knee, natural_curvature=np.sin) for _ in range(2))
    assert one == other and hash(one) == hash(other) and one != Beam(natural_curvature=np.sin)
    assert pickle.loads(pickle.dumps(one)) == one
    assert Beam(**json.loads(json.dumps(asdict(one)))) == one
    assert Case(one, OBJECT).digest == Case(other, OBJECT).digest != Case(profile=OBJECT).digest


@pytest.mark.parametrize("same", [lambda s: 2.0, lambda s: 2.0 + 0 * s, [(0, 2.0), (1, 2.0)]])
def test_what_does_not_vary_is_a_number(same):
    assert Beam(flexural_rigidity=same) == Beam(flexural_rigidity=2.0)
    assert not Beam(flexural_rigidity=same).varies and not Beam(tip_radius=0.005).varies


def test_cone():
    beam = Beam(2.0, 3.0, 0.01, tip_radius=0.004)
    s = np.array([0.0, 1.0, 2.0])
    np.testing.assert_allclose(beam.radius_at(s), [0.01, 0.007, 0.004], rtol=1e-15)
    np.testing.assert_allclose(beam.rigidity_at(s), 3 * np.array([1, 0.7, 0.4]) ** 4, rtol=1e-14)
    tube = Beam(2.0, lambda s: 3 - s, 0.01, tip_radius=0.004)
    np.testing.assert_allclose(tube.rigidity_at(s), [3, 2, 1], rtol=1e-15)


def test_other_units_and_the_mirror():
    beam = Beam(2.0, knee, natural_curvature=np.sin)
    longer = beam.scaled(length=3, rigidity=5)
    np.testing.assert_allclose(longer.rigidity_at(3 * S), 5 * beam.rigidity_at(S), rtol=1e-14)
    np.testing.assert_allclose(longer.curvature_at(3 * S), np.sin(S), atol=1e-15)
    np.testing.assert_array_equal(beam.mirrored().curvature_at(S), -beam.curvature_at(S))


def test_shape_at_rest_is_the_integral():
    """A curvature that grows with arc length bends the vibrissa to a clothoid."""
    x, y, phi = Beam(natural_curvature=lambda s: 2 * s).unloaded.at(np.array(1.0))
    assert x == pytest.approx(-quad(lambda s: np.sin(s * s), 0, 1)[0], abs=1e-15)
    assert y == pytest.approx(quad(lambda s: np.cos(s * s), 0, 1)[0], abs=1e-15)
    assert phi == pytest.approx(np.pi / 2 + 1, abs=1e-15)
    two_arcs = Beam(natural_curvature=lambda s: np.where(s < 0.4, -0.3, 0.2))
    height = two_arcs.unloaded.at(np.array(1.0))[1]
    assert height == pytest.approx(np.sin(0.12) * (1 / 0.3 + 1 / 0.2), abs=1e-13)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: stiff(lambda s: 1 - 1.2 * s), "0.833333: must be positive all"),
        (lambda: stiff(lambda s: (s - 0.5) ** 2 - 1e-9), "at s = 0.499968: must be positive"),
        (lambda: stiff(lambda s: 1 - s), "at s = 1: must be positive"),
        (lambda: stiff(lambda s: 1 - s**8), "at s = 1: must be positive"),
        (lambda: stiff(lambda s: 1 - (np.abs(s - 0.4) < 1e-3)), "a narrow dent at s = 0.399"),
        (lambda: stiff([(0, 1), (0.5, -1), (1, 2)]), "must be positive all along"),
        (lambda: stiff([(0, 1), (0.5, 1)]), "from the clamp, s = 0, to the tip"),
        (lambda: stiff([(0, 1), (0.5, float("nan")), (1, 1)]), "[1, 1] = nan"),
        (lambda: stiff([1, 2]), "2 to 200 pairs"),
        (lambda: stiff(lambda s: 1 / s), "inf at s = 0: must be finite"),
        (lambda: stiff(lambda s: np.ones(3)), "an array of arc lengths"),
        (lambda: Beam(natural_curvature=lambda s: np.sin(1 / (s + 1e-9))), "few kinks and jumps"),
        (lambda: Beam(natural_curvature={"a": 1}), "ascending ends of pieces"),
        (lambda: Beam(natural_curvature=lambda s: 4 - s), "back at the foot line"),
        (lambda: Case(Beam(natural_curvature=lambda s: 3.5 * s), OBJECT), "overhangs"),
        (lambda: Beam(tip_radius=-0.001), "beam.tip_radius = -0.001"),
        (lambda: Beam(tip_radius=0), "may not vanish"),
        (lambda: Beam(tip_radius=0.006), "and 0.005;"),
        (lambda: Beam(tip_radius=5e-6), "0.0015 of the radius at the clamp"),
        (lambda: Beam(radius=0, tip_radius=0), "beam.tip_radius = 0"),
    ],
)
def test_bad_input_is_one_line(make, says):
    assert says in refusal(make)


@pytest.mark.parametrize("place", [0.3, 0.4, 0.777])
def test_a_jump_is_where_the_function_has_it(place):
    """To 1e-9 L; next to the end of a longer piece the nodes of that do not see it."""
    found = stiff(lambda s: 1 - 0.5 * (s > place))
    near = place + np.array([-1e-3, -1e-5, -1e-7, -1e-9, 1e-9, 1e-7, 1e-5, 1e-3])
    np.testing.assert_array_equal(found.rigidity_at(near), [1.0] * 4 + [0.5] * 4)
