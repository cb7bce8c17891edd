"""What is a convex contour, what no vibrissa can feel, and what varies along a vibrissa."""

import json
import pickle
from dataclasses import asdict

import numpy as np
import pytest
from hypothesis import assume, given, seed, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from analytic import (
    Beam,
    Case,
    InputError,
    Profile,
    Sweep,
    catenary,
    certify,
    circle,
    ellipse,
    find_events,
    parabola,
    polygon,
    solve_sweep,
    two_circles,
)
from tests.analytic.problem.given import refusal


def waved(radius: float, depth: float, waves: float, phase: float) -> Profile:
    """A support function with waves: the radius of curvature is least `radius` (1 - `depth`)."""
    size = radius * depth / (waves**2 - 1)

    def height(a):  # of the tangent, below the origin
        return radius + size * np.cos(waves * a + phase)

    def slope(a):
        return -size * waves * np.sin(waves * a + phase)

    return Profile(
        xi=lambda a: height(a) * np.sin(a) + slope(a) * np.cos(a),
        eta=lambda a: 1.5 - height(a) * np.cos(a) + slope(a) * np.sin(a),
        alpha_range=(-1.2, 1.2),
    )


IN_STEP = (64, 128, 256, 512, 128 * np.pi / 1.2, 256 * np.pi / 1.2)  # with even samples


@seed(11)
@settings(max_examples=60, deadline=None)
@given(
    st.floats(0.1, 3),
    st.floats(0, 0.9) | st.floats(1.05, 3),
    st.floats(2, 3000) | st.sampled_from(IN_STEP),
    st.floats(0, 2 * np.pi),
)
def test_planted_waves_are_found(radius, depth, waves, phase):
    """Bumps of any wavelength; those that leave it convex pass."""
    dip = depth * np.cos(waves * np.linspace(-1.2, 1.2, 20_001) + phase).max()
    assume(abs(dip - 1) > 0.04)  # of few waves the lowest place may lie beyond the ends
    if dip < 1:
        assert waved(radius, depth, waves, phase).alpha_range == (-1.2, 1.2)
    else:
        assert "strictly convex" in refusal(waved, radius, depth, waves, phase)


@seed(13)
@settings(max_examples=30, deadline=None)
@given(
    st.sampled_from(["catenary", "parabola", "circle", "ellipse", "two-circles"]),
    st.floats(1e-9, 1e9),
    st.floats(1e-9, 1e9),
    st.floats(-10, 10),
    st.floats(-10, 10),
)
def test_any_numbers_make_a_case_or_one_line(kind, one, other, x, y):
    make = {
        "catenary": lambda: catenary(one, y),
        "parabola": lambda: parabola(one, y),
        "circle": lambda: circle(one, (x, y)),
        "ellipse": lambda: ellipse((one, other), (x, y)),
        "two-circles": lambda: two_circles(one, other, (x, y)),
    }[kind]
    try:
        case = Case(profile=make(), sweep=Sweep(stations=20))
    except InputError as error:
        assert "\n" not in str(error)
    else:
        assert np.isfinite(case.foot_x).all()
        assert (np.diff(case.foot_x) < 0).all()


ARC = {"xi": np.sin, "eta": lambda a: 1 - np.cos(a), "alpha_range": (-1, 1)}


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: ellipse((1000, 1), (0, 0.5)), "at most 1000 L"),
        (lambda: circle(1.0, (1e6, 0.5)), "within 10000 L"),
        (lambda: polygon([[1e9 - 1, 0.5], [1e9 + 1, 0.5], [1e9, 2]]), "within 10000 L"),
        (lambda: circle(1e-12, (0, 0.5)), "larger than 1e-10"),
        (lambda: ellipse((1e6, 1e-6), (0, 0.5)), "which stays"),
        (lambda: catenary(1e-200, -0.5), "profile.a = 1e-200"),
        (lambda: circle(True, (0, 0.5)), "profile.radius = True"),
        (lambda: circle(10**400, (0, 0.5)), "profile.radius"),
        (lambda: ellipse((1, 2, 3), (0, 0.5)), "two numbers"),
    ],
)
def test_what_cannot_be_felt_is_refused_when_it_is_made(make, said):
    assert said in refusal(lambda: Case(profile=make()))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"xi": 3}, "profile.xi = 3"),
        ({"eta": lambda a: a[0]}, "to ()"),
        ({"eta": lambda a: float(a)}, "NumPy functions"),
        ({"xi": lambda a: a * 1e200}, "not finite at alpha"),
        ({"alpha_range": 1.0}, "two numbers"),
        ({"alpha_range": (0, np.nan)}, "alpha_range[1] = nan"),
        ({"alpha_range": (-1, 2)}, "within [-pi/2, pi/2]"),
        ({"radius_of_curvature": 1.0}, "radius_of_curvature = 1.0"),
        ({"radius_of_curvature": lambda a: 0 * a - 1}, "positive"),
        ({"radius_of_curvature": lambda a: 0 * a + 2}, "which is 1 there"),
    ],
)
def test_an_arc_with_something_wrong_is_refused(change, said):
    assert said in refusal(lambda: Case(profile=Profile(**ARC | change)))


