"""The sensor of a study, and the method that finds the object from it."""

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import AfterValidator, Field

from analytic import CLAMP_READINGS
from compare.read.quantities import Table

if TYPE_CHECKING:
    from analytic import Readings
    from analytic.space import SpatialReadings


class SensorNoise(Table):
    """Gaussian noise of the sensor at the clamp."""

    # Standard deviation, relative to each reading's largest magnitude.
    relative: float = Field(default=0.0, ge=0, lt=1)
    seed: int = Field(default=0, ge=0, lt=2**63)  # the row's column has 64 bits

    def add_to(self, readings: "Readings | SpatialReadings") -> "Readings | SpatialReadings":
        """Add the noise to a sweep; in space to the forces and the moments, each as one reading."""
        if self.relative == 0:
            return readings
        from analytic.space import SpatialReadings  # pandas is slow to load, a check needs none
        from compare.sense.noise import with_noise

        if isinstance(readings, SpatialReadings):
            return self._add_in_space(readings)
        return with_noise(readings, dict.fromkeys(CLAMP_READINGS, self.relative), self.seed)

    def _add_in_space(self, readings: "SpatialReadings") -> "SpatialReadings":
        from analytic.space.problem.readings import FORCE, MOMENT

        table, random = readings.table.copy(), np.random.default_rng(self.seed)
        for names in (FORCE, MOMENT):
            values = readings.values(*names)
            size = self.relative * np.nanmax(np.abs(values))
            table[[*names]] = values + size * random.normal(size=values.shape)
        return replace(readings, table=table)


def _known(name: str) -> str:
    from analytic.from_clamp.earlier.methods import NAMES  # slow to load, and few studies name one

    if name not in NAMES:
        raise ValueError(f"a method is one of {', '.join(NAMES)}")
    return name


class Estimator(Table):
    """The method that ``reconstruction`` is recorded of."""

    # Name of a method, as `analytic.reconstruct` takes it.
    method: Annotated[str, AfterValidator(_known)] = "elastica"
