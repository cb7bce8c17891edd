"""Sharp edges of an obstacle, which the sides of the beam's links touch.

A bead is a fixed point of the beam: two of them hold a corner anywhere between their normals, as if
it were rough. What really touches a corner is the beam's side, a link, whose normal is that of the
link and turns with it. So past corners the beam has a bead at each joint, for facets, and its links
collide with the edges: together that is all that two polygons can touch each other with.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers

EDGE_PREFIX = "edge"
LINKS = 2  # the bit of contype and conaffinity by which links and edges collide
SHARP = 2e-3  # rad; polygons that turn less at all corners are smooth to beads, to 1e-3 of a force
_TURN = 1e-9  # rad; what turns less is no corner
_STRAIGHT = 1e-6  # rad; a side that turns less in all is one facet, which ends in two corners


@dataclass(frozen=True, eq=False)
class Corners:
    """The edges that stand on the plane of the sweep."""

    ends: Floats  # shape (m, 2, 3); Where each edge begins and ends [L]
    outward: Floats  # shape (m, 2); Unit vectors half-way between the normals of the two facets
    # Of the capsules that MuJoCo takes for edges, which reach as far outward as those [L].
    radius: float
    of_object: Integers  # shape (m,); the number of the object that each is of

    @classmethod
    def none(cls) -> "Corners":
        """Those of a smooth obstacle."""
        return cls(np.zeros((0, 2, 3)), np.zeros((0, 2)), 0.0, np.zeros(0, dtype=int))

    @classmethod
    def of(
        cls, vertices: Floats, edges: Floats, radius: float, ends: tuple[bool, bool]
    ) -> "Corners":
        """Those of a polygon, if one is sharp; its ends only where the object itself ends."""
        angles = _angles(vertices)
        turn = np.diff(angles)
        between = turn[1:-1]
        bowed = between.sum() > _STRAIGHT and between.max() < SHARP
        if bowed and not ends_sharp(vertices, ends):
            return cls.none()
        sharp = turn > _TURN
        bisector = ((angles[1:] + angles[:-1]) / 2)[sharp]
        outward = np.column_stack([np.sin(bisector), -np.cos(bisector)])
        return cls(edges[sharp], outward, radius, np.zeros(len(outward), dtype=int))

    @classmethod
    def of_all(cls, parts: Sequence["Corners"]) -> "Corners":
        """Those of several objects, in turn."""
        number = np.repeat(np.arange(len(parts)), [len(part) for part in parts])
        ends, outward = (
            np.concatenate([getattr(part, name) for part in parts]) for name in ("ends", "outward")
        )
        return cls(ends, outward, max(part.radius for part in parts), number)

    def __len__(self) -> int:
        return len(self.ends)

    def nearest(self, edge: Integers, points: Floats) -> Floats:
        begin, end = self.ends[edge].transpose(1, 0, 2)
        run = end - begin
        share = ((points - begin) * run).sum(axis=1) / (run**2).sum(axis=1)
        return np.asarray(begin + np.clip(share, 0, 1)[:, None] * run)

    def in_front(self, point: Floats, edge: int) -> bool:
        """Whether a place is in front of one of the object with an edge, so that it is outside."""
        own = np.flatnonzero(self.of_object == self.of_object[edge])
        away = point - self.nearest(own, point)
        return bool(((away[:, :2] * self.outward[own]).sum(axis=1) > 0).any())

    def add_to(self, spec: mujoco.MjSpec) -> None:
        inset = np.insert(self.radius * self.outward, 2, 0.0, axis=1)
        for i, (begin, end) in enumerate(self.ends - inset[:, None]):
            spec.worldbody.add_geom(
                name=f"{EDGE_PREFIX}{i}",
                type=mujoco.mjtGeom.mjGEOM_CAPSULE,
                fromto=[*begin, *end],
                size=[self.radius, 0, 0],
                contype=LINKS,
                conaffinity=0,
                condim=1,
            )


def ends_sharp(vertices: Floats, ends: tuple[bool, bool]) -> bool:
    """Whether a polygon has a sharp corner where the object itself ends."""
    return bool((np.diff(_angles(vertices))[[0, -1]] > SHARP)[list(ends)].any())


def _angles(vertices: Floats) -> Floats:
    """Slope angles of the facets, and upright ones before and after them."""
    run, rise = np.diff(vertices, axis=0).T
    return np.concatenate([[-np.pi / 2], np.arctan2(rise, run), [np.pi / 2]])


def upright(vertices: Floats, half_length: float) -> Floats:
    """Edges along z through vertices of the section."""
    ends = [np.insert(vertices, 2, z, axis=1) for z in (-half_length, half_length)]
    return np.stack(ends, axis=1)
