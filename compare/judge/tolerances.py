"""How far two sweeps may disagree, with the reason for every limit."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeAlias, TypeVar

import numpy as np

from analytic import CLAMP_READINGS, PHASES, InputError
from compare.judge.rate import Rate, free_fraction, soft_tip_fraction
from compare.sense.given import checked

if TYPE_CHECKING:  # limits are checked before pandas is needed
    from analytic import Readings

Kind: TypeAlias = Literal["rms", "max"]

CONTACT_PHASES = PHASES[1:]
KINDS = ("rms", "max")
_PEAK = 10  # times the rms, at the worst station
_QUASI_STATIC = 1e-2  # rms; flexural rigidity 5 % off is 2.7e-2 or more in all named cases
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
        """A float with its reason."""
        limit = super().__new__(cls, value)
        limit.reason = reason
        return limit

    def __getnewargs__(self) -> tuple[float, str]:  # type: ignore[override]  # float has one
        return float(self), self.reason


@dataclass(frozen=True)
class Limits:
    """Limits by name, and special ones by dotted name; each subclass has fields of its own."""

    special: Mapping[str, float] = field(default_factory=dict, kw_only=True)
    _SPECIAL_NAMES: ClassVar[str]

    @classmethod
    def general(cls) -> tuple[str, ...]:
        """Names of the limits that are not special."""
        return tuple(f.name for f in fields(cls) if f.name != "special")

    @staticmethod
    def _is_special(name: str) -> bool:
        raise NotImplementedError

    def __post_init__(self) -> None:
        for name in self.general():
            object.__setattr__(self, name, as_limit(name, getattr(self, name)))
        for name in self.special:
            if not self._is_special(name):
                raise InputError(
                    f"tolerances.{name}", "unknown", self._SPECIAL_NAMES, "correct the name"
                )
        special = {name: as_limit(name, value) for name, value in self.special.items()}
        object.__setattr__(self, "special", special)

    def limits(self) -> dict[str, Limit]:
        """All limits by name, the special ones by their dotted names.

        Returns
        -------
        dict of Limit
            Each with its reason.
        """
        named = {name: getattr(self, name) for name in self.general()} | dict(self.special)
        return {name: as_limit(name, value) for name, value in named.items()}

    def usual(self) -> set[str]:
        """Names of the limits that nobody asked for.

        Returns
        -------
        set of str
            Those with the reasons of the defaults.
        """
        return {
            n for n in self.general() if getattr(self, n).reason == getattr(type(self), n).reason
        }


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
        2e-3,
        "a chain of 40 segments is off by about 3/N^2 = 1.9e-3, a fine mesh's facets by less",
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
        0.99, "two stations of 200 may fall between the two models' transitions"
    )
    transition: float = Limit(1e-2, "less than half a station of the default sweep")
    snap_off: float = Limit(3e-3, "the rms limit times the foot's travel in the last phase")
    lateness: float = Limit(0.0, "at rest nothing lets go late")
    untrusted: float = Limit(5e-3, "one station of 200 may fail to settle")
    _SPECIAL_NAMES: ClassVar[str] = (
        f"READING.KIND, PHASE.KIND or READING.PHASE.KIND, a reading of {', '.join(CLAMP_READINGS)},"
        f" a phase of {', '.join(CONTACT_PHASES)}, a kind of {', '.join(KINDS)}"
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
        defaults, suited = self.usual(), self
        if not is_smooth_model(candidate):
            plain: dict[str, Any] = {
                name: Limit(getattr(self, name), reason)
                for name, reason in _CONVENTIONS.items()
                if name in defaults
            }
            suited = replace(self, **plain)
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
        foot_x = candidate.values("foot_x")
        stations, travel = len(foot_x), float(np.ptp(foot_x)) / candidate.beam.length
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
        return {
            "rms": Limit(rms, f"{self.rms:.1e} at rest ({_reason(self.rms)}), {what}{most}"),
            "max": Limit(max(self.max, _PEAK * rms), "ten times the rms, as at rest"),
            "transition": Limit(
                transition, f"{self.transition:.1e} at rest ({_reason(self.transition)}), {what}"
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

    @property
    def conventional(self) -> bool:
        """Whether some limit is a default that nothing but convention stands behind."""
        return any(getattr(self, name).reason == why for name, why in _CONVENTIONS.items())

    def of_reading(self, kind: Kind, reading: str, phase: str) -> Limit:
        """The limit at one station: the most special that there is.

        Parameters
        ----------
        kind : str
            ``"rms"`` or ``"max"``.
        reading : str
            Name of the clamp reading.
        phase : str
            ``"tip"`` or ``"tangent"``.

        Returns
        -------
        Limit
            With its reason.
        """
        for name in (f"{reading}.{phase}.{kind}", f"{reading}.{kind}", f"{phase}.{kind}"):
            if name in self.special:
                return as_limit(name, self.special[name])
        return as_limit(kind, getattr(self, kind))

    def of_sweep(self, reading: str) -> Limit:
        """The limit of a reading's rms over all phases.

        Parameters
        ----------
        reading : str
            Name of the clamp reading.

        Returns
        -------
        Limit
            With its reason.
        """
        return as_limit("rms", self.special.get(f"{reading}.rms", self.rms))

    def of_phase(self, reading: str, phase: str) -> Limit | None:
        """The limit of a reading's rms in one phase.

        Parameters
        ----------
        reading : str
            Name of the clamp reading.
        phase : str
            ``"tip"`` or ``"tangent"``.

        Returns
        -------
        Limit or None
            None if none was asked for.
        """
        for name in (f"{reading}.{phase}.rms", f"{phase}.rms"):
            if name in self.special:
                return as_limit(name, self.special[name])
        return None

    @staticmethod
    def _is_special(name: str) -> bool:
        *where, kind = name.split(".")
        allowed = [[r] for r in CLAMP_READINGS] + [[p] for p in CONTACT_PHASES]
        allowed += [[r, p] for r in CLAMP_READINGS for p in CONTACT_PHASES]
        return kind in KINDS and where in allowed


CONVENTION = (
    "note: the default limits are no more than a convention for this source: give limits of your "
    "own, each with its reason (`--tolerances FILE`, in Python `Tolerances`, in space "
    "`SpatialTolerances`)"
)
"""What is to be said where one of `_CONVENTIONS` is exceeded."""
_CONVENTIONS = {
    "rms": "the default",
    "max": "the default, ten times that of the rms",
    "transition": "the default, a hundredth of the length",
    "snap_off": "the default",
    "phase_agreement": "the default: one station of a hundred may fall beside a transition",
    "untrusted": "the default: one station of 200 may lack a number",
}
"""Reasons of the default limits for sources other than the one that they were made for."""


def is_smooth_model(readings: "Readings") -> bool:
    """Whether a sweep is of a beam in segments past a smooth contour, as far as it says."""
    settings = readings.provenance.get("settings")
    if not (isinstance(settings, Mapping) and "segments" in settings):
        return False
    contour = np.asarray(readings.provenance.get("contour", []), dtype=float)
    if contour.ndim != 2 or contour.shape[1] < 3:
        return True
    slope = np.unwrap(np.arctan2(*np.diff(contour)[::-1]))
    return bool(np.abs(np.diff(slope)).max() < _CORNER)


def as_limit(name: str, value: float) -> Limit:
    """A limit of that name, checked."""
    if isinstance(value, Limit):
        return value
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"tolerances.{name}", repr(value), "a number", "correct it")
    if not (math.isfinite(value) and value >= 0):
        raise InputError(f"tolerances.{name}", value, "finite, 0 or more", "correct it")
    return Limit(value)


def checked_limits(given: object, kind: type[_Kind]) -> _Kind:
    """What a caller asked for, or the defaults."""
    return kind() if given is None else checked("tolerances", given, kind, "see its fields")


def _reason(limit: float) -> str:
    return limit.reason if isinstance(limit, Limit) else ""
