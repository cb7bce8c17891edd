"""What of beam and obstacle takes part in collisions, and what that could overlook."""

from typing import Protocol

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.beams.layout import Layout
from mujoco_models.model.contacts import Contacts
from mujoco_models.obstacles.protocol import GEOM, Obstacle

_NEAR = 1e-6  # L; beads that are nearer to the obstacle must be watched at rest
_CLEAR = 1e-9  # L; beads that are at least so far off carry no load
_OVERLOOKED = 1e-6  # L; how deep an unloaded bead may be in the obstacle, or a depth be off


class Scene(Protocol):
    """The beads and the obstacle as an engine has them, and what of them collides."""

    radii: Floats
    """Of the beads, shape (n_beads,) [L]."""

    def bead_positions(self, beads: Integers) -> Floats:
        """Where the centres of beads are, shape (n, 2) [L]."""

    def show(self, window: int) -> None:
        """Let what the obstacle has for a window, and nothing else of it, collide."""

    def collide(self, beads: frozenset[int]) -> None:
        """Let these beads, and no others, collide with the obstacle."""


class MujocoScene:
    """That of a compiled model of MuJoCo's, whose collision masks are changed in place."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        beads: Integers,
        obstacle: Obstacle,
        name: str = GEOM,
    ) -> None:
        self._model, self._data, self._beads, self._obstacle = model, data, beads, obstacle
        self.radii = model.geom_size[beads, 0].copy()
        self._geom = model.geom(name).id
        self._chosen = np.arange(len(beads))

    def bead_positions(self, beads: Integers) -> Floats:
        return np.asarray(self._data.geom_xpos[self._beads[beads], :2])

    def show(self, window: int) -> None:
        self._obstacle.show(self._model, self._geom, window)

    def collide(self, beads: frozenset[int]) -> None:
        """By their masks, and those of their bodies: MuJoCo looks at no other body's beads."""
        model = self._model
        for chosen, mask in (self._chosen, 0), (np.array(sorted(beads), dtype=int), 1):
            geoms = self._beads[chosen]
            bodies = model.geom_bodyid[geoms]
            model.geom_conaffinity[geoms] = mask
            model.body_conaffinity[bodies] = model.body_conaffinity[bodies] & ~1 | mask
            self._chosen = chosen


class Lookout:
    """The obstacle's window and the watched beads: all else is left out, for speed."""

    def __init__(self, scene: Scene, obstacle: Obstacle, radius: float, layout: Layout) -> None:
        self._scene, self._obstacle, self._radius = scene, obstacle, radius
        self._links, self._longest = layout.links, float(layout.lengths.max())
        self._last = np.flatnonzero(np.diff(layout.links, append=len(layout.joints)))
        self.radii = scene.radii
        self._all = np.arange(len(scene.radii))
        self._idle = np.zeros(len(scene.radii), dtype=bool)
        self.window = -1
        self.face(np.pi / 2)  # where a sweep to the left begins
        self.watched: frozenset[int] = frozenset()
        self.watch(frozenset(self._all.tolist()))

    def use_window(self, window: int) -> None:
        """Let the engine see what the obstacle has for this window."""
        if window != self.window:
            self._scene.show(window)
            self.window = window

    def move_window(self, loaded: Floats) -> bool:
        """Ensure that all load rests on full resolution."""
        if loaded.size == 0 or self._obstacle.is_inside(self.window, loaded):
            return False
        best = self._obstacle.window_of(float(loaded.mean()))
        if best == self.window:
            return False
        self.use_window(best)
        return True

    def face(self, slope: float) -> None:
        """Use the window for a contact at this slope angle."""
        place = self._obstacle.place(np.array([slope]))
        self.use_window(self._obstacle.window_of(float(place[0])))

    def follow_contact(self, contacts: Contacts) -> None:
        """Use the window that is nearest to the deepest contact, if there is a loaded one."""
        if contacts.loaded.any():
            deepest = contacts.slope[[np.argmin(contacts.distance)]]
            place = self._obstacle.place(deepest)
            if not self._obstacle.is_inside(self.window, place):
                self.use_window(self._obstacle.window_of(float(place[0])))

    def watch(self, beads: frozenset[int]) -> None:
        """Let these beads, and no others, take part in collisions."""
        if beads != self.watched:
            self._scene.collide(beads)
            self.watched = beads
            self._idle[:] = True
            self._idle[list(beads)] = False

    def unwatched(self) -> frozenset[int]:
        """Beads that touch the obstacle, or may, while the engine does not look at them."""
        scene, obstacle, distance = self._scene, self._obstacle, self._radius + _NEAR
        # No bead is farther from the last one of its link than the link is long.
        near = obstacle.near(scene.bead_positions(self._last), distance + self._longest)
        links = np.zeros(len(self._last), dtype=bool)
        links[near] = True
        beads = np.flatnonzero(links[self._links] & self._idle)
        points = scene.bead_positions(beads)
        near = obstacle.near(points, distance)
        beads, points = beads[near], points[near]
        if len(beads) and (gap := obstacle.gap(self.window, points)) is not None:
            touches = gap[0] < self.radii[beads] + _CLEAR
            if not obstacle.upright:  # it is true to the contour about its window only
                touches[obstacle.near(points, self._radius - _OVERLOOKED)] = True
            beads = beads[touches]
        return frozenset(beads.tolist())

    def overlooked(self, contacts: Contacts) -> float | None:
        """Where a watched bead is in the obstacle and carries no load, nor does one in its place.

        What collides is true to the contour near its window only: this makes sure, at every state
        at rest, that it has not let the beam through.
        """
        carries = contacts.touch[contacts.loaded | contacts.fused].tolist()
        unloaded = np.array(sorted(self.watched.difference(carries)), dtype=int)
        positions = self._scene.bead_positions(unloaded)
        deep = self.radii[unloaded] - _OVERLOOKED
        for suspect in self._obstacle.near(positions, deep):
            clearance, place = self._obstacle.clearance(positions[suspect])
            if clearance < deep[suspect]:
                return place
        return None

    def belied(self, contacts: Contacts) -> bool:
        """Whether the engine's depth of a loaded bead is not that of the contour.

        The search over a mesh can end at a vertex far from the nearest one: a window of a circle of
        radius 0.038 L had facets of 0.11 rad so. If there is another window that has all of the
        contour around the loaded beads, it is used from now on.
        """
        if not self._obstacle.upright:
            return False
        beads = contacts.loaded & (contacts.touch < len(self.radii))
        if not beads.any():
            return False
        points, depths = contacts.point[beads], contacts.distance[beads]
        depths = depths + self.radii[contacts.touch[beads]]
        # No point of the object is nearer than a tangent, which mostly says enough.
        least = self._obstacle.from_tangents(points, contacts.slope[beads])
        if np.abs(least - depths).max() < _OVERLOOKED:
            return False
        gap = self._obstacle.gap(self.window, points)
        if gap is not None and np.abs(gap[0] - depths).max() < _OVERLOOKED:
            return False
        found = np.array([self._obstacle.clearance(point) for point in points])
        if np.abs(found[:, 0] - depths).max() < _OVERLOOKED:
            return False
        for other in (self.window - 1, self.window + 1):
            if 0 <= other < self._obstacle.windows and self._obstacle.is_inside(other, found[:, 1]):
                self.use_window(other)
                break
        return True

    def is_crossed(self, joints: Floats) -> bool:
        """Whether a link cuts through an obstacle with corners."""
        if len(self._obstacle.corners) == 0:
            return False
        return self._obstacle.is_cut(
            np.vstack([joints, self._scene.bead_positions(self._all[-1:])])
        )
