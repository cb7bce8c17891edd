"""Where along the vibrissa its joints and its contact spheres sit."""

from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats, Integers

_BEADS_A_CELL = 4


@dataclass(frozen=True)
class Layout:
    """Joints and contact spheres ("beads") along the vibrissa of length 1.

    Attributes
    ----------
    joints : array, shape (n_joints,)
        Arc length of each joint, or vertex, where the beam bends; link i begins at joint i.
    cells : array, shape (n_joints,)
        Length h of the piece of beam that bends at each joint.
    beads : array, shape (n_beads,)
        Arc length of each bead, the last one at the tip; none before the first joint.
    links : array of int, shape (n_beads,)
        The link that carries each bead; a bead at a joint is carried by the link that ends there.
    """

    joints: Floats
    cells: Floats
    beads: Floats
    links: Integers

    @classmethod
    def of(cls, joints: Floats, cells: Floats) -> "Layout":
        """Four beads to a cell: between two the obstacle bulges by its curvature times h^2/128."""
        lengths = np.diff(joints, append=1.0)
        counts = np.rint(_BEADS_A_CELL * lengths / cells).astype(int)
        beads = [
            start + length * np.arange(1, count + 1) / count
            for start, length, count in zip(joints, lengths, counts, strict=True)
        ]
        return cls(joints, cells, np.concatenate(beads), np.repeat(np.arange(len(joints)), counts))

    @property
    def lengths(self) -> Floats:
        """Length of each link, shape (n_joints,)."""
        return np.diff(self.joints, append=1.0)
