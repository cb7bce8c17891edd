"""The contacts that MuJoCo reports."""

from typing import NamedTuple

import mujoco
import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers


class Contacts(NamedTuple):
    """The contacts of one configuration, loaded or within the gap; arrays of n contacts.

    Attributes
    ----------
    bead : array of int, shape (n,)
        Number of the bead that touches.
    normal : array, shape (n, 2)
        Unit normal, away from the obstacle.
    distance : array, shape (n,)
        Of the bead's surface from the obstacle; negative where the contact is loaded [L].
    """

    bead: Integers
    normal: Floats
    distance: Floats

    @classmethod
    def of(cls, data: mujoco.MjData, bead_of: Integers) -> "Contacts":
        """All contacts that MuJoCo reports.

        Parameters
        ----------
        data : mujoco.MjData
            An evaluated configuration.
        bead_of : array of int, shape (ngeom,)
            The bead that each geom is, or -1.

        Returns
        -------
        Contacts
        """
        contact = data.contact
        if data.ncon == 0:
            return cls(np.zeros(0, dtype=int), np.zeros((0, 2)), np.zeros(0))
        beads = bead_of[contact.geom]
        outward = np.where(beads[:, 0] >= 0, -1.0, 1.0)[:, None]
        return cls(beads.max(axis=1), outward * contact.frame[:, :2], contact.dist.copy())

    @property
    def loaded(self) -> Booleans:
        """Which of them carry a load, shape (n,)."""
        return np.asarray(self.distance < 0)

    @property
    def slope(self) -> Floats:
        """Slope angles of the contour with these normals, shape (n,) [rad]."""
        return slope_angle(self.normal)


def slope_angle(normal: Floats) -> Floats:
    """Slope angles of the contour with these normals.

    Parameters
    ----------
    normal : array, shape (n, 2)
        Away from the obstacle, which is above.

    Returns
    -------
    array, shape (n,)
        Slope angles [rad].
    """
    return np.asarray(np.arctan2(normal[:, 0], -normal[:, 1]))
