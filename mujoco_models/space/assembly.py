"""MuJoCo's model of a vibrissa and a body: beads that touch, and sensors at the clamp."""

import math

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.beams.links import link_name
from mujoco_models.beams.protocol import FOOT
from mujoco_models.model.spec import add_clamp_sensors, add_options, compiled

_CCD_ITERATIONS = 500  # of MuJoCo's search for the nearest point of an ellipsoid: 35 leave 1e-5


def assembled(spec: mujoco.MjSpec, links: int, tangent: Floats, radius: float) -> mujoco.MjModel:
    """Beam and body with a bead on each link."""
    stand(spec, links, tangent)
    for i in range(links):
        spec.body(link_name(i)).add_geom(
            name=f"bead{i}",
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            pos=[0, 1e-3, 0],  # at the origin MuJoCo takes it that it never leaves it
            size=[radius, 0, 0],
            contype=0,
            conaffinity=1,  # MuJoCo leaves out bodies that had none when it compiled them
            condim=1,
            density=0,
            priority=1,
        )
    return compiled(spec)


def stand(spec: mujoco.MjSpec, links: int, tangent: Floats) -> list[mujoco.MjsGeom]:
    """A foot along its tangent with sensors at the clamp; the sides of its links, named."""
    add_options(spec)
    spec.option.ccd_iterations = _CCD_ITERATIONS
    spec.body(FOOT).quat = leaning(tangent)
    add_clamp_sensors(spec)
    sides = []
    for i in range(links):
        geoms = spec.body(link_name(i)).geoms
        (side,) = (g for g in geoms if g.type == mujoco.mjtGeom.mjGEOM_CAPSULE)
        side.name = f"side{i}"
        sides.append(side)
    return sides


def leaning(tangent: Floats) -> Floats:
    """The shortest turn from y to a direction, as a quaternion."""
    x, y, z = tangent.tolist()
    size, found = math.hypot(x, z), np.zeros(4)
    axis = np.array([z, 0.0, -x]) / size if size > 0 else np.array([1.0, 0.0, 0.0])
    mujoco.mju_axisAngle2Quat(found, axis, math.atan2(size, y))
    return found
