"""The sensor of a study: noise that is added to the clamp readings of a sweep."""

from typing import TYPE_CHECKING

from pydantic import Field

from analytic import CLAMP_READINGS
from compare.read.quantities import Table

if TYPE_CHECKING:
    from analytic import Readings


class SensorNoise(Table):
    """Gaussian noise of the sensor at the clamp."""

    # Standard deviation, relative to each reading's largest magnitude.
    relative: float = Field(default=0.0, ge=0, lt=1)
    seed: int = Field(default=0, ge=0, lt=2**63)  # the row's column has 64 bits

    def add_to(self, readings: "Readings") -> "Readings":
        """Add the noise to a sweep."""
        if self.relative == 0:
            return readings
        from compare.sense.noise import with_noise  # pandas is slow to load, a check needs none

        return with_noise(readings, dict.fromkeys(CLAMP_READINGS, self.relative), self.seed)
