"""How far two sweeps may disagree, with the reason for every limit."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeAlias, TypeVar

import numpy as np

from analytic import CLAMP_READINGS, PHASES
from analytic.problem.errors import InputError, near, require
from analytic.problem.numbers import within
from compare.align.frames import COMPONENTS
from compare.judge.rate import Rate, free_fraction, soft_tip_fraction

if TYPE_CHECKING:  # limits are checked before pandas is needed
    from analytic import Readings
    from analytic.space import SpatialReadings

LimitKind: TypeAlias = Literal["rms", "max"]

CONTACT_PHASES = PHASES[1:]
KINDS = ("rms", "max")
_READINGS_IN_PHASES = [f"{name}.{phase}" for name in CLAMP_READINGS for phase in CONTACT_PHASES]
_PEAK = 10  # times the rms, at the worst station
_QUASI_STATIC = 1e-2  # rms; flexural rigidity 5 % off is 2.7e-2 or more in all named cases
_BETWEEN = 2  # stations, one at each end of Phase B
_CORNER = 0.2  # rad; what a smooth contour of 181 points turns by at none of them


class Limit(float):
    """A number that carries the reason for its size.

    Parameters
    ----------
    value : float
        The limit.
    reason : str
        Why it is as large as it is, for whoever exceeds it.
    """

    reason: str

    def __new__(cls, value: float, reason: str = "asked for by the caller") -> "Limit":
        limit = super().__new__(cls, value)
        limit.reason = reason
        return limit

    def __getnewargs__(self) -> tuple[float, str]:  # type: ignore[override]  # float has one
        return float(self), self.reason


@dataclass(frozen=True)
class Limits:
    """Limits by name, and special ones by dotted name; each subclass has fields of its own."""

    special: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    _SPECIAL: ClassVar[tuple[str, ...]]  # names that special limits may have
    _OF_ANY_SOURCE: ClassVar[frozenset[str]] = frozenset()  # limits whose reasons hold for all

    @classmethod
    def general(cls) -> tuple[str, ...]:
        """Names of the limits that are not special."""
        return tuple(f.name for f in fields(cls) if f.name != "special")

    def __post_init__(self) -> None:
        for name in self.general():
            object.__setattr__(self, name, as_limit(name, getattr(self, name)))
        for name in self.special:
            if name not in self._SPECIAL:
                known = f"one of {', '.join(self._SPECIAL)}"
                raise InputError(f"tolerances.{name}", "unknown", known, near(name, self._SPECIAL))
        special = {name: as_limit(name, value) for name, value in self.special.items()}
        object.__setattr__(self, "special", special)

    def limits(self) -> dict[str, Limit]:
        """All limits by name, the special ones by their dotted names."""
        named = {name: getattr(self, name) for name in self.general()} | dict(self.special)
        return {name: as_limit(name, value) for name, value in named.items()}

    def of(self, component: str, kind: LimitKind, phase: str = "") -> Limit:
        """The limit of a component, as ``"force_x"``, the most special that there is."""
        limits, own = self.limits(), f"{component}.{phase}.{kind}"
        names = (own, f"{component}.{kind}", f"{phase}.{kind}", kind)
        return next(limits[name] for name in names if name in limits)

    def of_phase(self, component: str, phase: str) -> Limit | None:
        """The limit of a component's rms in one phase; None if none was asked for."""
        limits = self.limits()
        return limits.get(f"{component}.{phase}.rms", limits.get(f"{phase}.rms"))

    def usual(self) -> set[str]:
        """Names of the limits that nobody asked for: with the reasons of the defaults."""
        limits = self.limits()
        return {n for n in self.general() if limits[n].reason == getattr(type(self), n).reason}

    def by_convention(self) -> Self:
        """The same limits for a source that the defaults' reasons do not hold for."""
        names = self.usual() - self._OF_ANY_SOURCE
        plain: dict[str, Any] = {name: Limit(getattr(self, name), _DEFAULT) for name in names}
        return replace(self, **plain)

    @property
    def conventional(self) -> bool:
        """Whether some limit is a default that nothing but convention stands behind."""
        return any(getattr(self, name).reason == _DEFAULT for name in self.general())


_Kind = TypeVar("_Kind", bound=Limits)


