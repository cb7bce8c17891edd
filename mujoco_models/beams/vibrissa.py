"""The case's vibrissa as MuJoCo's beams are made from it: its shape at rest, its bending, its clamp."""

from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.rest import arc


@dataclass(frozen=True)
class Vibrissa:
    """Dimensionless: length and flexural rigidity are 1.

    Attributes
    ----------
    natural_curvature : float
        Of the unloaded vibrissa, positive to the left [1/L].
    clamp_compliance : float
        Turn of the clamp by moment, 0 if it is rigid [L/EI].
    """

    natural_curvature: float = 0.0
    clamp_compliance: float = 0.0

    @classmethod
    def of(cls, case: Case) -> "Vibrissa":
        """That of a case.

        Parameters
        ----------
        case : Case
            Of a sweep to the left.

        Returns
        -------
        Vibrissa
        """
        beam = case.beam
        return cls(
            beam.natural_curvature * beam.length, beam.moment_unit / case.clamp_stiffness
        )

    @property
    def is_plain(self) -> bool:
        """Whether it is straight and its clamp rigid."""
        return self == Vibrissa()

    def turn(self, s: Floats) -> Floats:
        """By how much the unloaded vibrissa is turned from the upright, to the left.

        Parameters
        ----------
        s : array
            Arc length; negative ones are on its continuation behind the clamp [L].

        Returns
        -------
        array, shape of `s`
            Angle [rad].
        """
        return np.asarray(self.natural_curvature * s)

    def at(self, s: Floats) -> Floats:
        """Where the unloaded vibrissa is, as seen from the foot.

        Parameters
        ----------
        s : array, shape (...)
            Arc length [L].

        Returns
        -------
        array, shape (..., 2)
            Position [L].
        """
        x, y, _ = arc(self.natural_curvature, np.asarray(s))
        return np.stack([x, y], axis=-1)
