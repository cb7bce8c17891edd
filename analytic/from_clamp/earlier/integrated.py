"""The elastica integrated from the clamp to where its moment vanishes."""

import numpy as np

from analytic.from_clamp.earlier.sensed import Answer, LoadedStations
from analytic.problem.arrays import Floats

_TOLERANCE = 1e-13
_PLACES = np.linspace(0, 1, 129)  # among which the moment's first zero is looked for [L]
_NEWTON = 4  # steps from there on; the third is at rounding
_BLOCK = 500  # stations that are integrated together
_AT_TIP = 0.05  # of the clamp's moment may be left at the tip: the errors of good readings


def up_to_zero(sensed: LoadedStations) -> Answer:
    """Integrate the elastica up to the first zero of its moment, or to the tip.

    In the plane: G. R. Scholz and C. D. Rahn, Profile sensing with an actuated whisker, IEEE
    Transactions on Robotics and Automation 20, 2004. In space it is T. N. Clements and C. D. Rahn,
    Three-dimensional contact imaging with an actuated whisker, IEEE Transactions on Robotics 22,
    2006, and a sweep in a plane is the same.
    """
    starts = range(0, len(sensed.moment), _BLOCK)
    blocks = [LoadedStations(*(values[i : i + _BLOCK] for values in sensed)) for i in starts]
    x, y = np.concatenate([np.zeros((2, 0)), *map(_contacts, blocks)], axis=1)
    return Answer(sensed.foot_x + x, y)


def _contacts(sensed: LoadedStations) -> Floats:
    """Contacts as seen from the foot, (2, n); NaN where too much moment is left at the tip."""
    from scipy.integrate import solve_ivp  # slow to load, and few methods need it

    n = len(sensed.moment)

    def left(state: Floats) -> Floats:
        x, y, _ = state
        return np.asarray(sensed.moment - sensed.along * x - sensed.across * y)

    def rate(_: float, state: Floats) -> Floats:
        here = state.reshape(3, n)
        return np.concatenate([np.cos(here[2]), np.sin(here[2]), -left(here)])

    start = np.repeat([0.0, 0.0, np.pi / 2], n)
    way = solve_ivp(
        rate,
        (0.0, 1.0),
        start,
        method="DOP853",
        rtol=_TOLERANCE,
        atol=_TOLERANCE,
        dense_output=True,
    ).sol
    assert way is not None  # asked for

    def at(s: Floats) -> Floats:
        """Each station's state at its own arc length."""
        return np.asarray(np.einsum("knn->kn", way(s).reshape(3, n, n)))

    profile = np.array([left(way(s).reshape(3, n)) for s in _PLACES])
    falls = (profile[:-1] > 0) & (profile[1:] <= 0)
    crosses = falls.any(axis=0)
    last = np.where(crosses, falls.argmax(axis=0) + 1, len(_PLACES) - 1)
    s = _PLACES[last]
    for _ in range(_NEWTON):
        here = at(s)
        falling = sensed.along * np.cos(here[2]) + sensed.across * np.sin(here[2])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(falling > 0, left(here) / falling, 0.0)
        s = np.clip(s + step, _PLACES[last - 1], _PLACES[last])
    near_tip = np.abs(profile[-1]) < _AT_TIP * sensed.moment
    return np.where(crosses | near_tip, at(s)[:2], np.nan)
