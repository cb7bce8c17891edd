"""Loss of stability sideways: the closed form against a discrete rod in space, with torsion."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from analytic import (
    Beam,
    Case,
    Readings,
    Sweep,
    circle,
    find_events,
    named_case,
    polygon,
    sideways_stiffness,
    solve_contact,
    solve_sweep,
)

CIRCLE = circle(1.0, lowest=(0.0, 0.4))
_TURN = 1e-3  # rad, of the differences: the energy is good to 1e-15, so its second ones to 1e-8
SEGMENTS = 12


class Rod:
    """Kirchhoff's rod in space as rigid links with springs between them, under a dead force.

    Links begin half a cell from the clamp, as in the second-order chain; the end of the last one
    carries the force. It knows nothing of elliptic integrals, of elevations or of planes.
    """

    def __init__(self, state, torsion):
        """`state` is a row of the readings table, in the units of Beam(radius=0)."""
        self.h = state.contact_arc_length / SEGMENTS
        self.torsion = torsion
        self.force = -np.array([state.force_x, state.force_y, 0.0])
        self.lengths = np.full(SEGMENTS, self.h)
        self.lengths[-1] /= 2
        start = np.pi / 2 + (state.tip_angle - np.pi / 2) * np.linspace(0, 1, SEGMENTS)
        found = root(self._planar_balance, start, tol=1e-13)
        assert np.abs(found.fun).max() < 1e-11
        self.heading = found.x

    def _planar_balance(self, heading):
        bend = np.diff(heading, prepend=np.pi / 2) / self.h
        across = self.force[1] * np.cos(heading) - self.force[0] * np.sin(heading)
        return bend - np.append(bend[1:], 0.0) - self.lengths * across

    def energy(self, turns):
        """Of links turned by `turns`, shape (n, links, 3), about their own axes."""
        planar = Rotation.from_rotvec(np.outer(self.heading - np.pi / 2, [0, 0, 1])).as_matrix()
        shape = turns.shape[:2]
        links = planar @ Rotation.from_rotvec(turns.reshape(-1, 3)).as_matrix().reshape(
            *shape, 3, 3
        )
        before = np.concatenate([np.broadcast_to(np.eye(3), (shape[0], 1, 3, 3)), links[:, :-1]], 1)
        between = np.einsum("nlji,nljk->nlik", before, links).reshape(-1, 3, 3)
        bend = Rotation.from_matrix(between).as_rotvec().reshape(*shape, 3)
        springs = (bend**2 @ np.array([1, self.torsion, 1])).sum(axis=1) / (2 * self.h)
        end = np.einsum("l,nli->ni", self.lengths, links[..., 1])
        return springs - end @ self.force

    def stiffness(self):
        """Second derivative of the energy by the turns out of the plane, about x and y."""
        axes = [(link, axis) for link in range(SEGMENTS) for axis in (0, 1)]
        count = len(axes)
        unit = np.zeros((count, SEGMENTS, 3))
        for i, (link, axis) in enumerate(axes):
            unit[i, link, axis] = _TURN
        pairs = unit[:, None] + unit[None]
        odd = unit[:, None] - unit[None]
        plus = self.energy(pairs.reshape(-1, SEGMENTS, 3))
        minus = self.energy(odd.reshape(-1, SEGMENTS, 3))
        return (plus - minus).reshape(count, count) / (2 * _TURN**2)

    def lateral_stiffness(self):
        # A turn of a link about its x axis, which lies in the plane, lifts its end out of it.
        push = np.array([[length, 0.0] for length in self.lengths]).ravel()
        return 1 / (push @ np.linalg.solve(self.stiffness(), push))

    def reach(self):
        return self.lengths @ np.cos(self.heading)


def rod(alpha, torsion=1.0):
    return Rod(solve_contact(CIRCLE, [alpha], Beam(radius=0)).iloc[0], torsion)


@pytest.mark.parametrize("torsion", [0.1, 1 / 1.3, 10.0])
@pytest.mark.parametrize("alpha", [0.8, 0.3, 0.01, -0.01, -0.3, -0.6])
def test_a_rod_in_space_is_stable_where_the_contact_angle_is_positive(alpha, torsion):
    least = np.linalg.eigvalsh(rod(alpha, torsion).stiffness())
    assert (least[0] > 0) == (alpha > 0)
    assert least[1] > 0  # only ever one way out


@pytest.mark.parametrize("torsion", [0.1, 1 / 1.3, 10.0])
def test_at_the_lowest_point_the_turn_about_the_clamp_is_neutral(torsion):
    least = np.linalg.eigvalsh(rod(0.0, torsion).stiffness())
    assert abs(least[0]) < 1e-5 * least[1]  # what differences leave


@pytest.mark.parametrize("torsion", [0.1, 1 / 1.3, 10.0])
@pytest.mark.parametrize("alpha", [0.8, 0.3, -0.3, -0.6])
def test_sideways_the_rod_is_a_pendulum_whatever_its_torsional_stiffness(alpha, torsion):
    """Exactly so, for any number of links: Z/z = -force_x over the rod's own reach."""
    found = rod(alpha, torsion)
    pendulum = found.force[0] / found.reach()
    assert found.lateral_stiffness() == pytest.approx(pendulum, rel=1e-5)


