"""Where Newton's method starts: close to the state, at folds and first contact too."""

import numpy as np
import pytest

from analytic import named_case
from analytic.problem.contours.many import Contours
from analytic.solver.branch import trace
from analytic.solver.starts import located
from analytic.solver.stations import solve_stations


@pytest.mark.parametrize("name", ["catenary", "parabola", "two-circles", "tip-only"])
def test_starts_are_near_the_states(name: str) -> None:
    case = named_case(name)
    contours = Contours([case.centreline])
    branches = trace(contours, [case.reach])
    first, last = branches[0].foot_x[[0, -1]]
    # Dense at both ends, where x0 moves like a root and folds.
    share = (1 - np.cos(np.linspace(0, np.pi, 402)[1:-1])) / 2
    foot_x = first + (last - first) * share
    _, starts = located(contours, branches, [foot_x])
    states = solve_stations(contours, branches, [foot_x])
    apart = np.abs(starts.t - states.point.alpha), np.abs(starts.tip_rotation - states.tip_rotation)
    in_a = ~states.tangent
    # Newton's method squares what it is off: from 1e-6 one step comes to rounding, from 1e-3 two.
    # Observed 3e-8, 8e-8, and 1.5e-4 next to a fold, where the foot hardly moves.
    assert np.median(apart[0]) < 1e-6
    assert np.median(apart[1][in_a]) < 1e-6
    assert apart[0].max() < 1e-3
