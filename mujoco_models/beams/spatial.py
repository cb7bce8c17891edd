"""Chain and rod that may leave the plane of the sweep, and are swept in space; the cable may, too.

Their section is round, so they bend alike in all directions. How much they resist twisting does
not matter: a frictionless contact applies no moment about the vibrissa's axis, so the vibrissa at
rest is not twisted, whatever its torsional stiffness. But something has to hold the twist, or the
links would spin freely about their own axes.
"""

import math

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.links import Balls, HingedLinks, link_name
from mujoco_models.beams.protocol import Furnish, Law, bare
from mujoco_models.beams.rod import Rod

_SLIGHT = 1e-3  # rad, below which a series is taken


def _bent(angle: Floats) -> tuple[Floats, float]:
    """Of theta^2/2."""
    return angle, 1.0


def _straddled(angle: Floats) -> tuple[Floats, Floats]:
    """Of 2 tan^2(theta/2)."""
    half = np.tan(angle / 2)
    stretch = 1 + half**2
    return 2 * half * stretch, stretch * (1 + 3 * half**2)


class SpatialChain(Balls, Chain):
    """The chain with balls for hinges.

    MuJoCo's springs of balls resist all turns alike, k = EI/h, so the torsional stiffness is
    GJ = EI; of a round section it is EI/(1 + nu), three quarters of that.
    """

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
        """The links, with a ball and its spring for every hinge."""
        spec = super().spec(radius, furnish)
        for joint in spec.joints:
            joint.type = mujoco.mjtJoint.mjJNT_BALL
        return spec

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


class UniversalLinks(HingedLinks):
    """Links on two hinges each, about z and about the x axis that the first one turns."""

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
        """The links, with a second hinge as stiff as the first."""
        spec = super().spec(radius, furnish)
        for i, joint in enumerate(tuple(spec.joints)):
            second = spec.body(link_name(i)).add_joint(
                type=mujoco.mjtJoint.mjJNT_HINGE, axis=[1, 0, 0], armature=joint.armature
            )
            second.stiffness[0] = joint.stiffness[0]
        return spec

    def place(self, data: mujoco.MjData, angles: Floats) -> None:
        """Every first hinge turns, no second one does."""
        data.qpos[:] = 0
        data.qpos[0::2] = angles

    def angles(self, data: mujoco.MjData) -> Floats:
        return np.array(data.qpos[0::2])

    def moments(self, force: Floats) -> Floats:
        return force[0::2]

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


class UniversalChain(UniversalLinks, Chain):
    """Balls' springs at two hinges each, which resist a turn about both a little more."""

    @property
    def law(self) -> Law | None:
        """None: they resist a turn about both axes a little more than one about either."""
        return None

    def blocks(self, configuration: Floats) -> Floats:
        """Of k (a^2 + b^2)/2."""
        return np.asarray(np.eye(2) / self.layout.compliances[:, None, None])


class SpatialRod(UniversalLinks, Rod):
    """The rod with a universal joint for every hinge.

    A one-dimensional flex knows its vertices only and cannot resist twisting. Universal joints do
    not let it twist at all, and put no link's axis out of reach.
    """

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