def test_stiffness_follows_from_the_clamp_alone():
    case = Case(profile=CIRCLE)
    exact = solve_sweep(case)
    sensed = Readings(exact.table[["foot_x", "force_x", "force_y", "moment_z"]], case.beam)
    stiffness = sideways_stiffness(sensed)
    touching = (exact.table["phase"] != "free").to_numpy()
    assert np.isnan(stiffness[~touching]).all()
    table = exact.table[touching]
    sign = np.sign(table["contact_angle"])
    np.testing.assert_array_equal(np.sign(stiffness[touching]), sign)
    reach = table["contact_x"] + case.beam.radius * np.sin(table["contact_angle"]) - table["foot_x"]
    np.testing.assert_allclose(stiffness[touching], -table["force_x"] / reach, rtol=1e-9)
    right = solve_sweep(case.mirrored())
    np.testing.assert_allclose(sideways_stiffness(right), stiffness, rtol=1e-9)


def test_place_is_the_lowest_point_in_closed_form(case):
    """In Phase B the reach at alpha = 0 is 1.66925368334815 times the height."""
    found = find_events(case.profile, case.beam).out_of_plane
    assert found.contact_angle == pytest.approx(0, abs=1e-12)
    assert found.force_x == pytest.approx(0, abs=1e-12)
    assert solve_sweep(case).provenance["events"]["out_of_plane"] == found.foot_x
    height = found.contact_y - case.beam.radius
    if found.phase == "tangent":
        assert found.contact_x - found.foot_x == pytest.approx(1.66925368334815 * height, rel=1e-12)
    else:
        assert 2.18843961522648 * height > 1


def test_no_such_place_where_the_planar_vibrissa_lets_go_before():
    """The object's lowest corner is its left end: the vibrissa slides off there, with alpha > 0."""
    events = find_events(polygon([(0.0, 0.5), (1.0, 1.4), (0.5, 2.0)]), Beam())
    assert events.out_of_plane is None
    assert events.snap_off.contact_angle > 0


def test_on_a_flat_side_it_is_the_far_end():
    """As long as the side is level the vibrissa is neutral, neither held nor pushed away."""
    flat = polygon([(-0.6, 1.2), (-0.2, 0.45), (0.3, 0.45), (0.8, 1.3)])
    place = find_events(flat, Beam()).out_of_plane
    assert (place.contact_x, place.contact_y) == pytest.approx((-0.2, 0.45), abs=1e-12)
    table = solve_sweep(Case(profile=flat, sweep=Sweep(stations=1000))).table
    table = table[table["phase"] != "free"]
    held = table["foot_x"] > place.foot_x
    assert (table["contact_angle"][held] > -1e-12).all()
    assert (table["contact_angle"][~held] < 0).all()


def test_places_scale_with_the_beam():
    case = named_case("parabola")
    place = find_events(case.profile, case.beam).out_of_plane.foot_x
    beam = Beam(50.0, 7.0, 0.25)
    other = replace(case, beam=beam, profile=case.profile.scaled(50.0))
    scaled = find_events(other.profile, beam).out_of_plane
    assert scaled.foot_x == pytest.approx(50 * place, rel=1e-12)
    sweep = solve_sweep(other)
    at = np.nanargmax(sideways_stiffness(sweep))
    unit = beam.force_unit / beam.length
    expected = sideways_stiffness(solve_sweep(case))[at] * unit
    assert sideways_stiffness(sweep)[at] == pytest.approx(expected, rel=1e-9)
