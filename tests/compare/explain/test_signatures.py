"""What a fault adds to the clamp readings, by sweeps that are interpolated."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Readings, named_case
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
