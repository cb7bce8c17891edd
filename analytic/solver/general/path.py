"""The equilibria of the general vibrissa by their curve's own length, up to where it lets go."""

from collections.abc import Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.hermite import hermite
from analytic.problem.clamp_path import Poses
from analytic.problem.contours.contour import Contour
from analytic.problem.rest import FirstTouch
from analytic.solver.general.balance import balance
from analytic.solver.general.curve import EquilibriumCurve, Point, normal_to
from analytic.solver.general.pair import Pair
from analytic.solver.general.states import FORCES, Vibrissa

# By how much the curve may turn between neighbours [rad], and its first step; finer if it is lost.
_STEPS = ((0.3, 0.02), (0.05, 0.004))
_LARGEST = 0.5
_SMALLEST = 1e-7
_BUCKLES, _NEAR = 0.75 * np.pi, 0.05  # rad; a curve close to another one: shorter steps stay on it
_TRUST = 0.1  # by how much a mean rate may lie outside those at the ends, of the larger one
_FLAT = 1e-5  # L; the same, of a rate that is next to nothing
_FACET = 0.02  # L; facets up to that length make a contour, and no edges
_SHORT = 1e-3  # of the curve's length: nothing hides there
_MOST, _A_BREAK = 1000, 4  # steps tried, and for each break of the contour: tens suffice mostly
_WITHIN = np.linspace(0, 1, 17)  # of a step, where the phase is looked at
_POLISHES, _MISSED = 3, 1e-12  # of the points that are kept; roundings of their misses
_PARTS = 32  # of a cell: its cubic errs by 1e-3, theirs by 1e-9 and their slopes by 1e-5 or less
_HALVINGS = 20  # of a cell, to begin Newton's method from
_ROUNDING = 4 * float(np.finfo(float).eps)  # between the two sides of a kink


EVENTS = (
    "first_contact",
    "phase_b_start",
    "phase_b_end",
    "back_start",
    "back_end",
    "out_of_plane",
    "snap_off",
)
"""What may happen in a sweep."""


class Path(NamedTuple):
    """Equilibria in sweep order; a cell lies between two neighbours and is smooth.

    ``z`` has shape (n, 4): contour parameter, normal force, excess, and the parameter of the
    clamp's way, that of a sweep its foot position; of two contacts (n, 7), with three numbers
    before the last. ``direction`` is its derivative by the curve's length. ``complete`` is false if
    the curve was lost before its end.
    """

    z: Floats
    direction: Floats
    complete: bool
    vibrissa: Vibrissa
    contour: Contour | Pair

    @property
    def p(self) -> Floats:
        """Parameters of the clamp's way, shape (n,)."""
        return self.z[:, -1]

    @property
    def side(self) -> Integers:
        """What touches in each cell: -1 the front, 0 the tip, 1 the back; shape (n - 1,)."""
        return self.vibrissa.side(self.z[:-1, 2])

    @property
    def snap_off(self) -> int:
        """Which point is the farthest on the way: from there the vibrissa lets go."""
        return int(np.argmin(self.p))

    def events(self) -> dict[str, int | None]:
        """What happens on the way to the snap-off, and at which point; None where it does not."""
        excess = self.z[: self.snap_off + 1, 2]
        side = self.vibrissa.side(excess)
        start, end = phase_limits(side != 0)
        back_start, back_end = phase_limits(side > 0)
        return {
            "first_contact": 0,
            "phase_b_start": start,
            "phase_b_end": end,
            "back_start": back_start,
            "back_end": back_end,
            "contact_length_minimum": (
                int(np.argmin(self.vibrissa.arc_length(excess))) if side.any() else None
            ),
            "snap_off": self.snap_off if self.complete else None,
        }

    def cells(self, p: Floats) -> Integers:
        return cells(self.p, p)

    def share(self, cells: Integers, wanted: Floats, coordinate: int) -> Floats:
        """How far along its cell a coordinate has a wanted value, by Hermite's cubic."""
        value, ends = self.z[:, coordinate], np.stack([cells, cells + 1])
        rate = self.length(cells) * self.direction[:, coordinate][ends]
        begin, end = value[cells], value[cells + 1]
        falls = begin > end
        low, high = np.zeros_like(wanted), np.ones_like(wanted)
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            before = (hermite(middle, begin, rate[0], end, rate[1]) > wanted) == falls
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return low

    def at(self, cells: Integers, share: Floats) -> Floats:
        """Places in cells, by Hermite's cubic: what Newton's method starts from."""
        length = self.length(cells)[:, None]
        z = hermite(
            share[:, None],
            self.z[cells],
            length * self.direction[cells],
            self.z[cells + 1],
            length * self.direction[cells + 1],
        )
        z[:, FORCES] = np.maximum(z[:, FORCES], 0.0)
        z[:, 2] = self.vibrissa.within(self.side[cells], z[:, 2])
        return z

    def length(self, cells: Integers) -> Floats:
        way = self.z[cells + 1] - self.z[cells]
        way /= self.vibrissa.sizes(self.z[cells])
        return np.asarray(np.sqrt(np.einsum("nk,nk->n", way, way)))


