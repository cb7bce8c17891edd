"""The rows of a sweep in space, and the readings that they are."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import pandas as pd

from analytic.numerics.arrays import Floats
from analytic.numerics.walk import WalkEvent
from analytic.problem.recorder import AnyRecorder
from analytic.space.problem.case import SpatialCase
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FOOT,
    FORCE,
    MOMENT,
    NORMAL,
    SpatialReadings,
)


@dataclass
class SpatialRecorder(AnyRecorder[SpatialReadings]):
    """Its events are what `analytic.numerics.walk` calls events."""

    case: SpatialCase

    @cached_property
    def places(self) -> dict[str, Floats]:
        path = self.case.path
        return {"travel": path.travel, **dict(zip(FOOT, path.at(path.travel).T, strict=True))}

    def readings(self) -> SpatialReadings:
        events = stated(self.case, self.events())
        columns = self._columns(("phase", *FORCE, *MOMENT, *CONTACT_POINT, *NORMAL))
        tangent, provenance = self.case.path.clamp_tangent, self._provenance(events)
        return SpatialReadings(
            pd.DataFrame(columns), self.case.beam, tangent, self.source, provenance
        )


def stated(case: SpatialCase, events: Iterable[WalkEvent]) -> list[dict[str, Any]]:
    """Events as provenance has them, in the case's unit of length."""
    way, length = case.way, case.beam.length
    return [
        {"kind": kind, "travel": at * length, "foot": (way.foot(at) * length).tolist()}
        for kind, at in sorted(events, key=lambda event: event.travel)
    ]
