"""The curve of equilibria of the general vibrissa: points on it, steps along it, kinks and folds.

Its coordinates are contour parameter t, normal force f, excess w, three numbers more of a second
contact (`analytic.solver.general.pair`), and the parameter p of the
clamp's way (`analytic.problem.clamp_path`). Keller's pseudo-arclength
continuation: a step along the tangent, and Newton's method back to the curve in the plane normal
to it. The curve has a kink where the phases take turns and where the contour is not smooth.
"""

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.clamp_path import Poses, Straight
from analytic.problem.contours.contour import Contour
from analytic.solver.general.balance import balance
from analytic.solver.general.pair import Pair
from analytic.solver.general.states import FORCES, INSIDE, Vibrissa

_NEAR = 1e-3  # of a step: what Newton's method leaves after it is of the square of that
_CLOSE = 1e-14  # where the curve has a kink or a fold: of an event
_ROUNDING = 1e-12  # of the misses: one that does not fall any more is as small as it can be
_NEWTON = 10
_ASIDE = 1e-9  # of a step: a kink nearer than that is the one that the step starts from
_LEAST = 1e-8  # of a rate: what is least is then exact to its square
_SEARCHES = 40
_F, _W, _P = 1, 2, -1


class Point(NamedTuple):
    z: Floats
    direction: Floats  # derivative of `z` by the curve's length
    amplitude: float = 0.0  # amplitude of the span [rad]; see `States`
    # whether `direction` is that of the cross product of the conditions' derivatives, or -1. It
    # stays along a smooth curve. Next to buckling two curves come close to each other, and the
    # other one has the other sense.
    sense: int = 1

    @property
    def p(self) -> float:
        return float(self.z[_P])

    @property
    def rate(self) -> float:
        return float(self.direction[_P])


