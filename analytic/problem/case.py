"""The problem: a vibrissa, a contour, and the positions of its foot."""

import hashlib
import json
import math
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.beam import Beam, Unloaded
from analytic.problem.clamp_path import ClampWay, Direction, Pose, Poses, Sweep, TurningWay, along_x
from analytic.problem.contours.contour import Contour
from analytic.problem.contours.families import catenary
from analytic.problem.errors import InputError, require
from analytic.problem.numbers import pair
from analytic.problem.reach import MARGIN, check_ends, contact_range, out_of_reach, sign_of
from analytic.problem.rest import FirstTouch, first_on_way, first_touch
from analytic.problem.shown import Shown, described, draw_ends, new_figure
from analytic.problem.support import (
    AnyCase,
    Support,
    check_support,
    given_contour,
    recorded_contours,
    support_record,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PLACES = 67  # of a contour


def digest_of(case: "Case") -> str:
    """Equal for equal problems, whatever the case is called."""
    xi, eta = case.centreline.place(np.linspace(*case.reach, _PLACES))
    beam, foot_x = case.beam, case.foot_x
    sizes = beam.length, beam.base_rigidity, beam.radius
    if isinstance(case.sweep, Sweep):
        ends = [foot_x[0], foot_x[-1], len(foot_x)]
    else:
        ends = [value for values in case.stations for value in values.tolist()]
    numbers = np.array([*sizes, *ends, *xi, *eta])
    if not case.is_plain:
        base_curvature = float(beam.curvature_at(0.0))
        beyond = base_curvature, case.clamp_stiffness, case.friction
        numbers = np.append(numbers, beyond)
    if case.clamp_angle or any(case.weight):
        numbers = np.append(numbers, case.clamp_angle)
    if any(case.weight):
        numbers = np.append(numbers, case.weight)
    for other in case.alone:
        places = other.centreline.place(np.linspace(*other.reach, _PLACES))
        numbers = np.append(numbers, places)
    text = " ".join(["%.12e"] * numbers.size) % tuple(numbers.tolist())
    if beam.varies:
        given = asdict(beam)
        names = "flexural_rigidity", "tip_radius", "natural_curvature"
        text += json.dumps([given[name] for name in names])
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@dataclass(frozen=True, repr=False)
class Case(AnyCase, Shown):
    """What every engine is given: physics only, no numerics.

    Parameters
    ----------
    beam : Beam
        The vibrissa.
    profile : Contour
        The body's contour, in the unit of length of `beam`.
    sweep : Sweep, Whisk or ClampPath
        The foot positions, or the way of the clamp.
    name : str
        What files and reports call the case.
    clamp_stiffness : float
        Moment of the clamp by its rotation [force length/rad]; by default it is rigid.
    friction : float
        Coulomb's coefficient between a sliding vibrissa and the object, from 0 to 1.
    clamp_angle : float
        By which the clamp leans to the left of the upright, phi(0) = pi/2 + clamp_angle [rad].
    weight : tuple of float
        That of the vibrissa along x and y, by length [force/length]: (0, -m g/L) if its clamp
        stands below it on a table.
    others : tuple of Contour
        Objects besides. `profile` may be a list of all, and becomes the one that the vibrissa at
        rest comes to first.

    Raises
    ------
    InputError
        If a field is of another kind or out of range, the vibrissa cannot reach the contour, the
        contour is more than 1,000 L wide within reach or farther than 10,000 L from the origin, or
        the sweep does not start clear of it.
    """

    beam: Beam = field(default_factory=Beam)
    profile: Contour = field(default_factory=lambda: catenary(0.5, -0.8))
    sweep: Sweep | TurningWay = field(default_factory=Sweep)
    name: str = "case"
    clamp_stiffness: float = field(default=math.inf, kw_only=True)
    friction: float = field(default=0.0, kw_only=True)
    clamp_angle: float = field(default=0.0, kw_only=True)
    weight: tuple[float, float] = field(default=(0.0, 0.0), kw_only=True)
    others: tuple[Contour, ...] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        if self.others or isinstance(self.profile, list | tuple):
            self._put_in_order()
        way = "a Sweep(stations=200), a Whisk(start=-1.2, stop=0.8), a ClampPath"
        for name, kind, remedy in (
            ("beam", Beam, "as Beam(length=..., flexural_rigidity=...)"),
            ("profile", Contour, "as catenary(0.5, -0.8), or a case's profile"),
            ("sweep", ClampWay, way),
            ("name", str, "it names files and reports"),
        ):
            require(f"case.{name}", getattr(self, name), kind, remedy)
        object.__setattr__(self, "weight", pair("weight", self.weight))
        check_support(self.support, self.beam)
        for name in ("clamp_stiffness", "friction", "clamp_angle"):
            object.__setattr__(self, name, float(getattr(self, name)))
        if not isinstance(self.sweep, Sweep):
            self._check_way()
            return
        touch = self._first_contact * self.beam.length
        check_ends(self.sweep, self._start, touch, self.beam.length)

    def _put_in_order(self) -> None:
        """Make `profile` the object that is touched first, and `others` the rest."""
        given: Any = self.profile
        objects = (*(given if isinstance(given, list | tuple) else (given,)), *self.others)
        for one in objects:
            require("case.profile", one, Contour, "as [circle(0.2, (0.3, 0.4)), parabola(1, 0.5)]")
        if not objects:
            raise InputError("case.profile", "no object", "one or more", "give an object to touch")
        alone = [replace(self, profile=one, others=()) for one in objects]
        first, *others = sorted(alone, key=Case._distance)
        object.__setattr__(self, "profile", first.profile)
        object.__setattr__(self, "others", tuple(other.profile for other in others))

    def _distance(self) -> float:
        """How far along its way the unloaded vibrissa first touches; infinite if it does not."""
        if isinstance(self.sweep, Sweep):
            return sign_of(self.direction) * self._first_contact
        touch = (self if self.direction == "left" else self.mirrored()).touch
        return math.inf if touch is None else -touch.p

    @property
    def alone(self) -> tuple["Case", ...]:
        """The cases of the other objects, each without the rest."""
        return tuple(replace(self, profile=other, others=()) for other in self.others)

    @property
    def support(self) -> Support:
        return Support(self.clamp_stiffness, self.friction, self.clamp_angle, self.weight)

    @property
    def unloaded(self) -> Unloaded:
        """The vibrissa that touches nothing, in its clamp, under its weight; dimensionless."""
        return self.support.at_rest(self.beam).shape

    @cached_property
    def _first_contact(self) -> float:
        """The foot position at which the unloaded vibrissa first touches [L]."""
        sign, held, beam = sign_of(self.direction), self.support, self.beam
        if beam.varies or self.unloaded.most_turned:
            if sign > 0:
                held, beam = held.mirrored(), beam.mirrored()
            return -sign * first_touch(*self._leftward, held.at_rest(beam).shape).p
        first = self.reach[0 if sign > 0 else 1]
        return float(self.centreline.place(np.array([first]))[0][0])

    @cached_property
    def _start(self) -> float:
        """The foot position of the first station [length]."""
        start = self.require_line("a foot position to start from").start
        if start is not None:
            return start
        return (self._first_contact - sign_of(self.direction) * MARGIN) * self.beam.length

    @cached_property
    def _stop(self) -> float:
        """The foot position of the last station [length]."""
        stop = self.require_line("a foot position to stop at").stop
        if stop is not None:
            return stop
        sign = sign_of(self.direction)
        if self.others:
            return sign * max(sign * x._stop for x in (replace(self, others=()), *self.alone))
        contour, reach = self._leftward
        return sign * (MARGIN - out_of_reach(contour, *reach)) * self.beam.length

    @property
    def _leftward(self) -> tuple[Contour, tuple[float, float]]:
        """Contour and reach of the sweep to the left that this one is, or mirrors."""
        if self.direction == "left":
            return self.centreline, self.reach
        mirrored = self.centreline.mirrored()
        return mirrored, contact_range(mirrored)

    @cached_property
    def centreline(self) -> Contour:
        """The contour that the centreline feels, a cone's at its tip; in units of the length."""
        return given_contour(self.profile, self.beam)

    def _check_way(self) -> None:
        """A way on which the clamp turns starts clear, and has all angles in it."""
        if self.clamp_angle:
            remedy = "add it to the angles of the way"
            raise InputError("clamp_angle", self.clamp_angle, "0 where the clamp turns", remedy)
        if any(self.weight):
            allowed = "(0, 0) where the clamp turns or leaves its line"
            raise InputError("weight", self.weight, allowed, "sweep it along x, or leave it out")
        if self.direction == "left":
            _ = self.touch
        else:
            self.mirrored()

    @property
    def direction(self) -> Direction:
        """Where the foot moves to, or the clamp turns to."""
        return self.sweep.direction

    @cached_property
    def poses(self) -> Poses:
        """The way of the clamp, of a case to the left."""
        if isinstance(self.sweep, Sweep):
            return along_x(self.clamp_angle)
        return self.sweep.poses(self.beam.length)

    @cached_property
    def way(self) -> Floats:
        """Parameters of that way at the stations, falling."""
        if isinstance(self.sweep, Sweep):
            return self.foot_x / self.beam.length
        along = self.running_values
        return -along / self.beam.length if self.sweep.running == "travel" else -along

    @cached_property
    def running_values(self) -> Floats:
        """Values of what the sweep runs over, shape (stations,)."""
        if isinstance(self.sweep, Sweep):
            return self.foot_x
        return self.sweep.stations_along(self.beam.length)

    @cached_property
    def stations(self) -> Pose:
        """The clamp at each station [length, rad]."""
        leftward = self if self.direction == "left" else self.mirrored()
        x, y, angle = leftward.poses.at(leftward.way)
        sign = 1.0 if self.direction == "left" else -1.0
        length = self.beam.length
        return Pose(sign * length * x, length * y, sign * angle)

    @property
    def way_columns(self) -> dict[str, Floats]:
        """What readings of such a way have beside a sweep's, shape (stations,)."""
        if isinstance(self.sweep, Sweep):
            return {}
        _, foot_y, angle = self.stations
        found = {"clamp_angle": angle}
        if self.sweep.running == "travel":
            found |= {"foot_y": foot_y, "travel": self.running_values}
        return found

    @cached_property
    def touch(self) -> FirstTouch | None:
        """The first contact, unloaded, of a case to the left; None if its way has none."""
        if isinstance(self.sweep, Sweep):
            return first_touch(self.centreline, self.reach, self.unloaded)
        ends = float(self.way[0]), float(self.way[-1])
        return first_on_way(self.centreline, self.reach, self.unloaded, self.poses, ends)

    @cached_property
    def reach(self) -> tuple[float, float]:
        """Contour parameters of the leftmost and the rightmost point within reach."""
        if isinstance(self.sweep, Sweep):
            return contact_range(self.centreline)
        highest = float(self.poses.at(self.way).foot_y.max())
        return contact_range(self.centreline.raised(-highest) if highest else self.centreline)

    @property
    def radius(self) -> float:
        """The beam's radius, a cone's at the clamp, in units of its length."""
        return self.beam.radius / self.beam.length

    @cached_property
    def foot_x(self) -> Floats:
        """Foot positions, shape (stations,), in sweep order [length]."""
        if not isinstance(self.sweep, Sweep):
            return self.stations.foot_x
        return np.linspace(self._start, self._stop, self.sweep.stations)

    digest = cached_property(digest_of)
    """A hash of the physics."""

    def provenance(self) -> dict[str, Any]:
        """What every engine records of the problem that it solved.

        Returns
        -------
        dict
            ``case`` and ``profile`` by name, ``digest``, and ``contour``: two lists, xi and eta
            [length]; ``support``, if the clamp turns or leans or the object rubs:
            ``clamp_stiffness``, None if rigid, ``friction``, ``clamp_angle``, unless upright, and
            ``weight_x`` and ``weight_y``, if it has any; ``others``, if there are more objects:
            the contour of each.
        """
        lines = [[line.tolist() for line in one.outline()] for one in (self, *self.alone)]
        return {
            "case": self.name,
            "profile": self.profile.label,
            "digest": self.digest,
            **recorded_contours(lines),
            **support_record(self.support),
        }

    def outline(self, points: int = 181) -> tuple[Floats, Floats]:
        """The body's contour within reach of the vibrissa: what a simulator makes its obstacle of.

        Points of the surface, from left to right. The body is convex and lies above them; nothing
        of it beyond them is ever touched.

        Parameters
        ----------
        points : int
            How many, unless the contour is a polygon, which has its own vertices.

        Returns
        -------
        xi, eta : array, shape (points,)
            Coordinates [length].
        """
        left, right = self.reach
        vertices = self.profile.scaled(1 / self.beam.length).outline(left, right, points)
        return vertices[:, 0] * self.beam.length, vertices[:, 1] * self.beam.length

    def mirrored(self) -> "Case":
        """The mirror image of the problem, x to -x.

        Returns
        -------
        Case
            Its foot moves the other way, from and to the mirrored positions.
        """
        sweep = self.sweep
        if isinstance(sweep, Sweep):
            opposite: Direction = "left" if self.direction == "right" else "right"
            sweep = Sweep(sweep.stations, -self._start, -self._stop, opposite)
        else:
            sweep = sweep.mirrored()
        return replace(
            self,
            beam=self.beam.mirrored(),
            profile=self.profile.mirrored(),
            others=tuple(other.mirrored() for other in self.others),
            sweep=sweep,
            **self.support.mirrored()._asdict(),
        )

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draw the object, the way of the foot, and the vibrissa at rest at its start and end.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            New ones if not given.

        Returns
        -------
        matplotlib.axes.Axes
            With equal scales.
        """
        ax = new_figure().subplots() if ax is None else ax
        for one in (self, *self.alone):
            xi, eta = one.outline()
            ax.fill_between(xi, eta, eta.max(), color="#dddddd", linewidth=0)
            ax.plot(xi, eta, color="#555555", linewidth=2.5, label=one.profile.label)
        draw_ends(ax, self.stations, self.unloaded, self.beam)
        return ax

    def _draw(self, figure: "Figure") -> None:
        self.plot(figure.subplots())

    def _tiles(self) -> dict[str, object]:
        first, last = self.running_values[[0, -1]]
        return {
            "case": self.name,
            "object": " and ".join(one.label for one in (self.profile, *self.others)),
            "beam": described(self.beam),
            **{name: f"{value:g}" for name, value in self.beyond_the_paper.items()},
            "stations": f"{len(self.way)}, {self.sweep.running} from {first:.4g} to {last:.4g}",
        }
