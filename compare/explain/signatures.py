"""What faults that need the contour do to the readings, from the closed form."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from analytic import (
    CLAMP_READINGS,
    Case,
    InputError,
    Readings,
    Sweep,
    solve_sweep,
    through_points,
    with_friction,
)
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.contours.contour import Contour
from analytic.problem.quantities import QUANTITIES
from analytic.problem.table import says

_STATIONS = 1000  # of the sweeps between which it is interpolated
_FEW = 10  # of them; a hundredth of the sweep, between which the readings are all but straight
_BEYOND = 0.02  # L; what a slightly longer vibrissa would reach, beyond the contour that is known
_SAME = 1e-3  # of the largest magnitude; the contour must reproduce the reference so well (rms)

_KEPT = 64  # sweeps, 32 kB each: a reference is often compared with many candidates


@dataclass(frozen=True)
class Resolved:
    """The reference's sweep in closed form, to be solved again with one thing changed."""

    case: Case  # the reference's, with a smooth contour through the points that it records
    points: Floats  # shape (points, 2); Those, and what lies a little beyond [length]
    foot_x: Floats  # shape (stations,); Where the readings are wanted [length]
    # Shape (3, stations); The clamp readings there; NaN where the vibrissa is free and next to it.
    seen: Floats

    @classmethod
    def of(cls, reference: Readings, foot_x: Floats) -> Resolved | None:
        """The sweep of a reference whose contour is in its provenance."""
        contour = reference.provenance.get("contour")
        if contour is None or reference.running != "foot_x":
            return None
        beam, swept = reference.beam, reference.values("foot_x")
        sweep = Sweep(_STATIONS, direction="left" if swept[-1] < swept[0] else "right")
        points = _extended(np.transpose(contour), _BEYOND * beam.length)
        try:
            case = Case(beam, _smooth(points), sweep, **reference.support._asdict())
            solved = _sweep(case)
        except (InputError, ArithmeticError):
            return None
        # At its own stations: between them it is not known to a thousandth.
        within = (swept >= foot_x.min()) & (swept <= foot_x.max())
        known = np.stack([reference.values(name)[within] for name in CLAMP_READINGS])
        miss = between(swept[within], *solved) - known
        if not np.isfinite(miss).any(axis=1).all():
            return None  # none of them is there
        miss /= np.nanmax(np.abs(known), axis=1)[:, None]
        same = np.sqrt(np.nanmean(miss**2)) < _SAME
        return cls(case, points, foot_x, between(foot_x, *solved)) if same else None

    @property
    def swept(self) -> tuple[Floats, Floats]:
        """Foot positions, ascending, and the clamp readings there, of the case as it is."""
        return _sweep(self.case)

    def change(self, fault: str, size: float) -> Floats | None:
        """What a fault adds to the clamp readings, by its size in the unit of `unit_of`."""
        try:
            there = between(self.foot_x, *self._swept_with(fault, size))
        except (InputError, ArithmeticError):
            return None
        if fault == "clamp":
            # Past the rigid part the clamp's force acts at its end, the moment is about its foot.
            there[2] -= size * self.case.beam.length * there[0]
        return there - self.seen

    def _swept_with(self, fault: str, size: float) -> tuple[Floats, Floats]:
        if fault == "friction" and (along := self.case.friction + size) < 0:
            return _sweep(replace(self.case, friction=0.0), along)
        return _sweep(self._changed(fault, size))

    def _changed(self, fault: str, size: float) -> Case:
        """With one of `QUANTITIES` larger, or with a ``"clamp"`` that reaches so far along it.

        ``"weight"`` and ``"object_size"`` are larger by a fraction, the object about its lowest
        point; a ``"radius"`` below zero is an object that is smaller all round.
        """
        if fault == "weight":
            x, y = self.case.weight
            return replace(self.case, weight=(x * (1 + size), y * (1 + size)))
        if fault == "object_size":
            lowest = self.points[self.points[:, 1].argmin()]
            # Of a smaller one more is within reach than of the reference's.
            points = _extended(self.points, max(-size, 0.0) * self.case.beam.length)
            return replace(self.case, profile=_smooth(lowest + (1 + size) * (points - lowest)))
        if fault == "radius" and size * self.case.beam.length < -self.case.beam.radius:
            ways = np.gradient(self.points, axis=0)
            outward = np.stack([ways[:, 1], -ways[:, 0]]) / np.hypot(*ways.T)
            inside = self.points + size * self.case.beam.length * outward.T
            return replace(self.case, profile=_smooth(inside))
        if fault != "clamp":
            return QUANTITIES[fault].larger(self.case, size * unit_of(fault, self.case))
        by = size * self.case.beam.length
        shorter = QUANTITIES["length"].larger(self.case, -by)
        return replace(shorter, profile=_smooth(self.points - [0.0, by]))


def unit_of(fault: str, case: Case) -> float:
    """What a fault of size 1 is: a tip that is thinner by the radius at the clamp, for one."""
    return -case.beam.radius if fault == "tip_radius" else QUANTITIES[fault].unit(case)


def _smooth(points: Floats) -> Contour:
    """The contour through points, shape (n, 2).

    Its arcs differ by so little that the closed form need not halt where they meet: three times as
    fast, and the same to rounding.
    """
    return _through(points.tobytes())


@lru_cache(_KEPT)
def _through(points: bytes) -> Contour:
    """One and the same contour whenever the points are, by which `_sweep` knows its case."""
    return replace(through_points(np.frombuffer(points).reshape(-1, 2)), kinks=())


@lru_cache(_KEPT)
def _sweep(case: Case, along: float = 0.0) -> tuple[Floats, Floats]:
    """Foot positions, ascending, and the clamp readings there, NaN where it is free or unknown.

    A few in a row that cannot be solved, where the contour's curvature jumps, are left out.
    Friction below zero, which no case has, is `along` the motion.
    """
    sweep = with_friction(case, along) if along else solve_sweep(case)
    foot_x, rows = sweep.values("foot_x"), np.stack([sweep.values(n) for n in CLAMP_READINGS])
    kept = ~_few_in_a_row(says(sweep.table["status"], "diverged"))
    rows[:, says(sweep.table["phase"], "free")] = np.nan
    order = np.argsort(foot_x[kept])
    return foot_x[kept][order], rows[:, kept][:, order]


def _few_in_a_row(wanted: Booleans) -> Booleans:
    """Those of the stations wanted that stand among few others."""
    ends = np.flatnonzero(np.diff(wanted, prepend=False, append=False)).reshape(-1, 2)
    found = np.zeros_like(wanted)
    for first, last in ends[np.diff(ends, axis=1)[:, 0] <= _FEW]:
        found[first:last] = True
    return found


def _extended(points: Floats, beyond: float) -> Floats:
    """A contour, shape (points, 2), extrapolated at either end, unless it is vertical there."""
    from scipy.interpolate import CubicSpline  # slow to load

    arc_length = np.append(0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    first, last = CubicSpline(arc_length, points)([-beyond, arc_length[-1] + beyond])
    before = [first] if first[0] < points[0, 0] else []
    after = [last] if last[0] > points[-1, 0] else []
    return np.vstack([*before, points, *after])


def between(there: Floats, x: Floats, rows: Floats) -> Floats:
    """Rows between the stations that they are of; NaN next to one without a number."""
    order = np.argsort(x)
    return np.stack([np.interp(there, x[order], row[order]) for row in rows])
