"""The vibrissa that MuJoCo's beams stand for: its shape at rest, its bending and its clamp."""

from dataclasses import dataclass, field

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.along import Along
from analytic.problem.beam import Beam, Unloaded
from analytic.problem.support import Support

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)  # of a piece of a cell, where it is smooth


@dataclass(frozen=True)
class Vibrissa:
    """Dimensionless: its length, and its flexural rigidity at the clamp, are 1."""

    rest: Unloaded = field(default_factory=lambda: Beam().unloaded)  # its shape and radius at rest
    # Flexural rigidity along it, in arc lengths of the case and any unit; if it is not given, it
    # follows the fourth power of the radius.
    rigidity: Along | None = None
    clamp_compliance: float = 0.0  # turn of the clamp by moment, 0 if it is rigid [L/EI]
    weight: tuple[float, float] = (0.0, 0.0)  # along x and y, by length [EI/L^3]

    @classmethod
    def of(cls, beam: Beam, held: Support) -> "Vibrissa":
        """That of a case whose clamp goes to the left, as the clamp has it."""
        given = beam.flexural_rigidity
        rigidity = given if isinstance(given, Along) else None
        w_x, w_y = (w * beam.length / beam.force_unit for w in held.weight)
        compliance = beam.moment_unit / held.clamp_stiffness
        return cls(beam.unloaded, rigidity, compliance, (w_x, w_y))

    @property
    def is_straight(self) -> bool:
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
        """By how much the unloaded vibrissa is turned from the upright, to the left."""
        return np.asarray(self.rest.at(s)[2] - np.pi / 2)

    def at(self, s: Floats) -> Floats:
        """Where the unloaded vibrissa is, as seen from the foot."""
        x, y, _ = self.rest.at(s)
        return np.stack([x, y], axis=-1)

    def thickness(self, s: Floats) -> Floats:
        """Radius over that at the clamp."""
        if not self.is_cone:
            return np.ones_like(s)
        return (self.rest.tip_radius + self.rest.taper(s)) / self.rest.base_radius

    def bending(self, edges: Floats) -> tuple[Floats, Floats]:
        """How pieces of the vibrissa bend, and where."""
        if self.rigidity is not None:
            return self._by_quadrature(self.rigidity, edges)
        thick = self.thickness(edges)
        a, b = thick[:-1], thick[1:]
        # Integrals of the fourth power of 1/thickness, which is linear.
        sum_ = a**2 + a * b + b**2
        fraction = a * (b + 2 * a) / (2 * sum_)
        return sum_ / (3 * a**3 * b**3), (fraction - 0.5) * np.diff(edges)

    def _by_quadrature(self, rigidity: Along, edges: Floats) -> tuple[Floats, Floats]:
        """Piece by piece of the cells and of the rigidity."""
        ends = np.array(rigidity.ends) / rigidity.ends[-1]
        marks = np.unique(np.concatenate([edges, ends[(ends > edges[0]) & (ends < edges[-1])]]))
        half, middle = np.diff(marks) / 2, (marks[1:] + marks[:-1]) / 2
        s = middle[:, None] + half[:, None] * _NODES
        soft = rigidity(np.zeros(1)) / rigidity(s * rigidity.ends[-1]) * _WEIGHTS
        parts = half[:, None] * np.stack([soft.sum(axis=1), (soft * s).sum(axis=1)], axis=1)
        reached = np.insert(np.cumsum(parts, axis=0), 0, 0.0, axis=0)
        compliance, moment = np.diff(reached[np.searchsorted(marks, edges)], axis=0).T
        centre = (edges[1:] + edges[:-1]) / 2
        return compliance / np.diff(edges), moment / compliance - centre
