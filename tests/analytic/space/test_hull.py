"""Any convex body from its contacts: the true one lies between the two, whatever it is."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analytic import Beam, InputError
from analytic.space import (
    FootPath,
    SpatialCase,
    convex_band,
    ellipsoid,
    polyhedron,
    solve_space,
    sphere,
)
from analytic.space.from_clamp.hull import volume
from analytic.space.problem.bodies.support import spread
from analytic.space.problem.readings import SENSED_IN_SPACE
from tests.analytic.noisy import noisy
from tests.analytic.space.test_fit_body import sizes

MIDDLE = np.array([0.0, 1.3, 0.0])
_, TURN = np.linalg.eigh([[1.0, 0.4, 0.2], [0.4, 2.0, -0.5], [0.2, -0.5, 3.0]])
CUBE = np.array(np.meshgrid(*[[-0.6, 0.6]] * 3)).reshape(3, -1).T
BODIES = {
    "sphere": sphere(1.0, MIDDLE + np.array([0.05, 0.1, 0.0])),
    "egg": ellipsoid((1.0, 0.7, 1.6), (0.0, 1.1, 0.02)),
    "box": polyhedron(CUBE @ TURN.T + MIDDLE),  # a corner is lowest
}
WAYS = [[[1.3, z], [-1.5, 0.8 * z]] for z in (-0.5, -0.2, 0.3)]
ROUNDED = 1e-9  # L; the contacts are exact to 1e-12, and Qhull's corners to some 1e-11


def swept(body, ways=WAYS):
    ways = [*ways, [[-1.3, 0.0], [1.3, 0.1]]]  # and back, as the way to the left sees one side
    paths = [FootPath(way, stations=30, tangent=(0.1, 1, 0.05)) for way in ways]
    return [solve_space(SpatialCase(body=body, path=path)) for path in paths]


@pytest.fixture(scope="module")
def sweeps():
    return {name: swept(body) for name, body in BODIES.items()}


@cache
def points_of(body):
    return np.array([body.nearest(MIDDLE + 4 * way, 1.0).point for way in spread(1000)])


def beyond(band, body):
    """How far the inner body reaches out of the true one, and that out of the outer one."""
    far = max(body.nearest(corner, 1.0).distance for corner in band.inner.vertices)
    surface = points_of(body)
    near = surface[((surface > band.box[0]) & (surface < band.box[1])).all(axis=1)]
    assert len(near) > 100
    return far, float((near @ band.outer.normals.T - band.outer.heights).max())


@pytest.mark.slow
@pytest.mark.parametrize("name", BODIES)
def test_the_true_body_is_between_the_two(sweeps, name):
    band = convex_band(sweeps[name])
    assert band.explains
    assert max(beyond(band, BODIES[name])) < ROUNDED
    assert band.half_width < ROUNDED
    assert 0 < volume(band.inner) < volume(band.outer)
    # No sweep sees the far side, and corners and edges end nothing between them.
    assert band.seen == 0.0 if name == "box" else 0.2 < band.seen < 0.8


@pytest.mark.slow
def test_more_sweeps_narrow_it(sweeps):
    """By the square of the distance between them, as a chord is below its arc."""
    between = [[[1.3, z], [-1.5, 0.8 * z]] for z in (-0.35, 0.05)]
    few, many = convex_band(sweeps["sphere"]), convex_band(swept(BODIES["sphere"], WAYS + between))
    assert volume(many.inner) > volume(few.inner)
    assert np.nanmedian(many.gaps) < 0.6 * np.nanmedian(few.gaps)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["sphere", "egg"])
def test_noise_widens_it_by_what_it_does(sweeps, name):
    """Of 40 draws of 0.1 %, 95 % of them; fewer than 33 hold once in 1e4."""
    draw, noise = np.random.default_rng(5), sizes(sweeps[name], 1e-3)
    held = 0
    for _ in range(40):
        band = convex_band([noisy(one, noise, draw) for one in sweeps[name]], noise)
        held += max(beyond(band, BODIES[name])) < 0 and band.explains
    assert held >= 33
    assert 1e-3 < band.half_width < 0.1


@pytest.mark.slow
def test_in_units():
    long, wire = 0.05, Beam(0.05, 2e-6, 1e-9)
    way = [FootPath(long * np.array(w), stations=30, tangent=(0.1, 1, 0.05)) for w in WAYS]
    egg = BODIES["egg"].scaled(long)
    band = convex_band([solve_space(SpatialCase(wire, body=egg, path=path)) for path in way])
    inner, outer = (body.scaled(1 / long) for body in (band.inner, band.outer))
    over_length = replace(band, inner=inner, outer=outer, box=band.box / long)
    assert max(beyond(over_length, BODIES["egg"])) < ROUNDED
    assert "volume at least" in repr(band)
    assert "<img" in band._repr_html_()


@pytest.mark.slow
def test_two_bodies_are_no_convex_one(sweeps):
    """A dent between them: each hides contacts of the other behind its planes."""
    apart = swept(sphere(0.5, MIDDLE - (0.0, 0.45, 0.0)))
    band = convex_band([*sweeps["sphere"], *apart])
    assert not band.explains


@pytest.mark.slow
def test_what_says_too_little_is_a_line(sweeps):
    idle = replace(sweeps["egg"][0], table=sweeps["egg"][0].table.iloc[:3])
    with pytest.raises(InputError, match="contacts = 0: must be 8 or more"):
        convex_band(idle)
    straight = FootPath([[1.3, 0.0], [-1.3, 0.0]], stations=60)
    flat = solve_space(SpatialCase(body=sphere(1.0, (0.0, 1.4, 0.0)), path=straight))
    with pytest.raises(
        InputError, match=r"contacts = in one line or plane.*several sweeps along different lines"
    ):
        convex_band(flat)
    noise = sizes(sweeps["sphere"], 0.03)
    with pytest.raises(InputError, match="within noise"):
        convex_band(sweeps["sphere"], noise)
    other = sweeps["egg"][0]
    with pytest.raises(InputError, match="of different vibrissae"):
        convex_band([other, replace(other, beam=Beam(2.0))])


@pytest.mark.slow
def test_a_gap_is_left_out(sweeps):
    one, *others = sweeps["egg"]
    gapped = replace(one, table=one.table.assign(**{SENSED_IN_SPACE[3]: np.nan}))
    band = convex_band([gapped, *others])
    assert band.stations < convex_band(sweeps["egg"]).stations
    assert max(beyond(band, BODIES["egg"])) < ROUNDED
