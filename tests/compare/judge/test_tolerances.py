"""Limits are data, each with its reason, and noise widens them by what it does."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from analytic import CLAMP_READINGS, InputError, Sweep, named_case, solve_sweep
from compare import Tolerances, compare
from compare.judge.allowance import noise_allowance
from compare.read.case import load_job
from compare.read.limits import read_tolerances
from compare.sense.noise import Noise, with_noise
from tests.compare.synthetic import changed, scaled
from tests.conftest import exact_sweep, simulated_sweep

FILE = """
[tolerances]
rms = { limit = 4e-3, reason = "half as many segments" }

[tolerances.force_x]
rms = { limit = 1e-4, reason = "the force that is used" }

[tolerances.moment_z.tangent]
max = { limit = 1e-5, reason = "a strict one" }
"""


def test_a_transition_may_move_as_far_as_noise_moves_it():
    """Ten times the noise, some ten times as far: of 1e-3 a tenth of the length at most."""
    levels = (Noise(dict.fromkeys(CLAMP_READINGS, level)) for level in (1e-4, 1e-3))
    small, large = (noise_allowance(exact_sweep("parabola"), level) for level in levels)
    assert large.transitions.keys() == {"first_contact", "phase_b_start", "phase_b_end"}
    for name, far in large.transitions.items():
        assert 3 < far / small.transitions[name] < 30
        assert far < 0.1
    assert 0.9 < large.phase_agreement < small.phase_agreement


@pytest.mark.slow
def test_limits_from_a_file(tmp_path):
    (tmp_path / "limits.toml").write_text(FILE)
    limits = read_tolerances(tmp_path / "limits.toml", Tolerances)
    assert limits.rms == 4e-3
    assert limits.max == Tolerances().max
    assert limits.of("force_x", "rms").reason == "the force that is used"
    assert limits.of("force_y", "rms") == 4e-3
    assert limits.of("moment_z", "max", "tangent") == 1e-5
    assert limits.of("moment_z", "max", "tip") == Tolerances().max
    found = compare(exact_sweep("catenary"), simulated_sweep("catenary"), limits)
    assert [line.split(":")[0] for line in found.failures] == ["force_x", "moment_z"]
    assert "(the force that is used)" in found.failures[0]
    assert "in phase tangent, arc length 0." in found.failures[1]
    assert found.to_dict()["tolerances"]["moment_z.tangent.max"] == 1e-5
    assert found.to_dict()["tolerance_reasons"]["moment_z.tangent.max"] == "a strict one"
    case = '[profile]\nkind = "circle"\nradius = 1.0\nlowest = [0.0, 0.4]\n'
    (tmp_path / "case.toml").write_text(case + FILE)
    assert load_job(str(tmp_path / "case.toml")).tolerances == limits


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("rms = 1e-3", "line 2: tolerances.rms = 0.001: must be a limit with its reason"),
        ("rms = { limit = 1e-3 }", "line 2: tolerances.rms.reason = missing"),
        ('rms = { limit = -1e-3, reason = "x" }', "tolerances.rms.limit = "),
        (
            'rsm = { limit = 1e-3, reason = "x" }',
            "line 2: tolerances.rsm = unknown",
        ),
        ('force_x.snap_off = { limit = 1e-3, reason = "x" }', "tolerances.force_x.snap_off"),
    ],
)
def test_limits_that_cannot_be_used(tmp_path, text, said):
    (tmp_path / "limits.toml").write_text(f"[tolerances]\n{text}\n")
    with pytest.raises(InputError, match=said):
        read_tolerances(tmp_path / "limits.toml", Tolerances)


@pytest.mark.parametrize("level", [1e-3, pytest.param(1e-2, marks=pytest.mark.slow)])
def test_noise_is_no_disagreement(case_name, exact, level):
    """A sweep that is right but for its noise fails without saying so, and passes with it."""
    seen = with_noise(exact, dict.fromkeys(CLAMP_READINGS, level), seed=5)
    seen = replace(seen, table=seen.table.drop(columns=["phase"]))
    if level > Tolerances().rms:
        assert not compare(exact, seen).agrees
    for noise in (level, "auto"):
        found = compare(exact, seen, noise=noise)
        assert found.agrees, found.failures
    assert found.noise.level["force_y"] == pytest.approx(level, rel=0.25)


def remembering(exact, memory, seed, gain=1.0):
    """A sweep with 1 % of such noise."""
    rng = np.random.default_rng(seed)
    white = rng.standard_normal((3, len(exact.table) + 500)) * np.sqrt(1 - memory**2)
    noise = lfilter([1.0], [1.0, -memory], white)[:, 500:]
    table = exact.table[["foot_x", *CLAMP_READINGS]].copy()
    for name, one in zip(CLAMP_READINGS, noise, strict=True):
        table[name] = gain * table[name] + 0.01 * np.abs(exact.values(name)).max() * one
    return replace(exact, table=table, source="rig")


@pytest.mark.slow
@pytest.mark.parametrize(("memory", "agree"), [(0.0, 10), (0.9, 8)])
def test_the_size_of_noise_is_known_as_far_as_the_sweep_shows_it(memory, agree):
    """Of 10 right ones each, 3 and 9 disagreed; of those 6 % too stiff none agrees."""
    exact = solve_sweep(replace(named_case("parabola"), sweep=Sweep(2000)))
    limits = Tolerances(rms=1e-3, max=5e-3)
    right = [compare(exact, remembering(exact, memory, i), limits, noise="auto") for i in range(10)]
    assert sum(one.agrees for one in right) >= agree
    for i in range(10):
        wrong = remembering(exact, memory, i, gain=1.06)
        assert not compare(exact, wrong, limits, noise="auto").agrees


def test_a_reading_that_is_all_jumps_agrees_with_nothing():
    """Its rows in any order were 29 % of noise, which `auto` allowed for; stated, they may be."""
    exact = exact_sweep("catenary")
    moment = np.random.default_rng(0).permutation(exact.values("moment_z"))
    found = compare(exact, changed(exact, moment_z=moment), noise="auto")
    assert not found.agrees
    assert any("of its largest magnitude; beyond 10% no agreement" in x for x in found.failures)


def test_noise_excuses_nothing_but_noise():
    """A gain 3 % off under 1 % of noise."""
    exact = exact_sweep("catenary")
    seen = with_noise(exact, dict.fromkeys(CLAMP_READINGS, 1e-2), seed=1)
    found = compare(exact, scaled(seen, force_y=1.03), noise=1e-2)
    assert [line.split(":")[0] for line in found.failures if "rms" in line] == ["force_y"]
    assert "beside noise of 1.0e-02" in found.failures[0]


@pytest.mark.parametrize(("wrong", "agrees"), [(2, True), (3, False)])
def test_two_stations_of_a_short_sweep_may_fall_between_the_transitions(wrong, agrees):
    """One of 60 stations is 1.7 %: of the 1 % that may be wrong of many there is none."""
    case = replace(named_case("catenary"), sweep=Sweep(stations=60))
    exact, other = solve_sweep(case), solve_sweep(case)
    tangent = np.flatnonzero(other.table["phase"] == "tangent")
    table = other.table
    table.loc[tangent[:wrong], "phase"] = "tip"
    other = replace(other, table=table)
    other.provenance["settings"] = {"segments": 40}
    found = compare(exact, other)
    assert ("phases of the candidate" in {one.name for one in found.exceeded}) is not agrees
