"""A walk along a way: where a gap closes and opens, and where what is followed changes."""

from collections.abc import Callable, Iterable
from typing import NamedTuple, TypeVar

_LEAST = 1e-9  # of the way: a gap that is closed over less stays unseen

State = TypeVar("State")


class WalkEvent(NamedTuple):
    """What happens on the way, and where; lengths in L."""

    kind: str  # ``"touch"``, ``"phase"``, ``"hop"``, ``"release"`` or ``"slip-off"``
    travel: float


def first_touch(
    gap: Callable[[float], float], begin: float, ends: Iterable[float], within: float
) -> float | None:
    """Where a gap closes first; to each end it is convex and changes by no more than the travel."""
    from scipy.optimize import minimize_scalar  # slow to load, and stating a case needs none of it

    low = begin
    for end in ends:
        gaps = gap(low), gap(end)
        if gaps[0] <= 0:
            return low
        closed = end
        if gaps[1] > 0 and sum(gaps) < end - low:
            found = minimize_scalar(
                gap, bounds=(low, end), method="bounded", options={"xatol": _LEAST}
            )
            closed = float(found.x)
        if gap(closed) <= 0:
            return _crossing(gap, low, closed, within)
        low = end
    return None


def first_clear(
    gap: Callable[[float], float], begin: float, ends: Iterable[float], within: float
) -> float | None:
    low = begin
    for end in ends:
        if gap(end) > 0:
            return low if gap(low) > 0 else _crossing(gap, low, end, within)
        low = end
    return None


def first_unlike(
    held: State,
    low: float,
    high: float,
    follow: Callable[[State, float, float], State | None],
    kind: Callable[[State], object],
    within: float,
) -> float:
    """Where what is followed becomes of another kind, which it is at `high`."""
    while high - low > within:
        middle = (low + high) / 2
        found = follow(held, low, middle)
        if found is None:
            break
        if kind(found) == kind(held):
            low, held = middle, found
        else:
            high = middle
    return high


def _crossing(gap: Callable[[float], float], low: float, high: float, within: float) -> float:
    from scipy.optimize import brentq

    if gap(low) == 0:
        return low
    return float(brentq(gap, low, high, xtol=within, rtol=9e-16))
