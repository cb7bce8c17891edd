"""Where along the vibrissa its joints and its contact spheres sit."""

from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats, Integers
from mujoco_models.settings import Settings

# A bead is a fixed material point, so the readings err by the contour's curvature times the beads'
# spacing. It is bounded in radii of the vibrissa, in radii of curvature of the contour, and by the
# square of the cell's length, so that it does not spoil the second order.
_OF_RADIUS = 0.65
OF_CURVATURE = 0.01
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
        """Beads at most `spacing` apart, and at least two to a link, or one at each link's end.

        Parameters
        ----------
        joints, cells : array, shape (n_joints,)
            As in the attributes [L].
        spacing : float
            Of the beads [L]; infinite for one a link.

        Returns
        -------
        Layout
        """
        lengths = np.diff(joints, append=1.0)
        fewest = 1 if spacing == np.inf else 2
        counts = np.maximum(fewest, np.ceil(lengths / spacing - 1e-9).astype(int))
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

    Returns
    -------
    float
        Spacing [L].
    """
    turning = OF_CURVATURE / max(curvature, OF_CURVATURE)
    dense = min(_OF_RADIUS * radius, turning, _OF_CELLS / segments**2)
    return max(dense, _LEAST)


def vertices(settings: Settings, grading: float = 0.0) -> Floats:
    """Arc lengths of the vertices of a beam that MuJoCo builds from N segments.

    The first segment is rigid in the clamp. If it straddles the clamp, as much before it as behind,
    the vertices that bend sit at the centres of their cells, and the beam is of second order; if it
    begins there (the naive beam), it is of first order.

    Parameters
    ----------
    settings : Settings
        Number of segments, and which clamp.
    grading : float
        How much longer segments grow towards the tip: by (1 + 3 grading) from the clamp on. The
        naive beam has equal ones.

    Returns
    -------
    array, shape (N + 1,)
        Arc lengths, ascending [L].
    """
    n = settings.segments
    if settings.clamp == "naive":
        return np.asarray(np.arange(n + 1) / n)
    # An odd and smooth map of equal segments: it keeps the symmetry at the clamp, and the order.
    u = (np.arange(n + 1) - 0.5) / (n - 0.5)
    return np.asarray(u * (1 + grading * u**2) / (1 + grading))