@pytest.mark.parametrize("make", [lambda: circle(1e5, (0, 0.3)), lambda: catenary(0.004, -0.7)])
def test_nearly_flat_objects_work(make):
    """At the lowest point the readings depend on the height alone, eta = 0.3 - 0.005."""
    lowest = find_events(make()).out_of_plane
    assert lowest.moment_z * 0.295 == pytest.approx(1.19814023473559, rel=1e-9)
    sweep = solve_sweep(Case(profile=make(), sweep=Sweep(stations=60)))
    assert (sweep.table["phase"] != "free").sum() > 50
    assert certify(sweep).max(axis=None) < 1e-11


def test_parallel_curves_keep_what_a_contour_can_do():
    """Enlarged, mirrored, raised or thickened again, and the same points with or without slopes."""
    arc = Profile(xi=np.sin, eta=lambda a: 1.4 - np.cos(a), alpha_range=(-0.3, 0.9))
    t, below = np.linspace(-1.5, 1.5, 31), arc.offset(0.05)
    for found, known in (
        (below.scaled(2.0), arc.scaled(2.0).offset(0.1)),
        (below.mirrored(), arc.mirrored().offset(0.05)),
        (below.raised(0.2), arc.raised(0.2).offset(0.05)),
        (below, arc.offset(0.02).offset(0.03)),
    ):
        point, expected = found.at(t), known.at(t)
        np.testing.assert_allclose(point, expected, rtol=1e-15, atol=1e-15)
        np.testing.assert_array_equal(found.place(t), point[1:3])
        np.testing.assert_array_equal(found.breaks(), known.breaks())
    corner = below.at(np.array([1.2]))  # round the end of the arc at the distance of the curve
    assert corner.stretch == 0.05
    assert np.hypot(corner.xi - np.sin(0.9), corner.eta - 1.4 + np.cos(0.9)) == pytest.approx(0.05)


@given(
    alpha=st.floats(-1.3, 1.3),
    length=st.floats(1e-3, 10.0),
    radius=st.floats(0.05, 1.0),
)
def test_a_straight_edge_is_refused(alpha, length, radius):
    """Round on both sides of it: two points with one slope angle, between which no place is."""

    said = refusal(
        Profile,
        xi=lambda t: radius * np.sin(t) + length * (t > alpha) * np.cos(alpha),
        eta=lambda t: 1 - radius * np.cos(t) + length * (t > alpha) * np.sin(alpha),
        alpha_range=(-1.4, 1.4),
    )
    assert "straight between" in said


@pytest.mark.parametrize("power", [3, 4, 5])
def test_what_is_flat_in_one_point_is_no_straight_edge(power):
    def x(t):
        slope = np.tan(t)
        return np.sign(slope) * (np.abs(slope) / power) ** (1 / (power - 1))

    flat = Profile(xi=x, eta=lambda t: 0.5 + np.abs(x(t)) ** power, alpha_range=(-1.2, 1.2))
    assert flat.place(np.zeros(1))[1] == 0.5


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


def test_table_goes_through_its_points_and_not_beyond():
    table = [(0, 1.0), (0.3, 0.9), (0.5, 0.2), (1, 0.1)]
    beam = Beam(flexural_rigidity=table)
    s, values = np.array(table).T
    np.testing.assert_allclose(beam.rigidity_at(s), values, rtol=1e-14)
    assert (np.diff(beam.rigidity_at(S)) < 0).all()


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
