"""A sweep in motion: the files, and that they show what the readings say."""

from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from analytic import InputError, curvatures, deflected_shapes
from compare.show.animation.plane import write_animation
from tests.compare.show import sweeps


@pytest.mark.slow
def test_files(tmp_path):
    exact, simulated = sweeps.exact("two-circles"), sweeps.candidate("two-circles")
    drawn = []
    written = write_animation(exact, simulated, tmp_path, 6, lambda: drawn.append(1))
    names = ["animation.gif", *(f"still-{n}.png" for n in (1, 2, 3, 4))]
    assert [path.name for path in written] == names
    assert sorted(path.name for path in tmp_path.iterdir()) == names  # nothing unfinished
    assert len(drawn) == 6
    with Image.open(tmp_path / "animation.gif") as film:
        assert film.n_frames == 6
        assert film.size == (800, 640)
        frames = []
        for i in range(film.n_frames):
            film.seek(i)
            frames.append(np.asarray(film.convert("RGB"), dtype=int))
    assert (tmp_path / "animation.gif").stat().st_size < 1e6
    changed = [np.abs(b - a).max(axis=2) > 0 for a, b in pairwise(frames)]
    assert all(0.002 < c.mean() < 0.3 for c in changed)
    # Axes, labels and the object in the strip above stay where they are.
    still = ~np.logical_or.reduce(changed)
    assert still[:, :45].all()
    assert still.mean() > 0.6


def test_too_few_frames(tmp_path):
    with pytest.raises(InputError, match="--frames = 1: must be 2 or more"):
        write_animation(sweeps.exact("two-circles"), sweeps.exact("two-circles"), tmp_path, 1)


def test_curvature_is_how_fast_the_centreline_turns(exact):
    x, y = deflected_shapes(exact)
    kappa = curvatures(exact, x, y)
    dx, dy = np.diff(x)[:, :-1], np.diff(y)[:, :-1]  # the last part is straight
    slope = np.unwrap(np.arctan2(dy, dx))
    turning = np.diff(slope) / np.hypot(dx, dy)[:, 1:]
    np.testing.assert_allclose(kappa[:, 1:-2], turning, atol=5e-3 * np.abs(kappa).max())
    assert np.abs(kappa[:, -2:]).max() < 1e-6  # the contact and the tip carry no moment
    np.testing.assert_allclose(kappa[:, 0], -exact.values("moment_z"), atol=1e-12)
