"""The planar equilibrium leaves its plane where the contact passes the lowest point, alpha = 0."""

import numpy as np
import pytest

from analytic import Beam, Case, circle, named_case
from mujoco_models import Settings, available_beams

pytestmark = pytest.mark.skipif(
    "cable" not in available_beams(), reason="only MuJoCo 3's cable has ball joints"
)


@pytest.mark.slow
@pytest.mark.parametrize(
    "case",
    [Case(Beam(), circle(1, lowest=(0, 0.4))), named_case("two-circles")],
    ids=["circle", "two-circles"],
)
def test_sideways_stiffness_has_the_sign_of_the_contact_angle(case):
    from mujoco_models.beams.kinds import build
    from mujoco_models.model import BeamModel
    from mujoco_models.obstacles.prism import Prism
    from mujoco_models.rest import State, relax
    from mujoco_models.sideways import sideways_stiffness

    beam = build(Settings(beam="cable", segments=20), spacing=0.003)
    model = BeamModel(beam, case.radius, Prism.of(case, 3200), 1e7)
    state = State.straight(len(beam.layout.joints))
    signs = []
    for foot_x in case.foot_x[:-1]:
        state = relax(model, float(foot_x), state, 1e-8)
        loaded = model.contacts().distance < 0
        if not state.settled or not loaded.any():
            if signs:
                break
            continue
        normal = model.contacts().normal[loaded].mean(axis=0)
        alpha = np.arctan2(normal[0], -normal[1])
        if abs(alpha) > 0.02:  # nearer to zero, 20 segments do not tell
            signs.append((np.sign(alpha), np.sign(sideways_stiffness(model))))
    angle, stiffness = np.array(signs).T
    assert {-1, 1} == set(angle)
    np.testing.assert_array_equal(stiffness, angle)
