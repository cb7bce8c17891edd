"""Stability in space against finite elements, which share nothing but the state.

The shape is integrated from the clamp, the body's distance is differentiated numerically, and all
variations of the shape are free.
"""

from itertools import product

import numpy as np
import pytest

from analytic.space import cylinder, ellipsoid, polyhedron
from analytic.space.checks.rod import integrate_rod
from analytic.space.problem.bodies.body import Feature
from analytic.space.solver.contact import Plane, Scene, contact_at
from analytic.space.solver.stability import margin, second_variation

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


ELEMENTS = 100
_STEP = 1e-5  # L, of the differences of the body's distance


def least_eigenvalue(gradient, tangent, state, elements=ELEMENTS):
    """Of the energy's second variation, with the contact kept on the body's surface.

    Variations turn the tangent by (a, b): in the plane of bending and out of it. They are linear in
    each element and vanish at the clamp. The energy less the force times the distance is varied
    twice; a tangential contact may roll, which adds the square of the distance's change along the
    vibrissa over twice its curvature there.
    """
    foot, force, moment, reach, normal, tangential = state
    place, along, bending = integrate_rod(tangent, force, moment, reach, 2 * elements + 1)
    push = -force  # of the body
    across = np.cross(normal - (normal @ tangent) * tangent, tangent)
    across /= np.linalg.norm(across)
    sides = np.cross(across, along)  # in the plane of bending
    h = reach / elements
    count = 2 * elements
    matrix = np.zeros((count, count))
    rows_d = np.zeros((3, count))  # displacement of the contact
    kappa2 = (np.cross(along, bending) ** 2).sum(axis=1)
    pull = along @ push
    for e in range(elements):
        nodes = (e, e + 1)
        for share, weight in ((0, 1 / 6), (1, 4 / 6), (2, 1 / 6)):
            i = 2 * e + share
            shape = (1 - share / 2, share / 2)
            slope = (-1 / h, 1 / h)
            for one in range(2):
                if nodes[one] == 0:
                    continue
                row = 2 * (nodes[one] - 1)
                rows_d[:, row] += weight * h * shape[one] * sides[i]
                rows_d[:, row + 1] += weight * h * shape[one] * across
                for two in range(2):
                    if nodes[two] == 0:
                        continue
                    column = 2 * (nodes[two] - 1)
                    stiff = weight * h * slope[one] * slope[two]
                    mass = weight * h * shape[one] * shape[two]
                    # |t'|^2 to second order, and the shortening (a^2 + b^2)/2 under the push.
                    matrix[row, column] += stiff + pull[i] * mass
                    matrix[row + 1, column + 1] += stiff + (pull[i] - kappa2[i]) * mass
    size = np.linalg.norm(push)
    hessian = _hessian(gradient, foot + place[-1])
    matrix -= size * rows_d.T @ hessian @ rows_d
    if tangential:
        curvature = along[-1] @ hessian @ along[-1]
        change = along[-1] @ hessian @ rows_d
        change[-2] += normal @ sides[-1]
        change[-1] += normal @ across
        matrix += size / max(curvature, 1e-9) * np.outer(change, change)
    constraint = normal @ rows_d
    kept = np.linalg.svd(constraint[None])[2][1:]
    return float(np.linalg.eigvalsh(kept @ matrix @ kept.T)[0])


def _hessian(gradient, at):
    """Second derivatives of the distance from the body, by differences of its gradient."""
    found = np.zeros((3, 3))
    for i in range(3):
        ahead, behind = at.copy(), at.copy()
        ahead[i] += _STEP
        behind[i] -= _STEP
        found[i] = (gradient(ahead) - gradient(behind)) / (2 * _STEP)
    return (found + found.T) / 2