@dataclass(frozen=True)
class Tolerances(Limits):
    """Limits of agreement; the defaults are for a chain of 40 segments against the closed form.

    Past an object with corners, or for another source as a rig, nothing stands behind the defaults
    but convention, and `suited_to` has the reasons say so. For a sweep in motion it widens them by
    what its speed does.

    Plain numbers become `Limit` whose reason is that the caller asked for them.

    Parameters
    ----------
    rms : float
        Of each clamp reading over all compared stations, relative to its largest magnitude.
    max : float
        The same at any one station.
    snap_off_window : float
        Stretch before snap-off, of the sweep's length, where neither applies.
    phase_agreement : float
        Fraction of stations whose phase, judged from the clamp, is the true contact's.
    transition, snap_off : float
        Of each event's foot position [L].
    lateness : float
        By how much more than `snap_off` the candidate may let go late, not early [L].
    untrusted : float
        Fraction of the candidate's stations that may have failed to settle.
    special : mapping
        Limits for one reading, one phase, or one reading in one phase, by dotted name:
        ``"force_x.rms"``, ``"tangent.max"``, ``"moment_z.tip.rms"``. An ``rms`` of a phase is asked
        beside the overall one; all others take the place of the general limit.

    Raises
    ------
    InputError
        If a limit is no finite number of zero or more, or a special name is unknown.
    """

    rms: float = Limit(
        2e-3, "a chain of 40 segments is off by about 3/N^2 = 1.9e-3, a fine mesh's facets by less"
    )
    max: float = Limit(
        2e-2,
        "ten times the rms, for the stations where the contact passes from segment to segment and "
        "where a transition falls between two stations",
    )
    snap_off_window: float = Limit(
        5e-3,
        "the readings grow like a square root before the snap-off, so an error of its place turns "
        "into any error of theirs",
    )
    phase_agreement: float = Limit(
        0.99, "two stations of 200 may fall between the two models' transitions, and of fewer two"
    )
    transition: float = Limit(1e-2, "less than half a station of the default sweep")
    snap_off: float = Limit(3e-3, "the rms limit times the way in the last phase")
    lateness: float = Limit(0.0, "at rest nothing lets go late")
    untrusted: float = Limit(5e-3, "one station of 200 may fail to settle")
    _OF_ANY_SOURCE = frozenset({"snap_off_window", "lateness"})
    _SPECIAL = tuple(
        f"{where}.{kind}"
        for where in (*CLAMP_READINGS, *CONTACT_PHASES, *_READINGS_IN_PHASES)
        for kind in KINDS
    )

    def suited_to(self, candidate: "Readings") -> "Tolerances":
        """The same limits, with reasons that hold for the source that they are applied to.

        Parameters
        ----------
        candidate : Readings
            Whoever made it.

        Returns
        -------
        Tolerances
            Limits that were asked for keep their reasons.
        """
        defaults = self.usual()
        suited = self if is_smooth_model(candidate) else self.by_convention()
        few = 1 - _BETWEEN / max(int(candidate.trusted.sum()), 1)
        if "phase_agreement" in defaults and few < suited.phase_agreement:
            reason = suited.limits()["phase_agreement"].reason
            suited = replace(suited, phase_agreement=Limit(max(few, 0.0), reason))
        rate = Rate.of(candidate)
        if rate is None:
            return suited
        if "snap_off" not in defaults:  # whoever limits the snap-off limits a late one, too
            defaults.discard("lateness")
        moved = suited._in_motion(rate, candidate)
        widened: dict[str, Any] = {name: moved[name] for name in moved if name in defaults}
        return replace(suited, **widened)

    def _in_motion(self, rate: Rate, candidate: "Readings") -> dict[str, Limit]:
        """These limits, and what the speed adds to each."""
        reasons = {name: limit.reason for name, limit in self.limits().items()}
        along, (size, _) = candidate.running_values, candidate.running_unit
        stations, travel = len(along), float(np.ptp(along)) / size
        adds = rate.lag + rate.inertia
        what = (
            f"{rate.lag:.1e} for the dampers' lag, zeta v T1/(pi L), and {rate.inertia:.1e} for "
            "inertia, m v^2 L^2/EI"
        )
        rms = max(self.rms, min(self.rms + adds, _QUASI_STATIC))
        capped = rms < self.rms + adds
        most = ", but no more than this: a faster motion is not quasi-static" if capped else ""
        free, soft = free_fraction(candidate), soft_tip_fraction(candidate)
        bounces = 2 / stations + rate.speed / travel
        transition = self.transition + adds
        unclear = 4 * transition / travel
        mean = min(max(rate.average, 0.0), 1.0) / (stations - 1)
        return {
            "snap_off_window": Limit(
                max(self.snap_off_window, mean),
                f"{reasons['snap_off_window']}; a station is a mean over {mean:.1%} of the sweep",
            ),
            "rms": Limit(rms, f"{self.rms:.1e} at rest ({reasons['rms']}), {what}{most}"),
            "max": Limit(max(self.max, _PEAK * rms), "ten times the rms, as at rest"),
            "transition": Limit(
                transition, f"{self.transition:.1e} at rest ({reasons['transition']}), {what}"
            ),
            "lateness": Limit(
                rate.lateness,
                "past the fold it takes time to run away: (v T1/(2 pi L))^(4/5) for inertia and "
                "(zeta v T1/(pi L))^(2/3) for dampers",
            ),
            "phase_agreement": Limit(
                max(self.phase_agreement - free - soft - unclear, 0.0),
                f"{float(self.phase_agreement):.0%} at rest, less the {free:.1%} of the stations "
                f"at which it swings freely, which the clamp takes for contact, the {soft:.1%} "
                f"whose contact sinks in so far that it takes in the tip, and the {unclear:.1%} "
                "by which the two limits of Phase B may be off to either side",
            ),
            "untrusted": Limit(
                self.untrusted + bounces,
                f"{float(self.untrusted):.1%} at rest; it bounces at the first contact and at the "
                f"release: a station each, and those of the way in half a period each",
            ),
        }


