"""The chain in Drake: rigid links on revolute joints with springs, and spheres that touch.

Everything physical comes from Drake: where links and spheres are, the springs' and the contacts'
generalised forces, the reaction of the clamp's weld. What is asked of it is what the rest solver
asks of MuJoCo, `mujoco_models.model.balance.Balance`, so both come to rest in the same way, and
what is left between their readings is the difference of two implementations.
"""

import numpy as np
from pydrake.geometry import (
    AddContactMaterial,
    CollisionFilterDeclaration,
    Convex,
    Cylinder,
    GeometryId,
    GeometrySet,
    ProximityProperties,
    Shape,
    Sphere,
)
from pydrake.math import RigidTransform, RollPitchYaw
from pydrake.multibody.plant import (
    AddMultibodyPlantSceneGraph,
    ContactModel,
    CoulombFriction,
    MultibodyPlant,
)
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    Frame,
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
_UNIT = SpatialInertia(1.0, np.zeros(3), UnitInertia(1, 1, 1))  # at rest masses do not matter


class DrakeChain:
    """Drake's plant and its context; see `mujoco_models.model.balance.Balance`.

    Parameters
    ----------
    beam : Beam
        A chain: where its joints and beads are, and how stiff its springs.
    radius : float
        Of the vibrissa, at the clamp [L].
    obstacle : Obstacle
        What it is swept past, without sharp corners.
    contact_stiffness : float
        Force over penetration at every bead [EI/L^3].

    Raises
    ------
    InputError
        If the obstacle is one that only MuJoCo's links or sliding beads can touch.
    """

    def __init__(
        self, beam: Beam, radius: float, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        _check(beam, obstacle)
        self.layout, self.obstacle, self._beam, self._radius = beam.layout, obstacle, beam, radius
        self.contact_stiffness, self.evaluations = contact_stiffness, 0
        # Two equal springs in a row: Drake's law for a pair of bodies, see the manual's
        # "compliant point contact model". Twice the stiffness on each side is that of the pair.
        self._material = ProximityProperties()
        AddContactMaterial(
            dissipation=0.0,
            point_stiffness=2 * contact_stiffness,
            friction=CoulombFriction(0.0, 0.0),
            properties=self._material,
        )
        builder = DiagramBuilder()
        self._plant, self._geometry = AddMultibodyPlantSceneGraph(builder, 0.0)
        self._assemble()
        self._diagram = builder.Build()
        self._root = self._diagram.CreateDefaultContext()
        self._context = self._plant.GetMyMutableContextFromRoot(self._root)
        self._forces = MultibodyForces(self._plant)
        self._angles = np.zeros(self._plant.num_positions())
        self._foot_x = 0.0
        self._read_places()
        self.lookout = Lookout(_Scene(self), obstacle, radius)

    def _assemble(self) -> None:
        """Foot, links, springs, spheres and the obstacle."""
        plant, layout = self._plant, self.layout
        plant.set_contact_model(ContactModel.kPoint)
        plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
        self._foot = plant.AddFrame(
            FixedOffsetFrame("foot", plant.world_frame(), RigidTransform())
        )
        before: RigidBody = plant.AddRigidBody("stub", _UNIT)
        self._weld = plant.AddJoint(
            WeldJoint("clamp", self._foot, before.body_frame(), RigidTransform())
        )
        self._links, joints = [], []
        stiffness = self._beam.stiffness(np.zeros(len(layout.joints)))
        for i, k in enumerate(stiffness.tolist()):
            offset, turn = layout.step(i)
            body = plant.AddRigidBody(f"link{i}", _UNIT)
            joints.append(_hinge(plant, i, before, body, np.append(offset, 0.0), float(turn)))
            plant.AddForceElement(RevoluteSpring(joints[-1], 0.0, k))
            self._links.append(body)
            before = body
        self.radii = self._radius * layout.vibrissa.thickness(layout.beads)
        self._in_link = np.array(
            [layout.within(i, s) for i, s in zip(layout.links.tolist(), layout.beads, strict=True)]
        )
        self._beads = [
            plant.RegisterCollisionGeometry(
                self._links[link],
                RigidTransform(np.append(place, 0.0)),
                Sphere(size),
                f"bead{number}",
                self._material,
            )
            for number, (link, place, size) in enumerate(
                zip(layout.links.tolist(), self._in_link, self.radii.tolist(), strict=True)
            )
        ]
        shape, pose = self._shape(0)
        self._object = plant.RegisterCollisionGeometry(
            plant.world_body(), pose, shape, "object", self._material
        )
        self._geometry.collision_filter_manager().Apply(
            CollisionFilterDeclaration().ExcludeWithin(GeometrySet(self._beads))
        )
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
        """Let the obstacle be what it has for a window.

        Parameters
        ----------
        window : int
            See `Obstacle.window_of`.
        """
        shape, pose = self._shape(window)
        context = self._geometry.GetMyMutableContextFromRoot(self._root)
        source = self._plant.get_source_id()
        self._geometry.ChangeShape(context, source, self._object, shape, pose)

    def collide(self, beads: frozenset[int]) -> None:
        """Let these beads, and no others, collide with the obstacle.

        Parameters
        ----------
        beads : frozenset of int
            Their numbers.
        """
        context = self._geometry.GetMyMutableContextFromRoot(self._root)
        filters, ob = self._geometry.collision_filter_manager(context), GeometrySet([self._object])
        every = GeometrySet(self._beads)
        filters.Apply(CollisionFilterDeclaration().ExcludeBetween(ob, every))
        watched: list[GeometryId] = [self._beads[i] for i in sorted(beads)]
        if watched:
            filters.Apply(CollisionFilterDeclaration().AllowBetween(ob, GeometrySet(watched)))

    def imbalance(self, foot_x: float, angles: Floats) -> Floats:
        """Drake's springs and contacts."""
        plant, context = self._plant, self._context
        if not np.isfinite(angles).all():
            raise DivergedError("the joint angles are not finite")
        self._foot_x = foot_x
        self._foot.SetPoseInParentFrame(context, RigidTransform(np.array([foot_x, 0.0, 0.0])))
        self._angles[self._order] = angles
        plant.SetPositions(context, self._angles)
        self.evaluations += 1
        plant.CalcForceElementsContribution(context, self._forces)
        self._elastic = np.array(self._forces.generalized_forces())[self._order]
        contact = plant.get_generalized_contact_forces_output_port(self._weld.model_instance())
        moments = self._elastic + np.asarray(contact.Eval(context))[self._order]
        if not np.isfinite(moments).all():
            raise DivergedError("Drake's moments at the joints are not finite")
        self._read_places()
        return np.asarray(moments)

    def _read_places(self) -> None:
        """Where Drake has joints and beads."""
        poses = self._plant.get_body_poses_output_port().Eval(self._context)
        own = [poses[int(body.index())] for body in self._links]
        self._joints = np.array([pose.translation()[:2] for pose in own])
        axes = np.array([pose.rotation().matrix()[:2, :2] for pose in own])
        links = self.layout.links
        turned = np.einsum("nij,nj->ni", axes[links], self._in_link)
        self._places = self._joints[links] + turned
        self._contacts: Contacts | None = None

    def contacts(self) -> Contacts:
        """The watched beads that Drake has within the gap of the obstacle."""
        if self._contacts is None:
            near = self.obstacle.near(self._places, self._radius + CONTACT_GAP)
            close = np.array([i for i in near.tolist() if i in self.lookout.watched], dtype=int)
            query = self._plant.get_geometry_query_input_port().Eval(self._context)
            pairs = [
                query.ComputeSignedDistancePairClosestPoints(self._beads[i], self._object)
                for i in close.tolist()
            ]
            normal = np.array([pair.nhat_BA_W[:2] for pair in pairs]).reshape(-1, 2)
            normal /= np.hypot(*normal.T)[:, None]
            distance = np.array([pair.distance for pair in pairs])
            no = np.zeros(len(close), dtype=bool)
            self._contacts = Contacts(
                close,
                self.layout.links[close],
                no,
                self._places[close],
                self.layout.beads[close],
                normal,
                distance,
                no,
                passed=False,
            )
        return self._contacts

    def contact_places(self) -> Floats:
        """Between the two surfaces, as MuJoCo's."""
        found = self.contacts()
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
        return self._elastic

    def joint_positions(self) -> Floats:
        """By the poses of the links."""
        return self._joints

    def bead_positions(self, beads: Integers) -> Floats:
        """By the poses of the links."""
        return np.asarray(self._places[beads])

    def positions(self) -> Floats:
        """Where all beads are.

        Returns
        -------
        array, shape (n_beads, 2)
            Positions of their centres [L].
        """
        return np.asarray(self._places)

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
        """The weld's reaction on the beam, of which the foot is the origin."""
        reactions = self._plant.get_reaction_forces_output_port().Eval(self._context)
        held = reactions[int(self._weld.index())]
        fx, fy, _ = held.translational()
        return clamp.Clamp(float(fx), float(fy), float(held.rotational()[2]))

    def discrepancy(self) -> float:
        """By how much the weld's reaction differs from Drake's contacts and its first spring."""
        required = clamp.Clamp(*(-self._contact_wrench()).tolist())
        first = float(self._elastic[0])
        return clamp.discrepancy(self.clamp(), required, self.layout.base[0], first)

    def _contact_wrench(self) -> Floats:
        """Forces and moment about the foot of all contacts on the beam, shape (3,)."""
        found = self._plant.get_contact_results_output_port().Eval(self._context)
        world, wrench = self._plant.world_body().index(), np.zeros(3)
        for i in range(found.num_point_pair_contacts()):
            pair = found.point_pair_contact_info(i)
            force = pair.contact_force() * (-1.0 if pair.bodyB_index() == world else 1.0)
            arm = pair.contact_point() - [self._foot_x, 0.0, 0.0]
            wrench += [force[0], force[1], arm[0] * force[1] - arm[1] * force[0]]
        return wrench

    def extension(self) -> float:
        """Joints of Drake's kinematics cannot part."""
        ends = np.vstack([self._joints, self._places[-1]])
        bent = np.hypot(*np.diff(ends, axis=0).T).sum()
        layout = self.layout
        arched = (layout.lengths - layout.chords).sum()
        return float(bent + layout.joints[0] - 1 + arched)


class _Scene:
    """What the lookout asks; see `mujoco_models.model.lookout.Scene`."""

    def __init__(self, chain: DrakeChain) -> None:
        self._chain, self.radii = chain, chain.radii
        self.positions, self.show, self.collide = chain.positions, chain.show, chain.collide


def _hinge(
    plant: MultibodyPlant, number: int, before: RigidBody, body: RigidBody, at: Floats, turn: float
) -> RevoluteJoint:
    """A joint about z between two links."""
    pose = RigidTransform(RollPitchYaw(0.0, 0.0, turn), at)
    frame: Frame = plant.AddFrame(FixedOffsetFrame(f"end{number}", before.body_frame(), pose))
    return plant.AddJoint(RevoluteJoint(f"hinge{number}", frame, body.body_frame(), [0, 0, 1]))


def _check(beam: Beam, obstacle: Obstacle) -> None:
    """Raise InputError for what only MuJoCo's links or sliding beads can touch."""
    if len(obstacle.corners):
        raise InputError(
            "object for drake",
            "with sharp corners",
            "smooth, or a mesh whose facets turn by less than 2e-3 rad",
            "take it out of --engine, or round the object",
        )
    layout = beam.layout
    spacing = float((layout.lengths / np.bincount(layout.links)).max())
    least = spacing / (2 * OF_CURVATURE)
    if obstacle.largest_curvature * least > 1:
        raise InputError(
            "smallest radius of curvature of the object for drake",
            f"{1 / obstacle.largest_curvature:.2g} L",
            f"at least {least:.2g} L: spheres {spacing:.1g} L apart are too far apart for less",
            "take it out of --engine, or enlarge the object",
        )
