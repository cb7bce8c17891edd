"""Two sweeps side by side: gains, events, phases; a pass and its repeat; what is taken for true."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic import (
    CLAMP_READINGS,
    Case,
    Readings,
    Sweep,
    circle,
    named_case,
    relative_noise,
    solve_sweep,
)
from compare.align.offset import without_offset
from compare.measure.measurement import measure
from compare.measure.repeats import repeats
from compare.sense.noise import with_noise
from compare.simulate.rigidity import tip_of
from tests.analytic.noisy import noisy
from tests.compare.synthetic import BEAM, changed, sensed, solved

WINDOW = 0.02
DATA = Path(__file__).parents[2] / "data"


def test_events_move_with_the_foot_and_come_back_with_the_offset():
    found = measure(solved(), without_offset(solved(), -0.03), WINDOW)
    again = measure(solved(), without_offset(solved(), -0.03), WINDOW, 0.03)
    for one, put_back in ((found, 0.03), (again, 0.0)):
        events = [*one.transitions.values(), one.snap_off]
        assert [e.difference for e in events] == pytest.approx([put_back] * 4, abs=1e-9)
    assert again.offset.value == 0.03
    assert max(d.rms for d in again.disagreement.values()) < 1e-9
    assert found.disagreement["force_y"].rms > 1e-3


def test_a_snap_off_between_stations_is_uncertain_by_half_a_step_in_each():
    rig = replace(solved(), provenance={})
    x = solved().values("foot_x")
    step = abs(x[1] - x[0])
    last = np.flatnonzero(solved().table["phase"] != "free")[-1]
    one, both = measure(solved(), rig, WINDOW), measure(rig, rig, WINDOW)
    assert one.snap_off.candidate == pytest.approx((x[last] + x[last + 1]) / 2)
    assert one.snap_off.reference == solved().snap_off
    assert one.snap_off.uncertainty == pytest.approx(step / 2)
    assert both.snap_off.uncertainty == pytest.approx(step)


def test_shares_of_phases():
    """Of 128 stations the last sixteen in contact read nothing."""
    inside = np.flatnonzero(solved().table["phase"] != "free")[-16:]
    idle = {name: solved().values(name).copy() for name in CLAMP_READINGS}
    for values in idle.values():
        values[inside] = 0.0
    found = measure(solved(), changed(solved(), **idle), WINDOW)
    assert found.phases_alike() == pytest.approx(7 / 8)
    assert found.phase_agreement() == pytest.approx({"reference": 1.0, "candidate": 7 / 8})
    assert found.alignment.counts["one_free"] == 16
    assert measure(solved(), solved(), WINDOW).phases_alike() == 1.0


def test_what_a_short_sweep_does_not_reach():
    """Up to foot_x = 0.6; a sweep that goes on touching lacks a snap-off that it does cover."""
    short = replace(changed(solved(), slice(0, 40)), provenance={})
    found = measure(solved(), short, WINDOW)
    assert found.beyond() == ["phase_b_start", "phase_b_end", "snap_off"]
    longer = {name: np.where(solved().values("moment_z") == 0, solved().values(name)[100],
                             solved().values(name)) for name in CLAMP_READINGS}  # fmt: skip
    on = measure(solved(), replace(changed(solved(), **longer), provenance={}), WINDOW)
    assert on.snap_off.candidate is None
    assert on.beyond() == []


def past_a_circle(height: float) -> Readings:
    return solve_sweep(Case(profile=circle(1.0, (0, height))))


def test_a_phase_that_noise_alone_makes():
    """Past a high circle the contact stays at the tip; a lower one has a Phase B of its own."""
    exact = past_a_circle(0.65)
    rig = sensed(with_noise(exact, dict.fromkeys(CLAMP_READINGS, 3e-3), seed=8))
    found = measure(exact, rig, WINDOW)
    made = [n for n, one in found.transitions.items() if one.reference is None is not one.candidate]
    assert found.unsure() == made != []
    real = measure(exact, past_a_circle(0.5), WINDOW)
    assert real.transitions["phase_b_end"].reference is None
    assert real.transitions["phase_b_end"].candidate is not None
    assert real.unsure() == []


def remembering(seed: int, stations: int = 600) -> tuple[Readings, Readings]:
    """Past a circle that is met in Phase B, with noise of 1 % that remembers; half of it free."""
    case = Case(profile=circle(0.3, (0.12, 0.68)))
    first, last = case.foot_x[[0, -1]]
    exact = solve_sweep(replace(case, sweep=Sweep(stations, first + 0.4, last - 0.4)))
    return exact, sensed(noisy(exact, relative_noise(exact, 0.01), seed, memory=0.9))


def test_noise_that_remembers_is_no_contact_and_no_phase():
    """Its jumps are a quarter of it: free stations seemed loaded, and first ones at the tip."""
    made = []
    for seed in range(4, 12):
        found = measure(*remembering(seed), WINDOW)
        assert abs(found.snap_off.difference) < 0.01
        one_sided = [
            n for n, e in found.events.items() if (e.reference is None) != (e.candidate is None)
        ]
        assert found.unsure() == one_sided
        made += one_sided
    assert set(made) == {"phase_b_start"}
    low, high = (solve_sweep(Case(profile=circle(0.3, (0.12, h)))) for h in (0.6, 0.75))
    real = measure(low, high, WINDOW)
    assert real.transitions["phase_b_start"].reference is None
    assert real.transitions["phase_b_start"].candidate is not None
    assert real.unsure() == []


@pytest.mark.parametrize("side", [0, 1])
def test_what_is_missing_where_a_sweep_is_not_trusted(side):
    """From before the end of Phase B on, or up to there."""
    after = np.arange(128) > np.flatnonzero(solved().table["phase"] == "tangent")[-10]
    for where, names in ((after, ["phase_b_end"]), (~after, ["phase_b_start"])):
        sweeps = [solved(), solved()]
        sweeps[side] = changed(solved(), status=np.where(where, "touches again", "ok"))
        missing = set(measure(*sweeps, WINDOW).not_trusted())
        assert set(names) <= missing
        assert not {"phase_b_start", "phase_b_end"} - set(names) & missing
    assert measure(solved(), changed(solved(), slice(0, 40)), WINDOW).not_trusted() == []


@pytest.mark.parametrize("seed", range(3))
def test_passes_differ_by_their_shift(seed):
    """A shift of 0.02 is found within its interval, and nothing but noise is left without it."""
    noise, rng = 1e-3, np.random.default_rng(seed)
    dense = solve_sweep(Case(BEAM, named_case("parabola").profile.scaled(2.0), Sweep(800)))
    size = relative_noise(dense, noise)
    passes = [sensed(noisy(dense, size, rng)) for _ in range(4)]
    alike = repeats(passes)
    assert alike.shifts.consistent
    assert np.all(alike.rms < noise)
    found = repeats([*passes[:3], without_offset(passes[3], -0.02)])
    assert not found.shifts.consistent
    assert found.shifts.farthest == 3
    shifts = found.shifts.numbers[:, 0]
    apart = shifts[3] - shifts[:3].mean()
    assert apart == pytest.approx(0.02, abs=3 * found.uncertainty[3] + 4e-4)  # slopes of the mean
    assert np.all(found.rms_without_shift < 1.3 * noise)


def test_the_exact_cantilever():
    """Against integration of the elastica; see tests/data/generate.py."""
    table = pd.read_csv(DATA / "cantilever_tip_load.csv")
    found = tip_of(table["PL2_EI"].to_numpy())
    expected = table[["w_over_L", "u_over_L"]].to_numpy()
    np.testing.assert_allclose(found, expected, atol=1e-12)
