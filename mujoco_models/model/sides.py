"""Which link touches which corner, and what only repeats another contact.

The beam's axis is a line of links, and the obstacle's section a polygon. They touch where a link's
side is at a corner, where a joint is at a facet, or where a joint is at a corner, and each such
place is one contact. MuJoCo knows the geoms only: beside the side of a link that is at a corner, it
reports the bead at the end of that link and the round end of the next link, as soon as their balls
reach the corner, too. They would hold the corner, along which the link should slide: by 4e-3 of a
force where the joint is within 1e-4 L, which is how far the balls reach past a contact as deep as
1e-6 L.
"""

from typing import NamedTuple

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from mujoco_models.beams.layout import Layout
from mujoco_models.model.surface import Surface

FUSED = 2  # MuJoCo's `mjContact.exclude` of a contact that another one stands for
_SAME = 1e-4  # rad; a mesh's single precision turns a bead's normal at a corner by 2e-5


class Sides(NamedTuple):
    """The contacts of links with corners; arrays as long as MuJoCo's contacts."""

    # Shape (n,); Whether a link touches a corner; where not, a bead does, and the rest means
    # nothing.
    touch: Booleans
    link: Integers  # shape (n,); Their numbers
    edge: Integers  # shape (n,); Their numbers
    s: Floats  # shape (n,); Where on the link, from where it begins [L]
    along: Booleans  # shape (n,); Whether it is on the side of the link, not on a round end
    point: Floats  # shape (n, 2); The corner then; else the centre of the round end [L]

    @classmethod
    def of(cls, data: mujoco.MjData, surface: Surface, layout: Layout, joints: Floats) -> "Sides":
        """Those of a configuration."""
        contact = data.contact
        link = surface.side_of[contact.geom].max(axis=1)
        edge = surface.edge_of[contact.geom].max(axis=1)
        touch = link >= 0
        ends = np.vstack([joints[1:], data.geom_xpos[surface.beads[-1], :2]])
        begin, length = joints[link], layout.lengths[link]
        along = (ends[link] - begin) / length[:, None]
        place = contact.pos[:, :2]
        s = ((place - begin) * along).sum(axis=1)
        on_side = touch & (s > 0) & (s < length)
        s = np.clip(s, 0, length)
        point = np.where(on_side[:, None], place, begin + s[:, None] * along)
        return cls(touch, link, edge, s, on_side, point)

    def fused(self, data: mujoco.MjData, surface: Surface) -> Booleans:
        """Which contacts only repeat another one.

        A round end does: the bead at that joint is the same ball. And a bead does, where it touches
        a corner that is on the side of a link next to it.
        """
        contact = data.contact
        found = self.touch & ~self.along
        found &= (self.link > 0) | (self.s > 0)  # no bead is where the first link begins
        bead = surface.bead_of[contact.geom].max(axis=1)
        outward = np.where(surface.moves[contact.geom[:, :1]], -1.0, 1.0) * contact.frame[:, :3]
        ball, side = np.flatnonzero(bead >= 0), np.flatnonzero(self.along)
        pair, of = np.nonzero(np.abs(bead[ball] - self.link[side][:, None] + 0.5) < 1)
        ball, edge = ball[of], self.edge[side[pair]]
        centre = data.geom_xpos[surface.beads[bead[ball]]]
        away = centre - surface.corners.nearest(edge, centre)
        away /= np.sqrt((away**2).sum(axis=1, keepdims=True))
        found[ball[((away - outward[ball]) ** 2).sum(axis=1) < _SAME**2]] = True
        return found
