"""Contours: the families, polygons, curves through points, and what is felt of them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    Profile,
    Sweep,
    catenary,
    certify,
    circle,
    ellipse,
    parabola,
    polygon,
    solve_sweep,
    through_points,
    two_circles,
)
from analytic.problem.reach import out_of_reach
from tests.analytic.problem.given import refusal


def inscribed(case: Case, count: int) -> Case:
    """The case with a polygon of `count` vertices on its contour, swept over the same stations."""
    last, first = case.reach
    chain = case.profile.outline(last, first, count)
    top = [[chain[-1, 0] - 1e-3, 3.0], [chain[0, 0] + 1e-3, 3.0]]
    sweep = Sweep(200, float(case.foot_x[0]), float(case.foot_x[-1]))
    return Case(case.beam, polygon(np.vstack([chain, top])), sweep)


def worst_rms(one, other) -> float:
    both = ((one.table["phase"] != "free") & (other.table["phase"] != "free")).to_numpy()
    return max(
        np.sqrt(np.mean((one.values(name) - other.values(name))[both] ** 2))
        / np.abs(other.values(name)).max()
        for name in CLAMP_READINGS
    )


def test_polygon_tends_to_the_curve(case):
    """First order: the contact stays on a facet to its end, so alpha lags by half a facet."""
    smooth = solve_sweep(Case(case.beam, case.profile, inscribed(case, 8).sweep))
    counts = np.array([100, 200, 400, 800, 1600, 3200])
    errors = np.array([worst_rms(solve_sweep(inscribed(case, n)), smooth) for n in counts])
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert abs(order - 1) < 0.15, (errors, order)
    assert errors[-1] < 1e-3


def test_polygon_states_are_those_of_its_points():
    """On an edge the angle is the edge's; round a vertex the point stays."""
    square = polygon([[-0.6, 0.5], [0.0, 0.3], [0.6, 0.5], [0.9, 2.0], [-0.9, 2.0]])
    t = np.linspace(*square.t_range, 4001)
    point = square.at(t)
    assert (np.diff(point.alpha) >= 0).all()
    moved = np.hypot(np.diff(point.xi), np.diff(point.eta))
    turned = np.diff(point.alpha)
    assert ((moved < 1e-12) | (turned < 1e-12) | (moved + turned < 2 * (t[1] - t[0]))).all()
    r = 0.05
    offset = square.offset(r).at(t)
    np.testing.assert_allclose(offset.xi, point.xi + r * np.sin(point.alpha), atol=1e-15)
    np.testing.assert_allclose(offset.eta, point.eta - r * np.cos(point.alpha), atol=1e-15)


def test_order_of_vertices_does_not_matter():
    points = np.array([[-1, 1.2], [-0.5, 0.5], [0.2, 0.4], [1, 1.2]])
    one = polygon(points)
    for other in (points[::-1], np.roll(points, 2, axis=0), np.vstack([points, points[:1]])):
        np.testing.assert_array_equal(polygon(other).vertices, one.vertices)


def test_a_thin_vibrissa_on_a_sharp_corner():
    """Phase A and B at one point: between the edges' angles only the angle moves."""
    wedge = polygon([[-1.5, 1.3], [0.0, 0.4], [1.5, 1.3]])
    readings = solve_sweep(Case(Beam(radius=0.0), wedge, Sweep(stations=300)))
    at_corner = np.abs(readings.values("contact_x")) < 1e-12
    assert at_corner.sum() > 30
    assert np.ptp(readings.values("contact_angle")[at_corner]) > 0.5


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.lists(st.floats(-1.3, 1.3), min_size=3, max_size=9, unique=True), st.floats(0.1, 0.7))
def test_any_polygon(angles, height):
    """Edges of random slopes: the sweep ends in a snap-off, in balance all the way."""
    slopes = np.sort(angles)
    slopes = slopes[np.append(True, np.diff(slopes) > 1e-3)]
    edges = 0.4 * np.column_stack([np.cos(slopes), np.sin(slopes)])
    chain = np.vstack([[0, 0], np.cumsum(edges, 0)])
    chain[:, 1] += height - chain[:, 1].min()
    top = chain[:, 1].max() + 1
    profile = polygon(np.vstack([chain, [[chain[-1, 0], top], [chain[0, 0], top]]]))
    readings = solve_sweep(Case(profile=profile, sweep=Sweep(stations=80)))
    table = readings.table
    assert table["phase"].iloc[-1] == "free"
    touching = table[table["phase"] != "free"]
    assert (np.diff(touching["contact_angle"]) <= 1e-12).all()
    assert certify(readings)["residual_moment"].max() < 1e-11 * (1 + touching["force_y"].max())


