"""Single precision loses contacts where its resolution says so; nothing of that is fitted."""

import numpy as np
import pytest

from engines.found import installed
from engines.precision.gate import by_stiffness, evaluators, gate
from engines.precision.resolution import chance_of_loss, force_deviation
from engines.precision.state import Evaluate, State
from mujoco_models import Settings
from mujoco_models.sweep.sweep import set_out
from tests.compare.command import vibrissa
from tests.engines.needs import needs, short

SETTINGS = Settings(segments=20)
STIFFNESSES = (1e4, 1e6, 1e8)


def single(extra: str) -> Evaluate:
    """What evaluates in single precision."""
    needs(f"mujoco-{extra}")
    if extra == "warp":
        from engines.precision.warp import evaluate
    else:
        from engines.precision.mjx import in_single as evaluate
    return evaluate


@pytest.fixture(
    scope="module",
    params=[
        ("catenary", "warp"),
        ("parabola", "warp"),
        pytest.param(("catenary", "mjx"), marks=pytest.mark.slow),
    ],
)
def looked_at(request):
    name, extra = request.param
    return gate(short(name, 24), SETTINGS, {"single": single(extra)}, STIFFNESSES)


def test_the_depths_are_off_by_the_resolution(looked_at):
    """Rms over stations and stiffnesses; a spacing twice as wide would be seen."""
    off = (looked_at["depth_error"] / looked_at["resolution"]).dropna()
    assert len(off) > 50
    assert 0.6 < np.sqrt((off**2).mean()) < 1.5


def test_contacts_are_lost_where_that_is_predicted(looked_at):
    """As many as the chances say, to three standard deviations of as many throws."""
    for stiffness, group in looked_at.groupby("contact_stiffness"):
        chance = group["chance"]
        spread = np.sqrt((chance * (1 - chance)).sum())
        assert abs(group["lost"].sum() - chance.sum()) <= 3 * spread + 0.5, stiffness
    found = by_stiffness(looked_at).set_index("contact_stiffness")
    assert found.loc[1e4, "lost"] == 0
    assert found.loc[1e8, "lost"] > 3


def test_forces_and_balance_are_off_by_stiffness_times_resolution(looked_at):
    found = by_stiffness(looked_at)
    for name in ("force_error", "imbalance"):
        ratio = found[name] / found[f"predicted_{name}"]
        assert ((ratio > 0.5) & (ratio < 2)).all(), name


@pytest.mark.parametrize("name", ["catenary", "parabola"])
@pytest.mark.parametrize("extra", ["warp", "mjx"])
def test_without_a_loaded_contact_both_precisions_agree(extra, name):
    evaluate, case = single(extra), short(name, 4)
    walk = set_out(case, Settings(segments=10, obstacle="primitive"))
    walk.go_to(float(case.foot_x[0]))
    (found,) = evaluate([State.of(walk.model)])
    assert (found.force == 0).all()
    assert found.imbalance < 1e-6


@pytest.mark.slow
def test_in_double_precision_it_is_mujocos_state():
    """To the rounding of a depth, some 2e-16 L, times the stiffness."""
    needs("mujoco-mjx")
    from engines.precision.mjx import in_double

    table = gate(short("parabola", 24), Settings(segments=10), {"double": in_double}, (1e4, 1e7))
    assert not table["lost"].any()
    assert table["depth_error"].abs().max() < 2e-15
    for stiffness, rows in table.groupby("contact_stiffness"):
        assert rows["force_error"].max() < 2e-15 * stiffness, stiffness


def test_the_chances_are_those_of_many_throws():
    """Against a million random throws of two correlated depths."""
    depth, together = np.array([0.5, -0.2]), np.array([[1.0, 0.6], [0.6, 1.0]])
    thrown = np.random.default_rng(1).multivariate_normal(depth, together, 1_000_000)
    assert chance_of_loss(depth, together) == pytest.approx(
        (thrown < 0).all(axis=1).mean(), abs=2e-3
    )
    off = np.maximum(thrown, 0) - np.maximum(depth, 0)
    np.testing.assert_allclose(
        force_deviation(depth, np.ones(2)), np.sqrt((off**2).mean(axis=0)), rtol=5e-3
    )


@pytest.mark.slow
def test_the_command_says_where_it_loses_contacts(tmp_path):
    """By either, or both."""
    if installed("mujoco-mjx")[1] is not None:
        needs("mujoco-warp")
    sweep = ("--stations", 20, "--segments", 20, "--contact-stiffness", "1e5,1e9")
    done = vibrissa("inspect", "parabola", "--float32", *sweep, "--out", "out", cwd=tmp_path)
    assert done.returncode in (0, 1), done.stderr
    for name in evaluators():
        verdict = "loses no contact" if name.endswith("64 bits") else "loses contacts from"
        assert f"{name} {verdict}" in done.stdout
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        "float32.csv", "float32.png", "stations.csv",
    }  # fmt: skip
