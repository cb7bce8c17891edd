"""The split with real engines: a planted fault is implementation, coarse links are not."""

from dataclasses import replace

import pytest

from analytic import named_case, solve_sweep
from compare.explain.split import ROUNDING, split
from engines import find_engine
from mujoco_models import Settings, simulate_sweep

pytest.importorskip("pydrake", reason="Drake is an extra: pip install '.[drake]'")
pytest.importorskip("exudyn", reason="Exudyn is an extra: pip install '.[exudyn]'")

ROLES = {"mujoco": "subject", "drake": "twin", "exudyn": "other model"}
CASE = replace(named_case("tip-only"), sweep=replace(named_case("tip-only").sweep, stations=30))


@pytest.fixture(scope="module", params=[20, pytest.param(80, marks=pytest.mark.slow)])
def others(request):
    """Settings, the closed form and the sweeps of all but MuJoCo; Exudyn's elements are finer."""
    settings = Settings(segments=request.param, obstacle="primitive")
    drake = find_engine("drake").sweep(CASE, settings)
    exudyn = find_engine("exudyn").sweep(CASE, replace(settings, segments=40))
    return settings, solve_sweep(CASE), {"drake": drake, "exudyn": exudyn}


def test_links_of_a_sound_model_are_the_model(others):
    settings, exact, sweeps = others
    found = split(exact, {"mujoco": simulate_sweep(CASE, settings), **sweeps}, ROLES)
    assert max(found.implementation.values()) < 1e-8
    assert found.blame == "model"
    assert found.share == 0
    assert "computes this model right" in found.sentence
    assert max(found.others["exudyn"].values()) < 1.5e-4


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
