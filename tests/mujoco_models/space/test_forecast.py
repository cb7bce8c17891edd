"""What is foreseen of a vibrissa on a mesh, against MuJoCo's own balance."""

import mujoco
import numpy as np
import pytest

from mujoco_models import SpatialSettings
from mujoco_models.space.rest import Rest
from mujoco_models.space.sweep import compiled
from mujoco_models.space.walk import Walk
from tests.mujoco_models.space.files import oblique

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
