"""The solver's own picture of beam and object: links, springs and a polygon, without an engine."""

from collections.abc import Collection

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)
# Gauss and Legendre's rule from the unbent joint to the bent one: where, and with which weight.
_RULE = list(zip(((1 + _NODES) / 2).tolist(), (_WEIGHTS / 2).tolist(), strict=True))


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
        self._joints, self._angles = self.layout.base, np.zeros(len(self.layout.joints))

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
        layout, self._angles = self.layout, angles
        heading = layout.headings + angles.cumsum()
        along = np.array([-np.sin(heading), np.cos(heading)])
        joints = np.zeros(along.shape)
        joints[:, 1:] = (layout.chords * along)[:, :-1].cumsum(axis=1)
        joints[0] += foot_x + layout.base[0, 0]
        joints[1] += layout.base[0, 1]
        ahead, (across, onward) = along[:, self._links], self._from_link
        points = joints[:, self._links] + onward * ahead
        points[0] += across * ahead[1]
        points[1] -= across * ahead[0]
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
        """The beam's own moment at each joint, from the stiffness on the way there."""
        angles = self._angles
        return np.asarray(-angles * sum(w * self.stiffness(x * angles) for x, w in _RULE))

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
        angles, depth = self._angles, np.minimum(contacts.distance, 0)
        toward = sum(w * (1 - x) * self.stiffness(x * angles) for x, w in _RULE)
        bent = float(angles @ (angles * toward))
        return bent + self.contact_stiffness / 2 * float(depth @ depth)

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
