"""The object as MuJoCo's smooth primitive: a cylinder that osculates the contour at the contact.

Free of facets, it separates their error from all others, on any smooth contour: where the vibrissa
touches, a cylinder with the contour's circle of curvature has its point, its normal and its
curvature, and it follows the contact. MuJoCo's distance of a sphere from a cylinder is a formula,
so its normals are exact; those of an ellipsoid come out of a search and are good to 1e-7 only.
"""

from functools import cached_property
from typing import NamedTuple

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.case import Case
from analytic.problem.errors import InputError
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import GEOM, Obstacle, add_collider

# rad, between neighbouring circles. A contact is off its circle's point of osculation by no more,
# and the contour from the circle by the cube of that; where curvature jumps, by the square.
_STEP = 5e-5
_HALF_LENGTH = 50.0  # radii; the caps must be farther away than the centre
_OUTLINE = 3200  # points of the polygon that looks for overlooked beads: 1e-7 L off the contour


class _Circles(NamedTuple):
    slope: Floats
    radius: Floats
    centre: Floats


class Primitive(Obstacle):
    """One cylinder along z, wherever the contact is; a window is one of the contour's circles."""

    faceted = False

    def __init__(self, circles: _Circles, outline: Prism) -> None:
        self._circles = circles
        self._outline = outline
        self.windows = len(circles.slope)

    @classmethod
    def of(cls, case: Case) -> "Primitive":
        """The part of the case's object that the vibrissa can reach."""
        body = case.profile.scaled(1 / case.beam.length)
        begin, end = case.centreline.at(np.array(case.reach)).alpha
        slope = np.linspace(begin, end, 2 + int((end - begin) / _STEP))
        point = body.at(body.parameter(slope))
        with np.errstate(divide="ignore"):
            radius = point.stretch / point.turning
        if not (np.isfinite(radius).all() and (radius > 0).all()):
            raise InputError(
                "mujoco.obstacle",
                f"'primitive' for {case.profile.label}",
                "'mesh', or a contour without corners",
                "no circle of curvature is there",
            )
        inward = np.column_stack([-np.sin(slope), np.cos(slope)])
        centre = np.column_stack([point.xi, point.eta]) + radius[:, None] * inward
        return cls(_Circles(slope, radius, centre), Prism.of(case, _OUTLINE))

    @property
    def label(self) -> str:
        return "MuJoCo's cylinder, with the contour's circle of curvature where the contact is"

    @property
    def largest_curvature(self) -> float:
        """Of all its circles [1/L]."""
        return float(1 / self._circles.radius.min())

    @property
    def lowest(self) -> tuple[float, float]:
        return self._outline.lowest

    def add_to(self, spec: mujoco.MjSpec, name: str = GEOM) -> None:
        """One geom; not at the origin, or MuJoCo takes it that it never leaves it."""
        cylinder = mujoco.mjtGeom.mjGEOM_CYLINDER
        add_collider(spec, cylinder, name, pos=[1, 1, 0], size=[1, _HALF_LENGTH, 0])

    def show(self, model: mujoco.MjModel, geom: int, window: int) -> None:
        radius = self._circles.radius[window]
        model.geom_size[geom, :2] = radius * np.array([1, _HALF_LENGTH])
        model.geom_rbound[geom] = radius * np.hypot(1, _HALF_LENGTH)
        model.geom_pos[geom, :2] = self._circles.centre[window]

    def circle(self, window: int) -> tuple[Floats, float]:
        """A window's circle of curvature, for engines that make a cylinder of it themselves."""
        return self._circles.centre[window], float(self._circles.radius[window])

    def curvature(self, slope: Floats) -> Floats:
        nearest = np.rint(self.place(slope)).astype(int)
        return np.asarray(1 / self._circles.radius[nearest])

    def support(self, slope: float) -> Floats:
        return self._outline.support(slope)

    def faces(self, slope: Floats) -> bool:
        """Whether contacts with these slope angles are within reach."""
        return self._outline.faces(slope)

    def near(self, points: Floats, distance: float | Floats) -> Integers:
        return self._outline.near(points, distance)

    def clearance(self, point: Floats) -> tuple[float, float]:
        clearance, facet = self._outline.clearance(point)
        slope = self._outline.facet_angles[int(facet)]
        return clearance, float(self.place(np.array([slope]))[0])

    def gap(self, window: int, points: Floats) -> tuple[Floats, Floats]:
        from_centre = points - self._circles.centre[window]
        out = np.hypot(*from_centre.T)
        return out - self._circles.radius[window], from_centre / out[:, None]

    def place(self, slope: Floats) -> Floats:
        return np.asarray(np.interp(slope, self._circles.slope, self._number))

    @cached_property
    def _number(self) -> Floats:
        """Those of all circles, shape (n_circles,)."""
        return np.arange(len(self._circles.slope), dtype=float)

    def window_of(self, place: float) -> int:
        return round(min(max(place, 0), len(self._circles.slope) - 1))

    def is_inside(self, window: int, places: Floats) -> bool:
        """Whether the circle is the nearest to the mean of these places, or next to that."""
        return bool(abs(places.mean() - window) <= 1)
