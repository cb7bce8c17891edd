"""Where a cause begins to be named: slopes by phase, spikes, and two causes that fit alike."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline

from compare import Tolerances
from compare.explain.causes import slopes
from compare.explain.likely import likely_cause
from compare.judge.allowance import NoiseAllowance
from compare.measure.measurement import measure
from tests.compare.synthetic import changed, solved


def named(force_y: np.ndarray, contour: bool = False) -> str | None:
    """The cause of a disagreement in force_y alone, with causes that need the contour or not."""
    exact = solved() if contour else replace(solved(), provenance={})
    found = measure(exact, changed(exact, force_y=force_y), 5e-3)
    return likely_cause(found, Tolerances(), NoiseAllowance())


def test_slopes_are_of_one_phase_each():
    """Up to its last station; a stretch of three has none."""
    x = np.linspace(1.0, -0.5, 14)
    phase = np.repeat(["tip", "tangent", "tip"], [4, 7, 3])
    values = np.stack([np.sin(k * x) + (phase == "tangent") for k in (1, 2, 3)])
    found = slopes(pd.DataFrame({"foot_x": x, "phase": phase}), values)
    for here in (slice(0, 4), slice(4, 11)):
        order = np.argsort(x[here])
        spline = CubicSpline(x[here][order], values[:, here][:, order], axis=-1)
        np.testing.assert_allclose(found[:, here], spline(x[here], 1), rtol=1e-10)
    assert np.isnan(found[:, 11:]).all()


@pytest.mark.parametrize(
    ("times", "spikes", "single"), [(25, 4, True), (15, 4, False), (25, 7, False)]
)
def test_single_stations_are_few_and_far_off(times, spikes, single):
    """More than twenty times the median, and at most one in twenty: of 110 in contact, five."""
    force = solved().values("force_y").copy()
    touching = np.flatnonzero(solved().table["phase"] != "free")
    error = 1e-4 * np.abs(force).max() * np.where(np.arange(len(force)) // 2 % 2, 1.0, -1.0)
    at = touching[10 : 10 + 8 * spikes : 8]
    error[at] *= times
    force[touching] += error[touching]
    assert str(named(force)).startswith("single stations") == single


@pytest.mark.parametrize(
    ("other", "contour", "clear"),
    [(0.2, False, True), (0.3, False, False), (1.0, True, False)],
)
def test_of_two_that_fit_alike_none_is_named(other, contour, clear):
    """A zero and a drift of the same rms, 30 degrees apart: half-way both leave sin^2 of 15.

    A tenth may be left, as rms, where no other cause can be solved for: 0.09 and 0.12 are.
    """
    force = solved().values("force_y")
    touching = np.flatnonzero(solved().table["phase"] != "free")
    error = np.zeros(len(force))
    error[touching] = 1 + other * np.sqrt(3) * np.linspace(0, 1, len(touching))
    assert (named(force + 0.02 * force.max() * error, contour) is not None) == clear


@pytest.mark.parametrize(("jumps", "noise"), [(0.75, True), (0.3, False)])
def test_half_of_the_square_has_to_jump_to_be_noise(jumps, noise):
    """Beside a slow wave that is no other cause."""
    force = solved().values("force_y")
    touching = (force != 0).astype(float)
    white = np.random.default_rng(6).standard_normal(len(force))
    wave = np.sqrt(2) * np.sin(np.arange(len(force)) / 6)
    error = np.sqrt(jumps) * white + np.sqrt(1 - jumps) * wave
    assert str(named(force + 0.02 * force.max() * error * touching)).startswith("noise") == noise
