"""Where the clamp is and how it leans on its way, over a parameter that falls as the sweep goes on.

Dimensionless. A sweep to the left has the foot's own x for parameter; a clamp that turns to the
left, less its angle; any other way, less what it has travelled.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from analytic.problem.arrays import Floats

if TYPE_CHECKING:
    from scipy.interpolate import PchipInterpolator


class Pose(NamedTuple):
    """Poses of the clamp, or how fast they change; arrays of one shape."""

    foot_x: Floats
    foot_y: Floats
    angle: Floats  # by which it leans to the left of the upright [rad]

    def place(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Where in the world something is that an upright clamp at the origin would have there."""
        sin, cos = np.sin(self.angle), np.cos(self.angle)
        return self.foot_x + x * cos - y * sin, self.foot_y + x * sin + y * cos

    def seen(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """The way back: a place of the world as the clamp has it."""
        sin, cos = np.sin(self.angle), np.cos(self.angle)
        x, y = x - self.foot_x, y - self.foot_y
        return x * cos + y * sin, y * cos - x * sin


class Poses(Protocol):
    def at(self, p: Floats) -> Pose:
        """Poses, shape of `p`."""

    def rate(self, p: Floats) -> Pose:
        """Their derivatives by the parameter."""


@dataclass(frozen=True)
class Straight:
    """A clamp that moves along a line, or turns about its foot."""

    origin: tuple[float, float, float]
    step: tuple[float, float, float]

    def at(self, p: Floats) -> Pose:
        return Pose(*(here + p * step for here, step in zip(self.origin, self.step, strict=True)))

    def rate(self, p: Floats) -> Pose:
        return Pose(*(np.full_like(p, step) for step in self.step))


def along_x(angle: float | Floats) -> Straight:
    """The foot along its line, in a clamp that leans by an angle."""
    return Straight((0.0, 0.0, float(angle)), (1.0, 0.0, 0.0))


@dataclass(frozen=True)
class Through:
    """A way through poses, with monotone cubics between them and straight on beyond."""

    p: tuple[float, ...]  # falling
    poses: tuple[tuple[float, float, float], ...]

    def at(self, p: Floats) -> Pose:
        inside = np.clip(p, self.p[-1], self.p[0])
        beyond = np.asarray(p - inside)[..., None]
        return Pose(*np.moveaxis(self._between(inside) + beyond * self._rate(inside), -1, 0))

    def rate(self, p: Floats) -> Pose:
        return Pose(*np.moveaxis(self._rate(np.clip(p, self.p[-1], self.p[0])), -1, 0))

    @cached_property
    def _between(self) -> "PchipInterpolator":
        from scipy.interpolate import PchipInterpolator  # slow to load

        return PchipInterpolator(self.p[::-1], self.poses[::-1])

    @cached_property
    def _rate(self) -> "PchipInterpolator":
        return self._between.derivative()


def travelled(poses: Floats) -> Floats:
    """What a clamp has travelled at each pose, shape (n, 3): turns count as those of L do [L]."""
    steps = np.linalg.norm(np.diff(poses, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])
