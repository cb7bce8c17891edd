"""The chain in Pinocchio, which has kinematics and inverse dynamics, and coal, which has distances.

Neither has springs or contacts: their forces are ours. Levers, the moments that these make at the
joints, and the clamp's reaction are Pinocchio's, normals and depths are coal's.
"""

import coal
import numpy as np
import pinocchio as pin

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.beams.protocol import Beam
from mujoco_models.model.clamp import Clamp
from mujoco_models.obstacles.file_mesh import FileMesh
from mujoco_models.obstacles.primitive import Primitive
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import Obstacle

_HALF_LENGTH = 50.0  # radii of the cylinder; its caps must be farther away than its centre
# Of coal's searches. Its own 1e-6 of a length is as much as a depth, and turns a normal by 8e-3
# rad; with 1e-10 both were right to rounding on 300 places of a polygon of 800 edges.
_TOLERANCE = 1e-12
_UNIT = pin.Inertia(1.0, np.zeros(3), np.eye(3))  # at rest masses do not matter


class PinocchioLinkage:
    """See `engines.linkage.Linkage`."""

    def __init__(
        self, beam: Beam, radii: Floats, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        self._layout, self._obstacle, self._beam, layout = beam.layout, obstacle, beam, beam.layout
        self._model, before = pin.Model(), 0
        self._model.gravity = pin.Motion.Zero()
        # The foot slides along x: what that joint transmits is what the clamp holds.
        steps = [(pin.JointModelPX(), np.zeros(2), 0.0)]
        steps += [(pin.JointModelRZ(), *layout.step(i)) for i in range(len(layout.joints))]
        for number, (joint, offset, turn) in enumerate(steps):
            pose = pin.SE3(pin.rpy.rpyToMatrix(0.0, 0.0, float(turn)), np.append(offset, 0.0))
            before = self._model.addJoint(before, joint, pose, f"joint {number}")
            self._model.appendBodyToJoint(before, _UNIT, pin.SE3.Identity())
        self._data, self._still = self._model.createData(), np.zeros(self._model.nv)
        places = zip(layout.links.tolist(), layout.beads, strict=True)
        self._on_links = [np.append(layout.within(i, s), 0.0) for i, s in places]
        self._beads = [coal.Sphere(radius) for radius in radii.tolist()]
        self._request, self._found = coal.DistanceRequest(), coal.DistanceResult()
        self._request.enable_signed_distance = True
        self._request.gjk_tolerance = self._request.epa_tolerance = _TOLERANCE
        self._window = -1

    def attend(self, window: int, beads: frozenset[int]) -> None:
        """By the shape of the object; coal is asked for no bead that is not named."""
        if window == self._window:
            return
        obstacle, self._window, centre = self._obstacle, window, np.zeros(2)
        if isinstance(obstacle, Primitive):
            centre, radius = obstacle.circle(window)
            self._shape = coal.Cylinder(radius, 2 * _HALF_LENGTH * radius)
        elif isinstance(obstacle, Prism | FileMesh):
            vertices = coal.StdVec_Vec3s()
            vertices.extend(obstacle.hull(window).astype(float))
            self._shape = coal.Convex.convexHull(vertices, False, "")
        else:
            raise TypeError(f"no shape of coal's for {type(obstacle).__name__}")
        self._seat = coal.Transform3s(np.eye(3), np.append(centre, 0.0))

    def place(self, foot_x: float, angles: Floats) -> tuple[Floats, Floats]:
        self._angles, self._configuration = angles, np.append(foot_x, angles)
        pin.forwardKinematics(self._model, self._data, self._configuration)
        self._poses = [self._data.oMi[i] for i in range(2, self._model.njoints)]
        joints = np.array([pose.translation[:2] for pose in self._poses])
        axes = np.array([pose.rotation for pose in self._poses])
        turned = np.einsum("nij,nj->ni", axes[self._layout.links], self._on_links)
        self._places: Floats = joints[self._layout.links] + turned[:, :2]
        return joints, self._places

    def gap(self, bead: int) -> tuple[Floats, float]:
        there = coal.Transform3s(np.eye(3), np.append(self._places[bead], 0.0))
        self._found.clear()
        distance = coal.distance(
            self._beads[bead], there, self._shape, self._seat, self._request, self._found
        )
        return -np.asarray(self._found.normal)[:2], float(distance)  # from the bead to the obstacle

    def moments(self, beads: Integers, forces: Floats) -> tuple[Floats, Floats]:
        """Springs by the beam's own stiffness, contacts by Pinocchio's inverse dynamics."""
        held = [pin.Force.Zero() for _ in range(self._model.njoints)]
        for bead, force in zip(beads.tolist(), forces, strict=True):
            link = int(self._layout.links[bead])
            push = self._poses[link].rotation.T @ np.append(force, 0.0)
            held[link + 2] += pin.Force(push, np.cross(self._on_links[bead], push))
        pushes = pin.StdVec_Force()
        pushes.extend(held)
        required = pin.rnea(
            self._model, self._data, self._configuration, self._still, self._still, pushes
        )
        return -self._beam.stiffness(self._angles) * self._angles, -np.asarray(required)[1:]

    def clamp(self) -> Clamp:
        """What the foot's joint transmits, in the axes of the world."""
        held = self._data.f[1]
        fx, fy, _ = held.linear.tolist()
        return Clamp(fx, fy, float(held.angular[2]))
