"""Stability in space against finite elements."""

import numpy as np
import pytest

from analytic.space import Scene, contact_at, cylinder, ellipsoid, second_variation
from analytic.space.solver.rod import Plane
from analytic.space.solver.stability import margin
from tests.analytic.space.second_variation import least_eigenvalue

UP, RADIUS = np.array([0.0, 1.0, 0.0]), 0.02
STATES = 200
NEUTRAL = 1e-3  # of the scaled form: next to that 60 elements may see the other sign


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
        force, plane = state.force, state.plane
        moment = np.sqrt(force) * state.loaded.moment * plane.across
        loads = state.foot, -force * plane.normal, moment, state.arc_length, plane.normal
        form = second_variation(state, RADIUS)
        if abs(margin(form)) < NEUTRAL:
            continue
        least = least_eigenvalue(
            lambda x, body=body: body.nearest(x, 0.25).normal, UP, (*loads, tangent), 60
        )
        assert (margin(form) > 0) == (least > 0), (tangent, alpha, margin(form), least)
        seen[tangent, least > 0] += 1
    assert min(seen.values()) > STATES / 20
