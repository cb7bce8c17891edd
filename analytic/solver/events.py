"""What happens in a sweep, and where: first contact, phase limits, snap-off.

Will, Steigenberger and Behn, section 4.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.problem.beam import Beam
from analytic.problem.contours.contour import Contour
from analytic.problem.reach import contact_range
from analytic.problem.roots import zeros
from analytic.solver.branch import trace
from analytic.solver.contact_length import surplus_and_rate
from analytic.solver.equilibria import Equilibria, equilibria, tangent_contact, to_columns
from analytic.solver.grid import along


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
    angle, contact point and arc length have a meaning. ``out_of_plane`` is where a vibrissa that
    nothing guides leaves the plane of the sweep (`analytic.from_clamp.sideways`); what is after it
    happens to one that is guided.
    """

    first_contact: Event
    phase_b_start: Event | None
    phase_b_end: Event | None
    contact_length_minimum: Event
    out_of_plane: Event | None
    snap_off: Event


def find_events(profile: Contour, beam: Beam | None = None) -> Events:
    """The events of a sweep of `beam` along `profile`, each with the readings there.

    Parameters
    ----------
    profile : Contour
        The body's contour [length].
    beam : Beam, optional
        The vibrissa; ``Beam()`` if not given.

    Returns
    -------
    Events
        In the units of `beam`.

    Raises
    ------
    InputError
        If the vibrissa cannot reach the contour.
    """
    beam = Beam() if beam is None else beam
    centreline = profile.scaled(1 / beam.length).offset(beam.radius / beam.length)
    reach = contact_range(centreline)
    branch = trace(centreline, reach)
    touch = _first_touch(centreline, branch.first_contact, beam)

    def event(t: float) -> Event:
        return _event(equilibria(centreline, np.array([t])), beam)

    changes, starts_in_b = branch.phase_changes, bool(branch.tangent[0])
    into_b, out_of_b = changes[int(starts_in_b) :: 2], changes[int(not starts_in_b) :: 2]
    starts = touch if starts_in_b else (event(into_b[0]) if into_b.size else None)
    ends = None if branch.tangent[-1] or not out_of_b.size else event(out_of_b[-1])
    lowest = _contact_length_minimum(centreline, reach)
    minimum = _event(tangent_contact(centreline.at(np.array([lowest]))), beam)
    return Events(
        touch,
        starts,
        ends,
        minimum if minimum.contact_arc_length < beam.length else _imaginary(minimum),
        None if branch.sideways_limit is None else event(branch.sideways_limit),
        event(branch.snap_off),
    )


def _contact_length_minimum(centreline: Contour, reach: tuple[float, float]) -> float:
    """Contour parameter at which the s1 of eq. 21 is least."""
    last, first = reach
    grid = along(centreline, first, last)
    value, rate = surplus_and_rate(centreline, grid)
    dips = np.flatnonzero((rate[:-1] > 0) & (rate[1:] < 0))
    extrema = zeros(lambda t: surplus_and_rate(centreline, t)[1], grid[dips + 1], grid[dips])
    places = np.append(grid, extrema)
    lowest = np.append(value, surplus_and_rate(centreline, extrema)[0])
    return float(places[np.argmin(lowest)])


def _event(state: Equilibria, beam: Beam) -> Event:
    columns = to_columns(state, beam)
    row: dict[str, Any] = {name: column[0].item() for name, column in columns.items()}
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
        contact_x=xi * beam.length - beam.radius * math.sin(alpha),
        contact_y=eta * beam.length + beam.radius * math.cos(alpha),
        tip_angle=np.pi / 2,
        status="ok",
    )


def _imaginary(minimum: Event) -> Event:
    """A minimum of eq. 21 longer than the vibrissa: geometry, with no equilibrium behind it."""
    none = dict.fromkeys(("foot_x", "force_x", "force_y", "moment_z", "tip_angle"), np.nan)
    return Event(**{**vars(minimum), **none, "status": "unreachable"})
