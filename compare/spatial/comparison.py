"""Two sweeps in space: six components, contact points, phases and events, and a verdict."""

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from html import escape
from typing import Any, Literal

import numpy as np

from analytic import InputError
from analytic.problem.arrays import Booleans, Floats, Words
from analytic.problem.errors import require
from analytic.space import SpatialReadings, reconstruct_space
from analytic.space.problem.readings import CONTACT_POINT, FOOT, FORCE, MOMENT
from compare.align.frames import Frame, components
from compare.judge.failures import Failure
from compare.judge.spatial import SpatialTolerances
from compare.spatial.events import paired_events
from compare.spatial.failures import failures
from compare.spatial.measured import (
    ComponentDisagreement,
    ContactDisagreement,
    SpatialMeasurement,
)
from compare.spatial.noise import component_scales, noise_levels, spatial_noise, touching

_SAME_FOOT = 1e-6  # L
_SAME_BEAM = 1e-9  # of a length or rigidity: what a file's digits leave
_SAME_TANGENT = 1e-6


@dataclass(frozen=True, eq=False, repr=False)
class SpatialComparison(SpatialMeasurement):
    """A candidate against a reference: what they differ by, and the verdict."""

    @cached_property
    def exceeded(self) -> tuple[Failure, ...]:
        """Every limit that is exceeded."""
        return tuple(failures(self))

    @property
    def failures(self) -> tuple[str, ...]:
        """Every limit that is exceeded, in a sentence each."""
        return tuple(str(failure) for failure in self.exceeded)

    @property
    def worst(self) -> Failure | None:
        """The limit that is exceeded most; None if the sweeps agree."""
        return max(self.exceeded, key=lambda failure: failure.excess, default=None)

    @property
    def largest(self) -> str:
        """The component that is off most, by its rms."""
        sizes = {name: one.rms for name, one in self.disagreement.items()}
        return max(sizes, key=lambda name: np.nan_to_num(sizes[name]))

    @property
    def remark(self) -> str | None:
        """What is to be known of the limits that are exceeded; None if there is nothing."""
        return self.tolerances.remark(self.candidate) if self.exceeded else None

    @property
    def agrees(self) -> bool:
        """Whether no limit is exceeded."""
        return not self.exceeded

    def lines(self) -> Iterator[str]:
        """The verdict and what it rests on, for a terminal.

        Yields
        ------
        str
            A line.
        """
        name, length = self.largest, self.reference.beam.length
        one = self.disagreement[name]
        yield (
            f"{self.candidate.source} {'agrees' if self.agrees else 'disagrees'} with "
            f"{self.reference.source}: {name} {one.rms:.1e} rms, the worst "
            f"({self.tolerances.of(name, 'rms'):g} allowed); {self._contact()}; "
            f"{int(self.compared.sum())} of {len(self.compared)} stations compared"
        )
        for event, pair in self.events.items():
            if pair.reference is not None and pair.difference is not None:
                wide = f" +- {pair.uncertainty / length:.1e} L" if pair.uncertainty else ""
                yield (
                    f"  {event:12} {pair.reference / length:.5f} L "
                    f"{pair.difference / length:+.1e} L{wide}"
                )
        for failure in self.exceeded:
            yield f"  failed: {failure.clause}"
        if self.remark is not None:
            yield f"  {self.remark}"

    def _contact(self) -> str:
        if self.contact.stations:
            return f"contact {self.contact.rms:.1e} L rms"
        return "contact known at no station"

    def to_dict(self) -> dict[str, Any]:
        """What ``comparison.json`` holds.

        Returns
        -------
        dict
            Ways in the beam's unit of length, contacts in L, the rest relative; JSON can hold it.
        """
        found: dict[str, Any] = _plain(
            {
                "verdict": "agrees" if self.agrees else "disagrees",
                "failures": list(self.failures),
                "frame": self.frame,
                "disagreement": {name: asdict(one) for name, one in self.disagreement.items()},
                "contact": self.contact.to_dict(),
                "noise": {
                    "level": dict(self.noise.readings.level),
                    "contact": self.noise.contact,
                    "unknown": self.noise.unknown,
                },
                "phases": {"agreement": self.phase_agreement},
                "events": {name: one.to_dict() for name, one in self.events.items()},
                "stations": {
                    "all": len(self.compared),
                    "compared": int(self.compared.sum()),
                    "untrusted": self.untrusted,
                    "status": self.statuses,
                },
                "tolerances": {name: float(x) for name, x in self.tolerances.limits().items()},
                "tolerance_reasons": {n: x.reason for n, x in self.tolerances.limits().items()},
                "reference": _origin(self.reference),
                "candidate": _origin(self.candidate),
            }
        )
        return found

    def __repr__(self) -> str:
        """The verdict, the events, and what failed."""
        return "\n".join(self.lines())

    def _repr_html_(self) -> str:
        """The same for a notebook."""
        return "<pre>" + "<br>".join(escape(line) for line in self.lines()) + "</pre>"


