"""The comparison of two sweeps: measured, judged by limits, and explained."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any, Literal, overload

import numpy as np

from analytic import PHASES, Case, InputError, Readings
from analytic.problem.errors import require
from analytic.space import SpatialReadings
from compare.align.frames import Frame
from compare.align.stations import check_same_stations
from compare.explain.budget import Budget
from compare.explain.in_space import likely_in_space
from compare.explain.likely import likely_cause, to_find_out
from compare.judge.allowance import (
    NoiseAllowance,
    SpatialAllowance,
    noise_allowance,
    spatial_allowance,
)
from compare.judge.failures import Failure, failures, failures_in_space
from compare.judge.judged import Judged, Number
from compare.judge.tolerances import SpatialTolerances, Tolerances, checked_limits, in_segments
from compare.measure.in_space import SpatialMeasurement, measure_in_space
from compare.measure.measurement import Measurement, measure
from compare.sense.noise import Noise, checked_level, noise_level
from compare.sense.occurrence import Occurrence
from compare.sense.touching import component_levels, component_scales
from compare.validate.stated import Input, Uncertainties
from compare.validate.validation import Side, Validation, validate

_EVENTS = {"touch": "touch", "slip_off": "slip-off", "release": "release"}  # in space
_KEPT = ("rms", "max", "at", "phase", "rms_by_phase", "scale")  # of a disagreement in space
_AS_TABLE = "wrap a table as Readings(table, beam), in space SpatialReadings(table, beam)"
_COARSE = 0.05  # of the stations; the last three before a snap-off are so in any reference
_OF_95 = 1.96  # standard deviations: half the width of an interval that holds 95 % of a normal


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Judged[Readings], Measurement):
    """A measurement with its limits: what exceeds them, and what that looks like.

    Attributes
    ----------
    tolerances : Tolerances
        Limits for the verdict.
    noise : NoiseAllowance
        What noise adds to the limits.
    validation : Validation or None
        The verdict that knows what is uncertain, if `validated` was asked for it.
    """

    tolerances: Tolerances
    noise: NoiseAllowance
    validation: Validation | None = None

    @cached_property
    def likely(self) -> str | None:
        """What the disagreement looks like; None if it agrees, or matches no known cause."""
        return None if self.agrees else likely_cause(self, self.tolerances, self.noise)

    @property
    def why(self) -> str:
        """What a disagreement is likely made of, or how to find that out; nothing if it agrees."""
        said = super().why
        return said if said or self.agrees else to_find_out(self.reference, self.candidate)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is to be known of both sweeps, and how well jumps of the contact are."""
        counts, (size, unit) = self.alignment.counts, self.reference.running_unit
        step = float(np.abs(np.diff(self.reference.running_values)).max()) / size
        jumped, coarse = counts["beside_jump"], counts["reference_coarse"]
        said = []
        if jumped:
            said.append("note: stations beside a jump of the contact, whose place is known to "
                        f"{step:.2g} {unit}, are not compared: {jumped}")  # fmt: skip
        if coarse > _COARSE * (coarse + counts["compared"]):
            said.append("note: stations between those of the reference, which are too far apart "
                        f"to say what is there, are not compared: {coarse}; sweep the reference in "
                        f"smaller steps than {step:.2g} {unit}")  # fmt: skip
        return (*super().remarks, *said)

    def validated(
        self,
        case: Case,
        stated: Uncertainties,
        simulation: Side = "reference",
        budget: Budget | None = None,
    ) -> Comparison:
        """The same comparison, held against what is uncertain about it (`validate`).

        An offset that was fitted is uncertain by what its fit leaves, not by what is stated.

        Parameters
        ----------
        case : Case
            What was simulated: the nominal inputs.
        stated : Uncertainties
            What is uncertain about them.
        simulation : {"reference", "candidate"}
            Which of the two sweeps is the simulation.
        budget : Budget, optional
            Of the simulation's numerics.

        Returns
        -------
        Comparison
            With its `validation`.
        """
        require("stated", stated, Uncertainties, "as Uncertainties({'length': Input(1e-3)})")
        if self.offset.uncertainty > 0:
            fitted = Input(self.offset.uncertainty / _OF_95)
            stated = replace(stated, inputs={**stated.inputs, "foot_x": fitted})
        by: dict[str, Any] = {"noise": self.noise, "window": self.tolerances.snap_off_window}
        found = validate(self, case, stated, simulation=simulation, budget=budget, **by)
        return replace(self, validation=found)

    def _failures(self) -> Iterator[Failure]:
        return failures(self, self.tolerances, self.noise)

    def _own(self) -> dict[str, Any]:
        agreement = self.phase_agreement()
        return {
            "likely": self.likely,
            "offset": self.offset,
            **({} if self.validation is None else {"validation": self.validation.to_dict()}),
            "disagreement": self.disagreement,
            "phases": {
                "agreement": min(agreement.values()) if agreement else None,
                "agreement_by_sweep": agreement,
                "confusion": {
                    which: {"phases": list(PHASES), "counts": table.to_numpy().tolist()}
                    for which, table in self.confusion.items()
                },
                "transitions": {name: event.to_dict() for name, event in self.transitions.items()},
            },
            "running": self.reference.running,
            "snap_off": self.snap_off.to_dict(),
            "stations": self.alignment.counts,
            "records": {which: record.to_dict() for which, record in self.records.items()},
        }

    def _own_metrics(self) -> dict[str, Number]:
        return {
            "phase_agreement": min(self.phase_agreement().values(), default=None),
            "stations_compared": self.alignment.counts["compared"],
        }

    def _places(self) -> Mapping[str, Occurrence | None]:
        places = {f"transition_{name}": event for name, event in self.transitions.items()}
        return {**places, "snap_off": self.snap_off}


