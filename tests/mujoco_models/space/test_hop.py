"""What is foreseen on a mesh, against MuJoCo's own balance; where a vibrissa goes over a corner."""

import mujoco
import numpy as np
import pytest

from analytic.space import FootPath, SpatialCase, polyhedron, solve_space
from compare import assert_agreement
from mujoco_models import SpatialSettings, simulate_space
from mujoco_models.space import walk as walks
from mujoco_models.space.descent import descend
from mujoco_models.space.rest import Rest
from mujoco_models.space.surface import Surface
from mujoco_models.space.sweep import compiled
from mujoco_models.space.walk import Walk
from tests.fuzz.space import trial
from tests.mujoco_models.space.files import oblique


@pytest.mark.parametrize("kind", ["hull", "box"])
def test_mujocos_contact_is_the_polyhedrons(kind, tmp_path):
    """Next to faces, edges and corners; four corners of a box in one plane, in single precision."""
    case = trial(0, tmp_path, kind)
    model = compiled(case, SpatialSettings(segments=4))
    mesh, random = model.mesh, np.random.default_rng(0)
    model.place(case.way.foot(0.0), model.straight)
    assert np.abs(mesh.vertices - case.way.body.vertices).max() < 1e-7
    for _ in range(200):
        weights = random.dirichlet([0.3, 0.3, 0.3])
        face = random.integers(len(mesh.faces))
        outward = mesh.normals[face] + 0.3 * random.normal(size=3)
        centre = weights @ mesh.corners[face] + model.radius * outward
        found, spot = model.probe(0, centre), mesh.nearest(centre, 1.0)
        if spot.distance > 0.1 * model.radius:
            assert found.distance + model.radius == pytest.approx(spot.distance, abs=1e-8)
            assert np.abs(found.normal - spot.normal).max() * spot.distance < 1e-8


def test_what_meets_next_to_a_corner_is_where_mujocos_contact_is(tmp_path):
    case = oblique("ellipsoid.obj", 0, tmp_path)
    model = compiled(case, SpatialSettings(segments=4))
    model.place(case.way.foot(0.0), model.straight)
    mesh = model.mesh
    for corner in range(0, len(mesh.vertices), 20):
        around = mesh.faces[(mesh.faces == corner).any(axis=1)]
        normals = mesh.normals[(mesh.faces == corner).any(axis=1)]
        faces, edges = mesh.features(mesh.vertices[corner])
        others = np.setdiff1d(around, corner)
        assert len(faces) == len(edges) == len(others)
        for other in others:
            beside = normals[(around == other).any(axis=1)].sum(axis=0)
            beside /= np.linalg.norm(beside)
            middle = (mesh.vertices[corner] + mesh.vertices[other]) / 2
            bead = middle + model.radius * beside
            assert sum(Surface(model, edge).holds(0, bead) for edge in edges) == 1
            aside = mesh.vertices[corner] + 1e-4 * (middle - mesh.vertices[corner])
            assert mesh.snapped(aside, 1e-4) == pytest.approx(mesh.vertices[corner], abs=0)
            assert mesh.snapped(middle, 1e-4) == pytest.approx(middle, abs=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize(("file", "seed"), [("ball.stl", 7), ("ellipsoid.obj", 2)])
def test_a_side_that_comes_over_a_corner_goes_where_the_way_down_leads(
    file, seed, tmp_path, monkeypatch
):
    # Over one of these corners of the ball there is a face, too, that would hold the tip.
    case = oblique(file, seed, tmp_path)
    model = compiled(case, SpatialSettings(segments=40))
    rest, hop, seen = Rest(model, 1e-8), walks.over_faces, []

    def watched(rest, held, foot, far):
        found = hop(rest, held, foot, far)
        if found is not None and held.state.sliding:
            down = descend(rest, held, foot, far)
            seen.append(np.abs(down.touch.centre - found.touch.centre).max())
        return found

    monkeypatch.setattr(walks, "over_faces", watched)
    walk = Walk(model, rest, case.way.foot, case.way.marks)
    for travel in case.path.travel:
        walk.go_to(float(travel) / case.beam.length)
    assert len(seen) >= 5
    assert max(seen) < 1e-6  # Newton's method ends both


def test_a_hop_is_no_change_of_phase(tmp_path):
    """Hops go from the tip to the side and back; as in the closed form, none begins a phase."""
    case = trial(515, tmp_path)
    exact, found = (
        [event for event in readings.provenance["events"] if event["kind"] == "phase"]
        for readings in (solve_space(case), simulate_space(case, SpatialSettings(segments=20)))
    )
    places = [[event["travel"] for event in events] for events in (exact, found)]
    assert places[0] == pytest.approx(places[1], abs=2e-3)


@pytest.mark.parametrize(
    ("segments", "lean"), [(40, 0.0), (40, 0.05), pytest.param(80, 0.0, marks=pytest.mark.slow)]
)
def test_a_vibrissa_meets_a_box_along_a_face_and_leaves_it_at_the_edge(segments, lean):
    """Beyond the edge its tip would be on a face that lets it turn about its clamp's tangent."""
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (0.5, 2.5) for z in (-0.5, 0.5)]
    way = FootPath([[1.5, 0.13], [-1.5, 0.02]], stations=20, tangent=[0, 1, lean])
    case = SpatialCase(body=polyhedron(np.array(corners)), path=way)
    assert_agreement(solve_space(case), simulate_space(case, SpatialSettings(segments=segments)))


