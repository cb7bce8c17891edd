"""What a fault adds to the clamp readings, by sweeps that are interpolated."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Beam, Case, Readings, Sweep, named_case, solve_sweep
from compare.explain import signatures
from tests.conftest import exact_sweep


@pytest.mark.parametrize(("unsolved", "bridged"), [(slice(80, 85), True), (slice(80, 100), False)])
def test_a_few_unsolved_stations_are_interpolated_over_and_a_stretch_is_not(
    monkeypatch, unsolved, bridged
):
    exact = exact_sweep("parabola")
    table = exact.table.copy()
    table.loc[table.index[unsolved], list(CLAMP_READINGS)] = np.nan
    table.loc[table.index[unsolved], "status"] = "diverged"
    swept = Readings(table, exact.beam)
    monkeypatch.setattr(signatures, "solve_sweep", lambda case: swept)
    case = replace(named_case("parabola"))  # one that no sweep is kept of
    at = signatures.between(exact.values("foot_x")[unsolved], *signatures._sweep(case))
    assert np.isfinite(at).all() == bridged
    if bridged:
        known = [exact.values(name)[unsolved] for name in CLAMP_READINGS]
        np.testing.assert_allclose(at, known, atol=6e-3)  # curved over six steps of 200
    signatures._sweep.cache_clear()


RESOLVED = Case(
    Beam(0.05, 2e-6, 2.5e-4, natural_curvature=-2.0, tip_radius=2e-4),
    named_case("parabola").profile.scaled(0.05),
    Sweep(60),
    clamp_stiffness=20 * 2e-6 / 0.05,
    friction=0.1,
)
SIZE = 2e-3
BEAM = RESOLVED.beam


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fault", "changed"),
    [
        ("length", replace(RESOLVED, beam=replace(BEAM, length=0.05 * (1 + SIZE)))),
        ("radius", replace(RESOLVED, beam=replace(BEAM, radius=BEAM.radius + SIZE * 0.05))),
        ("clamp_compliance", replace(RESOLVED, clamp_stiffness=2e-6 / 0.05 / (1 / 20 + SIZE))),
        ("friction", replace(RESOLVED, friction=0.1 + SIZE)),
        (
            "natural_curvature",
            replace(RESOLVED, beam=replace(BEAM, natural_curvature=-2.0 + SIZE / 0.05)),
        ),
        ("tip_radius", replace(RESOLVED, beam=replace(BEAM, tip_radius=2e-4 - SIZE * BEAM.radius))),
    ],
)
def test_each_fault_has_its_sign_and_its_unit(fault, changed):
    exact = solve_sweep(RESOLVED)
    touching = (exact.table["phase"] != "free").to_numpy()
    foot_x = exact.values("foot_x")[touching][2:-6]
    added = signatures.Resolved.of(exact, foot_x).change(fault, SIZE)
    first, last = RESOLVED.foot_x[[0, -1]].tolist()
    swept = solve_sweep(replace(changed, sweep=Sweep(60, first + 1e-3, last)))

    def at(sweep):
        x = sweep.values("foot_x")
        return np.stack([np.interp(foot_x, x[::-1], sweep.values(n)[::-1]) for n in CLAMP_READINGS])

    dense = solve_sweep(replace(RESOLVED, sweep=Sweep(60, first + 1e-3, last)))
    for true, seen in zip(at(swept) - at(dense), added, strict=True):
        apart = np.quantile(np.abs(true - seen), 0.8)
        assert apart < 0.1 * np.abs(true).max()
