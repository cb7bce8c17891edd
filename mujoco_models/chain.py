"""The vibrissa as a chain of rigid links on hinges, in the plane of the sweep.

Dimensionless: L = EI = 1. At rest the chain stands along y; its hinges have the stiffness EI/h of
the cell of length h that they stand for. They sit at the cells' centres, half a cell from the
clamp and from the tip, which makes the chain a second-order discretisation; the naive chain, whose
first whole link is rigid in the clamp, is one of first order.

The links touch the obstacle with spheres on their axis, several a link, not with capsules: the
distance of a point to a convex body has a continuous derivative, so an equilibrium exists at every
station; a capsule that lies along a facet has no single nearest point, its contact jumps from end
to end, and nothing comes to rest.
"""

from dataclasses import dataclass

import mujoco
import numpy as np

from analytic.problem.arrays import Floats, Integers
from mujoco_models.obstacle import Obstacle
from mujoco_models.settings import Settings

# A bead is a fixed material point, so the readings err by the contour's curvature times the beads'
# spacing. It is bounded in radii of the vibrissa, in radii of curvature of the contour, and by the
# square of the cell's length, lest it spoil the second order.
_BEAD_SPACING = 0.65
_CURVED_SPACING = 0.01
_FINE_SPACING = 3.0
_MOST_BEADS = 4000
CLAMP_SITE = "clamp"
CONTACT_GAP = 0.01  # L; how far ahead the solver sees contacts that carry no force yet
_DENSITY = 1e-3  # any small number: at rest masses do not matter
_ARMATURE = 1e-4  # of a joint with unit stiffness: likewise


@dataclass(frozen=True)
class Layout:
    """Where along the vibrissa the joints and the contact spheres ("beads") sit.

    Attributes
    ----------
    joints : array, shape (n_joints,)
        Arc length of each hinge.
    stiffness : float
        Of each hinge, EI/h.
    beads : array, shape (n_beads,)
        Arc length of each bead, the last one at the tip; none on the clamped first link.
    links : array of int, shape (n_beads,)
        The joint that carries each bead.
    """

    joints: Floats
    stiffness: float
    beads: Floats
    links: Integers

    @classmethod
    def of(cls, settings: Settings, radius: float, obstacle: Obstacle) -> "Layout":
        """The layout for a number of segments and a kind of clamp, with beads dense enough."""
        n = settings.segments
        spacing = min(
            _BEAD_SPACING * radius,
            _CURVED_SPACING / obstacle.curvature.max(),
            _FINE_SPACING / n**2,
        )
        a_link = max(2, int(np.ceil(min(1 / (n * spacing), _MOST_BEADS / n))))
        cells = np.arange(n)
        joints = (cells + 0.5) / n if settings.clamp == "cell-centre" else cells[1:] / n
        beads = np.arange(1, a_link * n + 1) / (a_link * n)
        beads = beads[beads > joints[0]]
        links = np.searchsorted(joints, beads - 1e-12) - 1
        return cls(joints, float(n), beads, links)


def chain_spec(layout: Layout, radius: float, obstacle: Obstacle) -> mujoco.MjSpec:
    """The chain, its clamp sensors and the obstacle.

    Parameters
    ----------
    layout : Layout
        Joints and beads.
    radius : float
        Of the vibrissa [L].
    obstacle : Obstacle
        What it is swept past.
    """
    spec = mujoco.MjSpec()
    option = spec.option
    option.gravity = [0, 0, 0]
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE  # 4.0.0: wrong Hessian with sparse ones
    option.tolerance = 1e-14
    option.ccd_tolerance = 1e-12
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MULTICCD
    # The midphase's tree tests every bead against every window: seven times the cost of a step.
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MIDPHASE
    obstacle.add_to(spec)

    ends = np.append(layout.joints, 1.0)
    body = spec.worldbody.add_body(name="foot", mocap=True)
    body.add_site(name=CLAMP_SITE)
    _add_link(body, ends[0], radius)
    origin = 0.0
    for i, start in enumerate(layout.joints):
        body = body.add_body(name=f"link{i}", pos=[0, start - origin, 0])
        origin = start
        joint = body.add_joint(
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=[0, 0, 1],
            armature=_ARMATURE * layout.stiffness,
        )
        joint.stiffness[0] = layout.stiffness
        _add_link(body, ends[i + 1] - start, radius)
        for s in layout.beads[layout.links == i]:
            body.add_geom(
                type=mujoco.mjtGeom.mjGEOM_SPHERE,
                pos=[0, s - start, 0],
                size=[radius, 0, 0],
                contype=0,
                conaffinity=1,
                condim=1,
                density=0,
                gap=CONTACT_GAP,
                priority=1,
            )
    for kind in (mujoco.mjtSensor.mjSENS_FORCE, mujoco.mjtSensor.mjSENS_TORQUE):
        spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=CLAMP_SITE)
    return spec


def _add_link(body: mujoco.MjsBody, length: float, radius: float) -> None:
    """What the eye sees of a link; its mass is there because MuJoCo wants one."""
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[0, 0, 0, 0, length, 0],
        size=[radius, 0, 0],
        contype=0,
        conaffinity=0,
        density=_DENSITY,
    )
