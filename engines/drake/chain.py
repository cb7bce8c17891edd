"""The chain in Drake: rigid links on revolute joints with springs, and spheres that touch.

Everything physical comes from Drake: where links and spheres are, how far from the obstacle, the
springs' and the contacts' generalised forces, the reaction of the clamp's weld. What is asked of it
is what the rest solver asks of MuJoCo, `mujoco_models.model.balance.Balance`, so both come to rest
in the same way, and what is left between their readings is the difference of two implementations.
"""

from collections.abc import Sequence

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

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.errors import InputError
from engines.drake.touch import Beads, CompliantContact, DistanceContact, material
from mujoco_models.beams.layout import OF_CURVATURE
from mujoco_models.beams.protocol import Beam
from mujoco_models.errors import DivergedError
from mujoco_models.model import clamp
from mujoco_models.model.contacts import Contacts
from mujoco_models.model.lookout import Lookout
from mujoco_models.model.surface import CONTACT_GAP
from mujoco_models.obstacles.file_mesh import FileMesh
from mujoco_models.obstacles.primitive import Primitive
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import Obstacle

_HALF_LENGTH = 50.0  # radii of the cylinder; its caps must be farther away than its centre
_SPHERES = 4000  # Drake needs minutes to take in the 8,000 of 160 links; then by their distances
_UNIT = SpatialInertia(1.0, np.zeros(3), UnitInertia(1, 1, 1))  # at rest masses do not matter


