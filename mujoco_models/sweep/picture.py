"""The solver's own picture of beam and object: links, springs and a polygon, without an engine."""

from collections.abc import Collection

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)


class Picture:
    """What of a `Balance` Newton's method needs, without an engine.

    Parameters
    ----------
    model : Balance
        Whose picture it is; it is not evaluated.
    loaded : collection of int
        The beads that touch.
    reach : int
        How many more on either side may come to touch.

    Attributes
    ----------
    radii : array, shape (n_beads,)
        Theirs [L].
    """

    def __init__(self, model: Balance, loaded: Collection[int], reach: int = 0) -> None:
        self._model, self.layout, self.obstacle = model, model.layout, model.obstacle
        self.contact_stiffness = model.contact_stiffness
        self.contact_curvature = model.contact_curvature
        self.stiffness = model.stiffness
        end = len(self.layout.beads)
        first, last = max(min(loaded) - reach, 0), min(max(loaded) + reach + 1, end)
        self._beads: Integers = np.arange(first, last)
        self._links = self.layout.links[self._beads]
        self._places = self.layout.beads[self._beads]
        self._from_link = self.layout.from_links[:, self._beads]
        self.radii = model.lookout.radii[self._beads]
        self._none = np.zeros(len(self._beads), dtype=bool)
        self._joints, self._elastic = self.layout.base, np.zeros(len(self.layout.joints))
        self._bent = 0.0

    def look(self, foot_x: float, angles: Floats) -> Contacts | None:
        """Where a configuration touches; what else is asked is of that.

        Parameters
        ----------
        foot_x : float
            Foot position [L].
        angles : array, shape (n_joints,)
            Joint angles [rad].

        Returns
        -------
        Contacts or None
            Of the beads; None if the obstacle says nothing of that.
        """
        layout = self.layout
        heading = layout.headings + angles.cumsum()
        along = np.array([-np.sin(heading), np.cos(heading)])
        joints = layout.chords * along
        joints[:, 1:] = joints[:, :-1].cumsum(axis=1)
        joints[:, 0] = 0.0
        joints += (layout.base[0] + [foot_x, 0.0])[:, None]
        # The springs' moments, from their stiffness at the nodes of Gauss and Legendre.
        part = [
            w * self.stiffness(angles * (1 + x) / 2) for x, w in zip(_NODES, _WEIGHTS, strict=True)
        ]
        self._elastic = -angles * sum(part) / 2
        toward = sum(p * (1 - x) for p, x in zip(part, _NODES, strict=True))
        self._bent = float(angles @ (angles * toward)) / 4
        ahead, aside = along[:, self._links], self._from_link
        points = joints[:, self._links] + aside[1] * ahead
        points += aside[0] * np.array([ahead[1], -ahead[0]])
        gap = self.obstacle.gap(self._model.lookout.window, points.T)
        if gap is None:
            return None
        distance, normal = gap
        self._joints, no = joints.T, self._none
        distance = distance - self.radii
        return Contacts(
            self._beads, self._links, no, points.T, self._places, normal, distance, no, False
        )

    def joint_positions(self) -> Floats:
        """Where the joints are."""
        return self._joints

    def elastic_moments(self) -> Floats:
        """The beam's own moment at each joint."""
        return self._elastic

    def slides(self, contacts: Contacts) -> Booleans:
        """No bead does."""
        return self._none[: len(contacts.link)]

    def energy(self, contacts: Contacts) -> float:
        """That of the springs and of what is pressed in.

        Parameters
        ----------
        contacts : Contacts
            Of the last configuration.

        Returns
        -------
        float
            By EI/L.
        """
        depth = np.minimum(contacts.distance, 0)
        return self._bent + self.contact_stiffness / 2 * float(depth @ depth)

    def is_inside(self, contacts: Contacts) -> bool:
        """Whether a bead is so deep in the object that it may be pushed out on the far side.

        Parameters
        ----------
        contacts : Contacts
            Of the last configuration.

        Returns
        -------
        bool
            From half of its radius on.
        """
        return bool((contacts.distance <= -self.radii / 2).any())
