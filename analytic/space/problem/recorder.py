"""The rows of a sweep in space, and the readings that they are."""

from dataclasses import dataclass

import pandas as pd

from analytic.problem.recorder import AnyRecorder
from analytic.space.problem.case import SpatialCase
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FORCE,
    MOMENT,
    NORMAL,
    SpatialReadings,
)


@dataclass
class SpatialRecorder(AnyRecorder[SpatialReadings]):
    """Its events are a list of what `analytic.numerics.walk` calls events."""

    case: SpatialCase

    def readings(self) -> SpatialReadings:
        """All rows, in the units of the case's beam."""
        beam, way = self.case.beam, self.case.way
        events = [
            {
                "kind": event.kind,
                "travel": event.travel * beam.length,
                "foot": (way.foot(event.travel) * beam.length).tolist(),
            }
            for event in sorted(self.events(), key=lambda event: event.travel)
        ]
        columns = self._columns(("phase", *FORCE, *MOMENT, *CONTACT_POINT, *NORMAL))
        tangent, provenance = self.case.path.clamp_tangent, self._provenance(events)
        return SpatialReadings(pd.DataFrame(columns), beam, tangent, self.source, provenance)
