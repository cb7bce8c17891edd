"""The vibrissa as a chain of rigid links on hinges with springs: all versions of MuJoCo have it.

Each hinge has the stiffness EI/h of the cell of length h that it stands for. The hinges sit at the
cells' centres, half a cell from the clamp and from the tip, which makes the chain a second-order
discretisation; the naive chain, whose first whole link is rigid in the clamp, is of first order.
"""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
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
        n = settings.segments
        cells = np.arange(n)
        joints = (cells + 0.5) / n if settings.clamp == "second-order" else cells[1:] / n
        edges = np.append(joints - 0.5 / n, joints[-1] + 0.5 / n)
        lengths = np.full(len(joints), 1 / n)
        super().__init__(Layout.of(joints, lengths, edges, spacing, vibrissa))
        self._stiffness = 1 / self.layout.compliances

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
        """The links, and a spring in every hinge."""
        spec = super().spec(radius, furnish)
        for joint, stiffness in zip(spec.joints, self._stiffness, strict=True):
            joint.stiffness[0] = stiffness
        return spec

    def stiffness(self, angles: Floats) -> Floats:
        """EI/h, and the clamp's."""
        return self._stiffness
