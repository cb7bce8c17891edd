"""Small systems of equations, many at a time, by Newton's method with Broyden's updates (1965)."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from analytic.numerics.arrays import Floats, Integers

Misses: TypeAlias = Callable[[Floats, Integers], Floats]
"""Maps unknowns, shape (m, k), of the systems listed, shape (m,), to their misses, shape (m, k);
NaN where they have no meaning."""
Jacobian: TypeAlias = Callable[[Floats, Integers], Floats]
"""The same to the derivatives of the misses, shape (m, k, k)."""

_ITERATIONS = 40
_EXACT = 2 * float(np.finfo(float).eps)
_DONE = 1e-13  # of a miss: from here on only as long as it still falls
_POOR = 0.1  # of a miss left by a step: then the Jacobian is taken anew
_LEAST = 1 / 64  # of a step whose parts make a miss larger, too


def solve(misses: Misses, jacobian: Jacobian, start: Floats) -> tuple[Floats, Floats]:
    z = np.array(start, dtype=float)
    everywhere = np.arange(len(z))
    values = misses(z, everywhere)
    missed = _largest(values)
    slopes = jacobian(z, everywhere)
    share = np.ones(len(z))
    fresh = np.ones(len(z), dtype=bool)
    for _ in range(_ITERATIONS):
        active = np.flatnonzero((missed > _EXACT) & np.isfinite(missed) & (share > _LEAST))
        if active.size == 0:
            break
        step = _step(slopes[active], values[active]) * share[active, None]
        at = z[active] - step
        new = misses(at, active)
        size = _largest(new)
        better = size < missed[active]
        poor = ~(size < _POOR * missed[active])
        rounding = poor & (missed[active] < _DONE)
        slopes[active] = _updated(slopes[active], step, values[active] - new)
        share[active] = np.where(better, np.minimum(1.0, 2 * share[active]), share[active] / 2)
        share[active[rounding]] = 0.0
        again = active[poor & ~rounding & (better | ~fresh[active])]
        fresh[active] = False
        won = active[better]
        z[won], values[won], missed[won] = at[better], new[better], size[better]
        if again.size:
            slopes[again], fresh[again] = jacobian(z[again], again), True
            share[again] = 1.0
    return z, missed


def _largest(values: Floats) -> Floats:
    largest = np.abs(values).max(axis=1)
    return np.where(np.isnan(largest), np.inf, largest)


def _step(slopes: Floats, values: Floats) -> Floats:
    regular = np.flatnonzero(np.isfinite(slopes).all(axis=(1, 2)))
    regular = regular[np.linalg.det(slopes[regular]) != 0]
    step = np.zeros_like(values)
    step[regular] = np.linalg.solve(slopes[regular], values[regular][..., None])[..., 0]
    return step


def _updated(slopes: Floats, step: Floats, change: Floats) -> Floats:
    """Broyden's update by a step that changed the misses by -`change`."""
    lack = change - np.einsum("njk,nk->nj", slopes, step)
    square = np.einsum("nk,nk->n", step, step)
    with np.errstate(all="ignore"):
        update = np.einsum("nj,nk->njk", lack, step) / square[:, None, None]
    return slopes + np.where(np.isfinite(update), update, 0.0)