def cells(points: Floats, foot_x: Floats) -> Integers:
    least = np.minimum.accumulate(points)
    end = np.searchsorted(-least, -foot_x, side="left")
    return np.clip(end, 1, len(points) - 1) - 1


def phase_limits(tangent: Booleans) -> tuple[int | None, int | None]:
    """Where among places in sweep order Phase B first starts and last ends."""
    inside = np.flatnonzero(tangent)
    if not inside.size:
        return None, None
    end = int(inside[-1]) + 1
    return int(inside[0]), end if end < tangent.size else None


def located(events: Mapping[str, int | None], p: Floats) -> dict[str, float | None]:
    """The foot positions, or parameters, of what happens at points in sweep order."""
    return {name: None if i is None else float(p[i]) for name, i in events.items()}


def follow(
    contour: Contour,
    vibrissa: Vibrissa,
    touch: FirstTouch,
    reach: tuple[float, float],
    poses: Poses,
) -> Path:
    """Follow the equilibria from first contact to where force or reach end."""
    # A curved vibrissa comes as far up as its length when it is straightened, and no farther.
    reach = reach[0], contour.t_range[1]
    curve = EquilibriumCurve(contour, vibrissa, poses, reach, contour.breaks())
    return follow_from(curve, curve.start(touch.t, touch.excess, touch.p))


def follow_from(curve: EquilibriumCurve, start: Point) -> Path:
    reach = curve.t_range
    for turn, step in _STEPS:
        points = _points(curve, start, turn, step)
        complete = _ended(points, reach)
        if complete:
            break
    points = _with_turns(curve, _exact(curve, points))
    z, direction = (np.array(column) for column in zip(*(p[:2] for p in points), strict=True))
    path = Path(z, direction, complete, curve.vibrissa, curve.contour)
    return path._replace(complete=complete and not _goes_over(path, reach))


def _goes_over(path: Path, reach: tuple[float, float]) -> bool:
    """Whether a vibrissa that is still pressed goes on to the object's upper side."""
    last = path.z[-1]
    pressed = bool((last[FORCES] > 0).all()) and path.snap_off == len(path.z) - 1
    return pressed and last[0] == reach[1]


def refined(path: Path, poses: Poses) -> tuple[Path, Floats]:
    """The path with shorter cells, and the derivatives of what its points miss, (n, k, k + 1)."""
    cells = np.repeat(np.arange(len(path.p) - 1), _PARTS)
    share = np.tile(np.arange(_PARTS) / _PARTS, len(path.p) - 1)
    begin, end = path.direction[cells], path.direction[cells + 1]
    z = np.vstack([path.at(cells, share), path.z[-1:]])
    direction = np.vstack([begin + share[:, None] * (end - begin), path.direction[-1:]])
    z, direction, slopes = _polished(path.contour, path.vibrissa, poses, z, direction)
    return path._replace(z=z, direction=direction), slopes


def _exact(curve: EquilibriumCurve, points: list[Point]) -> list[Point]:
    """Points of the curve by Newton's method; one by one they are only good to go on from."""
    z, direction = (np.array(column) for column in zip(*(p[:2] for p in points), strict=True))
    z, direction, _ = _polished(curve.contour, curve.vibrissa, curve.poses, z, direction)
    exact = zip(points, z, direction, strict=True)
    return [point._replace(z=z, direction=d) for point, z, d in exact]


