"""Families of bodies that an object in space may be of, by a few numbers over L."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.space.problem.bodies.body import Body, across
from analytic.space.problem.bodies.ellipsoid import ellipsoid, sphere
from analytic.space.problem.bodies.prism import cylinder


class Family(NamedTuple):
    """Bodies of one kind: a family knows nothing of vibrissae."""

    name: str
    start: Floats  # numbers of the body nearest to the contacts, by linear least squares
    # How far points near the surface are outside, to first order, and its normals there.
    surface: Callable[[Floats, Floats], tuple[Floats, Floats]]
    body: Callable[[Floats], Body]
    reported: Callable[[Floats], dict[str, float]]


def families(points: Floats, normals: Floats) -> dict[str, Family]:
    ball = _middle(points, normals)
    every = (
        Family(
            "sphere",  # radius and centre
            ball,
            _off_sphere,
            lambda numbers: sphere(float(numbers[0]), numbers[1:]),
            lambda numbers: {"radius": float(numbers[0]), **_named("centre", numbers[1:])},
        ),
        Family(
            "ellipsoid",  # semi-axes along x, y and z, and the centre
            ball[[0, 0, 0, 1, 2, 3]],
            _off_ellipsoid,
            lambda numbers: ellipsoid(numbers[:3], numbers[3:]),
            lambda numbers: {**_named("semi_axis", numbers[:3]), **_named("centre", numbers[3:])},
        ),
        _cylinders(points, normals),
    )
    return {one.name: one for one in every}


def _off_sphere(numbers: Floats, points: Floats) -> tuple[Floats, Floats]:
    out = points - numbers[1:]
    far = np.linalg.norm(out, axis=1)
    return far - numbers[0], out / far[:, None]


def _off_ellipsoid(numbers: Floats, points: Floats) -> tuple[Floats, Floats]:
    """By the level sets of |y/a| = 1."""
    scaled = (points - numbers[3:]) / numbers[:3]
    level = np.linalg.norm(scaled, axis=1)
    gradient = scaled / numbers[:3] / level[:, None]
    steep = np.linalg.norm(gradient, axis=1)
    return (level - 1) / steep, gradient / steep[:, None]


def _cylinders(points: Floats, normals: Floats) -> Family:
    """By radius, two slopes of the axis against a first guess of it, and where the axis passes."""
    near = points.mean(axis=0)
    guess = np.linalg.svd(normals, full_matrices=True)[2][2]  # normals lie in a plane
    guess = guess * np.sign(guess[np.abs(guess).argmax()])
    sides = across(guess)

    def line(numbers: Floats) -> tuple[Floats, Floats]:
        axis = guess + numbers[1:3] @ sides
        return near + numbers[3:] @ sides, axis / np.linalg.norm(axis)

    def off(numbers: Floats, points: Floats) -> tuple[Floats, Floats]:
        through, axis = line(numbers)
        out = points - through
        out = out - (out @ axis)[:, None] * axis
        far = np.linalg.norm(out, axis=1)
        return far - numbers[0], out / far[:, None]

    def reported(numbers: Floats) -> dict[str, float]:
        """The axis as a unit vector, and its point beside the middle of the contacts."""
        through, axis = line(numbers)
        through = through + ((near - through) @ axis) * axis
        found = {"radius": float(numbers[0])}
        return found | _named("axis", axis) | _named("through", through)

    circle = _middle((points - near) @ sides.T, normals @ sides.T)
    start = np.concatenate([circle[:1], [0.0, 0.0], circle[1:]])
    return Family(
        "cylinder",
        start,
        off,
        lambda numbers: cylinder(float(numbers[0]), *line(numbers)),
        reported,
    )


def _named(what: str, values: Floats) -> dict[str, float]:
    return {f"{what}_{axis}": x for axis, x in zip("xyz", values.tolist(), strict=True)}


def _middle(points: Floats, normals: Floats) -> Floats:
    """Radius and centre of the circle or sphere that has these points and outward normals.

    A point is the centre and a radius along the normal.
    """
    count = points.shape[1]
    centres = np.tile(np.eye(count), (len(points), 1))
    design = np.column_stack([normals.ravel(), centres])
    return np.asarray(np.linalg.lstsq(design, points.ravel(), rcond=None)[0])
