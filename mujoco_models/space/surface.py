"""What a bead touches while Newton's method runs: the body, or one face, edge or corner of a mesh.

On a mesh a face, an edge or a corner, each as if it had no end, is smooth, so that Newton's method
converges, and a step along the way of the foot that ends on another one is seen. Which one it is
MuJoCo's normals next to the contact say: they do not turn on a face, about an edge they turn one
way, at a corner two.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.space.model import SpaceModel, Touch, across

_STEPS = (
    1e-6,
    1e-7,
    1e-8,
)  # L, over which normals are compared: smaller where the first is unclear
_FLAT, _SHARP = 0.1, 0.9  # of 1/distance: how fast normals turn that do not turn, or do
_RINGS = 0.25, 1.0  # radii of the vibrissa; an edge's fan of normals is narrower than that
BESIDE = 2e-4
"""From where next to the body it is looked for what meets at a contact [L]: twice as far as that
may be from the edge over which it goes."""
STAYS = 1e-8
"""How far a feature and the mesh may be apart where they are one [L]: its place and direction are
found to that, over its length; what has left it by less has hardly moved."""
_SAME_NORMAL = 1e-5  # rad, of two edges that are one
_SAME_PLACE = 1e-6  # L, of two edges that are one: as far as it is touched they are as near
_SAME_FACE = 1e-12  # rad; next to a face an edge has another normal


class Surface(Protocol):
    """What may be touched."""

    def touch(self, link: int, s: float) -> Touch:
        """The nearest point to a bead.

        Parameters
        ----------
        link : int
            The link that carries it.
        s : float
            Its arc length [L].

        Returns
        -------
        Touch
            Place, normal and distance.
        """

    def turning(self, link: int, touch: Touch) -> Floats:
        """How the normal turns as the bead's centre moves.

        Parameters
        ----------
        link : int
            The link that carries it.
        touch : Touch
            Where it is.

        Returns
        -------
        array, shape (3, 3)
            Symmetric [1/L].
        """


class Whole(NamedTuple):
    """The body as it is."""

    model: SpaceModel

    def touch(self, link: int, s: float) -> Touch:
        """By MuJoCo."""
        return self.model.touch(link, s)

    def turning(self, link: int, touch: Touch) -> Floats:
        """By differences of MuJoCo's normals."""
        return self.model.turning(link, touch, self.model.shape.difference)


class Feature(NamedTuple):
    """A face, an edge or a corner without end."""

    model: SpaceModel
    point: Floats
    """One of it, shape (3,) [L]."""
    normal: Floats
    """Of a face, shape (3,)."""
    basis: Floats
    """Unit vectors along the directions that its normals have, across each other, shape (1 to 3,
    3)."""
    span: Floats
    """Projects on these, shape (3, 3)."""

    @property
    def flat(self) -> bool:
        """Whether it is a face."""
        return len(self.basis) == 1

    def touch(self, link: int, s: float) -> Touch:
        """The foot of the perpendicular."""
        return self.touched(self.model.centre(link, s))

    def touched(self, centre: Floats) -> Touch:
        """The same of a bead wherever it is."""
        away = centre - self.point
        if self.flat:
            return Touch(centre, self.normal, float(away @ self.normal) - self.model.radius)
        away = self.span @ away
        distance = math.sqrt(away @ away)
        return Touch(centre, away / distance, distance - self.model.radius)

    def turning(self, link: int, touch: Touch) -> Floats:
        """About an edge or a corner."""
        n = touch.normal
        return np.asarray((self.span - np.outer(n, n)) / (touch.distance + self.model.radius))

    def missed(self, link: int, s: float) -> float:
        """How far the mesh is from being as if this were all of it."""
        return self.missed_at(link, self.model.centre(link, s))

    def missed_at(self, link: int, centre: Floats) -> float:
        """The same for a bead wherever it is."""
        ours, found = self.touched(centre), self.model.probe(link, centre)
        apart = found.distance + self.model.radius
        return max(
            abs(ours.distance - found.distance),
            apart * float(np.abs(ours.normal - found.normal).max()),
        )


