"""Two sweeps in space: six components, contact points, phases and events, and a verdict."""

import math
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from analytic import InputError
from analytic.problem.arrays import Booleans, Floats
from analytic.problem.numbers import is_finite_number
from analytic.space import SpatialReadings
from analytic.space.problem.readings import CONTACT_POINT, FOOT, FORCE, MOMENT

COMPONENTS = (*FORCE, *MOMENT)
_SAME_FOOT = 1e-6  # L
_ENDS = ("slip-off", "release")


@dataclass(frozen=True)
class SpatialTolerances:
    """Limits of what agrees.

    Parameters
    ----------
    rms : float
        Of each component, over the largest component of force or of moment. 3e-3 is what forty
        segments keep past smooth bodies with room to spare: they reach 1e-4 to 1e-3.
    max : float
        The same at any one station: ten times that.
    contact : float
        Of the contact point, root mean square [L].
    event : float
        Where the vibrissa touches and where it leaves [L of the way].
    phases : float
        Share of the stations in contact that may be in the other phase: those beside a change.
    unsettled : float
        Share of the stations without readings that the reference has: half a per cent.
    """

    rms: float = 3e-3
    max: float = 3e-2
    contact: float = 2e-3
    event: float = 5e-3
    phases: float = 0.05
    unsettled: float = 5e-3

    def __post_init__(self) -> None:
        for one in fields(self):
            value = getattr(self, one.name)
            if not (is_finite_number(value) and value >= 0):
                raise InputError(f"tolerances.{one.name}", value, "0 or more", "correct it")


@dataclass(frozen=True)
class Apart:
    """How far one component of the candidate is off, over the largest of its kind.

    Attributes
    ----------
    rms, max : float
        Over the compared stations; NaN if there are none.
    at : float
        Way of the foot where it is largest [length].
    scale : float
        What it is relative to, in the readings' unit.
    """

    rms: float
    max: float
    at: float
    scale: float


@dataclass(frozen=True, eq=False)
class SpatialComparison:
    """A candidate against a reference.

    Attributes
    ----------
    reference, candidate : SpatialReadings
        The two.
    compared : array of bool, shape (stations,)
        Where both touch and are trusted.
    apart : dict of Apart
        By component.
    contact_rms, contact_max : float
        Between the contact points [L].
    phases : float
        Share of the compared stations that are in one phase.
    events : dict
        Of the first touch and each leaving, its way in both sweeps [length]; None where it is not.
    untrusted : int
        Stations of the candidate without readings where the reference has them.
    tolerances : SpatialTolerances
        Limits.
    """

    reference: SpatialReadings
    candidate: SpatialReadings
    compared: Booleans
    apart: dict[str, Apart]
    contact_rms: float
    contact_max: float
    phases: float
    events: dict[str, tuple[float | None, float | None]]
    untrusted: int
    tolerances: SpatialTolerances

    @property
    def worst(self) -> str:
        """The component that is off most, by its rms."""
        return max(self.apart, key=lambda name: np.nan_to_num(self.apart[name].rms))

    @property
    def agrees(self) -> bool:
        """Whether no limit is exceeded."""
        return not self.failures

    @property
    def failures(self) -> list[str]:
        """Every limit that is exceeded, in a clause each."""
        limits, length = self.tolerances, self.reference.beam.length
        found = []
        if not self.compared.any():
            found.append("no station at which both touch")
        for name, one in self.apart.items():
            if one.rms > limits.rms:
                found.append(f"{name}: {one.rms:.1e} rms, {limits.rms:g} allowed")
            elif one.max > limits.max:
                found.append(f"{name}: {one.max:.1e} at {one.at:.4g}, {limits.max:g} allowed")
        if self.contact_rms > limits.contact:
            found.append(f"contact: {self.contact_rms:.1e} L rms, {limits.contact:g} L allowed")
        if 1 - self.phases > limits.phases:
            found.append(f"phases: {1 - self.phases:.1%} differ, {limits.phases:.1%} allowed")
        for name, (ours, theirs) in self.events.items():
            if (ours is None) != (theirs is None):
                who = self.candidate if ours is None else self.reference
                found.append(f"{name}: only in {who.source}")
            elif ours is not None and theirs is not None:
                off = abs(ours - theirs) / length
                if off > limits.event:
                    found.append(f"{name}: {off:.1e} L apart, {limits.event:g} L allowed")
        if self.untrusted > limits.unsettled * len(self.reference.table):
            found.append(f"{self.untrusted} stations without readings")
        return found

    def lines(self) -> list[str]:
        """The verdict and what it rests on, for a terminal.

        Returns
        -------
        list of str
            A line each.
        """
        limits, one = self.tolerances, self.apart[self.worst]
        verdict = "agrees with" if self.agrees else "disagrees with"
        found = [
            f"{self.candidate.source} {verdict} {self.reference.source}: {self.worst} "
            f"{one.rms:.1e} rms, the worst ({limits.rms:g} allowed); contact "
            f"{self.contact_rms:.1e} L rms; {int(self.compared.sum())} stations"
        ]
        length = self.reference.beam.length
        for name, (ours, theirs) in self.events.items():
            if ours is not None and theirs is not None:
                found.append(f"  {name:10} {ours / length:.5f} L {(theirs - ours) / length:+.1e} L")
        found += [f"  failed: {line}" for line in self.failures]
        return found

    def to_dict(self) -> dict[str, Any]:
        """What ``comparison.json`` holds.

        Returns
        -------
        dict
            Anything JSON can hold.
        """
        return {
            "verdict": "agrees" if self.agrees else "disagrees",
            "failures": self.failures,
            "disagreement": {
                name: {k: _plain(v) for k, v in asdict(one).items()}
                for name, one in self.apart.items()
            },
            "contact": {"rms": _plain(self.contact_rms), "max": _plain(self.contact_max)},
            "phases": {"agreement": _plain(self.phases)},
            "events": {
                name: {"reference": one, "candidate": other}
                for name, (one, other) in self.events.items()
            },
            "stations": {
                "all": len(self.reference.table),
                "compared": int(self.compared.sum()),
                "without readings": self.untrusted,
            },
            "tolerances": asdict(self.tolerances),
            "reference": _origin(self.reference),
            "candidate": _origin(self.candidate),
        }


