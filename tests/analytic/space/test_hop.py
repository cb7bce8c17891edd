"""Where a vibrissa lands that hops on a mesh, against a chain that goes down its energy."""

import numpy as np
import pytest
import trimesh
from scipy.optimize import minimize

from analytic.space import FootPath, SpatialCase, polyhedron, solve_space
from analytic.space.checks.rod import deflected_rods
from analytic.space.problem.readings import CONTACT_POINT, FOOT
from analytic.space.solver.contact import Scene
from analytic.space.solver.stability import is_stable
from analytic.space.solver.walk import Walk

LINKS, STIFF = 80, 1e6
RADIUS = 0.005


def at_rest(body, tangent, foot, shape):
    """The local minimum of the energy of a chain in front of the planes of a mesh.

    Springs of EI/h between links of length h = L/80, of 2 EI/h at the clamp, and a penalty of
    1e6/2 EI/L^3 times the square of a joint's depth within the planes moved out by the radius.
    """
    springs = np.full(LINKS, float(LINKS))
    springs[0] *= 2
    planes, of_plane = np.unique(body.normals, axis=0, return_index=True)
    heights = body.heights[of_plane] + RADIUS

    def energy(x):
        links = x.reshape(-1, 3)
        sizes = np.linalg.norm(links, axis=1, keepdims=True)
        along = links / sizes
        turned = along - np.vstack([tangent, along[:-1]])
        joints = foot + np.cumsum(along, axis=0) / LINKS
        rooms = heights - joints @ planes.T
        nearest = rooms.argmin(axis=1)
        deep = np.maximum(rooms[np.arange(LINKS), nearest], 0.0)
        found = (springs * (turned**2).sum(axis=1)).sum() / 2 + STIFF * (deep**2).sum() / 2
        pull = springs[:, None] * turned
        by_link = pull - np.vstack([pull[1:], np.zeros(3)])
        push = -STIFF * deep[:, None] * planes[nearest]
        by_link += np.cumsum(push[::-1], axis=0)[::-1] / LINKS
        by_link -= (by_link * along).sum(axis=1, keepdims=True) * along
        return found, (by_link / sizes).ravel()

    start = np.diff(shape, axis=0)
    start /= np.linalg.norm(start, axis=1, keepdims=True)
    options = {"maxiter": 20_000, "maxfun": 40_000, "ftol": 1e-15, "gtol": 1e-9, "maxcor": 40}
    found = minimize(energy, start.ravel(), jac=True, method="L-BFGS-B", options=options)
    links = found.x.reshape(-1, 3)
    along = links / np.linalg.norm(links, axis=1, keepdims=True)
    return found.fun, foot + along.sum(axis=0) / LINKS


def test_a_tip_hops_where_its_face_ends():
    body = polyhedron(trimesh.creation.icosphere(1, 1.0).vertices + np.array([0.0, 1.4, 0.0]))
    case = SpatialCase(body=body, path=FootPath([[1.0, 0.65], [0.3, 0.65]], stations=2))
    events = solve_space(case).provenance["events"]
    place = next(event["travel"] for event in events if event["kind"] == "hop")
    walker = Walk(Scene(body, case.path.clamp_tangent, RADIUS), case.way)
    walked = walker.along(place + np.array([-1e-9, 1e-8])).contacts
    before, after = (held.state.contact for held in walked)
    point = before.spot.point
    faces = np.unique(body.normals[np.abs(body.normals @ point - body.heights) < 1e-7], axis=0)
    assert len(faces) == 2  # an edge
    assert np.linalg.norm(after.spot.point - point) > 0.01
    assert after.energy < before.energy
    assert min(is_stable(one, RADIUS) for one in (before, after))


@pytest.mark.slow
def test_a_tip_lands_where_a_chain_comes_to_rest():
    mesh = trimesh.creation.icosphere(3, 1.0)
    body = polyhedron(mesh.vertices + np.array([0.0, 1.4, 0.0]))
    path = FootPath([[1.0, 0.65], [-1.0, 0.65]], stations=301)
    readings = solve_space(SpatialCase(body=body, path=path))
    travel, contact = readings.values("travel"), readings.values(*CONTACT_POINT)
    shapes, foot = deflected_rods(readings)[:, :-1], readings.values(*FOOT)
    tips = readings.table["phase"].to_numpy() == "tip"
    hops = [e["travel"] for e in readings.provenance["events"] if e["kind"] == "hop"]
    seen = 0
    for hop in hops:
        after = int(np.searchsorted(travel, hop))
        beside = sum(abs(other - hop) < 3 * travel[1] for other in hops)
        if beside > 1 or travel[after] - hop < 1e-3:  # a chain holds a little longer
            continue
        if not tips[after - 1 : after + 1].all():
            continue
        links = np.linspace(0, shapes.shape[1] - 1, LINKS + 1)
        shape = np.stack(
            [np.interp(links, np.arange(shapes.shape[1]), c) for c in shapes[after - 1].T], axis=1
        )
        _, tip = at_rest(body, path.clamp_tangent, foot[after], shape)
        jump = float(np.linalg.norm(contact[after] - contact[after - 1]))
        missed = float(np.linalg.norm(tip - shapes[after][-1]))
        assert missed < 1e-5  # the chain has 80 links, and the planes an edge of no radius
        seen += jump > 0.01
    assert seen >= 10
