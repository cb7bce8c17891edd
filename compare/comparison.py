"""The comparison of two sweeps: measured, judged by limits, and explained."""

from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np

from analytic import PHASES, Readings
from compare.explain.causes import likely_cause
from compare.judge.allowance import NoiseAllowance, noise_allowance
from compare.judge.failures import failures
from compare.judge.tolerances import Tolerances
from compare.measure.measurement import Measurement, measure
from compare.sense.noise import checked_level, noise_level


@dataclass(frozen=True)
class Comparison(Measurement):
    """A measurement with its limits: what exceeds them, and what that looks like.

    Attributes
    ----------
    tolerances : Tolerances
        Limits for the verdict.
    noise : NoiseAllowance
        What noise adds to the limits.
    """

    tolerances: Tolerances
    noise: NoiseAllowance

    @cached_property
    def failures(self) -> tuple[str, ...]:
        """Every limit that is exceeded, in a sentence each."""
        return tuple(failures(self, self.tolerances, self.noise))

    @cached_property
    def likely(self) -> str | None:
        """What the disagreement looks like; None if it agrees, or matches no known cause."""
        return None if self.agrees else likely_cause(self, self.tolerances.snap_off_window)

    @property
    def agrees(self) -> bool:
        """Whether no tolerance is exceeded."""
        return not self.failures

    def to_dict(self) -> dict[str, Any]:
        """What ``comparison.json`` holds; lengths in the beam's unit, the rest relative."""
        agreement = self.phase_agreement()
        return {
            "verdict": "agrees" if self.agrees else "disagrees",
            "failures": list(self.failures),
            "likely": self.likely,
            "offset": asdict(self.offset),
            "noise": asdict(self.noise),
            "disagreement": {name: _plain(asdict(d)) for name, d in self.disagreement.items()},
            "phases": {
                "agreement": min(agreement.values()) if agreement else None,
                "agreement_by_sweep": agreement,
                "confusion": {
                    which: {"phases": list(PHASES), "counts": table.to_numpy().tolist()}
                    for which, table in self.confusion.items()
                },
                "transitions": {name: place.to_dict() for name, place in self.transitions.items()},
            },
            "snap_off": self.snap_off.to_dict(),
            "stations": self.alignment.counts,
            "tolerances": {name: float(x) for name, x in self.tolerances.limits().items()},
            "tolerance_reasons": {n: x.reason for n, x in self.tolerances.limits().items()},
            "reference": _origin(self.reference),
            "candidate": _origin(self.candidate),
        }


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
        By how much the candidate's ``foot_x`` exceeds the reference's for one and the same place
        [length]; ``"auto"`` estimates it from the readings.
    noise : float or "auto"
        Standard deviation of the clamp readings' noise over their largest magnitude. The limits are
        widened by what such noise does. ``"auto"`` estimates it from both sweeps, and takes
        everything for noise that jumps from station to station.

    Returns
    -------
    Comparison
        The measurement, its verdict and its likely cause.

    Raises
    ------
    InputError
        If the sweeps are of different beams or have no common stretch, the offset is ambiguous, or
        the noise is no share of the largest magnitude.
    """
    tolerances = Tolerances() if tolerances is None else tolerances
    found = measure(reference, candidate, tolerances.snap_off_window, offset)
    level = noise_level(reference, found.candidate) if noise == "auto" else checked_level(noise)
    allowance = noise_allowance(reference, level)
    widened = {
        name: replace(place, uncertainty=place.uncertainty + allowance.transitions.get(name, 0.0))
        for name, place in found.transitions.items()
    }
    return Comparison(
        **(vars(found) | {"transitions": widened}), tolerances=tolerances, noise=allowance
    )


def _plain(value: dict[str, Any]) -> dict[str, Any]:
    """JSON has no NaN."""
    return {k: None if isinstance(v, float) and np.isnan(v) else v for k, v in value.items()}


def _origin(readings: Readings) -> dict[str, Any]:
    return {
        "source": readings.source,
        "beam": asdict(readings.beam),
        "stations": len(readings.table),
        "provenance": {k: v for k, v in readings.provenance.items() if k != "contour"},
    }
