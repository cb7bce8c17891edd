"""Where a vibrissa goes that comes over a corner of a mesh, by MuJoCo."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from mujoco_models import SpatialSettings
from mujoco_models.space import walk as walks
from mujoco_models.space.descent import descend
from mujoco_models.space.rest import Rest
from mujoco_models.space.surface import STAYS, edges_of, features_at
from mujoco_models.space.sweep import compiled
from mujoco_models.space.walk import Walk
from tests.mujoco_models.space.files import oblique


def test_the_edges_around_a_corner_are_those_of_the_mesh(tmp_path):
    case = oblique("ellipsoid.obj", 0, tmp_path)
    model = compiled(case, SpatialSettings(segments=4))
    model.place(case.way.foot(0.0), model.straight)
    hull = ConvexHull(case.way.body.vertices)
    for corner in range(0, len(hull.points), 20):
        around = hull.simplices[(hull.simplices == corner).any(axis=1)]
        normals = hull.equations[(hull.simplices == corner).any(axis=1), :3]
        outward = normals.mean(axis=0) / np.linalg.norm(normals.mean(axis=0))
        centre = hull.points[corner] + model.radius * outward
        faces = [one for one in features_at(model, 0, centre) if one.flat]
        edges = edges_of(model, faces, centre)
        others = np.setdiff1d(around, corner)
        assert len(faces) == len(edges) == len(others)
        for other in others:
            beside = normals[(around == other).any(axis=1)].sum(axis=0)
            middle = (hull.points[corner] + hull.points[other]) / 2
            bead = middle + model.radius * beside / np.linalg.norm(beside)
            assert min(edge.missed_at(0, bead) for edge in edges) < STAYS


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
    assert max(seen) < 1e-6  # Newton's method ends both; edges by planes and by normals