def test_curve_through_points_is_third_order():
    exact, errors = catenary(0.5, -0.8), []
    for count in (11, 21, 41, 81):
        x = np.linspace(-2.6, 2.6, count)
        curve = through_points(np.column_stack([x, np.cosh(x / 2) - 0.8]))
        angle = np.linspace(-0.6, 0.6, 301)
        x, y = curve.xi(angle) - exact.xi(angle), curve.eta(angle) - exact.eta(angle)
        across = x * np.sin(angle) - y * np.cos(angle)
        errors.append(np.abs(across).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (orders > 2.8).all(), orders


def test_the_vibrissa_slides_off_an_open_end():
    """Beyond its range a contour is a corner: the contact stays there while the angle goes on."""
    short = circle(1.0, (0.0, 0.4))
    open_end = Profile(xi=short.xi, eta=short.eta, alpha_range=(0.3, np.pi / 2))
    case = Case(Beam(radius=0.0), open_end, Sweep(stations=400))
    table = solve_sweep(case).table
    at_end = table[table["contact_angle"] < 0.3]
    assert len(at_end) > 10
    np.testing.assert_allclose(at_end["contact_x"], short.xi(np.array(0.3)), rtol=1e-12)
    assert table["phase"].iloc[-1] == "free"


@pytest.mark.parametrize("mirrored", [False, True])
def test_families_are_what_their_equations_say(mirrored):
    """At 12 slope angles on either side; two circles change places in the mirror."""
    alpha = np.linspace(-1.2, 1.2, 24)
    for profile, height in (
        (catenary(0.5, -0.8), lambda x: np.cosh(x / 2) - 0.8),
        (parabola(0.7, 0.4), lambda x: 0.7 * x**2 + 0.4),
        (ellipse((2.0, 0.7), (0.0, 0.3)), lambda x: 1.0 - 0.7 * np.sqrt(1 - (x / 2) ** 2)),
    ):
        shown = profile.mirrored() if mirrored else profile
        x, y = shown.place(alpha)
        np.testing.assert_allclose(y, height(x), rtol=1e-14)
        step = 1e-5
        slope = (height(x + step) - height(x - step)) / (2 * step)
        np.testing.assert_allclose(slope, np.tan(alpha), rtol=1e-6)
    one, other = two_circles(1.3, 0.4, (0, 0.5)), two_circles(0.4, 1.3, (0, 0.5))
    np.testing.assert_allclose(one.mirrored().at(alpha), other.at(alpha), rtol=1e-14)
    radius = np.where(alpha > 0, 1.3, 0.4)
    np.testing.assert_allclose(np.hypot(one.xi(alpha), one.eta(alpha) - 0.5 - radius), radius)


@pytest.mark.parametrize(
    ("make", "points", "said"),
    [
        (polygon, [[0, 0], [1, 1]], "three or more"),
        (polygon, [[0, 0], [1, np.nan], [2, 3]], "vertex[1, 1]"),
        (polygon, [[0, 0], [1, 0], [1, 0], [0, 1]], "vertex 1"),
        (polygon, [[0, 0], [1, 0], [2, 0]], "folded back"),
        (polygon, [[0, 1], [1, 0], [2, 1], [1, 0.5]], "vertex 3, (1, 0.5)"),
        (polygon, [[0, 0], [1, 1], [1, 0], [0, 1]], "crosses itself"),
        (polygon, [[np.cos(a), np.sin(a)] for a in 0.8 * np.pi * np.arange(5)], "winding 2 times"),
        (through_points, [[0, 0], [1, np.inf], [2, 3]], "point[1, 1]"),
        (through_points, [[0, 1], [1, 0], [1, 0.5], [2, 2]], "point 2"),
        (through_points, [[0, 1], [1, 0], [2, 0.5], [3, 0.8]], "point 2 from the left, (2, 0.5)"),
        (through_points, [[0, 0], [1, 0], [2, 0]], "turn of 0 deg"),
    ],
)
def test_bad_points(make, points, said):
    assert said in refusal(make, points)


@pytest.mark.parametrize("radius", [0.0, 0.01])
@pytest.mark.parametrize(
    ("body", "centre", "size"),
    [
        (circle(0.3, (0.2, 0.6)), (0.2, 0.9), 0.3),
        (polygon([(0.3, 2.0), (0.5, 0.7), (0.8, 0.75), (0.9, 2.0)]), (0.5, 0.7), 0.0),
    ],
)
def test_a_body_is_out_of_reach_where_it_is_a_length_away(body, centre, size, radius):
    case = Case(Beam(radius=radius), body)
    expected = centre[0] - np.sqrt((1 + size + radius) ** 2 - centre[1] ** 2)
    assert out_of_reach(case.centreline, *case.reach) == pytest.approx(expected, abs=1e-12)
