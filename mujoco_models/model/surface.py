"""What of the beam may touch, and what of the obstacle its sides touch."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Integers
from mujoco_models.obstacles.corners import EDGE_PREFIX, Corners

SIDE_PREFIX = "side"
CONTACT_GAP = 0.01  # L; how far ahead the solver sees contacts that carry no force yet


@dataclass(frozen=True, eq=False)
class Surface:
    """The geoms by which beam and obstacle touch, and what each geom is."""

    beads: Integers  # shape (n_beads,); The beads' geoms
    sides: Integers  # shape (n_links,); Those of the links, if they collide with corners
    # Shape (ngeom,); The number of the bead, link or corner that each geom is, or -1.
    bead_of: Integers
    # Shape (ngeom,); The number of the bead, link or corner that each geom is, or -1.
    side_of: Integers
    # Shape (ngeom,); The number of the bead, link or corner that each geom is, or -1.
    edge_of: Integers
    corners: Corners  # the obstacle's
    radius: float  # of the vibrissa [L]

    @classmethod
    def of(cls, model: mujoco.MjModel, links: int, corners: Corners, radius: float) -> "Surface":
        """That of a compiled model."""
        beads = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)
        sides = [model.geom(f"{SIDE_PREFIX}{i}").id for i in range(links if len(corners) else 0)]
        edges = [model.geom(f"{EDGE_PREFIX}{i}").id for i in range(len(corners))]
        bead_of, side_of, edge_of = np.full((3, model.ngeom), -1)
        bead_of[beads] = np.arange(len(beads))
        side_of[sides] = np.arange(len(sides))
        edge_of[edges] = np.arange(len(edges))
        return cls(beads, np.array(sides, dtype=int), bead_of, side_of, edge_of, corners, radius)

    def objects(self, model: mujoco.MjModel, names: Iterable[str]) -> Integers:
        """The number of the object that each geom is, or is an edge of, or -1; shape (ngeom,)."""
        found = np.where(self.edge_of >= 0, 0, -1)
        found[self.edge_of >= 0] = self.corners.of_object[self.edge_of[self.edge_of >= 0]]
        for number, name in enumerate(names):
            found[model.geom(name).id] = number
        return found

    @cached_property
    def moves(self) -> Booleans:
        """Whether each geom is one of the beam's, shape (ngeom,)."""
        return (self.bead_of >= 0) | (self.side_of >= 0)
