"""Convex meshes from files in space, and where a vibrissa lands that hops on one."""

import zlib

import numpy as np
import pytest
import trimesh
from scipy.optimize import minimize

from analytic import InputError
from analytic.space import (
    FootPath,
    SpatialCase,
    convex_mesh,
    polyhedron,
    rod_residuals,
    solve_space,
    sphere,
)
from analytic.space.checks.rod import deflected_rods
from analytic.space.problem.readings import CONTACT_POINT, FOOT
from analytic.space.solver.contact import Scene
from analytic.space.solver.stability import is_stable
from analytic.space.solver.walk import Walk
from tests.net.problems import spatial

PATH = FootPath([[1.3, 0.3], [-1.5, 0.25]], stations=40)


def saved(mesh, tmp_path, name="body.stl"):
    mesh.export(tmp_path / name)
    return tmp_path / name


def ball(subdivisions=3, radius=1.0, centre=(0.0, 1.4, 0.0)):
    mesh = trimesh.creation.icosphere(subdivisions, radius)
    mesh.apply_translation(centre)
    return mesh


@pytest.mark.slow
def test_a_mesh_of_a_ball_is_nearly_the_ball(tmp_path):
    body = convex_mesh(saved(ball(4), tmp_path))
    found = solve_space(SpatialCase(body=body, path=PATH))
    exact = solve_space(SpatialCase(body=sphere(1.0, (0.0, 1.4, 0.0)), path=PATH))
    assert np.nanmax(rod_residuals(found)) < 1e-10
    both = found.touching & exact.touching
    assert both.sum() > 15
    names = ("force_x", "force_y", "force_z")
    force = [np.linalg.norm(r.values(*names), axis=1) for r in (found, exact)]
    # Facets 0.07 L wide turn the normal by up to 0.04 rad, and the force's size by as much.
    assert np.abs(force[0] - force[1])[both].max() < 0.04 * np.nanmax(force[1])
    assert any(event["kind"] == "hop" for event in found.provenance["events"])


def test_the_nearest_point_of_a_mesh_is_trimeshs(tmp_path):
    random = np.random.default_rng(0)
    mesh = trimesh.convex.convex_hull(random.normal(size=(60, 3)) * [1, 0.5, 2])
    body = convex_mesh(saved(mesh, tmp_path, "body.ply"))
    within = 0
    for x in np.repeat([[4], [0.5]], 100, axis=0) * random.normal(size=(200, 3)):
        spot = body.nearest(x, 0.25)
        within += spot.distance < 0
        best = trimesh.triangles.closest_point(mesh.triangles, np.tile(x, (len(mesh.faces), 1)))
        assert abs(spot.distance) == pytest.approx(np.linalg.norm(best - x, axis=1).min(), rel=1e-5)
        assert np.abs(spot.point + spot.distance * spot.normal - x).max() < 1e-12
    assert within > 50


def test_next_to_an_edge_the_nearest_point_is_on_the_right_side_of_it():
    """Their distances differ by 1e-17 there: a face is left where its edge begins."""
    body, apart, aside = polyhedron(ball().vertices), 0.25, 1e-9
    for face in range(0, len(body.faces), 7):
        normal, corners = body.normals[face], body.corners[face]
        for i in range(3):
            middle = (corners[i] + corners[i - 1]) / 2
            outward = np.cross(corners[i] - corners[i - 1], normal)
            outward *= np.sign(outward @ (middle - corners.mean(axis=0)))
            outward /= np.linalg.norm(outward)
            for side in (-1, 1):
                spot = body.nearest(middle + side * aside * outward + apart * normal, apart)
                on_face = bool((spot.turning == 0).all())
                assert on_face == (side < 0), (face, i, side)


