"""Ways of the clamp: along its line, turning about a foot that stands, and any at all.

Poses are dimensionless, over a parameter that falls as the sweep goes on. A sweep to the left has
the foot's own x for parameter; a clamp that turns to the left, less its angle; any other way, less
what it has travelled.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple, TypeAlias, get_args

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from analytic.problem.numbers import finite, floats, whole, within

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator

Direction: TypeAlias = Literal["left", "right"]
Running: TypeAlias = Literal["foot_x", "clamp_angle", "travel"]
"""The column over which a sweep runs."""

MOST_STATIONS = 1_000_000
_MOST_TURNED = math.pi  # rad, from the upright
_LEAST = 1e-9  # rad or L; stations must differ by more than rounding


class Pose(NamedTuple):
    """Poses of the clamp, or how fast they change; arrays of one shape."""

    foot_x: Floats
    foot_y: Floats
    angle: Floats  # by which it leans to the left of the upright [rad]

    def place(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Where in the world something is that an upright clamp at the origin would have there."""
        sin, cos = np.sin(self.angle), np.cos(self.angle)
        return self.foot_x + x * cos - y * sin, self.foot_y + x * sin + y * cos

    def seen(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """The way back: a place of the world as the clamp has it."""
        sin, cos = np.sin(self.angle), np.cos(self.angle)
        x, y = x - self.foot_x, y - self.foot_y
        return x * cos + y * sin, y * cos - x * sin


@dataclass(frozen=True)
class Straight:
    """A clamp that moves along a line, or turns about its foot."""

    origin: tuple[float, float, float]
    step: tuple[float, float, float]

    def at(self, p: Floats) -> Pose:
        return Pose(*(here + p * step for here, step in zip(self.origin, self.step, strict=True)))

    def rate(self, p: Floats) -> Pose:
        return Pose(*(np.full_like(p, step) for step in self.step))


def along_x(angle: float | Floats) -> Straight:
    """The foot along its line, in a clamp that leans by an angle."""
    return Straight((0.0, 0.0, float(angle)), (1.0, 0.0, 0.0))


@dataclass(frozen=True)
class Through:
    """A way through poses, with monotone cubics between them and straight on beyond."""

    p: tuple[float, ...]  # falling
    poses: tuple[tuple[float, float, float], ...]

    def at(self, p: Floats) -> Pose:
        inside = np.clip(p, self.p[-1], self.p[0])
        beyond = np.asarray(p - inside)[..., None]
        return Pose(*np.moveaxis(self._between(inside) + beyond * self._rate(inside), -1, 0))

    def rate(self, p: Floats) -> Pose:
        return Pose(*np.moveaxis(self._rate(np.clip(p, self.p[-1], self.p[0])), -1, 0))

    @cached_property
    def _between(self) -> "PchipInterpolator":
        from scipy.interpolate import PchipInterpolator  # slow to load

        return PchipInterpolator(self.p[::-1], self.poses[::-1])

    @cached_property
    def _rate(self) -> "PchipInterpolator":
        return self._between.derivative()


Poses: TypeAlias = Straight | Through  # over a parameter


def travelled(poses: Floats) -> Floats:
    """What a clamp has travelled at each pose, shape (n, 3): turns count as those of L do [L]."""
    steps = np.linalg.norm(np.diff(poses, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


class ClampWay(ABC):
    running: ClassVar[Running]

    @property
    @abstractmethod
    def stations(self) -> int:
        """How many there are."""

    @property
    @abstractmethod
    def direction(self) -> Direction:
        """Where it goes to."""


class TurningWay(ClampWay):
    """One on which the clamp turns, or leaves its line."""

    @abstractmethod
    def stations_along(self, length: float) -> Floats:
        """Values of the column over which it runs."""

    @abstractmethod
    def poses(self, length: float) -> Poses:
        """The way to the left, dimensionless, over a parameter that falls."""

    @abstractmethod
    def mirrored(self) -> "TurningWay":
        """The mirror image, x to -x."""

    @abstractmethod
    def shifted(self, x: float = 0.0, angle: float = 0.0) -> "TurningWay":
        """The same way with the foot elsewhere, in a clamp that leans more [length, rad]."""


@dataclass(frozen=True)
class Sweep(ClampWay):
    """Stations of the foot, equally spaced from `start` to `stop`.

    Parameters
    ----------
    stations : int
        Number of stations, from 2 to 1,000,000.
    start, stop : float, optional
        First and last foot position [length]. By default from just before the first contact to
        just past the position from which the contour is out of reach: geometry only, so that no
        engine learns the answer from it.
    direction : str
        Where the foot moves to: ``"left"``, as in the paper, or ``"right"``. The vibrissa starts
        clear of the object and straight either way, so the two are different sweeps: what one
        touches first, the other lets go of last and elsewhere.

    Raises
    ------
    InputError
        If a number or the direction cannot be.
    """

    stations: int = 200
    start: float | None = None
    stop: float | None = None
    direction: Direction = "left"
    running: ClassVar[Running] = "foot_x"

    def __post_init__(self) -> None:
        stations = whole("sweep.stations", self.stations, 2, MOST_STATIONS)
        object.__setattr__(self, "stations", stations)
        for name in ("start", "stop"):
            if getattr(self, name) is not None:
                finite(f"sweep.{name}", getattr(self, name))
        if self.direction not in get_args(Direction):
            remedy = "it is where the foot moves to"
            raise InputError("sweep.direction", repr(self.direction), "left or right", remedy)


@dataclass(frozen=True)
class Whisk(TurningWay):
    """A foot that stands while its clamp turns, at equally spaced angles.

    Parameters
    ----------
    foot_x : float
        Where the foot stands, on the line y = 0 [length].
    start, stop : float
        First and last angle of the clamp from the upright [rad], positive to the left. Turning to
        the left is what a sweep to the left is, with the object on that side.
    stations : int
        Number of stations, from 2 to 1,000,000.

    Raises
    ------
    InputError
        If a number cannot be.
    """

    foot_x: float = 0.0
    start: float = -1.2
    stop: float = 0.8
    stations: int = 200
    running: ClassVar[Running] = "clamp_angle"

    def __post_init__(self) -> None:
        stations = whole("whisk.stations", self.stations, 2, MOST_STATIONS)
        object.__setattr__(self, "stations", stations)
        object.__setattr__(self, "foot_x", finite("whisk.foot_x", self.foot_x))
        for name in ("start", "stop"):
            said = "it is in rad, from the upright"
            value = getattr(self, name)
            value = within(f"whisk.{name}", value, -_MOST_TURNED, _MOST_TURNED, said)
            object.__setattr__(self, name, value)
        if abs(self.stop - self.start) < _LEAST:
            allowed = f"another angle than the start, {self.start:g}"
            raise InputError(
                "whisk.stop", self.stop, allowed, "the clamp turns from one to another"
            )

    @property
    def direction(self) -> Direction:
        return "left" if self.stop > self.start else "right"

    def stations_along(self, length: float) -> Floats:
        return np.linspace(self.start, self.stop, self.stations)

    def poses(self, length: float) -> Poses:
        """The way to the left, dimensionless, over less the angle."""
        return Straight((self.foot_x / length, 0.0, 0.0), (0.0, 0.0, -1.0))

    def mirrored(self) -> "Whisk":
        return Whisk(0.0 - self.foot_x, 0.0 - self.start, 0.0 - self.stop, self.stations)

    def shifted(self, x: float = 0.0, angle: float = 0.0) -> "Whisk":
        return Whisk(self.foot_x + x, self.start + angle, self.stop + angle, self.stations)


@dataclass(frozen=True)
class ClampPath(TurningWay):
    """Any way of the clamp, station by station; between them it goes on monotone cubics (PCHIP).

    Parameters
    ----------
    foot_x, foot_y : sequence of float
        Where the foot is at each station [length].
    clamp_angle : sequence of float
        By which the clamp leans to the left of the upright there [rad].

    Raises
    ------
    InputError
        If they are not as long as each other, not finite, or two stations in a row are one pose.
    """

    foot_x: Sequence[float]
    foot_y: Sequence[float]
    clamp_angle: Sequence[float]
    running: ClassVar[Running] = "travel"

    def __post_init__(self) -> None:
        what = "as many numbers as stations, 2 or more"
        columns = {
            name: floats(f"clamp path: {name}", getattr(self, name), (None,), what)
            for name in ("foot_x", "foot_y", "clamp_angle")
        }
        lengths = {name: len(values) for name, values in columns.items()}
        if len(set(lengths.values())) > 1 or min(lengths.values()) < 2:
            said = ", ".join(f"{name} {length}" for name, length in lengths.items())
            raise InputError("clamp path", f"of {said} stations", what, "give one each a station")
        if not np.abs(columns["clamp_angle"]).max() <= _MOST_TURNED:
            worst = float(columns["clamp_angle"][np.abs(columns["clamp_angle"]).argmax()])
            allowed = f"from {-_MOST_TURNED:.6g} to {_MOST_TURNED:.6g}"
            raise InputError("clamp path: clamp_angle", worst, allowed, "it is in rad")
        same = np.flatnonzero(np.abs(np.diff(np.array([*columns.values()]))).max(axis=0) == 0)
        if same.size:
            what = f"the same at stations {same[0]} and {same[0] + 1}"
            raise InputError("clamp path", what, "another pose at each", "leave one out")
        for name, values in columns.items():
            object.__setattr__(self, name, tuple(values.tolist()))

    @property
    def stations(self) -> int:
        return len(self.foot_x)

    @property
    def direction(self) -> Direction:
        gone = self.foot_x[0] - self.foot_x[-1] or self.clamp_angle[-1] - self.clamp_angle[0]
        return "left" if gone >= 0 else "right"

    def _dimensionless(self, length: float) -> Floats:
        """Its poses over the vibrissa's length, shape (stations, 3)."""
        foot = np.array([self.foot_x, self.foot_y]) / length
        return np.column_stack([*foot, self.clamp_angle])

    def stations_along(self, length: float) -> Floats:
        """Values of that column: a turn counts as far as it takes the tip [length]."""
        return travelled(self._dimensionless(length)) * length

    def poses(self, length: float) -> Poses:
        """The way, dimensionless, over less what it has travelled."""
        given = self._dimensionless(length)
        return Through(tuple((-travelled(given)).tolist()), tuple(map(tuple, given.tolist())))

    def mirrored(self) -> "ClampPath":
        x, angle = (-np.array(values) for values in (self.foot_x, self.clamp_angle))
        return ClampPath(x.tolist(), self.foot_y, angle.tolist())

    def shifted(self, x: float = 0.0, angle: float = 0.0) -> "ClampPath":
        foot, leans = np.array(self.foot_x) + x, np.array(self.clamp_angle) + angle
        return ClampPath(foot.tolist(), self.foot_y, leans.tolist())
