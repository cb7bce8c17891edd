"""The chain in Drake: rigid links on revolute joints with springs, and spheres that touch.

Everything physical comes from Drake: where links and spheres are, how far from the obstacle, the
springs' and the contacts' generalised forces, the reaction of the clamp's weld.
"""

import numpy as np
from pydrake.geometry import Convex, Cylinder, Shape
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, ContactModel, MultibodyPlant
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    MultibodyForces,
    RevoluteJoint,
    RevoluteSpring,
    RigidBody,
    SpatialInertia,
    UnitInertia,
    WeldJoint,
)
from pydrake.systems.framework import DiagramBuilder

from analytic.numerics.arrays import Floats, Integers
from engines.drake.touch import Beads, CompliantContact, DistanceContact, material
from mujoco_models.beams.protocol import Beam
from mujoco_models.model.clamp import Clamp
from mujoco_models.obstacles.file_mesh import FileMesh
from mujoco_models.obstacles.primitive import Primitive
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import Obstacle

_HALF_LENGTH = 50.0  # radii of the cylinder; its caps must be farther away than its centre
_SPHERES = 4000  # Drake needs minutes to take in the 8,000 of 160 links; then by their distances
_UNIT = SpatialInertia(1.0, np.zeros(3), UnitInertia(1, 1, 1))  # at rest masses do not matter


class DrakeLinkage:
    """Drake's plant and its context; see `engines.linkage.Linkage`."""

    def __init__(
        self, beam: Beam, radii: Floats, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        self._layout, self._obstacle, self._radii = beam.layout, obstacle, radii
        builder = DiagramBuilder()
        self._plant, self._geometry = AddMultibodyPlantSceneGraph(builder, 0.0)
        self._assemble(beam, contact_stiffness)
        self._diagram = builder.Build()
        self._root = self._diagram.CreateDefaultContext()
        self._context = self._plant.GetMyMutableContextFromRoot(self._root)
        self._springs = MultibodyForces(self._plant)
        self._angles = np.zeros(self._plant.num_positions())
        self._window = -1

    def _assemble(self, beam: Beam, contact_stiffness: float) -> None:
        """Foot, links, springs, the obstacle and what touches it."""
        plant, layout = self._plant, self._layout
        plant.set_contact_model(ContactModel.kPoint)
        plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
        self._foot, stub, self._weld = _moved(plant, "foot")
        joints, links, before = [], [], stub
        for i, k in enumerate(beam.stiffness(np.zeros(len(layout.joints))).tolist()):
            offset, turn = layout.step(i)
            links.append(plant.AddRigidBody(f"link{i}", _UNIT))
            pose = RigidTransform(RollPitchYaw(0.0, 0.0, float(turn)), np.append(offset, 0.0))
            end = plant.AddFrame(FixedOffsetFrame(f"end{i}", before.body_frame(), pose))
            hinge = RevoluteJoint(f"hinge{i}", end, links[i].body_frame(), [0, 0, 1])
            joints.append(plant.AddJoint(hinge))
            plant.AddForceElement(RevoluteSpring(joints[i], 0.0, k))
            before = links[i]
        places = [
            layout.within(i, s) for i, s in zip(layout.links.tolist(), layout.beads, strict=True)
        ]
        self._beads = Beads(links, layout.links, np.array(places), self._radii)
        # On a body of its own: Drake leaves a geometry of the world where it first was.
        self._seat, thing, _ = _moved(plant, "object")
        matter = material(contact_stiffness)
        self._object = plant.RegisterCollisionGeometry(
            thing, RigidTransform(), self._shape(0)[0], "object", matter
        )
        self._contact: CompliantContact | DistanceContact
        if isinstance(self._obstacle, Primitive) and len(places) <= _SPHERES:
            self._contact = CompliantContact(
                plant, self._geometry, self._beads, self._object, thing, matter
            )
        else:
            self._contact = DistanceContact(plant, self._beads)
        plant.Finalize()
        self._order = np.array([joint.position_start() for joint in joints])

    def _shape(self, window: int) -> tuple[Shape, RigidTransform]:
        """What Drake has for a window of the obstacle, and where."""
        obstacle = self._obstacle
        if isinstance(obstacle, Primitive):
            centre, radius = obstacle.circle(window)
            cylinder = Cylinder(radius, 2 * _HALF_LENGTH * radius)
            return cylinder, RigidTransform(np.append(centre, 0.0))
        if not isinstance(obstacle, Prism | FileMesh):
            raise TypeError(f"no shape of Drake's for {type(obstacle).__name__}")
        return Convex(obstacle.hull(window).T, "object"), RigidTransform()

    def attend(self, window: int, beads: frozenset[int]) -> None:
        self._contact.collide(self._root, beads)
        if window == self._window:
            return
        self._window, (shape, pose) = window, self._shape(window)
        context = self._geometry.GetMyMutableContextFromRoot(self._root)
        source = self._plant.get_source_id()
        self._geometry.ChangeShape(context, source, self._object, shape)
        self._seat.SetPoseInParentFrame(self._context, pose)

    def place(self, foot_x: float, angles: Floats) -> tuple[Floats, Floats]:
        plant, context = self._plant, self._context
        self._foot.SetPoseInParentFrame(context, RigidTransform(np.array([foot_x, 0.0, 0.0])))
        self._angles[self._order] = angles
        plant.SetPositions(context, self._angles)
        poses = plant.get_body_poses_output_port().Eval(context)
        own = [poses[int(link.index())] for link in self._beads.links]
        joints = np.array([pose.translation()[:2] for pose in own])
        axes = np.array([pose.rotation().matrix()[:2, :2] for pose in own])
        links = self._layout.links
        turned = np.einsum("nij,nj->ni", axes[links], self._beads.places)
        self._places: Floats = joints[links] + turned
        return joints, self._places

    def gap(self, bead: int) -> tuple[Floats, float]:
        query = self._plant.get_geometry_query_input_port().Eval(self._context)
        outward, distance = self._contact.gap(query, bead, self._places[bead])
        return outward[:2], distance

    def moments(self, beads: Integers, forces: Floats) -> tuple[Floats, Floats]:
        plant, context = self._plant, self._context
        plant.CalcForceElementsContribution(context, self._springs)
        springs = np.array(self._springs.generalized_forces())[self._order]
        return springs, self._contact.moments(context, beads, forces)[self._order]

    def clamp(self) -> Clamp:
        """The weld's reaction on the beam, whose frame is the world's at the foot."""
        reactions = self._plant.get_reaction_forces_output_port().Eval(self._context)
        held = reactions[int(self._weld.index())]
        fx, fy, _ = held.translational()
        return Clamp(float(fx), float(fy), float(held.rotational()[2]))


def _moved(plant: MultibodyPlant, name: str) -> tuple[FixedOffsetFrame, RigidBody, WeldJoint]:
    """A frame that can be put anywhere, and a body that is welded to it."""
    frame = plant.AddFrame(FixedOffsetFrame(name, plant.world_frame(), RigidTransform()))
    body = plant.AddRigidBody(f"{name} body", _UNIT)
    weld = WeldJoint(f"{name} weld", frame, body.body_frame(), RigidTransform())
    return frame, body, plant.AddJoint(weld)
