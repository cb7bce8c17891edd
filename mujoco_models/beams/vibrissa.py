"""The vibrissa that MuJoCo's beams stand for: its shape at rest, how it bends, how its clamp turns."""

import math
from dataclasses import dataclass, field

import numpy as np

from analytic.problem.along import Along
from analytic.problem.arrays import Floats
from analytic.problem.beam import Beam
from analytic.problem.unloaded import Unloaded

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)  # of a piece of a cell, where it is smooth


@dataclass(frozen=True)
class Vibrissa:
    """Dimensionless: its length, and its flexural rigidity at the clamp, are 1.

    Attributes
    ----------
    rest : Unloaded
        Its shape and radius at rest.
    rigidity : Along, optional
        Flexural rigidity along it, in arc lengths of the case and any unit; if it is not given, it
        follows the fourth power of the radius.
    clamp_compliance : float
        Turn of the clamp by moment, 0 if it is rigid [L/EI].
    """

    rest: Unloaded = field(default_factory=lambda: Beam().unloaded)
    rigidity: Along | None = None
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
        given = beam.flexural_rigidity
        rigidity = given if isinstance(given, Along) else None
        return cls(beam.unloaded, rigidity, beam.moment_unit / clamp_stiffness)

    @property
    def is_straight(self) -> bool:
        """Whether it is straight at rest."""
        return self.rest.natural == 0

    @property
    def is_cone(self) -> bool:
        """Whether its radius varies."""
        return self.rest.base_radius != self.rest.tip_radius

    @property
    def is_plain(self) -> bool:
        """Whether it is straight and uniform, and its clamp rigid."""
        uniform = self.rigidity is None and not self.is_cone
        return self.is_straight and uniform and self.clamp_compliance == 0

    def turn(self, s: Floats) -> Floats:
        """By how much the unloaded vibrissa is turned from the upright, to the left.

        Parameters
        ----------
        s : array, any shape
            Arc length [L].

        Returns
        -------
        array, shape of `s`
            Angle [rad].
        """
        return np.asarray(self.rest.at(s)[2] - np.pi / 2)

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
        x, y, _ = self.rest.at(s)
        return np.stack([x, y], axis=-1)

    def thickness(self, s: Floats) -> Floats:
        """Radius over that at the clamp.

        Parameters
        ----------
        s : array, any shape
            Arc length [L].

        Returns
        -------
        array, shape of `s`
            1 everywhere but on a cone.
        """
        if not self.is_cone:
            return np.ones_like(s)
        return (self.rest.tip_radius + self.rest.taper(s)) / self.rest.base_radius

    def softness(self, edges: Floats) -> Floats:
        """Compliance of pieces of the vibrissa over that of as long a piece at the clamp.

        Parameters
        ----------
        edges : array, shape (n + 1,)
            Arc lengths at which n pieces begin and end, ascending [L].

        Returns
        -------
        array, shape (n,)
            Mean of 1/rigidity over each piece.
        """
        if self.rigidity is not None:
            return self._mean_softness(self.rigidity, edges)
        thick = self.thickness(edges)
        a, b = thick[:-1], thick[1:]
        # The integral of the fourth power of 1/thickness, which is linear.
        return np.asarray((a**2 + a * b + b**2) / (3 * a**3 * b**3))

    def _mean_softness(self, rigidity: Along, edges: Floats) -> Floats:
        """By quadrature, piece by piece of the cells and of the rigidity."""
        ends = np.array(rigidity.ends) / rigidity.ends[-1]
        marks = np.unique(np.concatenate([edges, ends[(ends > edges[0]) & (ends < edges[-1])]]))
        half, middle = np.diff(marks) / 2, (marks[1:] + marks[:-1]) / 2
        places = (middle[:, None] + half[:, None] * _NODES) * rigidity.ends[-1]
        integrals = half * (rigidity(np.zeros(1)) / rigidity(places) @ _WEIGHTS)
        reached = np.concatenate([[0.0], np.cumsum(integrals)])
        return np.asarray(np.diff(reached[np.searchsorted(marks, edges)]) / np.diff(edges))
