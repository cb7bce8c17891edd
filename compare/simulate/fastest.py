"""The fastest motion with a wanted error."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from analytic import InputError, Readings
from compare.explain.budget import largest_rms
from compare.explain.motion import THREE_SPEEDS
from mujoco_models.errors import DivergedError

_TRIES = 8
_CHATTER = 0.1  # fraction of the stations in contact; what is left of such a sweep says little
_NEAR = 1.1  # a speed that is known to within a tenth is good enough
_SPEEDS = 1e-3, 2.0  # L/T1; below it takes hours, above the vibrissa is thrown


@dataclass(frozen=True)
class Fastest:
    """The fastest motion with a wanted error, and what was measured of it."""

    target: float  # the wanted error: of the worst reading, rms relative to its largest magnitude
    speed: float  # of the fastest sweep with at most that [L/T1]
    error: float  # of that sweep; CPU time
    seconds: float  # of that sweep; CPU time
    at_rest: float  # what is left at rest
    tried: dict[float, float]  # error by speed, of all sweeps


def find_fastest(
    exact: Readings,
    runs: Mapping[str, Readings],
    move: Callable[[float], Readings],
    target: float,
) -> Fastest:
    """Sweep at other speeds until the fastest one with a wanted error is known to a tenth."""
    swept = {_speed(runs[name]): runs[name] for name in THREE_SPEEDS if name in runs}
    error = {speed: _error(exact, readings) for speed, readings in swept.items()}
    at_rest = _rms(exact, runs["rest"])
    slowest, quickest = _SPEEDS
    for _ in range(_TRIES):
        good = [v for v in error if error[v] <= target]
        bad = [v for v in error if not error[v] <= target]
        low, high = max(good, default=None), min(bad, default=None)
        if low is not None and low >= quickest:
            break
        if low is None or high is None or high <= low:
            # As many times slower or faster as an error of first order in the speed asks for.
            from_here = min(error) if low is None else max(error)
            factor = target / error[from_here] if math.isfinite(error[from_here]) else 0.25
            step = factor / 1.1 if low is None else factor * 1.1
            speed = from_here * (
                min(max(step, 0.1), 0.7) if low is None else min(max(step, 1.4), 4)
            )
        elif high / low <= _NEAR:
            break
        else:
            speed = math.sqrt(low * high)
        if speed < slowest:
            break
        speed = min(speed, quickest)
        try:
            swept[speed] = move(speed)
        except DivergedError:
            error[speed] = math.inf
        else:
            error[speed] = _error(exact, swept[speed])
    good = [v for v in error if error[v] <= target]
    if not good:
        least = min(error.values())
        raise InputError(
            "--target", target, f"at least {least:.1e}, with {at_rest:.1e} left at rest",
            "what is there at rest needs more segments, what is not a shorter time step, "
            "stiffer contacts or less damping",
        )  # fmt: skip
    best = max(good)
    seconds = float(swept[best].provenance["seconds"])
    return Fastest(target, best, error[best], seconds, at_rest, dict(sorted(error.items())))


def _error(exact: Readings, moved: Readings) -> float:
    touched = (exact.table["phase"] != "free").to_numpy()
    if (touched & ~moved.trusted).sum() > _CHATTER * touched.sum():
        return math.inf
    return _rms(exact, moved)


def _rms(exact: Readings, candidate: Readings) -> float:
    try:
        return largest_rms(exact, candidate)
    except InputError:  # no station in common
        return math.inf


def _speed(readings: Readings) -> float:
    return float(readings.provenance["motion"]["speed"])
