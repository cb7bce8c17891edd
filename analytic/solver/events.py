"""What happens in a sweep, and where: first contact, phase limits, snap-off (Will et al., 4)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING

import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.numerics.roots import zeros
from analytic.problem.beam import Beam
from analytic.problem.clamp_path import along_x
from analytic.problem.columns import CLAMP_READINGS, COLUMNS, WORDS
from analytic.problem.contours.contour import Contour
from analytic.problem.contours.many import Contours
from analytic.problem.errors import InputError
from analytic.problem.numbers import pair
from analytic.problem.reach import contact_range
from analytic.problem.rest import first_touch
from analytic.problem.shown import Shown, stacked
from analytic.problem.support import Support, check_support, given_contour, is_plain, require_plain
from analytic.solver.branch import trace
from analytic.solver.equilibria import Equilibria, equilibria_at, surplus_and_rate, tangent_contact
from analytic.solver.general.chain import (
    clear_state,
    joined,
    second_contacts,
    with_second_contacts,
)
from analytic.solver.general.columns import ReadingColumns, Units, to_columns, without
from analytic.solver.general.path import follow
from analytic.solver.general.states import INSIDE, States, Vibrissa
from analytic.solver.grid import along
from analytic.solver.residuals import without_inexact

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


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


@dataclass(frozen=True, repr=False)
class Events(Shown):
    """The events of a sweep in the direction of decreasing foot_x; None where there is none.

    If Phases A and B take turns more than once, as they may on an object that is flat below,
    Phase B is here from its first start to its last end. ``contact_length_minimum`` is that of
    eq. 21 even where it exceeds the vibrissa's length: then there is no Phase B, and only its
    angle, contact point and arc length have a meaning. With a natural curvature, friction or an
    elastic clamp there are no numbers then; and where such a vibrissa would touch the object in a
    place more than is solved, the ``status`` is ``"touches again"`` and there are no readings: the
    event does not happen. ``out_of_plane`` is where a vibrissa that
    nothing guides leaves the plane of the sweep (`analytic.from_clamp.sideways`); what is after it
    happens to one that is guided. From ``back_start`` to ``back_end`` a vibrissa that is curved
    towards the object lies on it with its other side: that is Phase B too. From
    ``second_contact_start`` to ``second_contact_end`` it touches in two places, and the contact of
    an event is the one nearer to the clamp: that is Phase B as well.
    """

    first_contact: Event
    phase_b_start: Event | None
    phase_b_end: Event | None
    contact_length_minimum: Event
    out_of_plane: Event | None
    snap_off: Event
    back_start: Event | None = None
    back_end: Event | None = None
    second_contact_start: Event | None = None
    second_contact_end: Event | None = None

    def plot(self, axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
        """Mark the events in the clamp readings over the foot position.

        Parameters
        ----------
        axes : sequence of matplotlib.axes.Axes, optional
            What ``plot`` of readings returned, to mark them there.

        Returns
        -------
        list of matplotlib.axes.Axes
            One a reading: ``force_x``, ``force_y``, ``moment_z``.
        """
        axes = stacked(CLAMP_READINGS, "foot_x") if axes is None else axes
        for ax, name in zip(axes, CLAMP_READINGS, strict=True):
            for i, (event, at) in enumerate(self._there().items()):
                said = event.replace("_", " ")
                ax.plot(at.foot_x, getattr(at, name), "D", color=f"C{i}", label=said)
        axes[0].legend(fontsize="small", ncols=2)
        return list(axes)

    def _there(self) -> dict[str, Event]:
        return {name: at for name, at in vars(self).items() if at and math.isfinite(at.foot_x)}

    def _draw(self, figure: "Figure") -> None:
        self.plot(stacked(CLAMP_READINGS, "foot_x", figure))

    def _tiles(self) -> dict[str, object]:
        return {name: f"{at.foot_x:.5g}" for name, at in self._there().items()}


def find_events(
    profile: Contour,
    beam: Beam | None = None,
    *,
    clamp_stiffness: float = math.inf,
    friction: float = 0.0,
    clamp_angle: float = 0.0,
    weight: tuple[float, float] = (0.0, 0.0),
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
    clamp_angle : float
        By which the clamp leans to the left of the upright [rad].
    weight : tuple of float
        That of the vibrissa along x and y, by length [force/length].

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
    contour = given_contour(profile, beam)
    held = Support(clamp_stiffness, friction, clamp_angle, pair("weight", weight))
    check_support(held, beam)
    if is_plain(beam, held):
        return find_many_events([profile], [beam])[0]
    return _general_events(contour, Vibrissa.of(beam, held), beam)


def find_many_events(profiles: Sequence[Contour], beams: Sequence[Beam]) -> list[Events]:
    """The events of many sweeps of the paper's vibrissa, as `find_events` has them one by one.

    Parameters
    ----------
    profiles : sequence of Contour
        The bodies' contours, each in the unit of length of its vibrissa.
    beams : sequence of Beam
        As many vibrissae, straight and uniform.

    Returns
    -------
    list of Events
        In their order.

    Raises
    ------
    InputError
        If one vibrissa cannot reach its contour, is curved at rest or not uniform.
    """
    if len(profiles) != len(beams):
        what = f"{len(beams)} of {len(profiles)} profiles"
        raise InputError("beams", what, "as many as profiles", "give one for each")
    contours = [given_contour(*one) for one in zip(profiles, beams, strict=True)]
    for beam in beams:
        require_plain("the events of many", beam)
    if not beams:
        return []
    reaches = [contact_range(one) for one in contours]
    many = Contours(contours)
    branches = trace(many, reaches)
    places = [
        (i, name, branch.t[at])
        for i, branch in enumerate(branches)
        for name, at in branch.events().items()
        if at  # not at first contact, which has no load
    ]
    owner, t = np.array([i for i, _, _ in places]), np.array([t for _, _, t in places])
    rows = _rows(_plain_columns(equilibria_at(many.at(owner, t)), beams, owner))
    found: list[dict[str, Event]] = [{} for _ in branches]
    for (i, name, _), event in zip(places, rows, strict=True):
        found[i][name] = event
    everyone = np.arange(len(many))
    lowest = tangent_contact(many.at(everyone, _contact_length_minima(many, reaches)))
    minima = _rows(_plain_columns(lowest, beams, everyone))
    every = zip(contours, branches, beams, found, minima, lowest.arc_length, strict=True)
    events = []
    for contour, branch, beam, known, minimum, length in every:
        touch = _first_touch(contour, float(branch.t[0]), beam)
        events.append(
            Events(
                touch,
                touch if branch.tangent[0] else known.get("phase_b_start"),
                known.get("phase_b_end"),
                minimum if length < 1 else _imaginary(minimum, float(length) * beam.length),
                known.get("out_of_plane"),
                known["snap_off"],
            )
        )
    return events


def _general_events(contour: Contour, vibrissa: Vibrissa, beam: Beam) -> Events:
    reach = contact_range(contour)
    touch = first_touch(contour, reach, vibrissa.at_rest.shape)
    poses = along_x(vibrissa.clamp_angle)
    path = follow(contour, vibrissa, touch, reach, poses)
    if not path.complete:
        place = f"beyond foot_x = {path.p[-1] * beam.length:.6g}"
        raise ArithmeticError(f"the equilibria along {contour.label} are lost {place}")
    paths = with_second_contacts((contour,), path, poses)
    path, units = joined(paths), Units.of(beam)
    found: dict[str, Event | None] = {field.name: None for field in fields(Events)}
    found["contact_length_minimum"] = _nowhere()
    for name, i in {**path.events(), **second_contacts(paths)}.items():
        if i is None:
            continue
        state, clear = clear_state(paths, i, (contour,))
        columns = to_columns(state, units)
        # First contact is of two rigid bodies: there is no force whose direction could be checked.
        if i > 0:
            foot_x = columns["foot_x"]
            wrong = np.array([not clear])
            columns = without(without_inexact(columns, vibrissa, units), wrong, "touches again")
            columns["foot_x"] = foot_x
        found[name] = _rows({column: columns[column] for column in COLUMNS})[0]
    return Events(**found)  # type: ignore[arg-type]  # what is always there is never None


def _contact_length_minima(many: Contours, reaches: Sequence[tuple[float, float]]) -> Floats:
    """Contour parameters at which the s1 of eq. 21 is least."""
    last, first = np.array(reaches).T
    grid = along(many, first, last)
    value, rate = surplus_and_rate(many.at(*grid))
    dips = np.flatnonzero(grid.cells & (rate[:-1] > 0) & (rate[1:] < 0))
    owner = grid.owner[dips]
    extrema = zeros(
        lambda dip, t: surplus_and_rate(many.at(owner[dip], t))[1],
        grid.t[dips + 1],
        grid.t[dips],
    )
    owners, places = np.append(grid.owner, owner), np.append(grid.t, extrema)
    lowest = np.append(value, surplus_and_rate(many.at(owner, extrema))[0])
    order = np.lexsort((lowest, owners))
    return np.asarray(places[order[np.unique(owners[order], return_index=True)[1]]])


def _plain_columns(contacts: Equilibria, beams: Sequence[Beam], whose: Integers) -> ReadingColumns:
    radius = np.array([beam.radius / beam.length for beam in beams])[whose]
    return to_columns(contacts.states(Vibrissa(radius=radius)), Units.of_each(beams, whose))


def _rows(columns: ReadingColumns) -> list[Event]:
    words = {name: np.array(of)[columns[name]] for name, of in WORDS.items()}
    every = {**columns, **words}
    rows = zip(*(values.tolist() for values in every.values()), strict=True)
    return [Event(**dict(zip(every, row, strict=True))) for row in rows]


def _first_touch(contour: Contour, t: float, beam: Beam) -> Event:
    """The straight, unloaded vibrissa whose tip, or side, meets the contour."""
    point, none = contour.at(np.array([t])), np.zeros(1)
    leant = np.pi / 2 - point.alpha
    excess = np.where(leant > 0, leant, np.minimum(point.eta - 1, INSIDE))
    vibrissa = Vibrissa(radius=beam.radius / beam.length)
    found = States(point, none, excess, none, point.eta, none, none, none, vibrissa)
    touch = _rows(to_columns(found, Units.of(beam)))[0]
    # Where the contour ends below the tip it is a corner, which the side touches.
    reached = min(float(point.eta[0]), 1.0) * beam.length
    return replace(touch, force_x=0.0, contact_arc_length=reached)


def _nowhere() -> Event:
    numbers = {name: np.nan for name in COLUMNS if name not in ("phase", "status")}
    return Event(**numbers, phase="free", status="unreachable")


def _imaginary(minimum: Event, length: float) -> Event:
    """A minimum of eq. 21 longer than the vibrissa: geometry, with no equilibrium behind it."""
    none = dict.fromkeys(("foot_x", "force_x", "force_y", "moment_z", "tip_angle"), np.nan)
    longer = {"contact_arc_length": length, "status": "unreachable"}
    return Event(**{**vars(minimum), **none, **longer})
