"""A clamp that turns, or goes any way, in motion: limits, and the sweep at rest."""

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Case, ClampPath, Sweep, Whisk, circle
from compare.simulate.dispatch import softened
from mujoco_models import Motion, Settings, simulate_motion, simulate_sweep

CIRCLE = circle(1.0, lowest=(0.0, 0.4))
SETTINGS = Settings(segments=10, contour_points=400)
_S = np.linspace(0, 1, 12)
TURNS = Case(profile=CIRCLE, sweep=Whisk(0.4, -0.55, 1.2, 12))
MOVES = Case(profile=CIRCLE, sweep=ClampPath(0.6 - 0.3 * _S, 0.05 * _S**2, 1.4 * _S - 0.4))


def test_a_path_along_x_moves_as_the_sweep():
    sweep = Case(profile=CIRCLE, sweep=Sweep(9, 1.0, -1.0))
    path = Case(profile=CIRCLE, sweep=ClampPath(sweep.foot_x, np.zeros(9), np.zeros(9)))
    motion = Motion(speed=0.5)
    expected, found = (simulate_motion(case, motion, SETTINGS) for case in (sweep, path))
    # Steps begin elsewhere by rounding, and contacts that bounce magnify it.
    for name in CLAMP_READINGS:
        np.testing.assert_allclose(found.values(name), expected.values(name), atol=1e-6)
    np.testing.assert_array_equal(found.values("foot_x"), expected.values("foot_x"))


@pytest.mark.slow
@pytest.mark.parametrize("case", [TURNS, MOVES], ids=["turns", "moves and turns"])
def test_the_slower_the_nearer_to_rest(case):
    motions = [
        Motion(speed=v, damping_ratio=0.5, contact_stiffness=1e4, average=0.0) for v in (0.2, 0.05)
    ]
    rest = simulate_sweep(case, softened(SETTINGS, motions[0]))
    off = []
    for motion in motions:
        moved = simulate_motion(case, motion, SETTINGS)
        values = [moved.values(n) - rest.values(n) for n in CLAMP_READINGS]
        scale = [np.abs(rest.values(n)).max() for n in CLAMP_READINGS]
        off.append(np.sqrt(np.mean(np.square(values), axis=1)) / scale)
        np.testing.assert_array_equal(moved.clamp_angle, rest.clamp_angle)
        np.testing.assert_allclose(moved.values("contact_x"), rest.values("contact_x"), atol=0.02)
    assert off[0].max() < 0.05
    assert (off[1] < off[0] / 2).all()