def compare_space(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    tolerances: SpatialTolerances | None = None,
    *,
    noise: float | Literal["auto"] = 0.0,
    frame: Frame = "world",
) -> SpatialComparison:
    """Set one sweep in space against another, from their readings alone.

    Parameters
    ----------
    reference, candidate : SpatialReadings
        Of the same beam and clamp, at the same stations. Contacts that a source does not record are
        found from its clamp.
    tolerances : SpatialTolerances, optional
        Limits for the verdict.
    noise : float or "auto"
        Standard deviation of the components' noise over the largest component of force, or of
        moment. The limits are widened by what such noise does. ``"auto"`` estimates it from both
        sweeps. What touches is judged beside the noise that is seen in any case.
    frame : {"world", "clamp"}
        In which the components are compared. Both sweeps' columns are in the world's.

    Returns
    -------
    SpatialComparison
        Measured and judged.

    Raises
    ------
    InputError
        If the two are of different beams or clamps, or at other stations, or there is no such
        frame, or the noise is no share of the largest component.
    """
    for name, given in (("reference", reference), ("candidate", candidate)):
        require(name, given, SpatialReadings, "wrap a table as SpatialReadings(table, beam)")
    if tolerances is not None:
        require("tolerances", tolerances, SpatialTolerances, "see its fields")
    _check_same(reference, candidate)
    scales = component_scales(reference)
    level = noise_levels(reference, candidate, noise, scales)
    stated = {name: level[name] * scales[name] for name in level}
    on, travel = touching(reference, candidate, stated), way(reference)
    compared = on.reference & on.candidate
    phases = _phases(reference), _phases(candidate)
    same = None
    if phases[0] is not None and phases[1] is not None and compared.any():
        same = float((phases[0] == phases[1])[compared].mean())
    return SpatialComparison(
        reference,
        candidate,
        frame,
        travel,
        compared,
        _disagreements(reference, candidate, frame, compared, travel),
        _contacts(reference, candidate, on.clear),
        same,
        paired_events(reference, candidate, travel, on),
        {"reference": _counted(reference), "candidate": _counted(candidate)},
        int((reference.trusted & ~candidate.trusted).sum()),
        SpatialTolerances() if tolerances is None else tolerances,
        spatial_noise(reference, level, stated, on.clear),
        on,
    )


