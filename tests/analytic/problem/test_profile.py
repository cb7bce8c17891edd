"""Profiles: what is a convex contour, what is none, and what no vibrissa can feel."""

import numpy as np
import pytest
from hypothesis import assume, given, seed, settings
from hypothesis import strategies as st

from analytic import (
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
