"""The beams of a sweep in space, and how stiff their joints are in MuJoCo's own coordinates.

The section is round, so the beams bend alike in all directions. How much they resist twisting does
not matter: the force of a frictionless contact passes through the axis of the vibrissa, so it has
no moment about that axis, and the vibrissa at rest is not twisted, whatever its torsional
stiffness. Balls have springs that resist all turns alike, GJ = EI, where a round section has
EI/(1 + nu); universal joints do not twist at all.
"""

import math
from collections.abc import Callable
from typing import Protocol, TypeAlias

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.beams.available import require
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.protocol import Furnish, bare
from mujoco_models.beams.spatial import SpatialChain, SpatialRod, UniversalLinks
from mujoco_models.settings import Settings
from mujoco_models.space.settings import SpatialSettings

_SLIGHT = 1e-3  # rad, below which a series is taken

Law: TypeAlias = Callable[[Floats], tuple[Floats, Floats | float]]
"""Maps the joints' angles to the first two derivatives of their energies, over EI/h."""


class SpaceBeam(Protocol):
    """A straight beam of rigid links on a foot, and the second derivative of its energy."""

    layout: Layout  # where its joints are

    @property
    def law(self) -> Law | None:
        """Of joints that bend alike in all directions; None of others."""

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
        """The foot and the beam of a radius [L] on it, with all collisions off."""

    def blocks(self, configuration: Floats) -> Floats:
        """Second derivative of each joint's energy by its d velocities, shape (n_joints, d, d)."""

    def bent(self, frame: Floats, side: Floats, angles: Floats) -> Floats:
        """MuJoCo's coordinates where the links lie in a plane with the clamp, without twist.

        They turn by angles from the clamp's tangent, the second column of the foot's frame, to a
        side across it.
        """


def _bent(angle: Floats) -> tuple[Floats, float]:
    """Of theta^2/2."""
    return angle, 1.0


def _straddled(angle: Floats) -> tuple[Floats, Floats]:
    """Of 2 tan^2(theta/2)."""
    half = np.tan(angle / 2)
    stretch = 1 + half**2
    return 2 * half * stretch, stretch * (1 + 3 * half**2)


class BallChain(SpatialChain):
    """Balls with springs of k = EI/h."""

    @property
    def law(self) -> Law | None:
        """Of theta^2/2."""
        return _bent

    def bent(self, frame: Floats, side: Floats, angles: Floats) -> Floats:
        """Each ball turns about the same axis, across the plane."""
        x, _, z = (side @ frame).tolist()
        half = angles / 2
        half[1:] -= angles[:-1] / 2
        found = np.zeros((len(angles), 4))
        found[:, 0], sine = np.cos(half), np.sin(half)
        found[:, 1], found[:, 3] = z * sine, -x * sine
        return found.ravel()

    def blocks(self, configuration: Floats) -> Floats:
        """Of k theta^2/2, theta the ball's rotation vector."""
        quaternion = configuration.reshape(-1, 4)
        cosine, vector = quaternion[:, 0], quaternion[:, 1:]
        sine = np.sqrt(np.einsum("ij,ij->i", vector, vector))
        half, some = np.arctan2(sine, cosine), np.maximum(sine, 1e-300)
        # The inverse of the right Jacobian of SO(3), its symmetric part.
        share = np.where(half > _SLIGHT / 2, 1 - half * cosine / some, half**2 / 3)
        axis = vector / some[:, None]
        found = (share[:, None] * axis)[:, :, None] * axis[:, None, :]
        found.reshape(-1, 9)[:, ::4] += (1 - share)[:, None]
        return np.asarray(found / self.layout.compliances[:, None, None])


class Universal:
    """Two hinges at every joint, about z and about the x axis that the first one turns."""

    def bent(self, frame: Floats, side: Floats, angles: Floats) -> Floats:
        """The first hinge turns the link to the left, the second one up."""
        x, before, z = frame.T.tolist()
        tangents = np.outer(np.cos(angles), frame[:, 1]) + np.outer(np.sin(angles), side)
        found: list[float] = []
        for t in tangents.tolist():
            across = x[0] * t[0] + x[1] * t[1] + x[2] * t[2]
            along = before[0] * t[0] + before[1] * t[1] + before[2] * t[2]
            aside = z[0] * t[0] + z[1] * t[1] + z[2] * t[2]
            flat = math.hypot(across, along)
            found += [math.atan2(-across, along), math.atan2(aside, flat)]
            cos, sin = along / flat, -across / flat
            x = [cos * x[i] + sin * before[i] for i in range(3)]
            z = [
                x[1] * t[2] - x[2] * t[1],
                x[2] * t[0] - x[0] * t[2],
                x[0] * t[1] - x[1] * t[0],
            ]
            before = t
        return np.array(found)


class UniversalChain(Universal, UniversalLinks, Chain):
    """Balls' springs at two hinges each, which resist a turn about both a little more."""

    @property
    def law(self) -> Law | None:
        """None: they resist a turn about both axes a little more than one about either."""
        return None

    def blocks(self, configuration: Floats) -> Floats:
        """Of k (a^2 + b^2)/2."""
        return np.asarray(np.eye(2) / self.layout.compliances[:, None, None])


class UniversalRod(Universal, SpatialRod):
    """The one-dimensional flex, on universal joints."""

    @property
    def law(self) -> Law | None:
        """Of 2 tan^2(theta/2)."""
        return _straddled

    def blocks(self, configuration: Floats) -> Floats:
        """Of (2 EI/h) tan^2(theta/2), with cos(theta) = cos(a) cos(b)."""
        a, b = configuration.reshape(-1, 2).T
        ca, cb, sa, sb = np.cos(a), np.cos(b), np.sin(a), np.sin(b)
        c = ca * cb
        # tan^2(theta/2) = (1 - c)/(1 + c)
        first, second = -2 / (1 + c) ** 2, 4 / (1 + c) ** 3
        da, db = -sa * cb, -ca * sb
        aa = second * da * da - first * c
        bb = second * db * db - first * c
        ab = second * da * db + first * sa * sb
        found = np.stack([np.stack([aa, ab], -1), np.stack([ab, bb], -1)], -1)
        return np.asarray(2 * found / self.layout.compliances[:, None, None])


def build(settings: SpatialSettings) -> SpaceBeam:
    """The beam that the settings ask for."""
    require(settings.beam)
    planar = Settings(beam=settings.beam, segments=settings.segments, clamp=settings.clamp)
    if settings.beam == "rod":
        return UniversalRod(planar, np.inf)
    kind = BallChain if settings.joints == "ball" else UniversalChain
    return kind(planar, np.inf)
