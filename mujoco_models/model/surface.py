"""What of the beam may touch, and what of the obstacle its sides touch."""

from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np

from analytic.problem.arrays import Booleans, Integers
from mujoco_models.obstacles.corners import EDGE_PREFIX, Corners

SIDE_PREFIX = "side"
CONTACT_GAP = 0.01  # L; how far ahead the solver sees contacts that carry no force yet


@dataclass(frozen=True, eq=False)
class Surface:
    """The geoms by which beam and obstacle touch, and what each geom is.

    Attributes
    ----------
    beads : array of int, shape (n_beads,)
        The beads' geoms.
    sides : array of int, shape (n_links,)
        Those of the links, if they collide with corners.
    bead_of, side_of, edge_of : array of int, shape (ngeom,)
        The number of the bead, link or corner that each geom is, or -1.
    corners : Corners
        The obstacle's.
    radius : float
        Of the vibrissa [L].
    """

    beads: Integers
    sides: Integers
    bead_of: Integers
    side_of: Integers
    edge_of: Integers
    corners: Corners
    radius: float

    @classmethod
    def of(cls, model: mujoco.MjModel, links: int, corners: Corners, radius: float) -> "Surface":
        """That of a compiled model.

        Parameters
        ----------
        model : mujoco.MjModel
            Its only spheres are the beads.
        links : int
            Number of the beam's links.
        corners : Corners
            The obstacle's.
        radius : float
            Of the vibrissa [L].

        Returns
        -------
        Surface
        """
        beads = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)
        sides = [model.geom(f"{SIDE_PREFIX}{i}").id for i in range(links if len(corners) else 0)]
        edges = [model.geom(f"{EDGE_PREFIX}{i}").id for i in range(len(corners))]
        bead_of, side_of, edge_of = np.full((3, model.ngeom), -1)
        bead_of[beads] = np.arange(len(beads))
        side_of[sides] = np.arange(len(sides))
        edge_of[edges] = np.arange(len(edges))
        return cls(beads, np.array(sides, dtype=int), bead_of, side_of, edge_of, corners, radius)

    @cached_property
    def moves(self) -> Booleans:
        """Whether each geom is one of the beam's, shape (ngeom,)."""
        return (self.bead_of >= 0) | (self.side_of >= 0)
