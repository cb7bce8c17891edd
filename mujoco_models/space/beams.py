"""The beams of a sweep in space, and how stiff their joints are in MuJoCo's own coordinates.

The section is round, so the beams bend alike in all directions. How much they resist twisting does
not matter: the force of a frictionless contact passes through the axis of the vibrissa, so it has
no moment about that axis, and the vibrissa at rest is not twisted, whatever its torsional
stiffness. Balls have springs that resist all turns alike, GJ = EI, where a round section has
EI/(1 + nu); universal joints do not twist at all.
"""

from typing import Protocol

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.beams.available import require
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.links import link_name
from mujoco_models.beams.spatial import SpatialChain, SpatialRod
from mujoco_models.settings import Settings
from mujoco_models.space.settings import SpatialSettings

_SLIGHT = 1e-3  # rad, below which a series is taken


class SpaceBeam(Protocol):
    """A straight beam of rigid links on a foot, and the second derivative of its energy."""

    layout: Layout
    """Where its joints are."""

    def spec(self, radius: float) -> mujoco.MjSpec:
        """The foot and the beam on it, with all collisions off.

        Parameters
        ----------
        radius : float
            Of the vibrissa [L].

        Returns
        -------
        mujoco.MjSpec
            Not yet compiled.
        """

    def blocks(self, configuration: Floats) -> Floats:
        """Second derivative of each joint's energy.

        Parameters
        ----------
        configuration : array, shape (nq,)
            MuJoCo's coordinates.

        Returns
        -------
        array, shape (n_joints, d, d)
            By the d velocities of a joint, symmetric [EI/L].
        """


class BallChain(SpatialChain):
    """Balls with springs of k = EI/h."""

    def blocks(self, configuration: Floats) -> Floats:
        """Of k theta^2/2, theta the ball's rotation vector."""
        quaternion = configuration.reshape(-1, 4)
        sine = np.linalg.norm(quaternion[:, 1:], axis=1)
        angle = 2 * np.arctan2(sine, quaternion[:, 0])
        axis = quaternion[:, 1:] / np.maximum(sine, 1e-300)[:, None]
        # The inverse of the right Jacobian of SO(3), its symmetric part.
        with np.errstate(divide="ignore", invalid="ignore"):
            half = angle / 2
            share = np.where(angle > _SLIGHT, 1 - half / np.tan(half), angle**2 / 12)
        flat = np.eye(3) - axis[:, :, None] * axis[:, None, :]
        return np.asarray(
            (np.eye(3) - share[:, None, None] * flat) / self.layout.compliances[:, None, None]
        )


class UniversalChain(Chain):
    """Two hinges at every joint, about z and about the x axis that the first one turns."""

    def spec(self, radius: float) -> mujoco.MjSpec:
        """The links with a second hinge and spring each."""
        spec = super().spec(radius)
        for i, joint in enumerate(tuple(spec.joints)):
            second = spec.body(link_name(i)).add_joint(
                type=mujoco.mjtJoint.mjJNT_HINGE, axis=[1, 0, 0], armature=joint.armature
            )
            second.stiffness[0] = joint.stiffness[0]
        return spec

    def blocks(self, configuration: Floats) -> Floats:
        """Of k (a^2 + b^2)/2."""
        return np.asarray(np.eye(2) / self.layout.compliances[:, None, None])


class UniversalRod(SpatialRod):
    """The one-dimensional flex, on universal joints."""

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
    """The beam that the settings ask for.

    Parameters
    ----------
    settings : SpatialSettings
        Which beam, of how many segments.

    Returns
    -------
    SpaceBeam
        Straight and uniform.

    Raises
    ------
    InputError
        If the installed MuJoCo lacks it.
    """
    require(settings.beam)
    planar = Settings(beam=settings.beam, segments=settings.segments, clamp=settings.clamp)
    if settings.beam == "rod":
        return UniversalRod(planar, np.inf)
    kind = BallChain if settings.joints == "ball" else UniversalChain
    return kind(planar, np.inf)
