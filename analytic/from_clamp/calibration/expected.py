"""What the clamp of a vibrissa reads at any foot positions, by the closed form."""

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS
from analytic.solver.general.sweep import solve

_MIRRORED = np.array([[-1.0], [1.0], [-1.0]])  # force_x, force_y and moment_z, x to -x


def expected_readings(case: Case, foot_x: Floats) -> Floats:
    """Force and moment at the clamp, as the case's vibrissa has them at the stations of a sweep.

    Parameters
    ----------
    case : Case
        The problem; its direction counts, but not its own stations.
    foot_x : array, shape (n,)
        In the order of the sweep [length].

    Returns
    -------
    array, shape (3, n)
        In the case's units; zero before the first contact, NaN where the vibrissa has let go or has
        no state that slides on.
    """
    rightward = case.sweep.direction == "right"
    leftward, stations = (case.mirrored(), -foot_x) if rightward else (case, foot_x)
    solved = solve(leftward, stations)
    found = np.zeros((len(CLAMP_READINGS), len(foot_x)))
    found[:, solved.where] = [
        np.where(solved.columns["status"] == "ok", solved.columns[name], np.nan)
        for name in CLAMP_READINGS
    ]
    first = solved.events["first_contact"]
    assert first is not None
    found[:, ~solved.where & (stations < first * case.beam.length)] = np.nan
    return found * _MIRRORED if rightward else found
