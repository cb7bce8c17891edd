"""The object from the clamp alone: exact readings, noisy ones, and none."""

import numpy as np
import pytest

from analytic import (
    Beam,
    Readings,
    named_case,
    reconstruct,
    reconstruct_by_decision,
    relative_noise,
    solve_sweep,
)


def missed(found, table):
    return np.hypot(
        found["contact_x"] - table["contact_x"], found["contact_y"] - table["contact_y"]
    )


def noisy(sweep: Readings, noise: dict[str, float], seed: int) -> Readings:
    rng = np.random.default_rng(seed)
    columns = {
        name: sweep.values(name) + deviation * rng.standard_normal(len(sweep.table))
        for name, deviation in noise.items()
    }
    return Readings(sweep.table.assign(**columns), sweep.beam)


@pytest.mark.parametrize("method", [reconstruct, reconstruct_by_decision])
def test_exact_readings(exact, method):
    found = method(exact)
    assert missed(found, exact.table).max() < 1e-13
    assert (found["phase"] == exact.table["phase"]).all()
    error = found["contact_arc_length"] - exact.table["contact_arc_length"]
    assert error.abs().max() < 1e-13


def test_only_the_clamp_is_looked_at(exact):
    bare = Readings(exact.table[["foot_x", "force_x", "force_y", "moment_z"]], exact.beam)
    np.testing.assert_array_equal(reconstruct(bare)["contact_x"], reconstruct(exact)["contact_x"])


def test_in_other_units():
    from dataclasses import replace

    case = named_case("catenary")
    beam = Beam(50.0, 7.0, 0.25)
    large = solve_sweep(replace(case, beam=beam, profile=case.profile.scaled(50.0)))
    assert missed(reconstruct(large), large.table).max() < 50 * 1e-13


@pytest.mark.parametrize("level", [1e-4, 1e-2])
def test_uncertainty_covers_the_error(exact, level):
    """95 % of the contacts of 30 noisy sweeps lie within what is stated: 5,000, so +-1 %."""
    noise = relative_noise(exact, level)
    covered = counted = 0
    for seed in range(30):
        found = reconstruct(noisy(exact, noise, seed), noise, seed + 1000)
        sure = np.isfinite(found["uncertainty"]) & exact.table["contact_x"].notna()
        error = missed(found, exact.table)
        covered += int((error <= found["uncertainty"])[sure].sum())
        counted += int(sure.sum())
    assert counted > 4000
    assert 0.935 < covered / counted < 0.965


def test_uncertainty_grows_with_the_noise(exact):
    small, large = (
        reconstruct(exact, relative_noise(exact, level))["uncertainty"] for level in (1e-4, 1e-3)
    )
    both = np.isfinite(small) & np.isfinite(large)
    assert np.median((large / small)[both]) == pytest.approx(10, rel=0.1)


def test_readings_that_no_elastica_has():
    """A moment too large for its force is told, not made up."""
    sweep = solve_sweep(named_case("parabola"))
    found = reconstruct(Readings(sweep.table.assign(moment_z=100.0), sweep.beam))
    touching = sweep.table["phase"] != "free"
    assert (found["phase"][touching] == "unexplained").all()
    assert found["contact_x"].isna().all()
