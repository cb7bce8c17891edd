"""What every measurement of two sweeps has, in the plane and in space."""

from dataclasses import dataclass
from typing import Generic, TypeVar

from analytic import Readings
from analytic.space import SpatialReadings
from compare.measure.disagreement import Disagreement

Sweep = TypeVar("Sweep", Readings, SpatialReadings)


@dataclass(frozen=True, eq=False, repr=False)
class SweepPair(Generic[Sweep]):
    """Two sweeps, and how far each component of the candidate is off along their travel."""

    reference: Sweep
    candidate: Sweep
    disagreement: dict[str, Disagreement]
