"""A foot and rigid links on hinges, one on the other: what the chain and the rod are built on."""

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.protocol import FOOT

_MASS = 1e-5  # of a link, any small number: at rest masses do not matter
_THINNEST = 1e-4  # L; the inertia of a thinner capsule is too small for MuJoCo
_ARMATURE = 1e-4  # of a joint with unit stiffness: likewise


class HingedLinks:
    """Links that turn about z, on hinges whose angles are MuJoCo's own coordinates.

    Parameters
    ----------
    layout : Layout
        Where the joints and the beads are.
    """

    def __init__(self, layout: Layout) -> None:
        self.layout = layout

    def spec(self, radius: float) -> mujoco.MjSpec:
        """The foot and the links, on hinges without stiffness."""
        layout = self.layout
        spec = mujoco.MjSpec()
        body = spec.worldbody.add_body(name=FOOT)
        _add_capsule(body, layout.base[0], radius)
        thickness = layout.thickness
        for i, compliance in enumerate(layout.compliances):
            offset, turn = layout.step(i)
            body = body.add_body(name=link_name(i), pos=[*offset, 0], quat=about_z(turn))
            body.add_joint(
                type=mujoco.mjtJoint.mjJNT_HINGE,
                axis=[0, 0, 1],
                armature=_ARMATURE / compliance,
            )
            _add_capsule(body, np.array([0, layout.chords[i]]), radius * thickness[i])
        return spec

    def mount(self, spec: mujoco.MjSpec, link: int, s: Floats) -> tuple[mujoco.MjsBody, Floats]:
        """The link itself, whose chord is along its own y axis."""
        return spec.body(link_name(link)), np.pad(self.layout.within(link, s).T, ((0, 0), (0, 1)))

    def place(self, data: mujoco.MjData, angles: Floats) -> None:
        """The joint angles are MuJoCo's own coordinates."""
        data.qpos[:] = angles

    def angles(self, data: mujoco.MjData) -> Floats:
        """The joint angles are MuJoCo's own coordinates."""
        return np.array(data.qpos)

    def moments(self, force: Floats) -> Floats:
        """The moments at the joints are MuJoCo's own generalised forces."""
        return force


def link_name(link: int) -> str:
    """Name of a link's body.

    Parameters
    ----------
    link : int
        Its number.

    Returns
    -------
    str
        The name.
    """
    return f"link{link}"


def about_z(turn: float) -> Floats:
    """A turn about z.

    Parameters
    ----------
    turn : float
        Angle [rad].

    Returns
    -------
    array, shape (4,)
        Quaternion.
    """
    return np.array([np.cos(turn / 2), 0, 0, np.sin(turn / 2)])


def _add_capsule(body: mujoco.MjsBody, end: Floats, radius: float) -> None:
    """What the eye sees of a link, and its mass, because MuJoCo requires one."""
    if np.hypot(*end) < _THINNEST:  # of a foot on whose clamp the vibrissa turns
        end = np.array([0, _THINNEST])
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[0, 0, 0, *end, 0],
        size=[max(radius, _THINNEST), 0, 0],
        contype=0,
        conaffinity=0,
        mass=_MASS,
    )
