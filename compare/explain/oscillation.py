"""How a beam of segments errs as its contact passes from segment to segment.

A joint bends for its whole cell. Of the cell that the contact is in only the part before the
contact bends, by a moment that falls to zero there. With the load f, the distance d of the contact
from the joint before it and the link's length h, the slope at the contact is off by
f (d - h/2)^2/(2 EI): the integral of the moment over half a cell before the joint and the distance
d behind it, less the joint's rotation f d h/EI. As the contact moves that oscillates between 0 and
f h^2/(8 EI), once a segment, and falls no faster with h than the beam's error does. Sweeps with
other segments oscillate at other places, so that no extrapolation from sweep to sweep takes it out.
But where each of them oscillates is known, and by how much shows in their differences.
"""

from collections.abc import Sequence

import numpy as np

from analytic.numerics.arrays import Booleans, Floats

_STATIONS = 10  # to an interval of the spline that the amplitude is
_FEWEST = 20  # stations that it is worth taking from
_MEAN = 1 / 12  # of (d/h - 1/2)^2, which the power of h has


def without_oscillation(
    runs: Sequence[Floats],
    joints: Sequence[Floats],
    contact: Floats,
    tangent: Booleans,
    power: Floats,
) -> list[Floats]:
    """Sweeps of three numbers of segments, each less what it oscillates by in Phase B."""
    count = int(tangent.sum())
    if count < _FEWEST:
        return list(runs)
    oscillations = np.stack([_oscillation(at, contact[tangent]) for at in joints])
    # What neither the limit nor the power of h has part in: only the oscillation is left in it.
    differences = np.cross(np.ones(3), power)
    left = np.tensordot(differences, np.stack(runs)[:, :, tangent], axes=1)
    basis = _basis(count)
    amplitude, *_ = np.linalg.lstsq((differences @ oscillations)[:, None] * basis, left.T)
    found = [run.copy() for run in runs]
    for run, oscillation in zip(found, oscillations, strict=True):
        run[:, tangent] -= (basis @ amplitude).T * oscillation
    return found


def _oscillation(joints: Floats, contact: Floats) -> Floats:
    """(d - h/2)^2 less its mean, at each contact [L^2]."""
    before = np.clip(np.searchsorted(joints, contact, side="right") - 1, 0, len(joints) - 1)
    lengths = np.diff(joints)
    h = np.append(lengths, lengths[-1])[before]  # the last link is half a one
    d = contact - joints[before]
    return np.asarray((d - h / 2) ** 2 - _MEAN * h**2)


def _basis(count: int) -> Floats:
    """Cubic B-splines over the stations' numbers, shape (count, splines)."""
    intervals = max(1, count // _STATIONS)
    place = np.linspace(0, intervals, count)
    away = np.abs(np.subtract.outer(place, np.arange(-1, intervals + 2)))
    return np.asarray((np.maximum(2 - away, 0) ** 3 - 4 * np.maximum(1 - away, 0) ** 3) / 6)
