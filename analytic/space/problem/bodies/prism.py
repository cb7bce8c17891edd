"""Bodies that are the same all along an axis: round cylinders, and prisms of planar contours."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.contours.polygon import Polygon
from analytic.problem.errors import require
from analytic.problem.numbers import Vector, direction, positive, vector
from analytic.space.problem.bodies.body import Body, Feature, Spot, across, grid_patches

_PLACES = 33  # of the contour, to begin with: NumPy takes hardly longer for them than for one
_ROUNDING = float(np.finfo(float).eps)  # of a parameter, relative to its range


@dataclass(frozen=True, eq=False)
class Cylinder(Body):
    """An endless round cylinder; made by `cylinder`."""

    radius: float  # [length]
    through: Floats  # a point of its axis, shape (3,) [length]
    axis: Floats  # of length 1, shape (3,)
    label: str  # what reports call it

    def nearest(self, x: Floats, apart: float) -> Spot:
        middle, normal, far, turning = self._line.nearest(x, self.radius + apart)
        return Spot(middle + self.radius * normal, normal, far - self.radius, turning)

    @cached_property
    def _line(self) -> Feature:
        sides = across(self.axis)
        return Feature(self.through, sides, sides[0])

    def scaled(self, factor: float) -> "Cylinder":
        return replace(self, radius=factor * self.radius, through=factor * self.through)

    def patches(self, centre: Floats, reach: float) -> Floats:
        sides = across(self.axis)
        middle = self.through + ((centre - self.through) @ self.axis) * self.axis
        angle = np.linspace(0, 2 * np.pi, 49)
        ring = self.radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1) @ sides
        along = np.linspace(-reach, reach, 9)[:, None, None] * self.axis
        return grid_patches(middle + ring + along)


@dataclass(frozen=True, eq=False)
class Prism(Body):
    """The prism of a planar contour, above whose ends its sides go straight up without end."""

    contour: Contour  # the lower side of its section [length]
    origin: Floats  # of the contour's coordinates, shape (3,) [length]
    frame: Floats  # the contour's x and y and the prism's axis, a row each
    label: str  # what reports call it

    @property
    def smooth(self) -> bool:
        return not isinstance(self.contour, Polygon)

    def nearest(self, x: Floats, apart: float) -> Spot:
        across_it, up, along = self.frame @ (x - self.origin)
        t = self._foot_of_perpendicular(across_it, up)
        point = self.contour.at(np.array([t]))
        alpha, xi, eta, turning, stretch = (float(value[0]) for value in point)
        sine, cosine = np.sin(alpha), np.cos(alpha)
        low, high = self.contour.t_range
        on_side = t in (low, high) and up > eta
        if on_side:  # the upright side above the end
            sine, cosine, eta, turning, stretch = np.sign(sine), 0.0, up, 0.0, 1.0
        normal = sine * self.frame[0] - cosine * self.frame[1]
        tangent = cosine * self.frame[0] + sine * self.frame[1]
        distance = (across_it - xi) * sine - (up - eta) * cosine
        moved = stretch + apart * turning
        rate = turning / moved if moved > 0 else 1 / apart
        place = self.origin + np.array([xi, eta, along]) @ self.frame
        return Spot(place, normal, float(distance), rate * np.outer(tangent, tangent))

    def _foot_of_perpendicular(self, x: float, y: float) -> float:
        """Parameter of the contour's point from which (x, y) lies along the normal."""
        places = np.linspace(*self.contour.t_range, _PLACES)
        there = self.contour.at(places)
        ahead, _ = _ahead(there, x, y)
        left, right = there.xi[[0, -1]]
        if ahead[0] <= 0 and x <= left:
            return float(places[0])
        if ahead[-1] >= 0 and x >= right:
            return float(places[-1])
        falls = np.flatnonzero((ahead[:-1] > 0) & (ahead[1:] <= 0))
        if not len(falls):  # inside
            return float(places[-1 if 2 * x >= left + right else 0])
        # On the other side of a thin body there is one, too: the nearest one's tangent is farthest.
        off = (x - there.xi) * np.sin(there.alpha) - (y - there.eta) * np.cos(there.alpha)
        end = int(falls[np.argmax(np.maximum(off[falls], off[falls + 1]))]) + 1
        low, high = float(places[end - 1]), float(places[end])
        t = low + (high - low) * float(ahead[end - 1] / (ahead[end - 1] - ahead[end]))
        rounding = _ROUNDING * float(places[-1] - places[0])
        while high - low > rounding:  # Newton's method, and bisection where it leaves the bounds
            value, falling = (
                float(found[0]) for found in _ahead(self.contour.at(np.array([t])), x, y)
            )
            low, high = (t, high) if value > 0 else (low, t)
            step = value / falling if falling > 0 else np.inf
            if abs(step) <= rounding:
                return t + step
            t = t + step if low < t + step < high else (low + high) / 2
        return t

    def scaled(self, factor: float) -> "Prism":
        return replace(self, contour=self.contour.scaled(factor), origin=factor * self.origin)

    def patches(self, centre: Floats, reach: float) -> Floats:
        low, high = self.contour.t_range
        line = self.contour.outline(low, high, 65)
        local = self.frame @ (centre - self.origin)
        line = line[(np.abs(line - local[:2]) <= 2 * reach).all(axis=1)]
        depth = local[2] + np.linspace(-reach, reach, 9)
        grid = np.empty((len(line), len(depth), 3))
        grid[..., :2] = line[:, None]
        grid[..., 2] = depth
        return grid_patches(self.origin + grid @ self.frame)


