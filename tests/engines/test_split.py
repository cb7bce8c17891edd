"""What a twin says of a disagreement: a planted fault is implementation, coarse links are not."""

from dataclasses import replace

import pytest

from analytic import named_case, solve_sweep
from compare.explain.split import split
from mujoco_models import Settings, simulate_sweep

ROLES = {"mujoco": "subject", "sound": "twin", "finer": "other model"}
CASE = replace(named_case("tip-only"), sweep=replace(named_case("tip-only").sweep, stations=40))
SETTINGS = Settings(segments=10)


@pytest.fixture(scope="module")
def exact():
    return solve_sweep(CASE)


@pytest.fixture(scope="module")
def sound():
    """In the place of a twin: the very same computation."""
    return simulate_sweep(CASE, SETTINGS)


def test_a_twin_that_is_equal_leaves_the_model(exact, sound):
    finer = simulate_sweep(CASE, replace(SETTINGS, segments=30))
    found = split(exact, {"mujoco": sound, "sound": sound, "finer": finer}, ROLES)
    assert found.blame == "model"
    assert found.share == 0
    assert found.snap_off == 0
    assert "computes this model right" in found.sentence
    assert found.model == found.disagreement
    assert max(found.others["finer"].values()) < 0.3 * max(found.disagreement.values())


@pytest.mark.parametrize(("joint", "share"), [(0, 0.1), (4, 0.05)])
def test_a_joint_that_is_two_percent_too_stiff_is_implementation(
    exact, sound, stiffer, joint, share
):
    """The size of the links errs alike in both, and takes no part in what is between them."""
    stiffer(joint)
    faulty = simulate_sweep(CASE, SETTINGS)
    found = split(exact, {"mujoco": faulty, "sound": sound}, ROLES)
    assert max(found.implementation.values()) > 1e-4
    assert found.share > share
    assert "implementations'" in found.sentence or "does not compute" in found.sentence


def test_without_a_twin_there_is_no_split(exact, sound):
    assert split(exact, {"mujoco": sound}, ROLES) is None
    assert split(exact, {"sound": sound}, ROLES) is None
