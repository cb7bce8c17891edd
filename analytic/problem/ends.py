"""Where a sweep along x starts and stops: as it is stated, or by geometry alone."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from analytic.problem.clamp_path import Direction, Sweep
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.numbers import within
from analytic.problem.reach import FARTHEST, contact_range, out_of_reach
from analytic.problem.rest import first_touch

if TYPE_CHECKING:
    from analytic.problem.case import Case

_MARGIN = 0.01  # L; the default sweep starts and ends this far beyond reach
_SHORTEST = 1e-9  # L, of the sweep: stations must differ by more than rounding


def sign_of(way: Direction) -> int:
    """That of the foot's motion along x."""
    return 1 if way == "right" else -1


def check_ends(sweep: Sweep, start: float, touch: float, length: float) -> None:
    """Refuse a sweep that does not start clear of the object, or does not go on from there."""
    farthest = 2 * FARTHEST * length
    for name in ("start", "stop"):  # by default they are in order, and the stop is not needed
        value = getattr(sweep, name)
        if value is not None:
            within(f"sweep.{name}", value, -farthest, farthest, "check its unit")
    sign, more = sign_of(sweep.direction), sweep.direction == "right"
    if sign * start > sign * touch:
        allowed = f"at {'most' if more else 'least'} {touch:.6g}, where the tip first touches"
        remedy = "a sweep starts clear of the object"
        raise InputError("sweep.start", sweep.start, allowed, remedy)
    if sweep.stop is not None and not sign * (sweep.stop - start) > _SHORTEST * length:
        allowed = f"{'more' if more else 'less'} than the start, {start:.6g}"
        remedy = f"the foot moves to the {sweep.direction} (sweep.direction)"
        raise InputError("sweep.stop", sweep.stop, allowed, remedy)


def first_contact(case: "Case") -> float:
    """The foot position at which the unloaded vibrissa first touches [L]."""
    sign, held, beam = sign_of(case.direction), case.support, case.beam
    if beam.varies or case.unloaded.most_turned:
        if sign > 0:
            held, beam = held.mirrored(), beam.mirrored()
        return -sign * first_touch(*_leftward(case), held.at_rest(beam).shape).p
    first = case.reach[0 if sign > 0 else 1]
    return float(case.centreline.place(np.array([first]))[0][0])


def start_of(case: "Case", touch: float) -> float:
    """The foot position of the first station [length]."""
    start = case.require_line("a foot position to start from").start
    if start is not None:
        return start
    return (touch - sign_of(case.direction) * _MARGIN) * case.beam.length


def stop_of(case: "Case") -> float:
    """The foot position of the last station [length]."""
    stop = case.require_line("a foot position to stop at").stop
    if stop is not None:
        return stop
    sign = sign_of(case.direction)
    if case.others:
        alone = [replace(case, others=()), *case.alone]
        return max(map(stop_of, alone), key=lambda stop: sign * stop)
    contour, reach = _leftward(case)
    return sign * (_MARGIN - out_of_reach(contour, *reach)) * case.beam.length


def _leftward(case: "Case") -> tuple[Contour, tuple[float, float]]:
    """Contour and reach of the sweep to the left that this one is, or mirrors."""
    if case.direction == "left":
        return case.centreline, case.reach
    mirrored = case.centreline.mirrored()
    return mirrored, contact_range(mirrored)
