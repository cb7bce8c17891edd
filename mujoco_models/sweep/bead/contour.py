"""How the normal of a contour turns as a bead goes along it: to the next facet, and the next."""

import math
from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.obstacles.faceted import Faceted
from mujoco_models.obstacles.protocol import TOP, Obstacle

_LARGEST = 0.3  # rad, of a step
_AROUND = 1.2  # rad; along the contour the places follow each other up to there
_FACETS = 64  # that are looked at, at first
_ITERATIONS = 4  # from a chord of 0.3 rad they lead to rounding
_MORE = 4  # times as many, if these are too few
# rad; MuJoCo's normal of a facet is as good as that, of a prism whose vertices it has exactly, of a
# mesh file, and, in L, as rounding of its ends in single precision lets it be.
_EXACT, _FLAT, _SINGLE = 1e-7, 1e-5, 2.0**-23


class Bead(NamedTuple):
    """Where a bead is on the contour; lengths in L."""

    slope: float  # of the contour there [rad]
    x: float
    y: float
    gap: float  # of its centre from the contour


class Way(NamedTuple):
    """How far a beam takes its bead along the contour, by how much the contact's normal turns."""

    at_once: float  # [L]
    by_turn: float  # [L/rad]


class Turn(NamedTuple):
    """To where on the contour a bead comes."""

    by: float  # the normal turns [rad]
    along: float  # the contour, as it was, its centre goes [L]
    rise: float  # and across it, away from the obstacle [L]


class Smooth:
    """The contour of a smooth obstacle."""

    def __init__(self, obstacle: Obstacle) -> None:
        self._obstacle = obstacle

    def radius(self, bead: Bead) -> float:
        """Radius of curvature of the way of a bead's centre [L]."""
        return 1 / float(self._obstacle.curvature(np.array([bead.slope]))[0]) + bead.gap

    def turn(self, bead: Bead, way: Way) -> Turn:
        """By how much the normal turns until beam and contour agree where the bead is."""
        radius = self.radius(bead)
        free = radius - way.by_turn
        found = way.at_once / free if free > 0 else math.copysign(_LARGEST, way.at_once)
        found = min(max(found, -_LARGEST), _LARGEST)
        return Turn(found, radius * math.sin(found), radius * (math.cos(found) - 1))


