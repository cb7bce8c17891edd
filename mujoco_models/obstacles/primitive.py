"""The object as MuJoCo's smooth primitive: a cylinder for a circle, an ellipsoid for an ellipse.

Free of facets, it separates their error from all others. MuJoCo's distance of a sphere from a
cylinder is a formula. That from an ellipsoid is searched for by comparing distances, which settles
them to rounding, but the place, and so the normal, only to its square root.
"""

import mujoco
import numpy as np
from scipy.optimize import brentq

from analytic.problem.arrays import Floats, Integers
from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.solid import EllipticCylinder
from mujoco_models.obstacles.protocol import GEOM_PREFIX, Obstacle

_HALF_LENGTH = 100.0  # L, along z; an ellipsoid this long is a cylinder to 5e-5 L at z = L
_TOP = 0.75 * np.pi  # rad; the lower side ends at pi/2


class Primitive(Obstacle):
    """A cylinder along z, or an ellipsoid so long that it is one.

    Parameters
    ----------
    solid : EllipticCylinder
        In units of the vibrissa's length.
    radius : float
        Of the vibrissa [L].
    """

    faceted = False

    def __init__(self, solid: EllipticCylinder, radius: float) -> None:
        self._centre = np.array(solid.centre)
        self._axes = np.array(solid.semi_axes)
        self._round = self._axes[0] == self._axes[1]
        if not self._round:
            self.normal_noise = float(np.sqrt(np.finfo(float).eps / radius))

    @classmethod
    def of(cls, case: Case) -> "Primitive":
        """The whole object of a case, within reach or not.

        Raises
        ------
        InputError
            If its contour is neither a circle nor an ellipse.
        """
        solid = case.profile.scaled(1 / case.beam.length).solid
        if not isinstance(solid, EllipticCylinder):
            raise InputError(
                "mujoco.obstacle",
                f"'primitive' for {case.profile.label}",
                "'mesh', or the contour a circle or an ellipse",
                "MuJoCo has no other smooth obstacle",
            )
        return cls(solid, case.radius)

    @property
    def label(self) -> str:
        """Which of MuJoCo's primitives."""
        return f"MuJoCo's {'cylinder' if self._round else 'ellipsoid'}"

    @property
    def largest_curvature(self) -> float:
        """At the ends of the longer axis [1/L]."""
        return float(self._axes.max() / self._axes.min() ** 2)

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """One geom."""
        kind, size = mujoco.mjtGeom.mjGEOM_ELLIPSOID, [*self._axes, _HALF_LENGTH]
        if self._round:
            kind, size = mujoco.mjtGeom.mjGEOM_CYLINDER, [self._axes[0], _HALF_LENGTH, 0]
        spec.worldbody.add_geom(
            name=f"{GEOM_PREFIX}0",
            type=kind,
            pos=[*self._centre, 0],
            size=size,
            contype=1,
            conaffinity=0,
            condim=1,
        )

    def curvature(self, slope: Floats) -> Floats:
        """That of the ellipse, exactly."""
        support = self._support(np.column_stack([np.sin(slope), -np.cos(slope)]))
        return np.asarray(support**3 / np.prod(self._axes) ** 2)

    def faces(self, slope: Floats) -> bool:
        """Whether none is at the top; where it is widest, a bead may touch a little above that."""
        return bool((np.abs(slope) < _TOP).all())

    def near(self, points: Floats, distance: float) -> Integers:
        """By one tangent each, which is not farther away than the contour."""
        offset = points - self._centre
        normal = offset / self._axes**2
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return np.flatnonzero((normal * offset).sum(axis=1) - self._support(normal) < distance)

    def clearance(self, point: Floats) -> tuple[float, float]:
        """From the nearest point of the ellipse, of which `point` is t gradients away."""
        offset = point - self._centre
        squares = self._axes**2

        def excess(t: float) -> float:
            return float((squares * (offset / (squares + t)) ** 2).sum()) - 1

        inmost = -float(squares.min())
        outmost = float(np.linalg.norm(self._axes * offset))
        t = brentq(excess, inmost * (1 - 1e-9), outmost, xtol=1e-16, rtol=1e-14)
        nearest = squares * offset / (squares + t)
        normal = nearest / squares
        slope = float(np.arctan2(normal[0], -normal[1]))
        return float(np.copysign(np.linalg.norm(offset - nearest), t)), slope

    def _support(self, normal: Floats) -> Floats:
        """Distance of the tangents with these normals, shape (n, 2), from the centre."""
        return np.asarray(np.linalg.norm(self._axes * normal, axis=1))