def way(readings: SpatialReadings) -> Floats:
    """How far along its way the foot is at the stations."""
    recorded = readings.values("travel")
    if np.isfinite(recorded).all():
        return recorded
    steps = np.linalg.norm(np.diff(readings.values(*FOOT), axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _check_same(reference: SpatialReadings, candidate: SpatialReadings) -> None:
    for name in ("length", "flexural_rigidity"):
        ours, theirs = getattr(reference.beam, name), getattr(candidate.beam, name)
        if not abs(ours - theirs) <= _SAME_BEAM * abs(ours):
            raise InputError(
                f"beam.{name} of {candidate.source}", theirs,
                f"{ours:g}, that of {reference.source}", "compare sweeps of one vibrissa",
            )  # fmt: skip
    if np.abs(reference.clamp_tangent - candidate.clamp_tangent).max() > _SAME_TANGENT:
        raise InputError(
            f"tangent of {candidate.source}", candidate.clamp_tangent.tolist(),
            f"{reference.clamp_tangent.tolist()}, that of {reference.source}",
            "compare sweeps of one clamp",
        )  # fmt: skip
    feet = reference.values(*FOOT), candidate.values(*FOOT)
    length = reference.beam.length
    if feet[0].shape != feet[1].shape or np.abs(feet[0] - feet[1]).max() >= _SAME_FOOT * length:
        raise InputError(
            f"stations of {candidate.source}",
            f"{len(feet[1])}, not the {len(feet[0])} of {reference.source}",
            f"the same foot positions, to {_SAME_FOOT:g} L",
            "sweep both along one [path]",
        )


def _disagreements(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    frame: Frame,
    compared: Booleans,
    travel: Floats,
) -> dict[str, ComponentDisagreement]:
    exact, other = components(reference, frame), components(candidate, frame)
    phases = _phases(reference)
    names_of = np.full(len(compared), "") if phases is None else phases
    found = {}
    for names in (FORCE, MOMENT):
        touching = reference.touching
        sizes = [np.abs(exact[name][touching]).max(initial=0.0) for name in names]
        scale = float(max(sizes)) or math.nan
        for name in names:
            off = np.abs((other[name] - exact[name])[compared]) / scale
            at = int(np.argmax(off)) if off.size else None
            found[name] = ComponentDisagreement(
                _rms(off),
                math.nan if at is None else float(off[at]),
                math.nan if at is None else float(travel[compared][at]),
                "" if at is None else str(names_of[compared][at]),
                {
                    str(phase): _rms(off[names_of[compared] == phase])
                    for phase in np.unique(names_of[compared].astype(str))
                    if phase
                },
                scale,
            )
    return found


def _contacts(
    reference: SpatialReadings, candidate: SpatialReadings, compared: Booleans
) -> ContactDisagreement:
    from_clamp, points = [], []
    for readings in (reference, candidate):
        contact = readings.values(*CONTACT_POINT)
        if not np.isfinite(contact[compared]).all():
            contact = reconstruct_space(readings)[list(CONTACT_POINT)].to_numpy(dtype=float)
            from_clamp.append(readings.source)
        points.append(contact)
    distance = np.linalg.norm(points[0] - points[1], axis=1) / reference.beam.length
    distance[~compared] = np.nan
    far = distance[np.isfinite(distance)]
    most = float(far.max()) if far.size else math.nan
    asked = int(compared.sum())
    return ContactDisagreement(_rms(far), most, far.size, asked, tuple(from_clamp), distance)


def _phases(readings: SpatialReadings) -> Words | None:
    return readings.table["phase"].to_numpy() if "phase" in readings.table else None


def _counted(readings: SpatialReadings) -> dict[str, int]:
    if "status" not in readings.table:
        fine = int(readings.trusted.sum())
        return {"ok": fine, **({"missing": len(readings.table) - fine} if not
                readings.trusted.all() else {})}  # fmt: skip
    return {str(k): int(n) for k, n in readings.table["status"].value_counts().items()}


def _rms(values: Floats) -> float:
    return float(np.sqrt((values**2).mean())) if values.size else math.nan


def _plain(value: Any) -> Any:  # noqa: ANN401  # whatever JSON can hold
    """JSON has neither NaN nor infinity: None stands for both."""
    if isinstance(value, dict):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _origin(readings: SpatialReadings) -> dict[str, Any]:
    return {
        "source": readings.source,
        "beam": asdict(readings.beam),
        "stations": len(readings.table),
        "provenance": dict(readings.provenance),
    }
