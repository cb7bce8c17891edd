"""The vibrissa: an inextensible elastic beam with a round tip, straight or an arc at rest."""

import math
from dataclasses import dataclass, field, replace

from analytic.problem.errors import InputError
from analytic.problem.numbers import is_finite_number


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
    natural_curvature : float
        Of the vibrissa at rest [1/length]: an arc from the upright clamp, positive to the left of
        its way from clamp to tip; 0 is the paper's straight vibrissa.
    si : bool
        Whether these numbers, and all that belong to them, are known to be in metres and newtons,
        as those of a case whose quantities have units. Only reports and pictures use it: they
        name the units then.

    Raises
    ------
    InputError
        If a value is not a finite number, length or rigidity is not positive, the units of force
        and moment that follow overflow, the radius is negative or not small against the length, or
        the vibrissa at rest is curved back to the foot line.
    """

    length: float = 1.0
    flexural_rigidity: float = 1.0
    radius: float = 0.005
    natural_curvature: float = field(default=0.0, kw_only=True)
    si: bool = field(default=False, kw_only=True, compare=False, repr=False)

    def __post_init__(self) -> None:
        for name in ("length", "flexural_rigidity"):
            value = getattr(self, name)
            if not (is_finite_number(value) and value > 0):
                raise InputError(
                    f"beam.{name}", value, "positive and finite", "give it in the units of the case"
                )
        if not (is_finite_number(self.radius) and 0 <= self.radius < 0.1 * self.length):
            raise InputError(
                "beam.radius",
                self.radius,
                f"finite, not negative and below a tenth of the length ({self.length:g})",
                "a vibrissa is slender: check the units of radius and length",
            )
        if not isinstance(self.si, bool):
            raise InputError("beam.si", repr(self.si), "True or False", "leave it out")
        turn = self.natural_curvature
        if not (is_finite_number(turn) and abs(turn) * self.length < math.pi):
            raise InputError(
                "beam.natural_curvature",
                turn,
                f"finite and within {math.pi / self.length:.6g} of zero, where the vibrissa at rest"
                " is curved back to the foot line",
                "it is an inverse length, positive to the left",
            )
        for name in ("length", "flexural_rigidity", "radius", "natural_curvature"):
            object.__setattr__(self, name, float(getattr(self, name)))
        if not self._has_units():
            raise InputError(
                "beam.flexural_rigidity",
                f"{self.flexural_rigidity:g} with a length of {self.length:g}",
                "such that EI/L^2 and EI/L are numbers",
                "choose units nearer to the case",
            )

    @property
    def force_unit(self) -> float:
        """EI/L^2, in which the dimensionless solution counts forces [force]."""
        return self.flexural_rigidity / self.length**2

    @property
    def moment_unit(self) -> float:
        """EI/L, in which the dimensionless solution counts moments [force length]."""
        return self.flexural_rigidity / self.length

    def mirrored(self) -> "Beam":
        """The mirror image, x to -x.

        Returns
        -------
        Beam
            Curved the other way at rest.
        """
        if self.natural_curvature == 0:
            return self
        return replace(self, natural_curvature=-self.natural_curvature)

    def _has_units(self) -> bool:
        try:
            return 0 < self.force_unit < math.inf and 0 < self.moment_unit < math.inf
        except (OverflowError, ZeroDivisionError):
            return False