@dataclass(frozen=True, eq=False, repr=False)
class SpatialComparison(Judged[SpatialReadings], SpatialMeasurement):
    """A measurement in space with its limits: what exceeds them.

    Attributes
    ----------
    tolerances : SpatialTolerances
        Limits for the verdict.
    noise : SpatialAllowance
        What noise adds to the limits.
    """

    tolerances: SpatialTolerances
    noise: SpatialAllowance

    @cached_property
    def likely(self) -> str | None:
        """What the disagreement looks like; None if it agrees, or matches no known mistake."""
        return None if self.agrees else likely_in_space(self, self.tolerances, self.noise)

    @property
    def largest(self) -> str:
        """The component that is off most, by its rms."""
        sizes = {name: one.rms for name, one in self.disagreement.items()}
        return max(sizes, key=lambda name: np.nan_to_num(sizes[name]))

    def _beside(self) -> Iterator[str]:
        known = f"{self.contact.rms:.1e} L rms" if self.contact.stations else "at no station known"
        yield f"  contact   {known}"

    def _failures(self) -> Iterator[Failure]:
        return failures_in_space(self, self.tolerances, self.noise)

    def _own(self) -> dict[str, Any]:
        off = {name: asdict(one) for name, one in self.disagreement.items()}
        return {
            "frame": self.frame,
            "disagreement": {name: {key: one[key] for key in _KEPT} for name, one in off.items()},
            "contact": self.contact.to_dict(),
            "phases": {"agreement": self.phase_agreement},
            "events": {name: one.to_dict() for name, one in self.events.items()},
            "stations": {
                "all": len(self.compared),
                "compared": int(self.compared.sum()),
                "untrusted": self.untrusted,
                "status": self.statuses,
            },
        }

    def _own_metrics(self) -> dict[str, Number]:
        return {
            "phase_agreement": self.phase_agreement,
            "stations_compared": int(self.compared.sum()),
            "contact_rms": self.contact.rms,
        }

    def _places(self) -> Mapping[str, Occurrence | None]:
        return {name: self.events.get(event) for name, event in _EVENTS.items()}