def compare_space(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    tolerances: SpatialTolerances | None = None,
) -> SpatialComparison:
    """Set one sweep in space against another.

    Parameters
    ----------
    reference, candidate : SpatialReadings
        With the same beam, at the same stations.
    tolerances : SpatialTolerances, optional
        Limits.

    Returns
    -------
    SpatialComparison
        Measured and judged.

    Raises
    ------
    InputError
        If the stations are not the same.
    """
    length = reference.beam.length
    feet = reference.values(*FOOT), candidate.values(*FOOT)
    same = feet[0].shape == feet[1].shape and bool(
        np.abs(feet[0] - feet[1]).max() < _SAME_FOOT * length
    )
    if not same:
        raise InputError(
            f"stations of {candidate.source}",
            f"{len(feet[1])}, not those of {reference.source}",
            f"the same foot positions, to {_SAME_FOOT:g} L",
            "sweep both along one [path]",
        )
    compared = reference.touching & candidate.touching
    apart = {
        name: one
        for names in (FORCE, MOMENT)
        for name, one in _components(reference, candidate, names, compared).items()
    }
    between = reference.values(*CONTACT_POINT) - candidate.values(*CONTACT_POINT)
    far = np.linalg.norm(between[compared], axis=1) / length
    phases = [r.table["phase"].to_numpy()[compared] for r in (reference, candidate)]
    return SpatialComparison(
        reference,
        candidate,
        compared,
        apart,
        _rms(far),
        float(far.max(initial=0.0)),
        float((phases[0] == phases[1]).mean()) if compared.any() else math.nan,
        _events(reference, candidate),
        int((reference.trusted & ~candidate.trusted).sum()),
        tolerances or SpatialTolerances(),
    )


def _components(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    names: tuple[str, ...],
    compared: Booleans,
) -> dict[str, Apart]:
    exact, other = reference.values(*names), candidate.values(*names)
    scale = float(np.abs(exact[reference.touching]).max(initial=0.0)) or math.nan
    off = (other - exact)[compared] / scale
    travel = way(reference)[compared]
    found = {}
    for name, column in zip(names, off.T, strict=True):
        size = np.abs(column)
        at = float(travel[np.argmax(size)]) if size.size else math.nan
        found[name] = Apart(_rms(column), float(size.max(initial=0.0)), at, scale)
    return found


def way(readings: SpatialReadings) -> Floats:
    """How far along its way the foot is at the stations.

    Parameters
    ----------
    readings : SpatialReadings
        A sweep.

    Returns
    -------
    array, shape (stations,)
        [length]
    """
    steps = np.linalg.norm(np.diff(readings.values(*FOOT), axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _events(
    reference: SpatialReadings, candidate: SpatialReadings
) -> dict[str, tuple[float | None, float | None]]:
    """The first touch and where the vibrissa leaves, slipping off or released."""
    found = [
        [(e["kind"], float(e["travel"])) for e in r.provenance.get("events", [])]
        for r in (reference, candidate)
    ]
    touches, *ends = (
        [[at for kind, at in events if kind == name] for events in found]
        for name in ("touch", *_ENDS)
    )
    paired: dict[str, tuple[float | None, float | None]] = {
        "touch": (_first(touches[0]), _first(touches[1]))
    }
    for name, (ours, theirs) in zip(_ENDS, ends, strict=True):
        for i in range(max(len(ours), len(theirs))):
            label = name if i == 0 else f"{name} {i + 1}"
            paired[label] = (_first(ours[i:]), _first(theirs[i:]))
    return paired


def _first(values: list[float]) -> float | None:
    return values[0] if values else None


def _rms(values: Floats) -> float:
    return float(np.sqrt((values**2).mean())) if values.size else math.nan


def _plain(value: float) -> float | None:
    """JSON has no NaN."""
    return value if math.isfinite(value) else None


def _origin(readings: SpatialReadings) -> dict[str, Any]:
    return {"source": readings.source, "provenance": dict(readings.provenance)}
