"""What happens in a sweep, and where: first contact, phase limits, snap-off (paper, section 4)."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import NamedTuple

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

    ``contact_length_minimum`` is that of eq. 21 even where it exceeds the vibrissa's length: then
    there is no Phase B, and only its angle, contact point and arc length have a meaning.
    """

    first_contact: Event
    phase_b_start: Event | None
    phase_b_end: Event | None
    contact_length_minimum: Event
    snap_off: Event | None


class Limits(NamedTuple):
    """The events as parameters t of the contour, decreasing along the sweep."""

    first_contact: float
    phase_b_start: float | None
    phase_b_end: float | None
    contact_length_minimum: float
    snap_off: float | None
    last: float


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

    def event(t: float | None) -> Event | None:
        return None if t is None else _event(to_table(equilibria(centreline, np.array([t])), beam))

    minimum = _event(
        to_table(tangent_contact(centreline.at(np.array([limits.contact_length_minimum]))), beam)
    )
    return Events(
        _first_touch(centreline, limits.first_contact, beam),
        event(limits.phase_b_start),
        event(limits.phase_b_end),
        minimum if minimum.contact_arc_length < beam.length else _imaginary(minimum),
        event(limits.snap_off),
    )


def find_limits(centreline: Contour) -> Limits:
    """The events of a dimensionless sweep, as contour parameters.

    The order is that of section 4: first contact, then the minimum of the contact's arc length s1
    (eq. 21), on both sides of it the limits of Phase B (s1 = 1) if it is below 1, and the fold of
    the foot position, where the vibrissa snaps off.
    """
    _, first = contact_range(centreline)
    low = centreline.t_range[0]
    grid = np.linspace(first, low, _GRID)

    snap_off = _first_fold(centreline, grid)
    end = low if snap_off is None else snap_off

    excess_length = _tangent_arc_length(centreline, grid) - 1
    lowest = int(np.nanargmin(excess_length))
    bracket = grid[max(lowest - 1, 0)], grid[min(lowest + 1, _GRID - 1)]
    minimum = _root(lambda t: _tangent_arc_length_rate(centreline, t), *bracket)
    start = finish = None
    if _tangent_arc_length(centreline, np.array([minimum]))[0] < 1:

        def surplus(t: Floats) -> Floats:
            return _tangent_arc_length(centreline, t) - 1

        start = _before(end, _root(surplus, first, minimum))
        beyond = grid[lowest:][excess_length[lowest:] > 0]
        finish = _before(end, _root(surplus, beyond[0], minimum)) if beyond.size else None
    return Limits(first, start, finish, minimum, snap_off, end)


def _before(end: float, t: float) -> float | None:
    """`t`, unless the sweep has ended before it (t decreases along the sweep)."""
    return t if t > end else None


def _tangent_arc_length(centreline: Contour, t: Floats) -> Floats:
    """s1 of eq. 21; infinite where tangential contact above the foot line is impossible."""
    states = tangent_contact(centreline.at(t))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(states.root_f > 0, states.span.q / states.root_f, np.inf)


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


def _root(function: Callable[[Floats], Floats], a: float, b: float) -> float:
    """A root between `a` and `b`; NaN-free signs must differ there."""
    return float(brentq(lambda t: float(function(np.array([t]))[0]), a, b, xtol=1e-300, rtol=9e-16))


def _event(table: pd.DataFrame) -> Event:
    return Event(**{name: table[name].iloc[0] for name in (f.name for f in fields(Event))})


def _first_touch(centreline: Contour, t: float, beam: Beam) -> Event:
    """The straight, unloaded vibrissa whose tip meets the contour."""
    alpha, xi, eta = (float(x) for (x,) in centreline.at(np.array([t]))[:3])
    return Event(
        foot_x=xi * beam.length,
        force_x=0.0,
        force_y=0.0,
        moment_z=0.0,
        phase="tip",
        contact_angle=alpha,
        contact_arc_length=beam.length,
        contact_x=xi * beam.length - beam.radius * np.sin(alpha),
        contact_y=eta * beam.length + beam.radius * np.cos(alpha),
        tip_angle=np.pi / 2,
        status="ok",
    )


def _imaginary(minimum: Event) -> Event:
    """A minimum of eq. 21 longer than the vibrissa: geometry, with no equilibrium behind it."""
    none = dict.fromkeys(("foot_x", "force_x", "force_y", "moment_z", "tip_angle"), np.nan)
    return Event(**{**vars(minimum), **none, "status": "unreachable"})