class DrakeChain:
    """Drake's plant and its context; see `mujoco_models.model.balance.Balance`."""

    def __init__(
        self, beam: Beam, radius: float, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        _check(beam, obstacle)
        self.layout, self.obstacle, self._beam, self._radius = beam.layout, obstacle, beam, radius
        self.contact_stiffness, self.evaluations = contact_stiffness, 0
        self.radii = radius * self.layout.vibrissa.thickness(self.layout.beads)
        builder = DiagramBuilder()
        self._plant, self._geometry = AddMultibodyPlantSceneGraph(builder, 0.0)
        self._assemble()
        self._diagram = builder.Build()
        self._root = self._diagram.CreateDefaultContext()
        self._context = self._plant.GetMyMutableContextFromRoot(self._root)
        self._springs = MultibodyForces(self._plant)
        self._angles = np.zeros(self._plant.num_positions())
        self._foot_x = 0.0
        self._read_places()
        self._contacts = self._at_beads([])
        self.lookout = Lookout(self, obstacle, radius, self.layout)

    def _assemble(self) -> None:
        """Foot, links, springs, the obstacle and what touches it."""
        plant, layout = self._plant, self.layout
        plant.set_contact_model(ContactModel.kPoint)
        plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
        self._foot, stub, self._weld = _moved(plant, "foot")
        joints, links, before = [], [], stub
        stiffness = self._beam.stiffness(np.zeros(len(layout.joints)))
        for i, k in enumerate(stiffness.tolist()):
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
        self._beads = Beads(links, layout.links, np.array(places), self.radii)
        # On a body of its own: Drake leaves a geometry of the world where it first was.
        self._seat, thing, _ = _moved(plant, "object")
        matter = material(self.contact_stiffness)
        self._object = plant.RegisterCollisionGeometry(
            thing, RigidTransform(), self._shape(0)[0], "object", matter
        )
        self._contact: CompliantContact | DistanceContact
        if isinstance(self.obstacle, Primitive) and len(places) <= _SPHERES:
            scene, spheres = self._geometry, self._beads
            self._contact = CompliantContact(plant, scene, spheres, self._object, thing, matter)
        else:
            self._contact = DistanceContact(plant, self._beads, self.contact_stiffness)
        plant.Finalize()
        self._order = np.array([joint.position_start() for joint in joints])

    def _shape(self, window: int) -> tuple[Shape, RigidTransform]:
        """What Drake has for a window of the obstacle, and where."""
        obstacle = self.obstacle
        if isinstance(obstacle, Primitive):
            centre, radius = obstacle.circle(window)
            cylinder = Cylinder(radius, 2 * _HALF_LENGTH * radius)
            return cylinder, RigidTransform(np.append(centre, 0.0))
        if not isinstance(obstacle, Prism | FileMesh):
            raise TypeError(f"no shape of Drake's for {type(obstacle).__name__}")
        return Convex(obstacle.hull(window).T, "object"), RigidTransform()

    def show(self, window: int) -> None:
        """Let the obstacle be what it has for a window."""
        shape, pose = self._shape(window)
        context = self._geometry.GetMyMutableContextFromRoot(self._root)
        source = self._plant.get_source_id()
        self._geometry.ChangeShape(context, source, self._object, shape)
        self._seat.SetPoseInParentFrame(self._context, pose)

    def collide(self, beads: frozenset[int]) -> None:
        """By the way it touches."""
        self._contact.collide(self._root, beads)

    def imbalance(self, foot_x: float, angles: Floats) -> Floats:
        """Drake's springs and contacts."""
        plant, context = self._plant, self._context
        if not np.isfinite(angles).all():
            raise DivergedError("the joint angles are not finite")
        self._foot_x, self.evaluations = foot_x, self.evaluations + 1
        self._foot.SetPoseInParentFrame(context, RigidTransform(np.array([foot_x, 0.0, 0.0])))
        self._angles[self._order] = angles
        plant.SetPositions(context, self._angles)
        self._read_places()
        self._contacts = self._find_contacts()
        plant.CalcForceElementsContribution(context, self._springs)
        self._elastic = np.array(self._springs.generalized_forces())[self._order]
        moments = self._elastic + self._contact.moments(context, self._contacts)[self._order]
        if not np.isfinite(moments).all():
            raise DivergedError("Drake's moments at the joints are not finite")
        self._moments: Floats = np.asarray(moments)
        return self._moments

    def relieved(self) -> Floats:
        """As they are: nothing accelerates."""
        return self._moments

    def _read_places(self) -> None:
        """Where Drake has joints and beads."""
        poses = self._plant.get_body_poses_output_port().Eval(self._context)
        own = [poses[int(link.index())] for link in self._beads.links]
        self._joints = np.array([pose.translation()[:2] for pose in own])
        axes = np.array([pose.rotation().matrix()[:2, :2] for pose in own])
        links = self.layout.links
        turned = np.einsum("nij,nj->ni", axes[links], self._beads.places)
        self._places: Floats = self._joints[links] + turned

    def _find_contacts(self) -> Contacts:
        """The watched beads within the gap, by Drake's distances."""
        near = self.obstacle.near(self._places, self._radius + CONTACT_GAP).tolist()
        beads = [i for i in near if i in self.lookout.watched]
        query = self._plant.get_geometry_query_input_port().Eval(self._context)
        return self._at_beads(beads, [self._contact.gap(query, i, self._places[i]) for i in beads])

    def _at_beads(self, beads: list[int], gaps: Sequence[tuple[Floats, float]] = ()) -> Contacts:
        """Contacts of beads by normal and distance, none of a link's side."""
        number, no = np.array(beads, dtype=int), np.zeros(len(beads), dtype=bool)
        outward = np.array([x[:2] for x, _ in gaps]).reshape(-1, 2)
        return Contacts(
            touch=number,
            link=self.layout.links[number],
            on_side=no,
            point=self.bead_positions(number),
            arc_length=self.layout.beads[number],
            normal=outward / np.hypot(*outward.T)[:, None],
            distance=np.array([distance for _, distance in gaps]),
            fused=no,
            passed=False,
        )

    def contacts(self) -> Contacts:
        """Of the last evaluated configuration."""
        return self._contacts

    def contact_places(self) -> Floats:
        """Between the two surfaces, as MuJoCo's."""
        found = self._contacts
        depth = self.radii[found.touch] + found.distance / 2
        return np.asarray(found.point - depth[:, None] * found.normal)

    def contact_curvature(self, slope: Floats) -> Floats:
        """That of the contour, farther out by the radius."""
        curvature = self.obstacle.curvature(slope)
        return np.asarray(curvature / (1 + self._radius * curvature))

    def stiffness(self, angles: Floats) -> Floats:
        """That of the springs."""
        return self._beam.stiffness(angles)

    def elastic_moments(self) -> Floats:
        """Of the springs."""
        return np.asarray(self._elastic)

    def joint_positions(self) -> Floats:
        """By the poses of the links."""
        return np.asarray(self._joints)

    def bead_positions(self, beads: Integers) -> Floats:
        """By the poses of the links."""
        return np.asarray(self._places[beads])

    def slide_beads(self, contacts: Contacts) -> bool:
        """Never; where they had to, there is no such chain."""
        return False

    def hold_beads(self) -> bool:
        """They never slide."""
        return False

    def slides(self, contacts: Contacts) -> Booleans:
        """None does."""
        return np.zeros(len(contacts.link), dtype=bool)

    def clamp(self) -> clamp.Clamp:
        """The weld's reaction on the beam, whose frame is the world's at the foot."""
        reactions = self._plant.get_reaction_forces_output_port().Eval(self._context)
        held = reactions[int(self._weld.index())]
        fx, fy, _ = held.translational()
        return clamp.Clamp(float(fx), float(fy), float(held.rotational()[2]))

    def discrepancy(self) -> float:
        """By how much the weld's reaction differs from the contacts and from the first spring."""
        wrench = self._contact.wrench(self._context, self._contacts, self._foot_x)
        required = clamp.Clamp(*(-wrench).tolist())
        first = float(self._elastic[0])
        return clamp.discrepancy(self.clamp(), required, self.layout.base[0], first)

    def extension(self) -> float:
        """By Drake's kinematics, whose joints cannot part."""
        ends = np.vstack([self._joints, self._places[-1]])
        bent = np.hypot(*np.diff(ends, axis=0).T).sum()
        layout = self.layout
        arched = (layout.lengths - layout.chords).sum()
        return float(bent + layout.joints[0] - 1 + arched)


def _moved(plant: MultibodyPlant, name: str) -> tuple[FixedOffsetFrame, RigidBody, WeldJoint]:
    """A frame that can be put anywhere, and a body that is welded to it."""
    frame = plant.AddFrame(FixedOffsetFrame(name, plant.world_frame(), RigidTransform()))
    body = plant.AddRigidBody(f"{name} body", _UNIT)
    weld = WeldJoint(f"{name} weld", frame, body.body_frame(), RigidTransform())
    return frame, body, plant.AddJoint(weld)


def _check(beam: Beam, obstacle: Obstacle) -> None:
    """Raise InputError for what only MuJoCo's links or sliding beads can touch."""
    if len(obstacle.corners):
        raise InputError(
            "object for drake",
            "with sharp corners",
            "smooth, or a mesh whose facets turn by less than 2e-3 rad",
            "leave drake out, or round the object",
        )
    layout = beam.layout
    spacing = float((layout.lengths / np.bincount(layout.links)).max())
    least = spacing / (2 * OF_CURVATURE)
    if obstacle.largest_curvature * least > 1:
        raise InputError(
            "smallest radius of curvature of the object for drake",
            f"{1 / obstacle.largest_curvature:.2g} L",
            f"at least {least:.2g} L: spheres {spacing:.1g} L apart are too far apart for less",
            "leave drake out, or enlarge the object",
        )