class Facets:
    """That of a polygon: the normal turns about its vertices only, there on circles."""

    def __init__(self, obstacle: Faceted) -> None:
        vertices, lean = obstacle.section, obstacle.lean
        run, rise = np.diff(vertices, axis=0).T
        self._vertices = vertices
        self._angles: Floats = np.concatenate([[-TOP], np.arctan2(rise, run), [TOP]])
        flat = _EXACT if obstacle.upright else _FLAT
        self._flat = np.pad(np.maximum(flat, _SINGLE / np.hypot(run, rise)), 1)
        normals = np.column_stack([np.sin(self._angles), -np.cos(self._angles)])
        self._offsets = np.stack([_offset(normals[:-1], lean), _offset(normals[1:], lean)], axis=1)

    def radius(self, bead: Bead) -> float:
        """Radius of curvature of the way of a bead's centre [L]."""
        end = int(self._angles.searchsorted(bead.slope))
        near = slice(max(end - 1, 0), end + 1)
        on = np.abs(self._angles[near] - bead.slope) < self._flat[near]
        return math.inf if on.any() else bead.gap

    def turn(self, bead: Bead, way: Way) -> Turn:
        """By how much the normal turns until beam and contour first agree where the bead is."""
        onward, count = 1 if way.at_once > 0 else -1, _FACETS
        while True:
            found = self._turn(bead, way, onward, count)
            if found is not None:
                return found
            count *= _MORE

    def _turn(self, bead: Bead, way: Way, onward: int, count: int) -> Turn | None:
        """The same, if it is over no more facets."""
        last = len(self._vertices)
        here = int(self._angles.searchsorted(bead.slope)) - 1
        low, high = self._angles.searchsorted([bead.slope - _AROUND, bead.slope + _AROUND]).tolist()
        first, end = max(here - count, low - 1, 0), min(here + count, high, last)
        if first >= end:  # pushed in so far that it is nearer to the far side
            return Turn(0.0, 0.0, 0.0)
        # Facets begin and end where the normal is that of one and the other of two at a vertex.
        turns = self._angles[first : end + 1] - bead.slope
        turned_by = np.clip(turns[[0, -1]], -_AROUND, _AROUND)
        cut = turns[[0, -1]] != turned_by
        turns[[0, -1]] = turned_by
        turns[np.abs(turns) < self._flat[first : end + 1]] = 0.0
        cos, sin = math.cos(bead.slope), math.sin(bead.slope)
        ends = self._vertices[first:end, None] + bead.gap * self._offsets[first:end]
        for edge in np.flatnonzero(cut):  # farther round, places along the contour come back
            angle = bead.slope + turned_by[edge]
            outward = np.array([math.sin(angle), -math.cos(angle)])
            ends[-edge, -edge] = self._vertices[first:end][-edge] + bead.gap * outward
        path = np.empty((3, 2 * len(ends)))
        path[0, 0::2], path[0, 1::2] = turns[:-1], turns[1:]
        path[1:] = [[cos, sin], [sin, -cos]] @ (ends.reshape(-1, 2) - [bead.x, bead.y]).T
        at = int(path[1].searchsorted(0.0))
        # Where the bead is, the path is said to be: its own distance may be off by a mesh's tilt.
        here = min(at, path.shape[1] - 1)
        if at % 2:
            begin, over = path[:, at - 1], path[:, at]
            path[2] -= begin[2] + _radius(begin, over, bead.gap) * (1 - math.cos(begin[0]))
        else:
            path[2] -= path[2, here]
        path = path[:, at:] if onward > 0 else path[:, :at][:, ::-1]
        ahead = onward * (way.at_once + way.by_turn * path[0] - path[1])
        passed = (ahead <= 0) | (np.abs(path[0]) > _LARGEST)
        if not passed.any():
            if end < min(high, last) if onward > 0 else first > max(low - 1, 0):
                return None
            return Turn(*path[:, -1].tolist()) if len(ahead) else Turn(0.0, 0.0, 0.0)
        number = int(passed.argmax())
        after, stop = float(ahead[number]), path[:, number]
        before, start = abs(way.at_once), np.zeros(3)
        if number:
            before, start = float(ahead[number - 1]), path[:, number - 1]
        share = min(before / (before - after), 1.0) if before > max(after, 0.0) else 1.0
        found = Turn(*(start + share * (stop - start)).tolist())
        if abs(stop[0] - start[0]) < _EXACT:
            return found
        gap = _radius(start, stop, bead.gap)
        return _about_a_vertex(Turn(*start.tolist()), found.by, float(stop[0]), gap, way)


def _offset(normals: Floats, lean: Floats) -> Floats:
    """Where from a vertex the centre of a bead of radius 1 is that leaves a facet there.

    The edge at the vertex leans, and so may the facet: it touches the edge above or below.
    """
    tilt = -(normals * lean).sum(axis=1)[:, None]  # of the facet, along z over in the plane
    return np.asarray((normals - tilt * lean) / np.sqrt(1 + tilt**2))


def _radius(begin: Floats, end: Floats, gap: float) -> float:
    """Of the circle about a vertex."""
    over = math.sin(end[0]) - math.sin(begin[0])
    return float(end[1] - begin[1]) / over if abs(over) > _EXACT else gap


def _about_a_vertex(start: Turn, guess: float, stop: float, gap: float, way: Way) -> Turn:
    """On the circle about a vertex, by Newton's method from a guess on its chord."""
    low, high = sorted(max(min(x, _LARGEST), -_LARGEST) for x in (start.by, stop))
    by, (sin, cos) = min(max(guess, low), high), (math.sin(start.by), math.cos(start.by))
    for _ in range(_ITERATIONS):
        missed = way.at_once + way.by_turn * by - start.along - gap * (math.sin(by) - sin)
        slope = gap * math.cos(by) - way.by_turn
        if slope <= 0:
            break
        by = min(max(by + missed / slope, low), high)
    return Turn(
        by, start.along + gap * (math.sin(by) - sin), start.rise + gap * (math.cos(by) - cos)
    )


def contour_of(obstacle: Obstacle) -> Smooth | Facets:
    """That of an obstacle, as MuJoCo has it."""
    return Facets(obstacle) if isinstance(obstacle, Faceted) else Smooth(obstacle)