def _ahead(point: ContourPoint, x: float, y: float) -> tuple[Floats, Floats]:
    """How far (x, y) is ahead of the normals of points, and how fast that falls along them."""
    cosine, sine = np.cos(point.alpha), np.sin(point.alpha)
    x_off, y_off = x - point.xi, y - point.eta
    falling = point.stretch + point.turning * (x_off * sine - y_off * cosine)
    return x_off * cosine + y_off * sine, falling


def cylinder(radius: float, through: Vector, axis: Vector) -> Cylinder:
    """An endless round cylinder.

    Parameters
    ----------
    radius : float
        Positive [length].
    through : array_like, shape (3,)
        A point of its axis [length].
    axis : array_like, shape (3,)
        Along it, of any length.

    Returns
    -------
    Body
        The body.

    Raises
    ------
    InputError
        If a number cannot be.
    """
    size = positive("body.radius", radius)
    place = vector("body.through", through)
    along = direction("body.axis", axis)
    return Cylinder(size, place, along, f"cylinder of radius {size:g}")


def prism(
    contour: Contour, axis: Vector = (0.0, 0.0, 1.0), origin: Vector = (0.0, 0.0, 0.0)
) -> Prism:
    """The endless prism of a planar contour, tilted as its axis is.

    Parameters
    ----------
    contour : Contour
        The lower side of its section, any of the planar problem [length].
    axis : array_like, shape (3,)
        The prism's axis. The contour is turned with it by the shortest way from z.
    origin : array_like, shape (3,)
        Where the contour's origin is put [length].

    Returns
    -------
    Body
        The body; with the default axis the planar problem's is its section at z = 0.

    Raises
    ------
    InputError
        If a number cannot be.
    """
    require("body.contour", contour, Contour, "as catenary(0.5, -0.8)")
    along = direction("body.axis", axis)
    if along[2] < 0:  # the prism is endless: its axis has no sense
        along = -along
    from scipy.spatial.transform import Rotation  # slow to load, and few cases need it

    half = along + np.eye(3)[2]  # two right angles about half-way take z to the axis,
    to = Rotation.from_quat([*half, 0.0]) * Rotation.from_quat([0.0, 0.0, 1.0, 0.0])
    place = vector("body.origin", origin)
    return Prism(contour, place, to.as_matrix().T, f"prism, {contour.label}")
