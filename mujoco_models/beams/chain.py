"""The vibrissa as a chain of rigid links on hinges: all versions of MuJoCo have it.

Each hinge has the stiffness EI/h of the cell of length h that it stands for. The hinges sit at the
cells' centres, half a cell from the clamp and from the tip, which makes the chain a second-order
discretisation; the naive chain, whose first whole link is rigid in the clamp, is one of first order.
"""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.protocol import FOOT
from mujoco_models.settings import Settings

_BEADS_A_LINK = 4  # spacing h/4: the object dips between two of them by curvature (h/4)^2 / 8
_DENSITY = 1e-3  # any small number: at rest masses do not matter
_ARMATURE = 1e-4  # of a joint with unit stiffness: likewise


class Chain:
    """Rigid links on hinges; see `mujoco_models.beams.protocol.Beam`."""

    def __init__(self, settings: Settings) -> None:
        n = settings.segments
        cells = np.arange(n)
        joints = (cells + 0.5) / n if settings.clamp == "second-order" else cells[1:] / n
        self.layout = Layout.of(joints, 1 / n, _BEADS_A_LINK)

    def spec(self, radius: float) -> mujoco.MjSpec:
        """The foot, and the links one on the other."""
        spec = mujoco.MjSpec()
        body = spec.worldbody.add_body(name=FOOT, mocap=True)
        starts, lengths = self.layout.joints, self.layout.lengths
        _add_capsule(body, starts[0], radius)
        for i, offset in enumerate(np.diff(starts, prepend=0.0)):
            body = body.add_body(name=_name(i), pos=[0, offset, 0])
            joint = body.add_joint(
                type=mujoco.mjtJoint.mjJNT_HINGE,
                axis=[0, 0, 1],
                armature=_ARMATURE / self.layout.cell,
            )
            joint.stiffness[0] = 1 / self.layout.cell
            _add_capsule(body, lengths[i], radius)
        return spec

    def mount(self, spec: mujoco.MjSpec, link: int, s: float) -> tuple[mujoco.MjsBody, Floats]:
        """The link itself."""
        return spec.body(_name(link)), np.array([0, s - self.layout.joints[link], 0])

    def stiffen(self, model: mujoco.MjModel) -> None:
        """Nothing is left to be set."""

    def place(self, data: mujoco.MjData, angles: Floats, tension: Floats) -> None:
        """The joint angles are MuJoCo's own coordinates."""
        data.qpos[:] = angles

    def balance(self, data: mujoco.MjData, force: Floats) -> Floats:
        """The moments at the joints are MuJoCo's own generalised forces."""
        return np.array(force)

    def stiffness(self, angles: Floats) -> Floats:
        """EI/h."""
        return np.full(len(angles), 1 / self.layout.cell)

    def joint_positions(self, data: mujoco.MjData) -> Floats:
        """Shape (n_joints, 2) [L]."""
        return np.asarray(data.xanchor[:, :2])


def _name(link: int) -> str:
    return f"link{link}"


def _add_capsule(body: mujoco.MjsBody, length: float, radius: float) -> None:
    """What the eye sees of a link; its mass is there because MuJoCo wants one."""
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[0, 0, 0, 0, length, 0],
        size=[radius, 0, 0],
        contype=0,
        conaffinity=0,
        density=_DENSITY,
    )
