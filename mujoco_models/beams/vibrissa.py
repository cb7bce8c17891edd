"""The vibrissa that MuJoCo's beams stand for: its shape at rest, and how its clamp turns."""

import math
from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.beam import Beam
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
    def of(cls, beam: Beam, clamp_stiffness: float = math.inf) -> "Vibrissa":
        """That of a case whose foot moves to the left.

        Parameters
        ----------
        beam : Beam
            The case's.
        clamp_stiffness : float
            Moment of the clamp by its rotation [force length/rad].

        Returns
        -------
        Vibrissa
        """
        return cls(beam.natural_curvature * beam.length, beam.moment_unit / clamp_stiffness)

    @property
    def is_plain(self) -> bool:
        """Whether it is straight and its clamp rigid."""
        return self == Vibrissa()

    def turn(self, s: Floats) -> Floats:
        """By how much the unloaded vibrissa is turned from the upright, to the left.

        Parameters
        ----------
        s : array, any shape
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
