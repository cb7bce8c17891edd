"""The vibrissa: a straight, inextensible elastic beam with a round tip."""

import math
from dataclasses import dataclass

from analytic.problem.errors import InputError


@dataclass(frozen=True)
class Beam:
    """A technical vibrissa, in any consistent units.

    Parameters
    ----------
    length : float
        Length L from the clamp to the centre of the round tip [length].
    flexural_rigidity : float
        Flexural rigidity EI [force length^2].
    radius : float
        Radius of the cross-section and of the tip [length]; 0 is the paper's thin vibrissa, which
        only the analytic side can handle.

    Raises
    ------
    InputError
        If a value is not finite, length or rigidity is not positive, or the radius is negative or
        not small against the length.
    """

    length: float = 1.0
    flexural_rigidity: float = 1.0
    radius: float = 0.005

    def __post_init__(self) -> None:
        for name in ("length", "flexural_rigidity"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise InputError(
                    f"beam.{name}", value, "positive and finite", "give it in the units of the case"
                )
        if not (math.isfinite(self.radius) and 0 <= self.radius < 0.1 * self.length):
            raise InputError(
                "beam.radius",
                self.radius,
                f"finite, not negative and below a tenth of the length ({self.length:g})",
                "a vibrissa is slender: check the units of radius and length",
            )

    @property
    def force_unit(self) -> float:
        """EI/L^2, the force that the dimensionless solution counts in [force]."""
        return self.flexural_rigidity / self.length**2

    @property
    def moment_unit(self) -> float:
        """EI/L, the moment that the dimensionless solution counts in [force length]."""
        return self.flexural_rigidity / self.length
