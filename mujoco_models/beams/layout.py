"""Where along the vibrissa its joints and its contact spheres sit."""

from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats, Integers

# A bead is a fixed material point, so the readings err by the contour's curvature times the beads'
# spacing. It is bounded in radii of the vibrissa, in radii of curvature of the contour, and by the
# square of the cell's length, lest it spoil the second order.
_OF_RADIUS = 0.65
_OF_CURVATURE = 0.01
_OF_CELLS = 3.0
_LEAST = 1 / 4000  # L


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
    def of(cls, joints: Floats, cells: Floats, spacing: float) -> "Layout":
        """Beads at most `spacing` apart, and at least two to a link."""
        lengths = np.diff(joints, append=1.0)
        counts = np.maximum(2, np.ceil(lengths / spacing - 1e-9).astype(int))
        beads = [
            start + length * np.arange(1, count + 1) / count
            for start, length, count in zip(joints, lengths, counts, strict=True)
        ]
        return cls(joints, cells, np.concatenate(beads), np.repeat(np.arange(len(joints)), counts))

    @property
    def lengths(self) -> Floats:
        """Length of each link, shape (n_joints,)."""
        return np.diff(self.joints, append=1.0)


def bead_spacing(segments: int, radius: float, curvature: float) -> float:
    """How far apart beads may be on a beam of so many segments [L].

    Parameters
    ----------
    segments : int
        Number of segments.
    radius : float
        Of the vibrissa [L].
    curvature : float
        Largest curvature of the contour, may be 0 [1/L].
    """
    turning = _OF_CURVATURE / max(curvature, _OF_CURVATURE)
    dense = min(_OF_RADIUS * radius, turning, _OF_CELLS / segments**2)
    return max(dense, _LEAST)
