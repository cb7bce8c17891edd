"""Newton's steps made better by what the last ones did.

Where what the solver knows of a contact is not quite its stiffness, as where a tip and a side share
a soft corner, Newton's steps come nearer by the same factor each time, which may be 0.97. The last
few show how a step changes with the place it is taken at, and so where there would be none.
"""

from collections import deque

import numpy as np

from analytic.numerics.arrays import Floats

_AWAITED = 2  # steps, before there is anything to be seen
_KEPT = 6  # differences of steps: in as many directions the stiffness may be off
_CUT = 1e-6  # of the largest difference: directions below it are rounding


class Secant:
    """Anderson's acceleration of a fixed-point iteration (J. ACM 12, 1965)."""

    def __init__(self) -> None:
        self._places: deque[Floats] = deque(maxlen=_KEPT + 1)
        self._steps: deque[Floats] = deque(maxlen=_KEPT + 1)

    def better(self, angles: Floats, step: Floats) -> Floats:
        """The step to where Newton's would be zero, by those before it."""
        self._places.append(angles)
        self._steps.append(step)
        if len(self._steps) <= _AWAITED:
            return step
        changes, moves = np.diff(self._steps, axis=0), np.diff(self._places, axis=0)
        # What counts is by how much links turn, not joints.
        turns = np.cumsum(changes, axis=1).T
        share = np.linalg.lstsq(turns, np.cumsum(step), rcond=_CUT)[0]
        return np.asarray(step - share @ (changes + moves))
