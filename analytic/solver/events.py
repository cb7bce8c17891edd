"""What happens in a sweep, and where: first contact, phase limits, snap-off (paper, section 4)."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from analytic.problem.arrays import Floats
from analytic.problem.beam import Beam
from analytic.problem.contour import Contour
from analytic.problem.reach import contact_range
from analytic.solver.elastica import frame
from analytic.solver.equilibria import equilibria, tangent_contact, to_table

_GRID = 401  # samples of the contour between which a limit is looked for; roots are then exact


@dataclass(frozen=True)
class Event:
    """A row of the readings table, at an event."""

    foot_x: float
    force_x: float
    force_y: float
    moment_z: float
    phase: str
    contact_angle: float
    contact_arc_length: float
    contact_x: float
    contact_y: float
    tip_angle: float
    status: str


@dataclass(frozen=True)
class Events:
    """The events of a sweep in the direction of decreasing foot_x; None where there is none.

    If Phases A and B take turns more than once, as they may on an object that is flat below,
    Phase B is here from its first start to its last end. ``contact_length_minimum`` is that of
    eq. 21 even where it exceeds the vibrissa's length: then there is no Phase B, and only its
    angle, contact point and arc length have a meaning.
    """

    first_contact: Event
    phase_b_start: Event | None
    phase_b_end: Event | None
    contact_length_minimum: Event
    snap_off: Event | None


class Limits(NamedTuple):
    """The events as parameters t of the contour, decreasing along the sweep."""

    first_contact: float
    starts_tangent: bool
    """Whether the side of the vibrissa touches first: the object ends below the tip."""
    changes: tuple[float, ...]
    """Where Phases A and B take turns."""
    contact_length_minimum: float
    snap_off: float | None
    last: float
    """End of the branch: the snap-off, or the end of the contour."""


def find_events(profile: Contour, beam: Beam | None = None) -> Events:
    """The events of a sweep of `beam` along `profile`, each with the readings there.

    Parameters
    ----------
    profile : Contour
        The body's contour [length].
    beam : Beam, optional
        The vibrissa; ``Beam()`` if not given.

    Raises
    ------
    InputError
        If the vibrissa cannot reach the contour.
    """
    beam = Beam() if beam is None else beam
    centreline = profile.scaled(1 / beam.length).offset(beam.radius / beam.length)
    limits = find_limits(centreline)

    touch = _first_touch(centreline, limits.first_contact, beam)

    def event(t: float | None) -> Event | None:
        return None if t is None else _event(to_table(equilibria(centreline, np.array([t])), beam))

    begins, ends = (
        limits.changes[limits.starts_tangent :: 2],
        limits.changes[not limits.starts_tangent :: 2],
    )
    begin, end = next(iter(begins), None), next(reversed(ends), None)
    if len(limits.changes) % 2 != limits.starts_tangent:
        end = None  # the vibrissa snaps off in Phase B
    minimum = _event(
        to_table(tangent_contact(centreline.at(np.array([limits.contact_length_minimum]))), beam)
    )
    return Events(
        touch,
        touch if limits.starts_tangent else event(begin),
        event(end),
        minimum if minimum.contact_arc_length < beam.length else _imaginary(minimum),
        event(limits.snap_off),
    )


def find_limits(centreline: Contour) -> Limits:
    """The events of a dimensionless sweep, as contour parameters.

    The order is that of section 4: first contact; the minimum of the contact's arc length s1
    (eq. 21); the limits of Phase B, where s1 = 1; and the fold of the foot position, where the
    vibrissa snaps off.
    """
    _, first = contact_range(centreline)
    low = centreline.t_range[0]
    grid = np.unique(np.concatenate([np.linspace(low, first, _GRID), centreline.breaks()]))
    grid = grid[grid <= first][::-1]

    snap_off = _first_fold(centreline, grid)
    last = low if snap_off is None else snap_off
    surplus = _surplus(centreline, grid)
    lowest = int(np.argmin(np.where(surplus > -np.inf, surplus, np.inf)))
    inner = grid[max(lowest - 1, 1)], grid[min(lowest + 1, len(grid) - 2)]
    minimum = _root_or_end(lambda t: _tangent_arc_length_rate(centreline, t), *inner)
    turns = np.flatnonzero((surplus[1:] < 0) != (surplus[:-1] < 0))
    changes = [_root(lambda t: _surplus(centreline, t), grid[i + 1], grid[i]) for i in turns]
    return Limits(
        first,
        bool(surplus[0] < 0),
        tuple(t for t in changes if t > last),
        minimum,
        snap_off,
        last,
    )


def _surplus(centreline: Contour, t: Floats) -> Floats:
    """1 - 1/s1 with s1 of eq. 21: negative in Phase B, and smooth through the pole of s1."""
    states = tangent_contact(centreline.at(t))
    straight = states.span.q == 0  # against an upright side, at first contact
    q, root_f = np.where(straight, 1.0, states.span.q), np.where(straight, 1.0, states.root_f)
    return np.where(straight, 1 - 1 / states.point.eta, 1 - root_f / q)


def _tangent_arc_length_rate(centreline: Contour, t: Floats) -> Floats:
    """d(log s1)/dt of eq. 21, with q' = -1/C and (C sin + S cos)' = across - 1/C."""
    point = centreline.at(t)
    states = tangent_contact(point)
    up, across = frame(states.span, point.alpha)
    q, C, _ = states.span
    by_alpha = -1 / (C * q) - (across - 1 / C) / up
    return point.stretch * np.sin(point.alpha) / point.eta + point.turning * by_alpha


def _first_fold(centreline: Contour, grid: Floats) -> float | None:
    """The first minimum of the foot position, or None if the contour ends before."""
    foot_x = equilibria(centreline, grid[1:]).foot_x
    turned = np.flatnonzero(~(np.diff(foot_x) < 0))  # rising again, or no longer reachable
    if turned.size == 0:
        return None
    i = int(turned[0]) + 1

    def rate(t: Floats) -> Floats:
        states = equilibria(centreline, t)
        return np.where(np.isfinite(states.excess), states.foot_x_rate, -1.0)

    return _root(rate, grid[max(i - 1, 1)], grid[i + 1])


def _root_or_end(function: Callable[[Floats], Floats], a: float, b: float) -> float:
    """A root between `a` and `b`, or the end nearer to one if there is none between."""
    at_a, at_b = (float(function(np.array([t]))[0]) for t in (a, b))
    if (at_a < 0) == (at_b < 0):
        return a if abs(at_a) < abs(at_b) else b
    return _root(function, a, b)


def _root(function: Callable[[Floats], Floats], a: float, b: float) -> float:
    """A root between `a` and `b`; NaN-free signs must differ there."""
    return float(brentq(lambda t: float(function(np.array([t]))[0]), a, b, xtol=1e-300, rtol=9e-16))


def _event(table: pd.DataFrame) -> Event:
    row: dict[str, Any] = {
        str(name): x if isinstance(x, str) else float(x) for name, x in table.iloc[0].items()
    }
    return Event(**row)


def _first_touch(centreline: Contour, t: float, beam: Beam) -> Event:
    """The straight, unloaded vibrissa whose tip, or side, meets the contour."""
    alpha, xi, eta = (float(x) for (x,) in centreline.at(np.array([t]))[:3])
    return Event(
        foot_x=xi * beam.length,
        force_x=0.0,
        force_y=0.0,
        moment_z=0.0,
        phase="tip" if alpha < np.pi / 2 else "tangent",
        contact_angle=alpha,
        contact_arc_length=min(eta, 1.0) * beam.length,
        contact_x=xi * beam.length - beam.radius * np.sin(alpha),
        contact_y=eta * beam.length + beam.radius * np.cos(alpha),
        tip_angle=np.pi / 2,
        status="ok",
    )


def _imaginary(minimum: Event) -> Event:
    """A minimum of eq. 21 longer than the vibrissa: geometry, with no equilibrium behind it."""
    none = dict.fromkeys(("foot_x", "force_x", "force_y", "moment_z", "tip_angle"), np.nan)
    return Event(**{**vars(minimum), **none, "status": "unreachable"})
