"""The solver's surrogate of beam and object, without an engine: links, springs and a polygon."""

from collections.abc import Collection

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.clamp_path import Pose
from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)
# Gauss and Legendre's rule from the unbent joint to the bent one: where, and with which weight.
_RULE = list(zip(((1 + _NODES) / 2).tolist(), (_WEIGHTS / 2).tolist(), strict=True))
_MOVES = 8  # from beads to beads; two are usual, where a beam slides over a needle
_FARTHER = 2 ** np.arange(8) - 1  # reaches: where the contact is looked for, all at once


class Surrogate:
    """What of a `Balance` Newton's method needs, without an engine."""

    def __init__(
        self, model: Balance, loaded: Collection[int], reach: int = 0, *, follow: bool = False
    ) -> None:
        self._model, self.layout, self.obstacle = model, model.layout, model.obstacle
        self.pose = model.pose
        self.contact_stiffness = model.contact_stiffness
        self.contact_curvature, self.radius = model.contact_curvature, model.radius
        self.stiffness = model.stiffness
        self._reach, self._moves = reach, _MOVES if follow else 0
        self._angles = np.zeros(len(self.layout.joints))
        self._joints = self._along = self.layout.base.T
        self._looked: tuple[Pose, int] | None = None  # in which pose of the clamp, by which window
        self._seen: Contacts | None = None
        first, last = min(loaded), max(loaded)
        self._width = last - first
        self._show(first)

    def _show(self, first: int) -> None:
        """Look at as many beads as touched at first, from one on, and those about them."""
        begin, end = max(first - self._reach, 0), first + self._width + self._reach + 1
        self._beads: Integers = np.arange(begin, min(end, len(self.layout.beads)))
        self._links = self.layout.links[self._beads]
        self._places = self.layout.beads[self._beads]
        self.radii = self._model.lookout.radii[self._beads]
        self._none = np.zeros(len(self._beads), dtype=bool)

    def look(self, pose: Pose, angles: Floats) -> Contacts | None:
        """Where a configuration touches; what else is asked is of that."""
        self.pose, looked = pose, (pose, self._model.lookout.window)
        if angles is self._angles and looked == self._looked:
            return self._seen
        layout, self._angles, self._looked = self.layout, angles, looked
        heading = layout.headings + (pose.angle + angles.cumsum())
        self._along = np.array([-np.sin(heading), np.cos(heading)])
        self._joints = np.zeros(self._along.shape)
        self._joints[:, 1:] = (layout.chords * self._along)[:, :-1].cumsum(axis=1)
        self._joints += np.array(pose.place(*layout.base[0]))[:, None]
        self._seen = self._contacts()
        for _ in range(self._moves):
            nearer = self._nearer(self._seen)
            if nearer is None:
                break
            self._show(max(nearer - self._width // 2, 0))
            self._seen = self._contacts()
        return self._seen

    def _contacts(self) -> Contacts | None:
        """Those of the beads that are looked at."""
        points, no = self._points(self._beads), self._none
        gap = self.obstacle.gap(self._model.lookout.window, points)
        if gap is None:
            return None
        distance, normal = gap[0] - self.radii, gap[1]
        return Contacts(
            self._beads, self._links, no, points, self._places, normal, distance, no, False
        )

    def _points(self, beads: Integers) -> Floats:
        """Where beads are, shape (n_beads, 2) [L]."""
        links, (across, onward) = self.layout.links[beads], self.layout.from_links[:, beads]
        ahead = self._along[:, links]
        points = self._joints[:, links] + onward * ahead
        points[0] += across * ahead[1]
        points[1] -= across * ahead[0]
        return np.asarray(points.T)

    def _nearer(self, contacts: Contacts | None) -> int | None:
        """A bead about which the nearest one may be, if that is not in the midst of those seen.

        Along a beam the distance from a convex object falls, and then it rises.
        """
        if contacts is None:
            return None
        nearest, last = int(contacts.distance.argmin()), len(self._beads) - 1
        if 0 < nearest < last:
            return None
        way = self._reach if nearest else -self._reach
        onward = self._beads[nearest] + way * _FARTHER
        onward = onward[(onward >= 0) & (onward < len(self.layout.beads))]
        if len(onward) == 1:
            return None  # there the beam ends
        gap = self.obstacle.gap(self._model.lookout.window, self._points(onward))
        if gap is None:
            return None
        return int(onward[(gap[0] - self._model.lookout.radii[onward]).argmin()])

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

    def energy(self, contacts: Contacts) -> float:
        """That of the springs and of what is pressed in."""
        angles, depth = self._angles, np.minimum(contacts.distance, 0)
        toward = sum(w * (1 - x) * self.stiffness(x * angles) for x, w in _RULE)
        bent = float(angles @ (angles * toward))
        bent -= float(self.layout.hanging @ (self.layout.vibrissa.weight @ self._along))
        return bent + self.contact_stiffness / 2 * float(depth @ depth)

    def is_inside(self, contacts: Contacts) -> bool:
        """Whether a bead is so deep in the object that it may be pushed out on the far side."""
        return bool((contacts.distance <= -self.radii / 2).any())
