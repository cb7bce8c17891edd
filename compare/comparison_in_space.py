"""The comparison of two sweeps in space: six components, contact points, phases and events."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np

from analytic.space import SpatialReadings
from compare.align.frames import Frame
from compare.align.travel import check_same_stations
from compare.judge.allowance import SpatialAllowance, spatial_allowance
from compare.judge.failures import Failure, failures_in_space
from compare.judge.judged import Judged, Number
from compare.judge.spatial import SpatialTolerances
from compare.judge.tolerances import checked_limits, in_segments
from compare.measure.in_space import SpatialMeasurement, measure_in_space
from compare.sense.given import checked_sweep
from compare.sense.occurrence import Occurrence
from compare.sense.touching import component_levels, component_scales

_KEPT = ("rms", "max", "at", "phase", "rms_by_phase", "scale")  # of a disagreement
_EVENTS = {"touch": "touch", "slip_off": "slip-off", "release": "release"}


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
        frame, or the noise is no fraction of the largest component.
    """
    reference = checked_sweep("reference", reference, SpatialReadings)
    candidate = checked_sweep("candidate", candidate, SpatialReadings)
    tolerances = checked_limits(tolerances, SpatialTolerances)
    if not in_segments(candidate):
        tolerances = tolerances.by_convention()
    check_same_stations(reference, candidate)
    scales = component_scales(reference)
    level = component_levels(reference, candidate, noise, scales)
    stated = {name: level[name] * scales[name] for name in level}
    found = measure_in_space(reference, candidate, stated, frame)
    allowance = spatial_allowance(reference, level, stated, found.touching.clear)
    return SpatialComparison(**vars(found), tolerances=tolerances, noise=allowance)
