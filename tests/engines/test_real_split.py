"""The split with a real twin: a planted fault is implementation, coarse links are not."""

from dataclasses import replace

import pytest

from analytic import solve_sweep
from compare.explain.split import ROUNDING, split
from engines import find_engine
from mujoco_models import Settings, simulate_sweep
from tests.engines.needs import needs, short

needs("drake")

ROLES = {"mujoco": "subject", "drake": "twin", "finer": "other model"}
CASE = short("tip-only", 30)


@pytest.fixture(scope="module", params=[20, pytest.param(80, marks=pytest.mark.slow)])
def others(request):
    """Settings, the closed form and the sweeps of all but MuJoCo's chain of as many links."""
    settings = Settings(segments=request.param, obstacle="primitive")
    drake = find_engine("drake").sweep(CASE, settings)
    finer = simulate_sweep(CASE, replace(settings, segments=2 * settings.segments))
    return settings, solve_sweep(CASE), {"drake": drake, "finer": finer}


def test_links_of_a_sound_model_are_the_model(others):
    settings, exact, sweeps = others
    found = split(exact, {"mujoco": simulate_sweep(CASE, settings), **sweeps}, ROLES)
    assert max(found.implementation.values()) < 1e-8
    assert found.blame == "model"
    assert found.share == 0
    assert "computes this model right" in found.sentence
    assert max(found.others["finer"].values()) < 0.3 * max(found.disagreement.values())


@pytest.mark.parametrize("joint", [0, 10])
def test_a_joint_two_percent_too_stiff_is_implementation(others, stiffer, joint):
    """What the size of the links makes is alike in both, and takes no part in it."""
    settings, exact, sweeps = others
    stiffer(joint)
    faulty = simulate_sweep(CASE, settings)
    found = split(exact, {"mujoco": faulty, **sweeps}, ROLES)
    assert max(found.implementation.values()) > 100 * ROUNDING
    assert found.share > 0.5
    assert "computes this model right" not in found.sentence
    assert found.blame == "implementation"
    assert "does not compute the model" in found.sentence
