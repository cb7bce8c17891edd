"""What the obstacles have in common, and what the relaxation asks of them."""

from abc import ABC, abstractmethod

import mujoco
import numpy as np

from analytic.problem.arrays import Floats, Integers

GEOM_PREFIX = "obstacle"
TOP = 0.75 * np.pi  # rad; the lower side ends at pi/2, but a bead may touch a little above that


class Obstacle(ABC):
    """The object in MuJoCo, convex, swept past from below; dimensionless, L = 1.

    It is one geom or several that stand for one another, named `GEOM_PREFIX` and their number. What
    MuJoCo sees of it is best near one place of the contour, its window, which follows the contact.
    """

    faceted: bool
    """Whether the normal turns in jumps, so that a curvature does not tell where it turns."""
    geoms: int
    """How many geoms there are."""

    @property
    @abstractmethod
    def label(self) -> str:
        """What it is and how true to the contour, for provenance."""

    @property
    @abstractmethod
    def largest_curvature(self) -> float:
        """Of the contour [1/L]."""

    @abstractmethod
    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add the geoms to the world body."""

    @abstractmethod
    def show(self, model: mujoco.MjModel, geoms: Integers, window: int) -> None:
        """Let what is best for `window`, and nothing else, take part in collisions.

        Parameters
        ----------
        model : mujoco.MjModel
            Changed in place.
        geoms : array of int, shape (geoms,)
            Their numbers in the model.
        window : int
            Which window.
        """

    @abstractmethod
    def curvature(self, slope: Floats) -> Floats:
        """Curvature of the contour where it has these slope angles, shape (n,) [1/L]."""

    @abstractmethod
    def faces(self, slope: Floats) -> bool:
        """Whether contacts with these slope angles are with the contour, not with its far side."""

    @abstractmethod
    def near(self, points: Floats, distance: float) -> Integers:
        """Which of the points, shape (n, 2), may be nearer to the contour than `distance`."""

    @abstractmethod
    def clearance(self, point: Floats) -> tuple[float, float]:
        """Distance of a point from the contour, negative inside, and the place it is at."""

    @abstractmethod
    def place(self, slope: Floats) -> Floats:
        """Where along the contour these slope angles are, in whatever measure windows have."""

    @abstractmethod
    def window_of(self, place: float) -> int:
        """The window that is best for a place."""

    @abstractmethod
    def is_inside(self, window: int, places: Floats) -> bool:
        """Whether `window` has all of the contour around these places."""
