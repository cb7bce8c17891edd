"""Families of bodies that an object in space may be of, by a few numbers over L."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats
from analytic.space.problem.bodies.body import Body, across
from analytic.space.problem.bodies.ellipsoid import ellipsoid, sphere
from analytic.space.problem.bodies.prism import cylinder

_XYZ = ("x", "y", "z")


class Family(ABC):
    """Bodies of one kind: a family knows nothing of vibrissae."""

    name: str

    @abstractmethod
    def start(self, points: Floats, normals: Floats) -> Floats:
        """Numbers of the body nearest to points of its surface, by linear least squares."""

    @abstractmethod
    def surface(self, numbers: Floats, points: Floats) -> tuple[Floats, Floats]:
        """How far points near the surface are outside, to first order, and its normals there."""

    @abstractmethod
    def body(self, numbers: Floats) -> Body:
        """The body of these numbers."""

    @abstractmethod
    def reported(self, numbers: Floats) -> dict[str, float]:
        """What of the body is reported."""


class Sphere(Family):
    """Radius and centre."""

    name = "sphere"

    def start(self, points: Floats, normals: Floats) -> Floats:
        """A point is the centre and a radius along the normal."""
        return _middle(points, normals)

    def surface(self, numbers: Floats, points: Floats) -> tuple[Floats, Floats]:
        """By the distance from the centre."""
        out = points - numbers[1:]
        far = np.linalg.norm(out, axis=1)
        return far - numbers[0], out / far[:, None]

    def body(self, numbers: Floats) -> Body:
        """A sphere."""
        return sphere(float(numbers[0]), numbers[1:])

    def reported(self, numbers: Floats) -> dict[str, float]:
        """All numbers."""
        return {"radius": float(numbers[0]), **_named("centre", numbers[1:])}


class Ellipsoid(Family):
    """Semi-axes along x, y and z, and the centre."""

    name = "ellipsoid"

    def start(self, points: Floats, normals: Floats) -> Floats:
        """The sphere."""
        return _middle(points, normals)[[0, 0, 0, 1, 2, 3]]

    def surface(self, numbers: Floats, points: Floats) -> tuple[Floats, Floats]:
        """By the level sets of |y/a| = 1."""
        scaled = (points - numbers[3:]) / numbers[:3]
        level = np.linalg.norm(scaled, axis=1)
        gradient = scaled / numbers[:3] / level[:, None]
        steep = np.linalg.norm(gradient, axis=1)
        return (level - 1) / steep, gradient / steep[:, None]

    def body(self, numbers: Floats) -> Body:
        """An ellipsoid."""
        return ellipsoid(numbers[:3], numbers[3:])

    def reported(self, numbers: Floats) -> dict[str, float]:
        """All numbers."""
        return {**_named("semi_axis", numbers[:3]), **_named("centre", numbers[3:])}


@dataclass(frozen=True)
class Cylinder(Family):
    """Radius, two slopes of the axis against a first guess of it, and where the axis passes."""

    name = "cylinder"
    near: Floats  # the middle of the contacts, shape (3,)
    axis: Floats  # the first guess

    @classmethod
    def about(cls, points: Floats, normals: Floats) -> "Cylinder":
        """Its normals lie in a plane."""
        axis = np.linalg.svd(normals, full_matrices=True)[2][2]
        return cls(points.mean(axis=0), axis * np.sign(axis[np.abs(axis).argmax()]))

    def start(self, points: Floats, normals: Floats) -> Floats:
        """The circle across the axis."""
        sides = across(self.axis)
        circle = _middle((points - self.near) @ sides.T, normals @ sides.T)
        return np.concatenate([circle[:1], [0.0, 0.0], circle[1:]])

    def surface(self, numbers: Floats, points: Floats) -> tuple[Floats, Floats]:
        """By the distance from the axis."""
        through, axis = self._line(numbers)
        out = points - through
        out = out - (out @ axis)[:, None] * axis
        far = np.linalg.norm(out, axis=1)
        return far - numbers[0], out / far[:, None]

    def body(self, numbers: Floats) -> Body:
        """An endless cylinder."""
        return cylinder(float(numbers[0]), *self._line(numbers))

    def reported(self, numbers: Floats) -> dict[str, float]:
        """The axis as a unit vector, and its point beside the middle of the contacts."""
        through, axis = self._line(numbers)
        through = through + ((self.near - through) @ axis) * axis
        return {
            "radius": float(numbers[0]), **_named("axis", axis), **_named("through", through)
        }  # fmt: skip

    def _line(self, numbers: Floats) -> tuple[Floats, Floats]:
        sides = across(self.axis)
        axis = self.axis + numbers[1:3] @ sides
        return self.near + numbers[3:] @ sides, axis / np.linalg.norm(axis)


def _named(what: str, values: Floats) -> dict[str, float]:
    return {f"{what}_{axis}": x for axis, x in zip(_XYZ, values.tolist(), strict=True)}


def _middle(points: Floats, normals: Floats) -> Floats:
    """Radius and centre of the circle or sphere that has these points and outward normals."""
    count = points.shape[1]
    centres = np.tile(np.eye(count), (len(points), 1))
    design = np.column_stack([normals.ravel(), centres])
    return np.asarray(np.linalg.lstsq(design, points.ravel(), rcond=None)[0])


def families(points: Floats, normals: Floats) -> dict[str, Family]:
    """All of them, for contacts at these points."""
    every = Sphere(), Ellipsoid(), Cylinder.about(points, normals)
    return {one.name: one for one in every}
