"""What the obstacles have in common, and what the relaxation asks of them."""

from abc import ABC, abstractmethod

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.obstacles.corners import Corners

GEOM = "obstacle0"  # hardly a name in a user's own model; other objects have other numbers
TOP = 0.75 * np.pi  # rad; the lower side ends at pi/2, but a bead may touch a little above that


class Obstacle(ABC):
    """The object in MuJoCo, convex, swept past from below; dimensionless, L = 1.

    It is one geom, `GEOM` if there is one object. What MuJoCo sees of it is best near one place of
    the contour, its window, which follows the contact.
    """

    faceted: bool
    """Whether the normal turns in jumps, so that a curvature does not say where it turns."""
    windows: int
    """How many windows there are."""
    upright: bool = False
    """Whether `clearance` is the very distance that MuJoCo's contacts should have."""

    @property
    @abstractmethod
    def label(self) -> str:
        """What it is and how true to the contour, for provenance."""

    @property
    @abstractmethod
    def largest_curvature(self) -> float:
        """Of the contour [1/L]."""

    @property
    def corners(self) -> Corners:
        """The sharp edges that the sides of links touch; none if it is smooth to beads."""
        return Corners.none()

    @property
    @abstractmethod
    def lowest(self) -> tuple[float, float]:
        """A lowest point of the contour [L]."""

    @abstractmethod
    def add_to(self, spec: mujoco.MjSpec, name: str = GEOM) -> None:
        """Add the geom to the world body."""

    @abstractmethod
    def show(self, model: mujoco.MjModel, geom: int, window: int) -> None:
        """Let what is best for `window`, and nothing else, take part in collisions."""

    @abstractmethod
    def curvature(self, slope: Floats) -> Floats:
        """Curvature of the contour where it has these slope angles."""

    def across(self, slope: Floats) -> Floats:
        """How much slower a contact's normal turns where the edge that it passes leans."""
        return np.ones(len(slope))

    @abstractmethod
    def support(self, slope: float) -> Floats:
        """The point of the contour that a line at this slope angle touches."""

    @abstractmethod
    def faces(self, slope: Floats) -> bool:
        """Whether contacts with these slope angles are with the contour, not with its far side."""

    @abstractmethod
    def near(self, points: Floats, distance: float | Floats) -> Integers:
        """Which of the points may be nearer to the contour than a distance."""

    @abstractmethod
    def clearance(self, point: Floats) -> tuple[float, float]:
        """Distance of a point from the contour."""

    def gap(self, window: int, points: Floats) -> tuple[Floats, Floats] | None:
        """How far points are from the contour as MuJoCo has it, to rounding."""
        return None

    def from_tangents(self, points: Floats, slope: Floats) -> Floats:
        """How far points are below tangents of the contour; asked of upright obstacles only."""
        raise TypeError(f"{type(self).__name__} is not upright")

    def is_cut(self, polyline: Floats) -> bool:
        """Whether a piece of a polyline is inside; asked of obstacles with corners only."""
        raise TypeError(f"{type(self).__name__} has no corners")

    @abstractmethod
    def place(self, slope: Floats) -> Floats:
        """Where along the contour these slope angles are, in whatever measure windows have."""

    @abstractmethod
    def window_of(self, place: float) -> int:
        """The window that is best for a place."""

    @abstractmethod
    def is_inside(self, window: int, places: Floats) -> bool:
        """Whether a window has all of the contour around some places."""


def add_collider(
    spec: mujoco.MjSpec, kind: mujoco.mjtGeom, name: str = GEOM, **given: object
) -> mujoco.MjsGeom:
    """Add a geom to the world body that a vibrissa may touch, without friction."""
    own = {"contype": 1, "conaffinity": 0, "condim": 1} | given
    return spec.worldbody.add_geom(name=name, type=kind, **own)
