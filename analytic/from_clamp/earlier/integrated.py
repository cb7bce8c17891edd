"""Methods that integrate the elastica from the clamp to where its moment vanishes."""

from collections.abc import Callable

import numpy as np

from analytic.from_clamp.earlier.sensed import Answer, LoadedStations
from analytic.numerics.vectors import cross
from analytic.problem.arrays import Floats

_TOLERANCE = 1e-13
_PLACES = np.linspace(0, 1, 129)  # among which the moment's first zero is looked for [L]
_NEWTON = 4  # steps from there on; the third is at rounding
_BLOCK = 500  # stations that are integrated together
_AT_TIP = 0.05  # of the clamp's moment may be left at the tip: the errors of good readings


def up_to_zero(sensed: LoadedStations) -> Answer:
    """Integrate the elastica up to the first zero of its moment, or to the tip.

    In the plane: G. R. Scholz and C. D. Rahn, Profile sensing with an actuated whisker, IEEE
    Transactions on Robotics and Automation 20, 2004; in space: `spatial_contact`.
    """
    none = np.zeros_like(sensed.foot_x)
    force = np.column_stack([-sensed.across, sensed.along, none])
    moment = np.column_stack([none, none, sensed.moment])
    place = spatial_contact(force, moment, np.tile([0.0, 1.0, 0.0], (len(none), 1)))
    return Answer(sensed.foot_x + place[:, 0], place[:, 1])


def spatial_contact(force: Floats, moment: Floats, tangent: Floats) -> Floats:
    """The contact of a straight isotropic vibrissa under one force, in space.

    r' = t, t' = t x m, m = M - r x F, up to where m vanishes: T. N. Clements and C. D. Rahn,
    Three-dimensional contact imaging with an actuated whisker, IEEE Transactions on Robotics 22,
    2006.
    """
    starts = range(0, len(force), _BLOCK)
    blocks = [[given[i : i + _BLOCK] for given in (force, moment, tangent)] for i in starts]
    return np.concatenate([np.zeros((0, 3)), *(_in_space(*block) for block in blocks)])


def _in_space(force: Floats, moment: Floats, tangent: Floats) -> Floats:
    size = np.linalg.norm(moment, axis=1)
    force, moment = force.T, moment.T
    axis = moment / size

    def rate(state: Floats) -> Floats:
        r, t = state[:3], state[3:]
        return np.concatenate([t, cross(t, moment - cross(r, force))])

    def left(state: Floats) -> tuple[Floats, Floats]:
        r, t = state[:3], state[3:]
        m = moment - cross(r, force)
        return (m * axis).sum(axis=0), (cross(force, t) * axis).sum(axis=0)

    start = np.concatenate([np.zeros_like(force), tangent.T])
    return _up_to_zero(rate, start, left, size)[:3].T


def _up_to_zero(
    rate: Callable[[Floats], Floats],
    start: Floats,
    left: Callable[[Floats], tuple[Floats, Floats]],
    size: Floats,
) -> Floats:
    """States of shape (m, n) at the first zero of what is `left`, or at the tip; NaN if neither.

    `left` returns the moment that is left at a state, and its rate; `size` is what it is at first.
    """
    m, n = start.shape
    from scipy.integrate import solve_ivp  # slow to load, and few methods need it

    way = solve_ivp(
        lambda _, state: rate(state.reshape(m, n)).ravel(),
        (0.0, 1.0),
        start.ravel(),
        method="DOP853",
        rtol=_TOLERANCE,
        atol=_TOLERANCE,
        dense_output=True,
    ).sol
    assert way is not None  # asked for

    def at(s: Floats) -> Floats:
        """Each station's state at its own arc length."""
        found = np.empty((m, n))
        for piece in np.unique(np.searchsorted(way.ts, s, side="left")):
            here = np.searchsorted(way.ts, s, side="left") == piece
            every = way(s[here]).reshape(m, n, -1)
            found[:, here] = every[:, np.flatnonzero(here), np.arange(here.sum())]
        return found

    profile = np.array([left(way(s).reshape(m, n))[0] for s in _PLACES])
    falls = (profile[:-1] > 0) & (profile[1:] <= 0)
    crosses = falls.any(axis=0)
    last = np.where(crosses, falls.argmax(axis=0) + 1, len(_PLACES) - 1)
    s = _PLACES[last]
    for _ in range(_NEWTON):
        value, slope = left(at(s))
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(slope < 0, value / slope, 0.0)
        s = np.clip(s - step, _PLACES[last - 1], _PLACES[last])
    return np.where(crosses | (profile[-1] < _AT_TIP * size), at(s), np.nan)