def surface_at(model: SpaceModel, link: int, touch: Touch) -> Surface:
    """What a bead touches."""
    if not model.shape.faceted:
        return Whole(model)
    apart = touch.distance + model.radius
    n = touch.normal
    for step in _STEPS:
        rates, ways = model.curved(link, touch, step)
        rates = rates * apart
        if ((rates < _FLAT) | (rates > _SHARP)).all():
            break
    basis = np.concatenate([n[None], ways[rates > (_FLAT + _SHARP) / 2]])
    return Feature(model, touch.centre - apart * n, n, basis, basis.T @ basis)


def features_at(model: SpaceModel, link: int, centre: Floats) -> list[Feature]:
    """The faces and the edges of a mesh that meet where a bead touches, faces first.

    They are looked for from next to the body, where the fans of normals of edges are narrow.
    """
    touch = model.probe(link, centre)
    low = model.contact(touch) + BESIDE * touch.normal
    return _features(model, link, low + BESIDE * _ring(touch.normal, 16))


def features_around(
    model: SpaceModel, link: int, centre: Floats, known: Sequence[Feature] = ()
) -> list[Feature]:
    """The faces and the edges of a mesh next to a bead, faces first."""
    ring = _ring(model.probe(link, centre).normal, 8)
    rings = [centre + size * model.radius * ring for size in _RINGS]
    return _features(model, link, np.concatenate(rings), known)


def edges_of(model: SpaceModel, faces: Sequence[Feature], centre: Floats) -> list[Feature]:
    """The edges in which faces meet around a corner, or in which two do.

    The fan of an edge's normals is narrow, and what lies next to a corner is mostly faces.
    """
    if len(faces) < 2:
        return []
    normals = np.array([one.normal for one in faces])
    one, other = (normals @ across(_unit(normals.sum(axis=0))).T).T
    turn = np.argsort(np.arctan2(other, one))
    pairs = list(zip(turn, np.roll(turn, -1), strict=True))
    if len(pairs) == 2:
        pairs.pop()
    return [_edge(model, faces[i], faces[j], centre) for i, j in pairs]


def _edge(model: SpaceModel, one: Feature, other: Feature, centre: Floats) -> Feature:
    """In which two faces meet."""
    normal = _unit(one.normal + other.normal)
    basis = np.array([normal, _unit(one.normal - other.normal)])
    heights = [face.normal @ (face.point - centre) for face in (one, other)]
    down = basis.T @ np.linalg.solve([face.normal @ basis.T for face in (one, other)], heights)
    return Feature(model, centre + down, normal, basis, basis.T @ basis)


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))


def _features(
    model: SpaceModel, link: int, places: Floats, known: Sequence[Feature] = ()
) -> list[Feature]:
    """What a bead touches in some places."""
    faces = [one for one in known if one.flat]
    edges = [one for one in known if not one.flat]
    before = len(faces), len(edges)
    for place in places:
        touch = model.probe(link, place)
        if any(np.abs(touch.normal - one.normal).max() < _SAME_FACE for one in faces):
            continue
        found = surface_at(model, link, touch)
        assert isinstance(found, Feature)
        alike = faces if found.flat else edges
        if not any(_same(found, one) for one in alike):
            alike.append(found)
    return faces[before[0] :] + edges[before[1] :]


def _same(one: Feature, other: Feature) -> bool:
    """Whether two are one."""
    if np.abs(one.span - other.span).max() > _SAME_NORMAL:
        return False
    return bool(np.abs(one.span @ (one.point - other.point)).max() < _SAME_PLACE)


def _ring(normal: Floats, count: int) -> Floats:
    """Ways along a surface, shape (count, 3)."""
    angle = np.arange(count) * 2 * np.pi / count
    return np.column_stack([np.cos(angle), np.sin(angle)]) @ across(normal)