@overload
def compare(
    reference: Readings,
    candidate: Readings,
    tolerances: Tolerances | None = None,
    *,
    offset: float | Literal["auto"] = 0.0,
    noise: float | Literal["auto"] = 0.0,
) -> Comparison: ...


@overload
def compare(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    tolerances: SpatialTolerances | None = None,
    *,
    noise: float | Literal["auto"] = 0.0,
    frame: Frame = "world",
) -> SpatialComparison: ...


@overload
def compare(
    reference: Readings | SpatialReadings,
    candidate: Readings | SpatialReadings,
    tolerances: Tolerances | SpatialTolerances | None = None,
    *,
    offset: float | Literal["auto"] = 0.0,
    noise: float | Literal["auto"] = 0.0,
    frame: Frame = "world",
) -> Comparison | SpatialComparison: ...


def compare(
    reference: Readings | SpatialReadings,
    candidate: Readings | SpatialReadings,
    tolerances: Tolerances | SpatialTolerances | None = None,
    *,
    offset: float | Literal["auto"] = 0.0,
    noise: float | Literal["auto"] = 0.0,
    frame: Frame = "world",
) -> Comparison | SpatialComparison:
    """Set `candidate` against `reference`, from their readings alone.

    Parameters
    ----------
    reference, candidate : Readings or SpatialReadings
        Two sweeps of the same beam, both in the plane or both in space; in space at the same
        stations.
    tolerances : Tolerances or SpatialTolerances, optional
        Limits for the verdict.
    offset : float or "auto"
        In the plane: by how much the candidate's ``foot_x`` exceeds the reference's for one foot
        position [length]; ``"auto"`` estimates it from the readings.
    noise : float or "auto"
        Standard deviation of the clamp readings' noise over their largest magnitude. The limits are
        widened by what such noise does. ``"auto"`` estimates it from both sweeps, and takes for
        noise all that jumps from station to station.
    frame : {"world", "clamp"}
        In space: in which the components are compared.

    Returns
    -------
    Comparison or SpatialComparison
        The measurement, its verdict and its likely cause.

    Raises
    ------
    InputError
        If the sweeps are of different beams or have no common stretch, the reference never touches
        or its rows are out of order, or the noise is no fraction of the
        largest magnitude; in space, if they are of two clamps or not at the same stations. If one
        is in the plane and the other in space, or what is given is for the other kind.
    """
    if isinstance(reference, SpatialReadings):
        if offset != 0:
            raise InputError("offset", offset, "0 in space", "leave it out, or widen the limits")
        candidate = require("candidate", candidate, SpatialReadings, _AS_TABLE)
        limits = checked_limits(tolerances, SpatialTolerances)
        limits = limits if in_segments(candidate) else limits.by_convention()
        check_same_stations(reference, candidate)
        scales = component_scales(reference)
        level = component_levels(reference, candidate, noise, scales)
        stated = {name: level[name] * scales[name] for name in level}
        in_space = measure_in_space(reference, candidate, stated, frame)
        widened = spatial_allowance(reference, level, stated, in_space.touching.clear)
        return SpatialComparison(**vars(in_space), tolerances=limits, noise=widened)
    if frame != "world":
        raise InputError("frame", repr(frame), "'world' in the plane", "leave it out")
    reference = require("reference", reference, Readings, _AS_TABLE)
    candidate = require("candidate", candidate, Readings, _AS_TABLE)
    tolerances = checked_limits(tolerances, Tolerances).suited_to(candidate)
    found = measure(reference, candidate, tolerances.snap_off_window, offset)
    if noise == "auto":
        allowance = noise_allowance(reference, noise_level(reference, found.candidate))
    else:
        allowance = noise_allowance(reference, Noise(checked_level(noise)))
    events = {
        name: replace(event, uncertainty=event.uncertainty + allowance.transitions.get(name, 0.0))
        for name, event in found.events.items()
    }
    return Comparison(**(vars(found) | {"events": events}), tolerances=tolerances, noise=allowance)
