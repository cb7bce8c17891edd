"""The elastica integrated from the clamp: what the closed forms are checked against."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np

from analytic.numerics.arrays import Floats

Quantity: TypeAlias = Callable[[Floats], Floats]
"""A quantity along the vibrissa, dimensionless, element by element."""

_MARKS = np.linspace(0, 1, 17)[1:]  # parts of the span at which its slope is looked at


def _none(s: Floats) -> Floats:
    return np.zeros_like(s)


class End(NamedTuple):
    """The state at the end of each span, shape (n,): position, slope angle, moment."""

    x: Floats
    y: Floats
    phi: Floats
    moment: Floats  # positive where it adds to the curvature [EI/L]
    least_phi: Floats  # smallest slope angle on the way, at 16 places [rad]


def integrate_span(
    force_x: Floats,
    force_y: Floats,
    moment: Floats,
    length: Floats,
    tolerance: float = 1e-13,
    compliance: float = 0.0,
    clamp_angle: float | Floats = 0.0,
    natural: Quantity = _none,
    flexibility: Quantity = np.ones_like,
    breaks: Sequence[float] | Floats = (),
    weight: tuple[float, float] = (0.0, 0.0),
    begin: float | Floats = 0.0,
) -> End:
    """March from the clamp along the loaded span (Will et al., eqs. 4 and 15)."""
    from scipy.integrate import solve_ivp  # slow to load, and a plain sweep needs none of it

    n = len(moment)

    def rate(share: float, state: Floats, low: Floats, length: Floats) -> Floats:
        phi, m = state.reshape(4, n)[2:]
        cos, sin = np.cos(phi), np.sin(phi)
        s = low + share * length
        kappa = natural(s) + m * flexibility(s)
        carried_x, carried_y = (w * (s - begin) for w in weight)
        bends = (force_y + carried_y) * cos - (force_x + carried_x) * sin
        return np.concatenate([length * cos, length * sin, length * kappa, length * bends])

    state = np.concatenate(
        [np.zeros(2 * n), np.pi / 2 + clamp_angle - compliance * moment, -moment]
    )
    least_phi = np.full(n, np.inf)
    for low, high in pairwise([0.0, *breaks, 1.0]):
        first, last = (np.minimum(np.maximum(at, begin), length) for at in (low, high))
        found = solve_ivp(
            rate,
            (0.0, 1.0),
            state,
            method="DOP853",
            rtol=tolerance,
            atol=tolerance,
            t_eval=_MARKS,
            args=(first, last - first),
        )
        state = found.y[:, -1]
        least_phi = np.minimum(least_phi, found.y.reshape(4, n, len(_MARKS))[2].min(axis=1))
    x, y, phi, m = state.reshape(4, n)
    return End(x, y, phi, m, least_phi)


def march(rate: Callable[[Floats], Floats], state: Floats, length: Floats, steps: int) -> Floats:
    """The classical Runge-Kutta method of order 4, with equal steps."""
    h = length / steps
    states = [state]
    for _ in range(steps):
        k1 = rate(state)
        k2 = rate(state + h / 2 * k1)
        k3 = rate(state + h / 2 * k2)
        k4 = rate(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        states.append(state)
    return np.stack(states)