def test_what_happens_past_a_seam_does_not_depend_on_the_stations(tmp_path, monkeypatch):
    """A file's triangles of one face are 1e-7 rad apart: phases changed at the next station."""
    monkeypatch.chdir(tmp_path)
    seed = zlib.crc32(b"compare/space-capsule")
    cases = (spatial("capsule", n, np.random.default_rng(seed)) for n in (8, 30))
    every = [solve_space(case) for case in cases]
    (few, more) = ([(e["kind"], e["travel"]) for e in x.provenance["events"]] for x in every)
    assert [kind for kind, _ in few] == [kind for kind, _ in more]
    assert [at for _, at in few] == pytest.approx([at for _, at in more], abs=1e-8)


@pytest.mark.slow
def test_a_fine_mesh_is_simplified_within_what_its_label_says(tmp_path):
    """327,680 triangles, a second's work."""
    file = saved(ball(7), tmp_path)
    fine = np.asarray(trimesh.load_mesh(file).vertices)
    for tolerance in (0.0, 1e-3):
        body = convex_mesh(file, scale=2.0, tolerance=tolerance)
        said = float(body.label.split("simplified within ")[1])
        assert len(body.vertices) <= 50_000
        assert tolerance == 0 or said <= tolerance * 1.05  # of two digits
        draw = np.random.default_rng(0).permutation(len(fine))[:300]
        beyond = (2 * fine[draw] @ body.normals.T - body.heights).max(axis=1)
        assert beyond.max() <= 1.05 * said
    with pytest.raises(InputError, match=r"tolerance.* or more"):
        convex_mesh(file, tolerance=1e-6)


@pytest.mark.parametrize("name", ["body.stl", "body.obj", "body.ply"])
def test_a_mesh_in_millimetres_and_inside_out(name, tmp_path):
    mesh = ball(2, 1000.0, (0.0, 1400.0, 0.0))
    mesh.invert()
    body = convex_mesh(saved(mesh, tmp_path, name), scale=1e-3)
    x = np.array([0.7, 0.2, 0.4])
    spot, best = body.nearest(x, 0.25), polyhedron(ball(2).vertices).nearest(x, 0.25)
    assert np.abs(spot.point - best.point).max() < 1e-6  # STL holds single precision
    assert np.abs(spot.normal - best.normal).max() < 1e-6
    path = FootPath([[1.1, 0.3], [0.7, 0.3]], stations=5)
    found, expected = (
        solve_space(SpatialCase(body=b, path=path)) for b in (body, polyhedron(ball(2).vertices))
    )
    assert found.touching.sum() == 2
    names = ("force_x", "force_y", "force_z")
    assert np.nanmax(np.abs(found.values(*names) - expected.values(*names))) < 1e-6


def test_meshes_that_cannot_be_touched_are_refused_in_one_line(tmp_path):
    whole = ball()
    hole = trimesh.Trimesh(whole.vertices, whole.faces[5:], process=False)
    doubled = trimesh.Trimesh(whole.vertices, [*whole.faces, whole.faces[7]], process=False)
    dented = whole.copy()
    dented.vertices[0] *= [1, 0.4, 1]
    for mesh, says, near in (
        (hole, "open at", whole.triangles_center[:5]),
        (doubled, "with 3 faces on one edge at", whole.triangles_center[7:8]),
        (dented, "dented at", dented.vertices[:1]),
    ):
        with pytest.raises(InputError, match=says) as refused:
            convex_mesh(saved(mesh, tmp_path))
        assert "\n" not in str(refused.value)
        place = str(refused.value).split(says)[1].strip(" (").split(")")[0]
        apart = np.linalg.norm(near - np.array(place.split(","), dtype=float), axis=1)
        assert apart.min() < 0.3
    for mesh, says in (
        (ball(2, 2000.0, (0.0, 2800.0, 0.0)), "4000 L in size.*scale"),
        (ball(2, 1.0, (3e4, 1.4, 0.0)), "around .*check its unit"),
        (ball(2, 1.0, (0.0, 2.5, 0.0)), "at a distance of 0.5"),
    ):
        with pytest.raises(InputError, match=says) as refused:
            SpatialCase(body=convex_mesh(saved(mesh, tmp_path)), path=PATH)
        assert "\n" not in str(refused.value)


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
