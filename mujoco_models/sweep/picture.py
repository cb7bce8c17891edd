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
    """What of a `Balance` Newton's method needs, without an engine."""

    def __init__(self, model: Balance, loaded: Collection[int], reach: int = 0) -> None:
        self._model, self.layout, self.obstacle = model, model.layout, model.obstacle
        self.contact_stiffness = model.contact_stiffness
        self.contact_curvature = model.contact_curvature
        self.stiffness = model.stiffness
        begin, end = max(min(loaded) - reach, 0), max(loaded) + reach + 1
        self._beads: Integers = np.arange(begin, min(end, len(self.layout.beads)))
        self._links = self.layout.links[self._beads]
        self._none = np.zeros(len(self._beads), dtype=bool)
        self.radii = model.lookout.radii[self._beads]

    def look(self, foot_x: float, angles: Floats) -> Contacts | None:
        """Where a configuration touches; what else is asked is of that."""
        layout, links, no = self.layout, self._links, self._none
        heading = layout.headings + angles.cumsum()
        along = np.array([-np.sin(heading), np.cos(heading)])
        self._angles, self._joints = angles, np.zeros(along.shape)
        self._joints[:, 1:] = (layout.chords * along)[:, :-1].cumsum(axis=1)
        self._joints[0] += foot_x + layout.base[0, 0]
        self._joints[1] += layout.base[0, 1]
        (across, onward), ahead = layout.from_links[:, self._beads], along[:, links]
        points = self._joints[:, links] + onward * ahead
        points[0] += across * ahead[1]
        points[1] -= across * ahead[0]
        gap = self.obstacle.gap(self._model.lookout.window, points.T)
        if gap is None:
            return None
        distance, places = gap[0] - self.radii, layout.beads[self._beads]
        return Contacts(self._beads, links, no, points.T, places, gap[1], distance, no, False)

    def joint_positions(self) -> Floats:
        """Where the joints are."""
        return np.asarray(self._joints.T)

    def elastic_moments(self) -> Floats:
        """The beam's own moment at each joint, from the stiffness on the way there."""
        angles = self._angles
        return np.asarray(-angles * sum(w * self.stiffness(x * angles) for x, w in _RULE))

    def slides(self, contacts: Contacts) -> Booleans:
        """No bead does."""
        return self._none[: len(contacts.link)]

    def is_inside(self, contacts: Contacts) -> bool:
        """Whether a bead is so deep in the object that it may be pushed out on the far side."""
        return bool((contacts.distance <= -self.radii / 2).any())
