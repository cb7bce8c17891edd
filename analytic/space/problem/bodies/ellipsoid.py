"""Spheres and ellipsoids."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from analytic.problem.numbers import Vector, axes, positive, vector
from analytic.space.problem.bodies.body import Body, Spot, flat_spot, grid_patches, sphere_grid

_STEPS = 60  # of Newton's method, from below: it cannot overshoot
_EPS = float(np.finfo(float).eps)
_ALL = np.eye(3)


@dataclass(frozen=True, eq=False)
class Ellipsoid(Body):
    """An ellipsoid; made by `sphere` and `ellipsoid`."""

    semi_axes: Floats  # shape (3,) [length]
    centre: Floats  # shape (3,) [length]
    frame: Floats  # unit vectors along the semi-axes, a row each
    label: str  # what reports call it

    def nearest(self, x: Floats, apart: float) -> Spot:
        """By the root of the secular equation sum (a_i y_i/(a_i^2 + m))^2 = 1."""
        squares = self.semi_axes**2
        y = self.frame @ (x - self.centre)
        inside = float(y @ (y / squares))
        if inside <= 1:
            inward = (math.sqrt(inside) - 1) * float(self.semi_axes.min())
            rise = y / squares if inside else np.eye(3)[self.semi_axes.argmin()]
            return flat_spot(x, rise / math.sqrt(rise @ rise) @ self.frame, inward)
        multiplier = _multiplier((squares * y * y).tolist(), squares.tolist())
        gradient = y / (squares + multiplier)
        steepness = math.sqrt(gradient @ gradient)
        normal = gradient / steepness
        flat = _ALL - normal[:, None] * normal
        # n = D p/|D p| with D = 1/a^2, and p + m D p stays as far apart as the parallel surface.
        bend = (flat / squares) @ flat / steepness
        turning = self.frame.T @ _of_parallel(bend, apart) @ self.frame
        return Spot(
            self.centre + (squares * gradient) @ self.frame,
            normal @ self.frame,
            multiplier * steepness,
            turning,
        )

    def scaled(self, factor: float) -> "Ellipsoid":
        return replace(self, semi_axes=factor * self.semi_axes, centre=factor * self.centre)

    def patches(self, centre: Floats, reach: float) -> Floats:
        return grid_patches(self.centre + (sphere_grid() * self.semi_axes) @ self.frame)


def _multiplier(weighted: list[float], squares: list[float]) -> float:
    """Root of sum w_i/(a_i^2 + m)^2 = 1; three numbers are faster one by one than as arrays."""
    both = list(zip(weighted, squares, strict=True))
    m = max(0.0, *(math.sqrt(w) - square for w, square in both))
    for _ in range(_STEPS):
        total = slope = 0.0
        for w, square in both:
            part = w / (square + m) ** 2
            total += part
            slope += part / (square + m)
        step = (total - 1) / (2 * slope)
        m += max(step, 0.0)
        if step <= 2 * _EPS * m:
            break
    return m


def _of_parallel(bend: Floats, apart: float) -> Floats:
    """The turning on the parallel surface, from that on the surface itself."""
    turned = np.linalg.solve(_ALL + apart * bend, bend)
    return np.asarray((turned + turned.T) / 2)


def sphere(radius: float, centre: Vector) -> Ellipsoid:
    """A sphere.

    Parameters
    ----------
    radius : float
        Positive [length].
    centre : array_like, shape (3,)
        (x, y, z) [length].

    Returns
    -------
    Body
        With three equal semi-axes.

    Raises
    ------
    InputError
        If a number cannot be.
    """
    size = positive("body.radius", radius)
    middle = vector("body.centre", centre)
    return Ellipsoid(np.full(3, size), middle, np.eye(3), f"sphere of radius {size:g}")


def ellipsoid(semi_axes: Vector, centre: Vector, frame: ArrayLike | None = None) -> Ellipsoid:
    """An ellipsoid.

    Parameters
    ----------
    semi_axes : array_like, shape (3,)
        Positive [length].
    centre : array_like, shape (3,)
        (x, y, z) [length].
    frame : array_like, shape (3, 3), optional
        Unit vectors along the semi-axes, a row each; x, y and z if not given.

    Returns
    -------
    Body
        The body.

    Raises
    ------
    InputError
        If a number cannot be, the frame is none, or one semi-axis is more than 1e4 of another.
    """
    sizes = vector("body.semi_axes", semi_axes)
    for i, size in enumerate(sizes):
        positive(f"body.semi_axes[{i}]", float(size))
    if sizes.max() > 1e4 * sizes.min():
        allowed = "within 1e4 of each other"
        raise InputError("body.semi_axes", semi_axes, allowed, "it is a disc else")
    name = " by ".join(f"{size:g}" for size in sizes)
    rows = np.eye(3) if frame is None else axes("body.frame", frame)
    middle = vector("body.centre", centre)
    return Ellipsoid(sizes, middle, rows, f"ellipsoid {name}")
