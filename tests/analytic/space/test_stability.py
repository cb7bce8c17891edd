"""Stability in space against finite elements."""

from itertools import product

import numpy as np
import pytest

from analytic.space import cylinder, ellipsoid, polyhedron
from analytic.space.problem.bodies.body import Feature
from analytic.space.solver.contact import Plane, Scene, contact_at
from analytic.space.solver.stability import margin, second_variation
from tests.analytic.space.second_variation import least_eigenvalue

UP, RADIUS = np.array([0.0, 1.0, 0.0]), 0.02
STATES = 200
NEUTRAL = 1e-3  # of the scaled form: next to that 60 elements may see the other sign


def by_elements(body, state):
    force, plane = state.force, state.plane
    moment = np.sqrt(force) * state.loaded.moment * plane.across
    loads = state.foot, -force * plane.normal, moment, state.arc_length, plane.normal
    return least_eigenvalue(lambda x: body.nearest(x, 0.25).normal, UP, (*loads, state.tangent), 60)


def judged(body, place, random):
    """A state there: its phase, and whether it is stable; None of what cannot be, or next to it."""
    scene, tangent = Scene(body, UP, RADIUS), random.random() < 0.5
    alpha = Plane.of(UP, body.nearest(place, 0.25).normal).alpha
    if not 0.05 < alpha < np.pi / 2 - 0.06:
        return None
    free = random.uniform(0.2, 1) if tangent else random.uniform(0.05, np.pi / 2 - alpha)
    state = contact_at(scene, place, free, tangent)
    least = margin(second_variation(state, RADIUS))
    if abs(least) < NEUTRAL:
        return None
    touched = body if body.smooth else Feature.of(state.spot)
    assert (least > 0) == (by_elements(touched, state) > 0), (tangent, alpha)
    return tangent, least > 0


@pytest.mark.slow
def test_the_second_variation_agrees_with_finite_elements():
    random, seen = np.random.default_rng(5), []
    while len(seen) < STATES:
        centre = np.array([0.0, random.uniform(0.3, 1.5), 0.0])
        if random.random() < 0.8:
            body = ellipsoid(10 ** random.uniform(-1.3, 0.5, 3), centre)
        else:
            body = cylinder(10 ** random.uniform(-1.5, 0.3), centre, random.normal(size=3))
        down = random.normal(size=3)
        down[1] = -abs(down[1])
        found = judged(body, centre + 15 * down / np.linalg.norm(down), random)
        seen += [found] if found else []
    assert min(map(seen.count, product((False, True), repeat=2))) > STATES / 20


@pytest.mark.slow
def test_it_does_so_on_edges_and_corners_of_meshes():
    random, seen = np.random.default_rng(11), []
    while len(seen) < STATES / 2:
        points = random.normal(size=(random.integers(6, 30), 3)) * random.uniform(0.2, 2, 3)
        body = polyhedron(points + np.array([0, random.uniform(0.3, 1.5), 0]))
        one, other, third = random.permutation(body.corners[random.integers(len(body.faces))])
        on_edge = random.random() < 0.7
        point = one + random.uniform(0.2, 0.8) * (other - one) if on_edge else third
        normals = np.array([face.normal for face in body.features(point)[0]])
        normal = random.dirichlet(np.ones(len(normals))) @ normals
        place = point + 0.25 * normal / np.linalg.norm(normal)
        found = judged(body, place, random) if len(normals) > 1 else None
        seen += [(on_edge, *found)] if found else []
    assert {(True, *kind) for kind in product((False, True), repeat=2)} <= set(seen)
    assert {(False, tangent, False) for tangent in (False, True)} <= set(seen)
