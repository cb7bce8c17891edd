"""What URDF can hold of a chain: links with masses, hinges with dampers, and what touches."""

from xml.etree.ElementTree import Comment, Element, SubElement, indent, tostring

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from mujoco_models.beams.protocol import FOOT
from mujoco_models.export.whisker import PREFIX, Whisker
from mujoco_models.settings import Settings

LACKING = (
    "URDF has no springs, sensors, contact parameters or time step: each joint's stiffness stands "
    "beside it as a comment, for whatever reads it to set"
)
_LEAST = 1.1e-14  # what MuJoCo takes for a moment of inertia in URDF
_ALONG = f"{np.pi / 2:.9g} 0 0"  # a cylinder's axis is z, a link's y


def require_chain(settings: Settings) -> None:
    if not settings.elsewhere:
        allowed = "a chain in the plane on linear springs in URDF"
        raise InputError("--beam", settings.beam, allowed, "or write MJCF")


def as_urdf(whisker: Whisker) -> str:
    """The chain without its carriage."""
    model = whisker.spec().compile()
    root = Element("robot", name="whisker")
    root.append(Comment(f" {LACKING} "))
    foot = model.body(PREFIX + FOOT).id
    for number in range(foot, foot + 1 + len(whisker.beam.layout.joints)):
        _add_link(root, model, number)
        if number > foot:
            _add_joint(root, model, number)
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def _add_link(root: Element, model: mujoco.MjModel, number: int) -> None:
    link = SubElement(root, "link", name=model.body(number).name)
    inertial = SubElement(link, "inertial")
    SubElement(inertial, "origin", xyz=_text(model.body_ipos[number]))
    SubElement(inertial, "mass", value=_text(model.body_mass[[number]]))
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[number])
    axes = turn.reshape(3, 3)
    inertia = (axes * np.maximum(model.body_inertia[number], _LEAST)) @ axes.T
    names = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "ixz": (0, 2),
             "iyz": (1, 2)}  # fmt: skip
    SubElement(inertial, "inertia", {k: _text(inertia[[i], j]) for k, (i, j) in names.items()})
    geom = int(model.body_geomadr[number])
    radius, half, _ = model.geom_size[geom]
    middle = model.geom_pos[geom]
    side = SubElement(link, "collision")
    SubElement(side, "origin", xyz=_text(middle), rpy=_ALONG)
    shape = SubElement(side, "geometry")
    SubElement(shape, "cylinder", radius=f"{radius:.9g}", length=f"{2 * half:.9g}")
    end = SubElement(link, "collision")
    SubElement(end, "origin", xyz=_text(middle + np.array([0, half, 0])))
    SubElement(SubElement(end, "geometry"), "sphere", radius=f"{radius:.9g}")


def _add_joint(root: Element, model: mujoco.MjModel, number: int) -> None:
    """That of a link with the one before it."""
    bend = int(model.body_jntadr[number])
    w, _, _, z = model.body_quat[number]
    joint = SubElement(root, "joint", name=model.joint(bend).name, type="continuous")
    joint.append(Comment(f" stiffness {model.jnt_stiffness[bend]:.9g} "))
    SubElement(joint, "parent", link=model.body(model.body_parentid[number]).name)
    SubElement(joint, "child", link=model.body(number).name)
    turn = f"0 0 {2 * np.arctan2(z, w):.9g}"
    SubElement(joint, "origin", xyz=_text(model.body_pos[number]), rpy=turn)
    SubElement(joint, "axis", xyz="0 0 1")
    damping = float(model.dof_damping[model.jnt_dofadr[bend]])
    SubElement(joint, "dynamics", damping=f"{damping:.9g}")


def _text(numbers: Floats) -> str:
    return " ".join(f"{x:.9g}" for x in numbers)
