"""Where readings jump, since a contact passes from corner to corner: a spline would swing out."""

from collections.abc import Iterator

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers

LARGE = 1e-2
"""Of a reading's largest magnitude: half of what a single station may be off."""
_TYPICAL = 8.0  # times the median: of noise alone, one cell in a million is so much more
_SUDDEN = 4.0  # times what rises change by from one to the next: before a snap-off 1.5 to 3
_ASIDE = 3e-3  # L or rad, by which a jump may be early or late, as a snap-off may


def jumps(x: Floats, relative: Floats, starts: Integers) -> Integers:
    """Stations behind which readings jump, before the next one of the same stretch.

    Else they rise from a station to the next as they do on one side, but for what this changes by.
    The largest are found first: what is beside one goes on from its own side alone. A bend between
    two stations, where a contact comes to a corner, is found as well if it is as large. Readings,
    shape (k, n), are over their largest magnitudes; stretches of one phase begin at `starts`.
    """
    step = np.diff(x)
    whole = step != 0  # places may be repeated
    whole[starts[1:] - 1] = False
    slope = np.diff(relative) / np.where(step == 0, 1.0, step)
    found: Integers = np.zeros(0, dtype=int)
    limit = LARGE
    while True:
        miss, changes = _beside_others(np.where(whole, slope, np.nan), step)
        if not found.size and miss.any():
            limit = max(LARGE, _TYPICAL * float(np.median(miss[miss > 0])))
        miss[miss <= np.maximum(limit, _SUDDEN * changes)] = 0.0
        beside = np.maximum(np.append(0.0, miss[:-1]), np.append(miss[1:], 0.0))
        new = np.flatnonzero((miss > 0) & (miss >= beside))
        if not new.size:
            return np.sort(found)
        found = np.append(found, new)
        whole[new] = False


def _beside_others(slope: Floats, step: Floats) -> tuple[Floats, Floats]:
    """How far each rise is from the nearer one beside it, and by how much those change."""
    edge = np.full((len(slope), 2), np.nan)
    far = np.hstack([edge, slope, edge])
    (left2, left, _, right, right2) = (far[:, i : i + slope.shape[1]] for i in range(5))
    rises = np.fmin(np.abs(slope - left), np.abs(slope - right))
    changes = np.fmin(np.abs(left - left2), np.abs(right - right2))
    both = np.nan_to_num(np.stack([rises, changes]) * np.abs(step))
    miss, most = both.max(axis=1)
    return miss, most


def sides(after: int, starts: Integers, count: int) -> Iterator[tuple[int, slice]]:
    """The stretch on either side of a jump, and up to four stations that say what is beyond it."""
    ends = np.append(starts, count)
    last = int(np.searchsorted(ends, after, side="right"))
    yield last - 1, slice(after + 1, min(ends[last + 1], after + 5))
    yield last, slice(max(ends[last - 1], after - 3), after + 1)


def beside(x: Floats, places: Floats, size: float) -> Booleans:
    """Which of `x` are no farther from a stretch between two places than a jump may be off."""
    return np.asarray(np.abs(x - places.mean()) <= np.ptp(places) / 2 + _ASIDE * size)
