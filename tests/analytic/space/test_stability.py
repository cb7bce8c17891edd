"""Stability in space against finite elements."""

import numpy as np
import pytest

from analytic.space import cylinder, ellipsoid, polyhedron
from analytic.space.solver.contact import Scene, contact_at
from analytic.space.solver.rod import Plane
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


@pytest.mark.slow
def test_the_second_variation_agrees_with_finite_elements():
    random = np.random.default_rng(5)
    seen = {(tangent, stable): 0 for tangent in (False, True) for stable in (False, True)}
    while sum(seen.values()) < STATES:
        centre = np.array([0.0, random.uniform(0.3, 1.5), 0.0])
        if random.random() < 0.8:
            body = ellipsoid(10 ** random.uniform(-1.3, 0.5, 3), centre)
        else:
            body = cylinder(10 ** random.uniform(-1.5, 0.3), centre, random.normal(size=3))
        down = random.normal(size=3)
        down[1] = -abs(down[1])
        tangent = random.random() < 0.5
        scene, place = Scene(body, UP, RADIUS), centre + 15 * down / np.linalg.norm(down)
        alpha = Plane.of(UP, body.nearest(place, 0.25).normal).alpha
        if not 0.05 < alpha < np.pi / 2 - 0.06:
            continue
        free = random.uniform(0.2, 1) if tangent else random.uniform(0.05, np.pi / 2 - alpha)
        state = contact_at(scene, place, free, tangent)
        form = second_variation(state, RADIUS)
        if abs(margin(form)) < NEUTRAL:
            continue
        least = by_elements(body, state)
        assert (margin(form) > 0) == (least > 0), (tangent, alpha, margin(form), least)
        seen[tangent, least > 0] += 1
    assert min(seen.values()) > STATES / 20


@pytest.mark.slow
def test_it_does_so_on_edges_and_corners_of_meshes():
    random, seen = np.random.default_rng(11), {}
    while sum(seen.values()) < STATES / 2:
        points = random.normal(size=(random.integers(6, 30), 3)) * random.uniform(0.2, 2, 3)
        body = polyhedron(points + np.array([0, random.uniform(0.3, 1.5), 0]))
        one, other, third = random.permutation(body.corners[random.integers(len(body.faces))])
        on_edge = random.random() < 0.7
        point = one + random.uniform(0.2, 0.8) * (other - one) if on_edge else third
        normals = np.array([face.normal for face in body.features(point)[0]])
        normal = random.dirichlet(np.ones(len(normals))) @ normals
        place = point + 0.25 * normal / np.linalg.norm(normal)
        alpha = Plane.of(UP, body.nearest(place, 0.25).normal).alpha
        if len(normals) < 2 or not 0.05 < alpha < np.pi / 2 - 0.06:
            continue
        tangent = random.random() < 0.5
        free = random.uniform(0.2, 1) if tangent else random.uniform(0.05, np.pi / 2 - alpha)
        state = contact_at(Scene(body, UP, RADIUS), place, free, tangent)
        form = second_variation(state, RADIUS)
        if abs(margin(form)) < NEUTRAL:
            continue
        stable = margin(form) > 0
        assert stable == (by_elements(body.feature(state.spot), state) > 0), (tangent, on_edge)
        seen[on_edge, tangent, stable] = seen.get((on_edge, tangent, stable), 0) + 1
    assert all(seen[True, tangent, stable] for tangent in (True, False) for stable in (True, False))
    assert all(seen[False, tangent, False] for tangent in (True, False))
