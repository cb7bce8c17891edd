"""Beads that slide along their link, where the contour is sharper than beads can be dense.

A bead is a material point: hung up on one, the beam leans on the contour at an angle of up to the
contour's curvature times half of the beads' spacing, and the force is turned by that. Where this is
too much, the beads of the link that touches slide until one of them is where the link is tangential
to the contour, whatever the configuration: the contact is then that of the link's whole side.

One bead that slides on all contours, as in space, was measured in place of the rows of them. It is
as near (catenary, 40 links: 1.04e-3 rms, beads 1.05e-3) and nearer past what is sharp and smooth
(a needle, 80 links: 6e-5, beads 1.7e-3), at 5.0 ms a station, beads 1.2. It was not taken, as two
contacts, cones, weight, clamps that lean and the engines' twins would need the rows all the same.
"""

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from mujoco_models.beams.layout import OF_CURVATURE, Layout
from mujoco_models.model.contacts import Contacts, slope_angle
from mujoco_models.obstacles.protocol import Obstacle

_NEXT_TO_A_JOINT = 1e-3  # of its link; a bead stays on it
_SAME_PLACE = 1e-9  # L
_SHARP = 2 * OF_CURVATURE  # rad; beads a little farther apart than they should be do no harm
_STAYS = 0.7  # of the depth at which beads begin to share a load: they go on down to that
_ITS_OWN = mujoco.mjtSameFrame.mjSAMEFRAME_NONE


class SlidingBeads:
    """Where the beads of a model are."""

    def __init__(
        self, model: mujoco.MjModel, beads: Integers, layout: Layout, obstacle: Obstacle
    ) -> None:
        self._model, self._beads, self._layout, self._obstacle = model, beads, layout, obstacle
        self._home = layout.beads.copy()
        self._spacing = layout.lengths / np.bincount(layout.links)
        self._ends = np.append(layout.joints[1:], 1.0)
        self._begins = layout.joints + _NEXT_TO_A_JOINT * layout.lengths
        self._link: int | None = None
        self._guided = False
        self._shared = False

    def needed(self, curvature: float) -> bool:
        """Whether there may be a contact at which beads have to slide."""
        return len(self._obstacle.corners) == 0 and curvature * self._spacing.max() >= _SHARP

    def slide(self, contacts: Contacts, curvature: Floats, joints: Floats) -> bool:
        """Let a bead be where the link that touches is tangential to the contour."""
        self._guided = False
        if len(contacts.link) == 0:
            return False
        deepest = int(np.argmin(contacts.distance))
        link, kappa = int(contacts.link[deepest]), float(curvature[deepest])
        spacing = self._spacing[link]
        if contacts.touch[deepest] == len(self._home) - 1 or kappa * spacing < _SHARP:
            return False
        between = kappa * spacing**2 / 2  # how far the next bead is from the contour
        if contacts.distance[deepest] > between:
            return False  # so far away that it may be another link that touches
        depth = -contacts.distance[contacts.loaded].sum()
        self._shared = bool(depth > (_STAYS if self._shared else 1) * between)
        if self._shared:
            return False  # so soft that several beads share the load
        heading = contacts.point[deepest] - joints[link]
        heading /= np.hypot(*heading)
        across = contacts.normal[deepest] - (contacts.normal[deepest] @ heading) * heading
        touched = self._obstacle.support(float(slope_angle(across[None])[0]))
        along = float((touched - joints[link]) @ heading)
        tangential = self._layout.joints[link] + along
        there = float(np.clip(tangential, self._begins[link], self._ends[link]))
        self._guided = there == tangential  # or it is a joint that touches, a material point
        return self._shift(link, there)

    def hold(self) -> bool:
        """Put all beads where they were at first."""
        moved, self._guided = self._link is not None, False
        if self._link is not None:
            back = np.flatnonzero(self._layout.links == self._link)
            self._put(back, self._home[back])
            self._link = None
        return moved

    def slides(self, contacts: Contacts) -> Booleans:
        """Which contacts are of a link whose beads slide."""
        if not self._guided:
            return np.zeros(len(contacts.link), dtype=bool)
        return np.asarray(contacts.link == self._link) & (contacts.touch < len(self._home) - 1)

    def _shift(self, link: int, there: float) -> bool:
        """Slide a link's beads until one of them is there; whether that is another place."""
        own = np.flatnonzero(self._layout.links == link)
        home = self._home[own]
        shift = there - home[np.argmin(np.abs(home - there))]
        places = np.clip(home + shift, self._begins[link], self._ends[link])
        same = np.abs(places - self._layout.beads[own]).max() < _SAME_PLACE
        if self._link not in (None, link):
            back = np.flatnonzero(self._layout.links == self._link)
            self._put(back, self._home[back])
        self._link = link
        if not same:
            self._put(own, places)
        return not same

    def _put(self, beads: Integers, places: Floats) -> None:
        layout = self._layout
        begin = layout.joints[layout.links[beads]]
        scale = (places - begin) / (layout.beads[beads] - begin)
        geoms = self._beads[beads]
        self._model.geom_pos[geoms] *= scale[:, None]
        self._model.geom_sameframe[geoms] = _ITS_OWN  # or MuJoCo ignores the place of a middle one
        layout.move(beads, places)
