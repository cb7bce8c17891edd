"""What of the beam may touch, and the contacts that MuJoCo reports."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import mujoco
import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from mujoco_models.beams.layout import Layout
from mujoco_models.obstacles.corners import EDGE_PREFIX

SIDE_PREFIX = "side"


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
    outward : array, shape (m, 2)
        Of the obstacle's corners, see `Corners`.
    radius : float
        Of the vibrissa [L].
    """

    beads: Integers
    sides: Integers
    bead_of: Integers
    side_of: Integers
    edge_of: Integers
    outward: Floats
    radius: float

    @classmethod
    def of(cls, model: mujoco.MjModel, links: int, outward: Floats, radius: float) -> "Surface":
        """That of a compiled model.

        Parameters
        ----------
        model : mujoco.MjModel
            Its only spheres are the beads.
        links : int
            Number of the beam's links.
        outward : array, shape (m, 2)
            Of the obstacle's corners.
        radius : float
            Of the vibrissa [L].

        Returns
        -------
        Surface
        """
        beads = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)
        sides = [model.geom(f"{SIDE_PREFIX}{i}").id for i in range(links if len(outward) else 0)]
        edges = [model.geom(f"{EDGE_PREFIX}{i}").id for i in range(len(outward))]
        bead_of, side_of, edge_of = np.full((3, model.ngeom), -1)
        bead_of[beads] = np.arange(len(beads))
        side_of[sides] = np.arange(len(sides))
        edge_of[edges] = np.arange(len(edges))
        return cls(beads, np.array(sides, dtype=int), bead_of, side_of, edge_of, outward, radius)

    @cached_property
    def moves(self) -> Booleans:
        """Whether each geom is one of the beam's, shape (ngeom,)."""
        return (self.bead_of >= 0) | (self.side_of >= 0)


class Contacts(NamedTuple):
    """The contacts of one configuration, loaded or within the gap; arrays of n contacts.

    Attributes
    ----------
    touch : array of int, shape (n,)
        What touches: the number of the bead or, from n_beads on, one for each corner and link.
    link : array of int, shape (n,)
        The link that carries it.
    on_side : array of bool, shape (n,)
        Whether a corner is on the side of the link, along which it slides.
    point : array, shape (n, 2)
        The corner then; else the centre of the bead, or of the link's round end [L].
    arc_length : array, shape (n,)
        Along the beam [L].
    normal : array, shape (n, 2)
        Unit normal, away from the obstacle.
    distance : array, shape (n,)
        Of the beam's surface from the obstacle; negative where the contact is loaded [L].
    passed : bool
        Whether a corner has gone through a link's axis, and MuJoCo pushes the wrong way.
    """

    touch: Integers
    link: Integers
    on_side: Booleans
    point: Floats
    arc_length: Floats
    normal: Floats
    distance: Floats
    passed: bool

    @classmethod
    def of(
        cls, data: mujoco.MjData, surface: Surface, layout: Layout, joints: Floats
    ) -> "Contacts":
        """All contacts that MuJoCo reports.

        Parameters
        ----------
        data : mujoco.MjData
            An evaluated configuration.
        surface : Surface
            What its geoms are.
        layout : Layout
            Of the beam.
        joints : array, shape (n_joints, 2)
            Where its joints are [L].

        Returns
        -------
        Contacts
        """
        contact = data.contact
        if data.ncon == 0:
            none, nothing = np.zeros(0), np.zeros(0, dtype=int)
            nowhere = np.zeros((0, 2))
            return cls(nothing, nothing, none > 0, nowhere, none, nowhere, none, passed=False)
        moves = surface.moves[contact.geom]
        normal = np.where(moves[:, :1], -1.0, 1.0) * contact.frame[:, :2]
        bead = surface.bead_of[contact.geom].max(axis=1)
        centre = data.geom_xpos[surface.beads[bead], :2]
        beads = cls(
            bead,
            layout.links[bead],
            np.zeros(len(bead), dtype=bool),
            centre,
            layout.beads[bead],
            normal,
            contact.dist.copy(),
            passed=False,
        )
        return (
            beads if len(surface.sides) == 0 else beads._with_sides(data, surface, layout, joints)
        )

    def _with_sides(
        self, data: mujoco.MjData, surface: Surface, layout: Layout, joints: Floats
    ) -> "Contacts":
        """The same, where what is no bead is a link that touches a corner."""
        contact = data.contact
        side = surface.side_of[contact.geom].max(axis=1)
        edge = surface.edge_of[contact.geom].max(axis=1)
        is_side = side >= 0
        ends = np.vstack([joints[1:], data.geom_xpos[surface.beads[-1], :2]])
        begin, length = joints[side], layout.lengths[side]
        along = (ends[side] - begin) / length[:, None]
        place = contact.pos[:, :2]
        s = ((place - begin) * along).sum(axis=1)
        on_side = is_side & (s > 0) & (s < length)
        s = np.clip(s, 0, length)
        point = np.where(on_side[:, None], place, begin + s[:, None] * along)
        # Deeper than the axis of a link, MuJoCo sees the corner from behind.
        behind = on_side & (self.distance < 0)
        behind &= (self.normal * surface.outward[edge]).sum(axis=1) < 0
        number = len(surface.beads) + edge * len(joints) + side
        return Contacts(
            np.where(is_side, number, self.touch),
            np.where(is_side, side, self.link),
            on_side,
            np.where(is_side[:, None], point, self.point),
            np.where(is_side, layout.joints[side] + s, self.arc_length),
            np.where(behind[:, None], -self.normal, self.normal),
            np.where(behind, -self.distance - 2 * surface.radius, self.distance),
            passed=bool(behind.any()),
        )

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
