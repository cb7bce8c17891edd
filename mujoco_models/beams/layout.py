"""Where along the vibrissa its joints and its contact spheres sit."""

from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats, Integers


@dataclass(frozen=True)
class Layout:
    """Joints and contact spheres ("beads") along the vibrissa of length 1.

    Attributes
    ----------
    joints : array, shape (n_joints,)
        Arc length of each joint, or vertex, where the beam bends; link i begins at joint i.
    cell : float
        Length h of the piece of beam that bends at a joint.
    beads : array, shape (n_beads,)
        Arc length of each bead, the last one at the tip; none before the first joint.
    links : array of int, shape (n_beads,)
        The link that carries each bead.
    """

    joints: Floats
    cell: float
    beads: Floats
    links: Integers

    @classmethod
    def of(cls, joints: Floats, cell: float, beads_a_link: int) -> "Layout":
        """Beads equally spaced `cell / beads_a_link` from the tip down to the first joint."""
        from_tip = np.arange(int(beads_a_link * (1 - joints[0]) / cell + 0.5))
        beads = 1 - from_tip[::-1] * cell / beads_a_link
        # A bead at a joint belongs to the link that ends there: turning the joint leaves it alone.
        links = np.searchsorted(joints, beads - 1e-9) - 1
        return cls(joints, cell, beads, links)

    @property
    def lengths(self) -> Floats:
        """Length of each link, shape (n_joints,)."""
        return np.diff(self.joints, append=1.0)
