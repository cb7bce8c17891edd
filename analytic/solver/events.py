"""What happens in a sweep, and where: first contact, phase limits, snap-off.

Will, Steigenberger and Behn, section 4.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.problem.beam import Beam
from analytic.problem.columns import COLUMNS, PHASES, STATUSES
from analytic.problem.contours.contour import Contour
from analytic.problem.contours.many import Contours
from analytic.problem.errors import require
from analytic.problem.reach import contact_range
from analytic.problem.rest import first_touch
from analytic.problem.roots import zeros
from analytic.problem.support import check_support, is_plain
from analytic.solver.branch import trace
from analytic.solver.contact_length import surplus_and_rate
from analytic.solver.equilibria import (
    Column,
    Equilibria,
    Units,
    equilibria,
    tangent_contact,
    to_columns,
)
from analytic.solver.general.clearance import is_clear
from analytic.solver.general.columns import to_columns as general_columns
from analytic.solver.general.path import follow
from analytic.solver.general.residuals import without_inexact
from analytic.solver.general.states import Vibrissa, states
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
    angle, contact point and arc length have a meaning. With a natural curvature, friction or an
    elastic clamp there are no numbers then; and where such a vibrissa would touch the object in a
    second place, the ``status`` is ``"touches again"`` and there are no readings: the event does
    not happen as that of a vibrissa with one contact. ``out_of_plane`` is where a vibrissa that
    nothing guides leaves the plane of the sweep (`analytic.from_clamp.sideways`); what is after it
    happens to one that is guided.
    """

    first_contact: Event
    phase_b_start: Event | None
    phase_b_end: Event | None
    contact_length_minimum: Event
    out_of_plane: Event | None
    snap_off: Event


def find_events(
    profile: Contour,
    beam: Beam | None = None,
    *,
    clamp_stiffness: float = math.inf,
    friction: float = 0.0,
) -> Events:
    """The events of a sweep of `beam` along `profile`, each with the readings there.

    Parameters
    ----------
    profile : Contour
        The body's contour [length].
    beam : Beam, optional
        The vibrissa; ``Beam()`` if not given.
    clamp_stiffness : float
        Moment of the clamp by its rotation [force length/rad]; by default it is rigid.
    friction : float
        Coulomb's coefficient, from 0 to 1.

    Returns
    -------
    Events
        In the units of `beam`. Where the vibrissa leaves the plane of the sweep is not known with a
        natural curvature, friction or an elastic clamp.

    Raises
    ------
    InputError
        If the vibrissa cannot reach the contour, or a number is out of range.
    ArithmeticError
        If the equilibria of such a vibrissa cannot be followed to where it snaps off.
    """
    beam = Beam() if beam is None else beam
    require("profile", profile, Contour, "as catenary(0.5, -0.8), or polygon([...])")
    require("beam", beam, Beam, "as Beam(length=..., flexural_rigidity=...)")
    check_support(clamp_stiffness, friction, beam, signed=False)
    centreline = profile.scaled(1 / beam.length).offset(beam.unloaded.tip_radius)
    reach = contact_range(centreline)
    if not is_plain(beam, clamp_stiffness, friction):
        vibrissa = Vibrissa.of(beam, clamp_stiffness, friction)
        return _general_events(centreline, reach, vibrissa, beam)
    (branch,) = trace([centreline], [reach])
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
        None if branch.sideways_limit is None else event(branch.sideways_limit[0]),
        event(branch.snap_off),
    )


def _general_events(
    centreline: Contour, reach: tuple[float, float], vibrissa: Vibrissa, beam: Beam
) -> Events:
    touch = first_touch(centreline, reach, vibrissa.unloaded)
    path = follow(centreline, vibrissa, touch, reach)
    if not path.complete:
        place = f"beyond foot_x = {path.foot_x[-1] * beam.length:.6g}"
        raise ArithmeticError(f"the equilibria along {centreline.label} are lost {place}")
    places = path.events()

    def event(name: str) -> Event | None:
        i = places[name]
        if i is None:
            return None
        z = path.z[i : i + 1]
        found = states(centreline.at(z[:, 0]), z[:, 1], z[:, 2], vibrissa)
        columns = general_columns(found, np.zeros(1, dtype=bool), beam)
        if name == "first_contact":  # two rigid bodies: no force whose direction could be checked
            return _only(columns)
        columns = without_inexact(columns, beam, vibrissa)
        if not is_clear(centreline, found)[0]:
            columns = general_columns(found, np.ones(1, dtype=bool), beam)
            columns["foot_x"] = path.foot_x[i : i + 1] * beam.length
        return _only(columns)

    first, snap_off = event("first_contact"), event("snap_off")
    assert first is not None and snap_off is not None
    minimum = event("contact_length_minimum") or _nowhere()
    start, end = event("phase_b_start"), event("phase_b_end")
    return Events(first, start, end, minimum, None, snap_off)


def _contact_length_minimum(centreline: Contour, reach: tuple[float, float]) -> float:
    """Contour parameter at which the s1 of eq. 21 is least."""
    last, first = (np.array([end]) for end in reach)
    _, grid = along(Contours([centreline]), first, last)
    value, rate = surplus_and_rate(centreline.at(grid))
    dips = np.flatnonzero((rate[:-1] > 0) & (rate[1:] < 0))
    extrema = zeros(lambda t: surplus_and_rate(centreline.at(t))[1], grid[dips + 1], grid[dips])
    places = np.append(grid, extrema)
    lowest = np.append(value, surplus_and_rate(centreline.at(extrema))[0])
    return float(places[np.argmin(lowest)])


def _event(state: Equilibria, beam: Beam) -> Event:
    columns: dict[str, Any] = {**to_columns(state, Units.of(beam))}
    columns["phase"] = np.array(PHASES)[columns["phase"]]
    columns["status"] = np.array(STATUSES)[columns["status"]]
    return _only(columns)


def _only(columns: Mapping[str, Column]) -> Event:
    """The one row of a table."""
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


def _nowhere() -> Event:
    """What there is not."""
    numbers = {name: np.nan for name in COLUMNS if name not in ("phase", "status")}
    return Event(**numbers, phase="free", status="unreachable")


def _imaginary(minimum: Event) -> Event:
    """A minimum of eq. 21 longer than the vibrissa: geometry, with no equilibrium behind it."""
    none = dict.fromkeys(("foot_x", "force_x", "force_y", "moment_z", "tip_angle"), np.nan)
    return Event(**{**vars(minimum), **none, "status": "unreachable"})