class EquilibriumCurve(NamedTuple):
    """The curve of one vibrissa along one contour, within reach."""

    contour: Contour | Pair
    vibrissa: Vibrissa
    poses: Poses
    t_range: tuple[float, float]
    breaks: Floats

    def start(self, t: float, excess: float, p: float) -> Point:
        here = self._loaded(np.array([t, 0.0, excess, p]))
        if excess == 0 and here.direction[_W] < 0:
            here = self._loaded(np.array([t, 0.0, INSIDE, p]))
        return here

    def _loaded(self, z: Floats) -> Point:
        return _towards(self._point(z), _F)

    def touched(self, guess: Floats, force: int) -> Point | None:
        """The point near a guess where one of the forces is nothing, and grows from."""
        guess[force] = 0.0
        found = self._fixed(guess, force)
        return found and _towards(found, force)

    def onward(self, z: Floats) -> Point | None:
        """The point of the curve near another one, the way's parameter as it is, on from there."""
        found = self._fixed(z, _P)
        return found and turned_round(_towards(found, _P))

    def advance(self, behind: Point | None, here: Point, length: float) -> tuple[Point, ...]:
        """The next points of the curve, at most a step ahead."""
        z = self._ahead(behind, here, length)
        lost = [i for i in range(len(z))[FORCES] if z[i] < 0]
        if lost:
            places = [(here.z[i] / (here.z[i] - z[i]), i, 0.0, math.nan) for i in lost]
            return self._stopped(here, min(places), z)
        places = self._places(here.z, z)
        if places:
            return self._stopped(here, min(places), z)
        scale = self.vibrissa.sizes(here.z)
        new = self._corrected(z, here.direction / scale**2, near=_NEAR * length)
        if new is None:
            return ()
        new = _along(new, here.direction / scale**2)
        if new.sense != here.sense:
            return ()
        places = self._places(here.z, new.z)
        return self._stopped(here, min(places), new.z) if places else (new,)

    def _ahead(self, behind: Point | None, here: Point, length: float) -> Floats:
        """Where the cubic through two points and their directions leads; else the tangent."""
        z = here.z + length * here.direction
        if behind is None:
            return z
        way = here.z - behind.z
        step = (self._size(way, here.z) + self._size(way, behind.z)) / 2
        share = length / step
        bend = step * (2 * here.direction + behind.direction) - 3 * way
        twist = step * (here.direction + behind.direction) - 2 * way
        return z + share**2 * (bend + share * twist)

    def _stopped(
        self, here: Point, place: tuple[float, int, float, float], ahead: Floats
    ) -> tuple[Point, ...]:
        """A kink or the end of the curve between here and a place ahead."""
        share, index, before, after = place
        way = ahead - here.z
        guess = here.z + share * way
        guess[index] = before
        found = self._fixed(guess, index) if share > _ASIDE else None
        if found is None or self._size(found.z - guess, here.z) > self._size(way, here.z):
            return ()
        first = _along(found, way / self.vibrissa.sizes(here.z) ** 2)
        side, same_side = (self.vibrissa.side(np.array(z[_W])) for z in (here.z, first.z))
        if first.sense != here.sense or side != same_side:
            return ()
        if math.isnan(after):
            return (first,)
        z = first.z.copy()
        z[index] = after
        second = self._point(z)
        same = second.direction[index] * first.direction[index] > 0
        return first, second if same else turned_round(second)

    def turn(self, begin: Point, end: Point, rate: Callable[[Point], float]) -> Point | None:
        """Where something is least between two points of a smooth part."""
        chord = end.z - begin.z
        normal = chord / self.vibrissa.sizes(begin.z) ** 2
        length = float(chord @ normal)
        low, high = 0.0, 1.0
        rate_low, rate_high = rate(begin), rate(end)
        found, at, last = begin, 0.0, 0.0
        for _ in range(_SEARCHES):  # regula falsi, as the Illinois method has it
            share = low + (high - low) * rate_low / (rate_low - rate_high)
            way = (share - at) * length / float(found.direction @ normal)
            beside = self._corrected(found.z + way * found.direction, normal)
            if beside is None:
                return None
            found, at = _along(beside, normal), share
            here = rate(found)
            if abs(here) < _LEAST:
                break
            if here < 0:
                low, rate_low, rate_high = share, here, rate_high / (2 if here * last > 0 else 1)
            else:
                high, rate_high, rate_low = share, here, rate_low / (2 if here * last > 0 else 1)
            last = here
        return found

    def turning(self, here: Point, new: Point) -> float:
        """By how much the curve turns between two points, but for a straight way of the clamp."""
        seen = slice(_P if isinstance(self.poses, Straight) else None)
        scale = self.vibrissa.sizes(here.z)
        a, b = ((point.direction / scale)[seen] for point in (here, new))
        return float(np.arccos(np.clip(a @ b / np.sqrt((a @ a) * (b @ b)), -1, 1)))

    def _size(self, way: Floats, at: Floats) -> float:
        return math.hypot(*(way / self.vibrissa.sizes(at)))

    def _places(self, old: Floats, new: Floats) -> list[tuple[float, int, float, float]]:
        """Kinks between: share of the way, coordinate, and its value before and after."""
        places = []
        lowest, highest = self.vibrissa.limits
        for before, after in zip(highest[:-1], lowest[1:], strict=True):
            if (old[_W] < after) != (new[_W] < after):
                sides = (before, after) if old[_W] < after else (after, before)
                share = float((after - old[_W]) / (new[_W] - old[_W]))
                places.append((share, _W, *sides))
        for i, t_range, breaks in self._contours:
            begin, end = float(old[i]), float(new[i])
            low, high = sorted((begin, end))
            back, on = (low, high) if end > begin else (high, low)
            for at in breaks[(breaks > low) & (breaks < high)]:
                sides = float(np.nextafter(at, back)), float(np.nextafter(at, on))
                places.append((float((at - begin) / (end - begin)), i, *sides))
            ends = [at for at in t_range if low < at < high or end == at != begin]
            places += [(float(at - begin) / (end - begin), i, at, math.nan) for at in ends]
        return places

    @property
    def _contours(self) -> Iterator[tuple[int, tuple[float, float], Floats]]:
        """The places of the contour parameters, their ranges, and where the contour breaks."""
        yield 0, self.t_range, self.breaks
        if isinstance(self.contour, Pair):
            inner = self.contour.inner
            yield 3, inner.t_range, inner.breaks()

    def _point(self, z: Floats) -> Point:
        return self._with_direction(z)[0]

    def _with_direction(self, z: Floats) -> tuple[Point, Floats, Floats]:
        """A point, what it misses, and the derivatives of that, shape (3, 4)."""
        misses, slopes, here = balance(self.contour, self.vibrissa, self.poses, z[None])
        direction = normal_to(slopes[0])
        direction = direction / (self._size(direction, z) or math.nan)
        return Point(z, direction, float(here.amplitude[0])), misses[0], slopes[0]

    def _corrected(
        self, z: Floats, normal: Floats, pinned: slice = slice(0), *, near: float = 0.0
    ) -> Point | None:
        """The point of the curve in the plane through z; or one, by a step of at most `near`."""
        value = z[pinned].copy()
        missed = np.inf
        for _ in range(_NEWTON):
            point, misses, slopes = self._with_direction(z)
            before, missed = missed, float(np.abs(misses).max())
            if not math.isfinite(missed + float(point.direction.sum())):
                return None
            if missed < _CLOSE or (missed < _ROUNDING and missed >= before / 2):
                return point
            try:
                step = np.linalg.solve(np.vstack([slopes, normal]), np.append(misses, 0.0))
            except np.linalg.LinAlgError:
                return None
            z = z - step
            z[pinned] = value
            ranges = ((low - 1 < z[i] < high + 1) for i, (low, high), _ in self._contours)
            if not (all(ranges) and (z[FORCES] >= 0).all()):
                return None
            if self._size(step, z) < near:
                return point._replace(z=z)
        return None

    def _fixed(self, z: Floats, index: int) -> Point | None:
        """The point of the curve with one coordinate as it is."""
        normal = np.zeros_like(z)
        normal[index] = 1.0
        return self._corrected(z, normal, slice(index, index + 1))


def _towards(point: Point, index: int) -> Point:
    """The point, its direction that in which one of its coordinates grows."""
    return point if point.direction[index] > 0 else turned_round(point)


def _along(point: Point, way: Floats) -> Point:
    """The point, its direction that of a way."""
    return point if point.direction @ way > 0 else turned_round(point)


def turned_round(point: Point) -> Point:
    return point._replace(direction=-point.direction, sense=-point.sense)


def normal_to(slopes: Floats) -> Floats:
    """The cross product of n rows, shape (..., n, n + 1): what changes none of them."""
    every = np.arange(slopes.shape[-1])
    others = np.array([np.delete(every, k) for k in every])
    minors = np.moveaxis(slopes[..., others], -2, -3)
    with np.errstate(invalid="ignore"):  # next to what no vibrissa can be
        return np.asarray((-1.0) ** every * np.linalg.det(minors))