def _polished(
    contour: Contour | Pair, vibrissa: Vibrissa, poses: Poses, z: Floats, direction: Floats
) -> tuple[Floats, Floats, Floats]:
    """Points of a curve by Newton's method, across it, all at a time; directions and slopes."""
    side, size = vibrissa.side(z[:, 2]), vibrissa.sizes(z)
    normal = direction / size**2
    for polishes in range(_POLISHES + 1):
        misses, slopes, _ = balance(contour, vibrissa, poses, z)
        # One that is exact stays: it may stand on a kink.
        poor = (np.abs(misses).max(axis=1) > _MISSED) & (z[:, FORCES] > 0).all(axis=1)
        if polishes == _POLISHES or not poor.any():
            break
        across = np.concatenate([slopes, normal[:, None]], axis=1)[poor]
        missed = np.pad(misses[poor], ((0, 0), (0, 1)))
        z[poor] -= np.linalg.solve(across, missed[..., None])[..., 0]
        z[:, 2] = vibrissa.within(side, z[:, 2])
    way = normal_to(slopes)
    way *= np.sign(np.einsum("nk,nk->n", way, normal))[:, None]
    return z, way / np.linalg.norm(way / size, axis=1)[:, None], slopes


def _points(curve: EquilibriumCurve, start: Point, largest: float, length: float) -> list[Point]:
    """Points of the curve between which it turns by an angle at most, from a first step on."""
    points, behind = [start], None
    # Past small facets the foot turns back at every corner, and goes on.
    slack = min(_FACET, float(np.diff(curve.breaks).max(initial=0.0)))
    for _ in range(_MOST + _A_BREAK * len(curve.breaks)):
        if length <= _SMALLEST or _ended(points, curve.t_range, slack):
            break
        here = points[-1]
        if here.amplitude > _BUCKLES:
            length = min(length, _NEAR)
        ahead = curve.advance(behind, here, length)
        turn = curve.turning(here, ahead[0]) if ahead else np.inf
        if turn > 2 * largest or (length > _SHORT and _hides(curve, here, ahead[0])):
            length /= 2
            continue
        if length > _NEAR and ahead[0].amplitude > _BUCKLES:
            length = max(length / 2, _NEAR)
            continue
        points.extend(ahead)
        behind = here if len(ahead) == 1 else None
        if behind is not None:
            length = min(_LARGEST, length * min(2.0, max(0.5, largest / max(turn, 1e-3))))
    return points


def _hides(curve: EquilibriumCurve, begin: Point, end: Point) -> bool:
    """Whether something may happen between two points that neither shows."""
    way = (end.z - begin.z) / curve.vibrissa.sizes(begin.z)
    length, most = float(np.linalg.norm(way)), curve.vibrissa.most_turned
    mean = (end.p - begin.p) / length
    low, high = sorted((begin.rate, end.rate))
    slack = _TRUST * max(-low, high) + _FLAT
    return not low - slack <= mean <= high + slack or _skips_phase(begin, end, length, most)


def _skips_phase(begin: Point, end: Point, length: float, most: float) -> bool:
    """Whether the excess, as Hermite's cubic, leaves the phase between two points of one."""
    excess, rate = begin.z[2], length * begin.direction[2]
    after, rate_after = end.z[2], length * end.direction[2]
    within = hermite(_WITHIN, excess, rate, after, rate_after)
    for limit in (0.0, most):
        sign = -1.0 if excess < limit else 1.0
        dips = sign * rate < 0 < sign * rate_after and sign * (after - limit) >= 0
        if dips and (sign * (within - limit) < 0).any():
            return True
    return False


def _ended(points: list[Point], reach: tuple[float, float], slack: float = 0.0) -> bool:
    """Whether the vibrissa has let go, is out of reach, or cannot be after it lost its hold."""
    if len(points) == 1:
        return False
    here = points[-1]
    if (here.z[FORCES] == 0).any() or here.z[0] in reach:
        return True
    if not (here.amplitude > np.pi or here.z[2] > np.pi) or here.rate <= 0:
        return False
    return slack == 0 or here.p > min(point.p for point in points) + slack


def _with_turns(curve: EquilibriumCurve, points: list[Point]) -> list[Point]:
    """The points, and those between where foot position or contact's arc length are least."""
    for rate in (lambda at: at.rate, lambda at: float(at.direction[2]) if at.z[2] < 0 else 0.0):
        found = points[:1]
        for begin, end in pairwise(points):
            if rate(begin) < 0 < rate(end) and not _are_kink(begin, end):
                least = curve.turn(begin, end, rate)
                if least is not None:
                    found.append(least)
            found.append(end)
        points = found
    return points


def _are_kink(begin: Point, end: Point) -> bool:
    """Whether two points are the sides of a kink, between which there is nothing to search."""
    apart, size = np.abs(end.z - begin.z).max(), np.abs(end.z).max()
    return bool(apart <= _ROUNDING * size)
