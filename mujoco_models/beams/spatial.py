"""Chain and rod that may leave the plane of the sweep; the cable always may.

Their section is round, so they bend alike in all directions. How much they resist twisting does
not matter: a frictionless contact applies no moment about the vibrissa's axis, so the vibrissa at
rest is not twisted, whatever its torsional stiffness. But something has to hold the twist, or the
links would spin freely about their own axes.
"""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.beams.chain import Chain
from mujoco_models.beams.links import Balls, HingedLinks, link_name
from mujoco_models.beams.protocol import Furnish, bare
from mujoco_models.beams.rod import Rod


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
        """The first hinges' angles."""
        return np.array(data.qpos[0::2])

    def moments(self, force: Floats) -> Floats:
        """The moments at the first hinges."""
        return force[0::2]


class SpatialRod(UniversalLinks, Rod):
    """The rod with a universal joint for every hinge.

    A one-dimensional flex knows its vertices only and cannot resist twisting. Universal joints do
    not let it twist at all, and put no link's axis out of reach.
    """
