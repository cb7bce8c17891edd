"""What an earlier method is given, and what it answers."""

from typing import NamedTuple

from analytic.problem.arrays import Booleans, Floats


class LoadedStations(NamedTuple):
    """Loaded stations of a sweep, arrays of shape (n,)."""

    foot_x: Floats  # foot position [L]
    across: Floats  # force of the clamp across the vibrissa, -F_x, Q in the formulas [EI/L^2]
    along: Floats  # force of the clamp along the vibrissa, F_y, P in the formulas [EI/L^2]
    moment: Floats  # moment of the clamp, M [EI/L]
    travel: Floats  # way of the foot since the first contact [L]


class Answer(NamedTuple):
    """The contact on the vibrissa's axis, arrays of shape (n,); NaN where there is no answer."""

    x: Floats
    y: Floats  # position [L]

    def where(self, valid: Booleans) -> "Answer":
        """The same, with no answer where a method's assumptions do not hold."""
        return Answer(*(_masked(values, valid) for values in self))


def _masked(values: Floats, valid: Booleans) -> Floats:
    found = values.copy()
    found[~valid] = float("nan")
    return found
