"""The comparison of two sweeps: measured, judged by limits, and explained."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Any, Literal

from analytic import PHASES, Case, InputError, Readings
from compare.explain.budget import Budget
from compare.explain.likely import likely_cause
from compare.judge.allowance import NoiseAllowance, noise_allowance
from compare.judge.failures import Failure, failures
from compare.judge.tolerances import CONVENTION, Tolerances
from compare.measure.measurement import Measurement, measure
from compare.sense.noise import checked_level, noise_level
from compare.validate.stated import Input, Uncertainties
from compare.validate.validation import Side, Validation, validate

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_SHOWN = 6  # failures in the short form
_OF_95 = 1.96  # standard deviations: half the width of an interval that holds 95 % of a normal


@dataclass(frozen=True, repr=False)
class Comparison(Measurement):
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
    def exceeded(self) -> tuple[Failure, ...]:
        """Every limit that is exceeded."""
        return tuple(failures(self, self.tolerances, self.noise))

    @property
    def failures(self) -> tuple[str, ...]:
        """Every limit that is exceeded, in a sentence each."""
        return tuple(str(failure) for failure in self.exceeded)

    @property
    def worst(self) -> Failure | None:
        """The limit that is exceeded most; None if the sweeps agree."""
        return max(self.exceeded, key=lambda failure: failure.excess, default=None)

    @cached_property
    def likely(self) -> str | None:
        """What the disagreement looks like; None if it agrees, or matches no known cause."""
        return None if self.agrees else likely_cause(self, self.tolerances, self.noise)

    @property
    def remark(self) -> str | None:
        """What is to be known of the limits that are exceeded; None if there is nothing."""
        return CONVENTION if self.exceeded and self.tolerances.conventional else None

    @property
    def agrees(self) -> bool:
        """Whether no tolerance is exceeded."""
        return not self.exceeded

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
        if self.offset.uncertainty > 0:
            fitted = Input(self.offset.uncertainty / _OF_95)
            stated = replace(stated, inputs={**stated.inputs, "foot_x": fitted})
        found = validate(
            self,
            case,
            stated,
            simulation=simulation,
            budget=budget,
            noise=self.noise,
            window=self.tolerances.snap_off_window,
        )
        return replace(self, validation=found)

    def to_dict(self) -> dict[str, Any]:
        """What ``comparison.json`` holds.

        Returns
        -------
        dict
            Lengths in the beam's unit, the rest relative; JSON can hold it.
        """
        agreement = self.phase_agreement()
        found: dict[str, Any] = _plain(
            {
                "verdict": "agrees" if self.agrees else "disagrees",
                "failures": list(self.failures),
                "likely": self.likely,
                "offset": asdict(self.offset),
                "noise": asdict(self.noise),
                **({} if self.validation is None else {"validation": self.validation.to_dict()}),
                "disagreement": {name: asdict(d) for name, d in self.disagreement.items()},
                "phases": {
                    "agreement": min(agreement.values()) if agreement else None,
                    "agreement_by_sweep": agreement,
                    "confusion": {
                        which: {"phases": list(PHASES), "counts": table.to_numpy().tolist()}
                        for which, table in self.confusion.items()
                    },
                    "transitions": {
                        name: event.to_dict() for name, event in self.transitions.items()
                    },
                },
                "snap_off": self.snap_off.to_dict(),
                "stations": self.alignment.counts,
                "records": {which: record.to_dict() for which, record in self.records.items()},
                "tolerances": {name: float(x) for name, x in self.tolerances.limits().items()},
                "tolerance_reasons": {n: x.reason for n, x in self.tolerances.limits().items()},
                "reference": _origin(self.reference),
                "candidate": _origin(self.candidate),
            }
        )
        return found

    def plot(self) -> list[Axes]:
        """Draw the clamp readings of both sweeps over the foot position.

        Returns
        -------
        list of matplotlib.axes.Axes
            One a reading; a notebook shows them.
        """
        return self.candidate.plot(self.reference.plot())

    def __repr__(self) -> str:
        """The verdict, the disagreement of each reading, and what failed."""
        return "\n".join(self._lines())

    def _repr_html_(self) -> str:
        """The same for a notebook."""
        return "<pre>" + "<br>".join(escape(line) for line in self._lines()) + "</pre>"

    def _lines(self) -> Iterator[str]:
        verdict = "agrees with" if self.agrees else "disagrees with"
        compared = self.alignment.counts["compared"]
        yield (
            f"{self.candidate.source} {verdict} {self.reference.source} "
            f"({compared} of {len(self.candidate.table)} stations compared)"
        )
        if self.likely is not None:
            yield f"  likely: {self.likely}"
        for name, d in self.disagreement.items():
            limit = self.tolerances.of_sweep(name)
            yield f"  {name:9} rms {d.rms:.1e}  max {d.max:.1e}  allowed {limit:.1e} rms"
        for name, event in {**self.transitions, "snap_off": self.snap_off}.items():
            if event.difference is not None:
                yield f"  {name:13} {event.reference:.5g} {event.difference:+.1e}"
        for failure in self.exceeded[:_SHOWN]:
            yield f"  failed: {failure.clause}"
        if len(self.exceeded) > _SHOWN:
            yield f"  and {len(self.exceeded) - _SHOWN} more, see .failures"
        if self.remark is not None:
            yield f"  {self.remark}"


def compare(
    reference: Readings,
    candidate: Readings,
    tolerances: Tolerances | None = None,
    *,
    offset: float | Literal["auto"] = 0.0,
    noise: float | Literal["auto"] = 0.0,
) -> Comparison:
    """Set `candidate` against `reference`, from their readings alone.

    Parameters
    ----------
    reference, candidate : Readings
        Two sweeps of the same beam.
    tolerances : Tolerances, optional
        Limits for the verdict.
    offset : float or "auto"
        By how much the candidate's ``foot_x`` exceeds the reference's for one foot position
        [length]; ``"auto"`` estimates it from the readings.
    noise : float or "auto"
        Standard deviation of the clamp readings' noise over their largest magnitude. The limits are
        widened by what such noise does. ``"auto"`` estimates it from both sweeps, and takes for
        noise all that jumps from station to station.

    Returns
    -------
    Comparison
        The measurement, its verdict and its likely cause.

    Raises
    ------
    InputError
        If the sweeps are of different beams or have no common stretch, the reference never touches
        or its rows are out of order, the offset is ambiguous, or the noise is no share of the
        largest magnitude.
    """
    for name, given, kind in (
        ("reference", reference, Readings),
        ("candidate", candidate, Readings),
        ("tolerances", tolerances, Tolerances | None),
    ):
        if not isinstance(given, kind):
            raise InputError(
                name,
                f"a {type(given).__name__}",
                "Readings" if kind is Readings else "Tolerances",
                "wrap a table as Readings(table, beam)" if kind is Readings else "see its fields",
            )
    tolerances = (Tolerances() if tolerances is None else tolerances).suited_to(candidate)
    found = measure(reference, candidate, tolerances.snap_off_window, offset)
    level = noise_level(reference, found.candidate) if noise == "auto" else checked_level(noise)
    allowance = noise_allowance(reference, level)
    widened = {
        name: replace(event, uncertainty=event.uncertainty + allowance.transitions.get(name, 0.0))
        for name, event in found.transitions.items()
    }
    return Comparison(
        **(vars(found) | {"transitions": widened}), tolerances=tolerances, noise=allowance
    )


def _plain(value: Any) -> Any:  # noqa: ANN401  # whatever JSON can hold
    """JSON has neither NaN nor infinity: None stands for both."""
    if isinstance(value, Mapping):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _origin(readings: Readings) -> dict[str, Any]:
    return {
        "source": readings.source,
        "beam": asdict(readings.beam),
        "stations": len(readings.table),
        "provenance": {k: v for k, v in readings.provenance.items() if k != "contour"},
    }