@dataclass(frozen=True)
class SpatialTolerances(Limits):
    """Limits of agreement; the defaults are for a chain of 40 segments against the closed form.

    Plain numbers become `Limit` whose reason is that the caller asked for them.

    Parameters
    ----------
    rms : float
        Of each component over all compared stations, relative to the largest component of force or
        of moment.
    max : float
        The same at any one station.
    contact : float
        Of the contact point, root mean square [L].
    event : float
        Of the foot's travel to where the vibrissa touches and where it leaves [L].
    phase_agreement : float
        Fraction of the compared stations that are in one phase.
    untrusted : float
        Fraction of the stations without readings that the reference has.
    special : mapping
        Limits for one component, by dotted name: ``"force_x.rms"``, ``"moment_z.max"``.

    Raises
    ------
    InputError
        If a limit is no finite number of zero or more, or a special name is unknown.
    """

    rms: float = Limit(
        3e-3, "forty segments reach 1e-4 to 1e-3 past smooth bodies, a coarse mesh three times that"
    )
    max: float = Limit(
        3e-2, "ten times the rms, for stations beside an edge, a change of phase or the slip-off"
    )
    contact: float = Limit(2e-3, "what forty segments reconstruct to")
    event: float = Limit(5e-3, "half a station of two hundred on a way of 2 L")
    phase_agreement: float = Limit(0.95, "the stations beside a change of phase")
    untrusted: float = Limit(5e-3, "one station of 200 may fail to settle")
    _SPECIAL = tuple(f"{name}.{kind}" for name in COMPONENTS for kind in KINDS)


CONVENTION = (
    "note: the default limits are no more than a convention for this source: give limits of your "
    "own, each with its reason (`--tolerances FILE`, in Python `Tolerances`, in space "
    "`SpatialTolerances`)"
)
"""What is to be said where one of these is exceeded."""
_DEFAULT = "the default"


def in_segments(readings: "Readings | SpatialReadings") -> bool:
    """Whether a sweep is of a beam in segments, as far as it says."""
    settings = readings.provenance.get("settings")
    return isinstance(settings, Mapping) and "segments" in settings


def is_smooth_model(readings: "Readings") -> bool:
    """Whether a sweep is of a beam in segments past a smooth contour, as far as it says."""
    if not in_segments(readings):
        return False
    contour = np.asarray(readings.provenance.get("contour", []), dtype=float)
    if contour.ndim != 2 or contour.shape[1] < 3:
        return True
    slope = np.unwrap(np.arctan2(*np.diff(contour)[::-1]))
    return bool(np.abs(np.diff(slope)).max() < _CORNER)


def as_limit(name: str, value: float) -> Limit:
    if isinstance(value, Limit):
        return value
    return Limit(within(f"tolerances.{name}", value, 0.0))


def checked_limits(given: object, kind: type[_Kind]) -> _Kind:
    """What a caller asked for, or the defaults."""
    return kind() if given is None else require("tolerances", given, kind, "see its fields")
