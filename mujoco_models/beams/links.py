"""A foot and rigid links on hinges, one on the other: what the chain and the rod are built on."""

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.protocol import FOOT, Furnish, bare

_MASS = 1e-5  # of a mean link, any small number: at rest its weight alone matters
_THINNEST = 1e-4  # L; the inertia of a thinner capsule is too small for MuJoCo
_PART = 20  # links, that are put together first
_ARMATURE = 1e-4  # of a joint with unit stiffness: likewise


class HingedLinks:
    """Links that turn about z, on hinges whose angles are MuJoCo's own coordinates."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout

    def spec(self, radius: float, furnish: Furnish = bare) -> mujoco.MjSpec:
        """The foot and the links, on hinges without stiffness.

        MuJoCo goes through a whole tree for each geom that is added to it, so the links are put
        together in parts: with 8,000 beads that takes a quarter of the time.
        """
        spec = mujoco.MjSpec()
        end = spec.worldbody.add_body(name=FOOT)
        count, by_length = len(self.layout.joints), mass_by_length(self.layout)
        _add_capsule(end, self.layout.base[0], radius, by_length * self.layout.joints[0])
        for begin in range(0, count, _PART):
            part = mujoco.MjSpec()
            links = range(begin, min(begin + _PART, count))
            self._add_links(part, links, radius, furnish)
            end.add_frame().attach_body(part.body(_own_name(begin)), _prefix(begin), "")
            end = self.body(spec, links[-1])
        return spec

    def _add_links(
        self, part: mujoco.MjSpec, links: range, radius: float, furnish: Furnish
    ) -> None:
        layout, thickness, body = self.layout, self.layout.thickness, part.worldbody
        for i in links:
            offset, turn = layout.step(i)
            body = body.add_body(name=_own_name(i), pos=[*offset, 0], quat=about_z(turn))
            body.add_joint(
                type=mujoco.mjtJoint.mjJNT_HINGE,
                axis=[0, 0, 1],
                armature=_ARMATURE / layout.compliances[i],
            )
            mass = mass_by_length(layout) * layout.lengths[i]
            _add_capsule(body, np.array([0, layout.chords[i]]), radius * thickness[i], mass)
            furnish(body, i)

    def body(self, spec: mujoco.MjSpec, link: int) -> mujoco.MjsBody:
        """The link itself, whose chord is along its own y axis."""
        return spec.body(link_name(link))

    def within(self, link: int, s: Floats) -> Floats:
        across, along = self.layout.within(link, s)
        return np.column_stack([across, along, np.zeros_like(along)])

    def place(self, data: mujoco.MjData, angles: Floats) -> None:
        """The joint angles are MuJoCo's own coordinates."""
        data.qpos[:] = angles

    def angles(self, data: mujoco.MjData) -> Floats:
        """The joint angles are MuJoCo's own coordinates."""
        return np.array(data.qpos)

    def moments(self, force: Floats) -> Floats:
        """The moments at the joints are MuJoCo's own generalised forces."""
        return force


class Balls:
    """What a beam on balls knows of its planar angles: each ball then turns about z alone.

    A ball's quaternion is (cos a/2, axis sin a/2); its generalised forces are moments about the
    link's own axes, the third of which stays along z.
    """

    def place(self, data: mujoco.MjData, angles: Floats) -> None:
        """Every ball turns about z."""
        data.qpos[:] = 0
        data.qpos[0::4] = np.cos(angles / 2)
        data.qpos[3::4] = np.sin(angles / 2)

    def angles(self, data: mujoco.MjData) -> Floats:
        """Turns of the balls about z."""
        return np.asarray(2 * np.arctan2(data.qpos[3::4], data.qpos[0::4]))

    def moments(self, force: Floats) -> Floats:
        """Those of the balls about z."""
        return force[2::3]


def link_name(link: int) -> str:
    return _prefix(link) + _own_name(link)


def _prefix(link: int) -> str:
    return f"part{link // _PART}-"


def _own_name(link: int) -> str:
    return f"link{link}"


def mass_by_length(layout: Layout) -> float:
    """Of links at rest."""
    return _MASS * len(layout.joints)


def about_z(turn: float) -> Floats:
    return np.array([np.cos(turn / 2), 0, 0, np.sin(turn / 2)])


def _add_capsule(body: mujoco.MjsBody, end: Floats, radius: float, mass: float) -> None:
    """What the eye sees of a link, and its mass."""
    if np.hypot(*end) < _THINNEST:  # of a foot on whose clamp the vibrissa turns
        end = np.array([0, _THINNEST])
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[0, 0, 0, *end, 0],
        size=[max(radius, _THINNEST), 0, 0],
        contype=0,
        conaffinity=0,
        mass=mass,
    )
