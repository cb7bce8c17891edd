"""A smooth body by its support function: the point that has a given normal."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from analytic.problem.numbers import positive
from analytic.space.problem.bodies.body import Body, Spot, across, grid_patches, sphere_grid

_STEPS = 80  # of Newton's method on the sphere of normals
_WIDE = 0.5  # rad, the longest step
_DIFFERENCE = 1e-3  # rad, of differences
_TESTED = 200  # normals at which a body is looked at when it is stated
_CLOSE = 4 * float(np.finfo(float).eps)
_PLAIN = ((1, 1 / 2),)  # of order 2: Newton's method needs no more than 1e-6 of a radius
_FINE = ((1, 45 / 60), (2, -9 / 60), (3, 1 / 60))  # of order 6: 1e-13 of a radius of curvature


@dataclass(frozen=True, eq=False)
class SmoothBody(Body):
    """A strictly convex smooth body, by its support function's gradient.

    Parameters
    ----------
    point : callable
        Maps a unit vector, shape (3,), to the point of the surface with that outward normal, shape
        (3,) [length]: the gradient of the support function h(n) = max n . x over the body.
    label : str
        What reports call it.

    Raises
    ------
    InputError
        If the points are not those of a convex body.
    """

    point: Callable[[Floats], Floats]
    label: str = "smooth body"
    factor: float = field(default=1.0, kw_only=True, repr=False)

    def __post_init__(self) -> None:
        if not callable(self.point):
            allowed = "a function of a unit vector"
            raise InputError("body.point", self.point, allowed, "the support's gradient")
        normals = spread(_TESTED)
        try:
            points = np.array([self._at(n) for n in normals])
        except (TypeError, ValueError, IndexError) as error:
            allowed = "a function of an array of shape (3,)"
            raise InputError("body.point", "failing", allowed, str(error)) from error
        if points.shape != (_TESTED, 3) or not np.isfinite(points).all():
            raise InputError("body.point", "not finite", "three finite coordinates", "check it")
        own = (normals * points).sum(axis=1)
        beyond = points @ normals.T - own
        size = float(np.ptp(points, axis=0).max())
        worst = int(np.argmax(beyond.max(axis=0)))
        if not size > 0 or beyond[:, worst].max() > 1e-9 * size:
            x, y, z = normals[worst]
            what = f"of the normal ({x:.3f}, {y:.3f}, {z:.3f}) is not the farthest along it"
            allowed = "the gradient of a convex body's support function"
            raise InputError("body.point", what, allowed, "check its sign and derivative")

    def nearest(self, x: Floats, apart: float) -> Spot:
        """Newton's method for the normal along which the point lies off the surface."""
        outward = x - self._centre
        normal = outward / max(float(np.linalg.norm(outward)), 1e-300)
        best, missed = normal, np.inf
        for _ in range(_STEPS):
            away = x - self._at(normal)
            distance = float(away @ normal)
            sides = across(normal)
            slip = sides @ away
            miss = float(np.linalg.norm(slip))
            if miss < missed:
                best, missed = normal, miss
            if miss <= _CLOSE * max(1.0, float(np.abs(x).max())):
                break
            radii = self._radii(normal, sides, _PLAIN)
            bend = radii + max(distance, 0.0) * np.eye(2)
            turn = np.linalg.solve(bend, slip) @ sides
            size = float(np.linalg.norm(turn))
            turn *= min(1.0, _WIDE / max(size, 1e-300))
            normal = normal + turn
            normal = normal / np.linalg.norm(normal)
            if size <= _CLOSE:
                break
        point, sides = self._at(best), across(best)
        turning = np.linalg.inv(self._radii(best, sides, _FINE) + apart * np.eye(2))
        return Spot(point, best, float((x - point) @ best), sides.T @ turning @ sides)

    @cached_property
    def _centre(self) -> Floats:
        """Somewhere in the middle."""
        extremes = [self._at(s * e) for e in np.eye(3) for s in (1, -1)]
        return np.asarray(np.mean(extremes, axis=0))

    def _at(self, normal: Floats) -> Floats:
        return self.factor * np.asarray(self.point(normal), dtype=float)

    def _radii(
        self, normal: Floats, sides: Floats, weights: tuple[tuple[int, float], ...]
    ) -> Floats:
        """Radii of curvature: how the point moves as the normal turns, shape (2, 2)."""
        columns = []
        for side in sides:
            moved = np.zeros(3)
            for steps, weight in weights:
                angle = steps * _DIFFERENCE
                turned = np.cos(angle) * normal, np.sin(angle) * side
                moved += weight * (
                    self._at(turned[0] + turned[1]) - self._at(turned[0] - turned[1])
                )
            columns.append(sides @ moved / _DIFFERENCE)
        found = np.array(columns)
        return np.asarray((found + found.T) / 2)

    def scaled(self, factor: float) -> "SmoothBody":
        return replace(self, factor=positive("factor", factor) * self.factor)

    def patches(self, centre: Floats, reach: float) -> Floats:
        return grid_patches(np.apply_along_axis(self._at, -1, sphere_grid()))


def spread(count: int) -> Floats:
    """Unit vectors evenly over the sphere, on a spiral."""
    height = 1 - 2 * (np.arange(count) + 0.5) / count
    angle = np.pi * (1 + np.sqrt(5)) * np.arange(count)
    ring = np.sqrt(1 - height**2)
    return np.stack([ring * np.cos(angle), height, ring * np.sin(angle)], axis=1)
