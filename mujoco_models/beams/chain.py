"""The vibrissa as a chain of rigid links on hinges with springs: all versions of MuJoCo have it.

Each hinge has the stiffness EI/h of the cell of length h that it stands for. The hinges sit at the
cells' centres, half a cell from the clamp and from the tip, which makes the chain a second-order
discretisation; the naive chain, whose first whole link is rigid in the clamp, is of first order.

What is left of second order are three parts. Springs of "arc" take two off. Their moment is EI
times the curvature of the arc that both links touch at their centres, (2 EI/h) tan(turn/2), where
EI/h times the turn is too soft by (curvature h)^2/12. And a sum over the centres of the cells
misses h^2/24 of the slope of what it sums at either end: at the free end there is none, and the
first hinge is h/24 nearer the clamp. The third part is the contact's: its link is straight.
"""

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.links import HingedLinks
from mujoco_models.beams.protocol import Furnish, bare
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.settings import Settings


class Chain(HingedLinks):
    """Hinges with springs; see `mujoco_models.beams.protocol.Beam`."""

    def __init__(
        self, settings: Settings, spacing: float, vibrissa: Vibrissa | None = None
    ) -> None:
        n, arc = settings.segments, settings.springs == "arc"
        cells = np.arange(n)
        joints = (cells + 0.5) / n if settings.clamp == "second-order" else cells[1:] / n
        edges = np.append(joints - 0.5 / n, joints[-1] + 0.5 / n)
        if arc:
            joints[0] -= 1 / (24 * n)
        lengths = np.full(len(joints), 1 / n)
        super().__init__(Layout.of(joints, lengths, edges, spacing, vibrissa))
        self._stiffness = 1 / self.layout.compliances
        self._cubic = self._stiffness / 12 if arc else np.zeros(len(self._stiffness))
        if self.layout.clamp_turns:
            self._cubic[0] = 0.0

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
        """The links, and a spring in every hinge."""
        spec = super().spec(radius, furnish)
        laws = zip(spec.joints, self._stiffness, self._cubic, strict=True)
        for joint, linear, cubic in laws:
            joint.stiffness[:] = [linear, 0, cubic]
        return spec

    def stiffness(self, angles: Floats) -> Floats:
        """EI/h, and the clamp's."""
        return np.asarray(self._stiffness + 3 * self._cubic * angles**2)
