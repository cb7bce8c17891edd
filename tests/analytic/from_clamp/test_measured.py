"""Which stations of a pass a fit is from."""

import numpy as np
import pytest

from analytic.from_clamp.calibration.measured import measured_under_load
from analytic.problem.beam import Beam
from analytic.problem.readings import Readings


def pass_of(force: np.ndarray) -> Readings:
    columns = {"foot_x": -np.arange(len(force)) / 100, "force_x": 0 * force, "force_y": force}
    return Readings.of({**columns, "moment_z": -force}, Beam())


@pytest.mark.parametrize(("behind", "last"), [([0.03, 0.04, 0.04, 0.03], 49), ([], 51)])
def test_a_pass_ends_where_the_force_falls_most(behind, last):
    """Noise that hardly jumps is a load by what it jumps: the vibrissa let go before it."""
    force = np.append(np.linspace(0.5, 1.0, 52), behind)
    noise = dict.fromkeys(("force_x", "force_y", "moment_z"), 1e-3)
    found = measured_under_load(pass_of(force), (0.0, 0.0), noise, 1)
    assert found.foot_x[-1] == pytest.approx(-last / 100)
