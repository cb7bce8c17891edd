"""Many contacts at once: a few are solved, and the others start from those beside them."""

from typing import NamedTuple

import numpy as np

from analytic.numerics.hermite import hermite
from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.contour import Contour
from analytic.solver.general.states import Vibrissa, states, with_rates

_CHUNK = 8192  # contacts at a time: their arrays stay in the cache
_STEPS = 4  # of Newton's method with the slopes of the contact beside
_CLOSE = 1e-14  # L, rad; of the misses, some roundings


class Nodes(NamedTuple):
    """Contacts that are solved, by ascending contour parameter; m of them.

    ``z`` has shape (m, 2): force and excess; ``rate`` is its derivative by the contour parameter;
    ``inverse`` that of the misses' derivatives by it, shape (m, 2, 2).
    """

    t: Floats
    z: Floats
    rate: Floats
    inverse: Floats


def nodes(contour: Contour, vibrissa: Vibrissa, t: Floats, z: Floats) -> Nodes:
    """What solved contacts say of those beside them."""
    _, rates = with_rates(contour.at(t), z[:, 0], z[:, 1], vibrissa)
    slopes = np.stack([rates.slope_residual, rates.height_residual], axis=1)
    a, b, c, d = slopes[:, 0, 1], slopes[:, 0, 2], slopes[:, 1, 1], slopes[:, 1, 2]
    with np.errstate(all="ignore"):
        inverse = np.moveaxis(np.array([[d, -b], [-c, a]]) / (a * d - b * c), -1, 0)
        rate = -np.einsum("njk,nk->nj", inverse, slopes[:, :, 0])
    return Nodes(t, z, rate, inverse)


def between(
    contour: Contour, vibrissa: Vibrissa, known: Nodes, t: Floats
) -> tuple[Floats, Booleans]:
    """Contacts that start from Hermite's cubic between their neighbours."""
    z, found = np.empty((len(t), 2)), np.zeros(len(t), dtype=bool)
    for begin in range(0, len(t), _CHUNK):
        part = slice(begin, begin + _CHUNK)
        z[part], found[part] = _between(contour, vibrissa, known, t[part])
    return z, found


def _between(
    contour: Contour, vibrissa: Vibrissa, known: Nodes, t: Floats
) -> tuple[Floats, Booleans]:
    left = np.clip(np.searchsorted(known.t, t, side="right") - 1, 0, len(known.t) - 2)
    with np.errstate(all="ignore"):  # next to a contact that there is not
        width = (known.t[left + 1] - known.t[left])[:, None]
        share = (t - known.t[left])[:, None] / width
        ends = (values for i in (left, left + 1) for values in (known.z[i], width * known.rate[i]))
        force, excess = hermite(share, *ends).T
        inside = known.z[left, 1] < 0
        alike = inside == (known.z[left + 1, 1] < 0)
        smooth = ~_has_break(contour, known.t[left], known.t[left + 1])
        hopeful = np.flatnonzero(alike & smooth & (force >= 0) & ((excess < 0) == inside))
    found = np.zeros(len(t), dtype=bool)
    point = contour.at(t[hopeful])
    f, w = force[hopeful], excess[hopeful]
    (a, b), (c, d) = np.moveaxis(known.inverse[left[hopeful]], 0, -1)
    for _ in range(_STEPS):
        here = states(point, np.maximum(f, 0.0), w, vibrissa)
        slope_residual, height_residual = here.slope_residual, here.height_residual
        close = np.maximum(np.abs(slope_residual), np.abs(height_residual)) <= _CLOSE
        if close.all():
            break
        f = np.where(close, f, f - (a * slope_residual + b * height_residual))
        w = np.where(close, w, w - (c * slope_residual + d * height_residual))
    found[hopeful] = close & ((w < 0) == inside[hopeful])
    return np.stack([_put(force, hopeful, f), _put(excess, hopeful, w)], axis=1), found


def _put(values: Floats, where: Integers, new: Floats) -> Floats:
    values = values.copy()
    values[where] = new
    return values


def _has_break(contour: Contour, begin: Floats, end: Floats) -> Booleans:
    breaks = contour.breaks()
    return np.asarray(np.searchsorted(breaks, begin) != np.searchsorted(breaks, end))