BEAMS = [("chain", "ball"), pytest.param("rod", "universal", marks=pytest.mark.slow)]


def walked(beam, joints, folder):
    """States along a way over faces and edges, each with the foot it belongs to."""
    if beam == "rod" and mujoco.__version__ < "4":
        pytest.skip("MuJoCo 3 has no elastic one-dimensional flex")
    case = oblique("ellipsoid.obj", 0, folder)
    model = compiled(case, SpatialSettings(beam=beam, joints=joints, segments=12))
    rest = Rest(model, 1e-8)
    walk, states = Walk(model, rest, case.way.foot, case.way.marks), []
    for travel in case.path.travel:
        held = walk.go_to(float(travel)).settled
        if held is not None:
            states.append((held, case.way.foot(float(travel))))
    return rest, states


def turned(planar, by, random):
    """With other directions of its links [rad]."""
    return planar._replace(angles=planar.angles + by * random.normal(size=planar.angles.shape))


@pytest.mark.parametrize(("beam", "joints"), BEAMS)
def test_mujoco_is_at_rest_where_it_is_foreseen(beam, joints, tmp_path):
    rest, states = walked(beam, joints, tmp_path)
    random, kinds = np.random.default_rng(0), set()
    for held, foot in states:
        planar = rest.forecast.rest(turned(held.planar, 0.03, random), held.surface.feature, foot)
        found = rest.confirm(planar, held.surface, foot)
        assert np.abs(planar.angles - held.planar.angles).max() < 1e-9
        assert np.abs(planar.side - held.planar.side).max() < 1e-9
        assert found.state.force == pytest.approx(held.state.force, rel=1e-8)
        kinds.add((held.surface.feature.flat, held.state.sliding))
    assert len(kinds) >= 3  # faces and edges, with the tip and with the side


@pytest.mark.slow
@pytest.mark.parametrize(("beam", "joints"), BEAMS)
def test_it_is_stable_where_mujocos_stiffness_is_positive(beam, joints, tmp_path):
    rest, states = walked(beam, joints, tmp_path)
    random, seen = np.random.default_rng(1), []
    for held, foot in states * 20:
        # Newton's method does not mind saddles: from twenty times the force it finds many.
        there = foot + [0.3, 0.0, 0.3] * random.normal(size=3)
        start = turned(held.planar._replace(force=20 * held.planar.force), 0.3, random)
        planar = rest.forecast.rest(start, held.surface.feature, there)
        found = planar and rest.confirm(planar, held.surface, there)
        if found:
            least = rest.softest(found, there)[0]
            seen.append(found.stable)
            assert seen[-1] == (least > 0)
    assert min(seen.count(True), seen.count(False)) > 10
