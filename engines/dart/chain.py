"""The chain in DART: capsules on revolute joints, and hard contacts by its own LCP.

The foot stands and the object moves, which is the same at rest. Springs are torques that are set in
every step: DART's own are implicit, and its contacts push on inertia alone, so that what rests
would depend on damping and step. The inertia is ours to choose, as nothing of it shows at rest.
Links that are hard to turn and light to move make the springs' fastest swing only 4N/pi times as
fast as the slowest. A polygon is what of it is near: a hull of small balls.
"""

from typing import Any

import dartpy
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.errors import InputError
from engines.agreement import State, Surface, hinges
from mujoco_models.obstacles.kinds import place
from mujoco_models.obstacles.primitive import Primitive
from mujoco_models.obstacles.prism import Prism
from mujoco_models.settings import Settings

# DART recovers from a depth by 1 % a step, and by 1e-3 of its lengths in one of its times at most.
# A step of a thousand of these leaves the 1 %.
_LENGTH, _STEP = 1000.0, 1000.0  # L; a step
_LIGHT = 0.1  # mass of a link by its rotary inertia [1/L^2]
_FASTEST = 0.5  # of a step's own limit of stability, for the fastest swing
# The same past corners, which are small: a link that Bullet does not see for a step must not go
# through one.
_FASTEST_PAST_CORNERS = 0.15
# L; of a polygon what is nearer to the contact than this. Bullet's search is for squares of
# distances to 1e-6 of the sizes, and loses contacts of an object as large as the vibrissa.
_CUT = 0.1
_LONGEST = 0.05  # L, of a capsule, for the same reason


class DartChain:
    """DART's world; see `engines.stepping.Stepper`."""

    def __init__(self, case: Case, settings: Settings) -> None:
        self.layout = hinges(case, settings.segments)
        self._surface, obstacle = Surface(case), place(case, settings)
        if not isinstance(obstacle, Primitive | Prism):
            raise InputError("object for dart", case.profile.label, "a contour", "take its section")
        self._obstacle: Primitive | Prism = obstacle
        smooth = isinstance(obstacle, Primitive)
        self._fastest = _FASTEST if smooth else _FASTEST_PAST_CORNERS
        self.period = round(4 * settings.segments / self._fastest)
        self._share = case.beam.unloaded.tip_radius / 2
        self._radii = case.radius * self.layout.thickness - self._share
        self._stiffness = _LENGTH / self.layout.compliances
        self._kept_speed = 1 - 4 * np.pi / self.period
        self._window, self._centre = -1, np.full(2, np.inf)
        self._make_world()
        self._slide.setPosition(0, -_LENGTH * float(case.foot_x[0]) / case.beam.length)
        self._look_ahead()

    def _make_world(self) -> None:
        """The vibrissa, the object, and no sleep, gravity or friction."""
        self._world = dartpy.simulation.World("vibrissa")
        self._world.setGravity(np.zeros(3))
        self._world.setTimeStep(_STEP)
        sleep = self._world.getDeactivationOptions()
        sleep.mEnabled = False
        self._world.setDeactivationOptions(sleep)
        bullet = dartpy.collision.BulletCollisionDetector()
        self._world.getConstraintSolver().setCollisionDetector(bullet)
        self._add_vibrissa()
        self._add_object()

    def _add_vibrissa(self) -> None:
        layout, dynamics = self.layout, dartpy.dynamics
        inertia = (_STEP / self._fastest) ** 2 * float(np.median(self._stiffness))
        mass = _LIGHT * inertia / _LENGTH**2
        self._chain = dynamics.Skeleton("vibrissa")
        _, self._foot = self._chain.createWeldJointAndBodyNodePair()
        self._foot.setInertia(dynamics.Inertia(mass, np.zeros(3), inertia * np.eye(3)))
        self._links, before = [], self._foot
        for i, (chord, radius) in enumerate(
            zip(layout.chords.tolist(), self._radii.tolist(), strict=True)
        ):
            joint = dynamics.RevoluteJointProperties()
            joint.mName, joint.mAxis = f"hinge {i}", np.array([0.0, 0.0, 1.0])
            offset, turn = layout.step(i)
            joint.mT_ParentBodyToJoint = _pose(offset * _LENGTH, float(turn))
            _, link = self._chain.createRevoluteJointAndBodyNodePair(before, joint)
            middle = np.array([0.0, chord * _LENGTH / 2, 0.0])
            link.setInertia(dynamics.Inertia(mass, middle, inertia * np.eye(3)))
            pieces = int(np.ceil(chord / _LONGEST))
            for piece in range(pieces):
                size = chord * _LENGTH / pieces
                capsule = dynamics.CapsuleShape(radius * _LENGTH, size)
                _touchable(link, capsule).setRelativeTransform(_upright((piece + 0.5) * size))
            self._links.append(link)
            before = link
        self._world.addSkeleton(self._chain)

    def _add_object(self) -> None:
        dynamics = dartpy.dynamics
        moved = dynamics.Skeleton("object")
        joint = dynamics.PrismaticJointProperties()
        joint.mName, joint.mAxis = "way", np.array([1.0, 0.0, 0.0])
        self._slide, body = moved.createPrismaticJointAndBodyNodePair(None, joint)
        self._shape = _touchable(body, dynamics.SphereShape(1.0))
        moved.setMobile(False)
        self._world.addSkeleton(moved)

    def _show(self, near: Floats, normal: Floats) -> None:
        """Let the object be what it is near a place of its surface.

        A half of the vibrissa's radius is the object's, so that a polygon is a hull of balls.
        """
        slope = np.array([np.arctan2(normal[0], -normal[1])])
        window = self._obstacle.window_of(float(self._obstacle.place(slope)[0]))
        if isinstance(self._obstacle, Primitive):
            if window != self._window:
                centre, radius = self._obstacle.circle(window)
                self._shape.getShape().setRadius((radius + self._share) * _LENGTH)
                self._shape.setRelativeTransform(_pose(centre * _LENGTH))
        elif window != self._window or np.hypot(*(near - self._centre)) > _CUT / 4:
            self._centre = near
            points = self._obstacle.hull(window)[:, :2]
            polygon = points[: len(points) // 2]
            touched = _nearest(polygon[:-1], near)  # its last corner is none of the object's
            inside = polygon.mean(axis=0) - touched
            kept = _cut(polygon, touched, _CUT)
            inner = touched + _CUT * inside / np.hypot(*inside)
            corners = np.vstack([kept, inner]) * _LENGTH
            balls = [(self._share * _LENGTH, [x, y, 0.0]) for x, y in corners.tolist()]
            self._shape.setShape(dartpy.dynamics.MultiSphereConvexHullShape(balls))
        self._window = window

    def _look_ahead(self) -> None:
        """By what of the object is nearest to a joint or the tip."""
        foot = np.array([-self._slide.getPosition(0) / _LENGTH, 0.0])
        places = self._places() + foot
        out, normals = self._surface.outward(places)
        nearest = int(out.argmin())
        self._show(places[nearest] - out[nearest] * normals[nearest], normals[nearest])

    def step(self, foot_x: float) -> None:
        """One of DART's, with the springs' torques, and velocities that fade."""
        chain, slide = self._chain, self._slide
        before, now = slide.getPosition(0), -foot_x * _LENGTH
        slide.setPosition(0, now)
        slide.setVelocity(0, (now - before) / _STEP)
        chain.setVelocities(self._kept_speed * chain.getVelocities())
        chain.setForces(-self._stiffness * chain.getPositions())
        self._world.step()
        contacts = self._contacts()
        push = np.sum([c.force[:2] for c in contacts] or [[0.0, 0.0]], axis=0)
        size = float(np.hypot(*push))
        if size > 0:
            near = np.mean([c.point[:2] for c in contacts], axis=0) / _LENGTH
            self._show(near + np.array([foot_x, 0.0]), push / size)
        else:
            self._look_ahead()

    def _contacts(self) -> list[Any]:
        return list(self._world.getLastCollisionResult().getContacts())

    def _places(self) -> Floats:
        poses = [link.getWorldTransform() for link in self._links]
        tip = poses[-1].multiply([0.0, _LENGTH * float(self.layout.chords[-1]), 0.0])
        ends = [*(pose.translation() for pose in poses), np.ravel(tip)]
        return np.array(ends)[:, :2] / _LENGTH

    def look(self) -> State:
        """By its kinematics, its contacts, and what its weld does to the foot."""
        contacts = self._contacts()
        forces = np.array([c.force[:2] for c in contacts]).reshape(-1, 2)
        points = np.array([c.point[:2] for c in contacts]).reshape(-1, 2) / _LENGTH
        size = np.hypot(*forces.T)
        outward = forces / np.maximum(size, 1e-300)[:, None]
        moment, fx, fy = self._foot.getBodyForce()[2:5]
        return State(
            self._places(),
            np.array([fx, fy, moment / _LENGTH]),
            points - self._share * outward,
            forces,
        )

    def keep(self) -> tuple[Floats, Floats, float]:
        chain = self._chain
        return chain.getPositions(), chain.getVelocities(), float(self._slide.getPosition(0))

    def go_back(self, kept: tuple[Floats, Floats, float]) -> None:
        angles, speeds, place_ = kept
        self._chain.setPositions(angles)
        self._chain.setVelocities(speeds)
        self._slide.setPosition(0, place_)
        self._look_ahead()


def _nearest(line: Floats, place: Floats) -> Floats:
    """The place of a line of edges that is nearest to another one."""
    begins, ways = line[:-1], np.diff(line, axis=0)
    along = ((place - begins) * ways).sum(axis=1) / (ways**2).sum(axis=1)
    places = begins + np.clip(along, 0, 1)[:, None] * ways
    return np.asarray(places[np.linalg.norm(places - place, axis=1).argmin()])


def _cut(polygon: Floats, near: Floats, distance: float) -> Floats:
    """The ends of what of its edges is within a square about a place, shape (n, 2)."""
    begins, ways = polygon[:-1], np.diff(polygon, axis=0)
    length = np.hypot(*ways.T)
    along = ((near - begins) * ways).sum(axis=1) / length**2
    reach = np.stack([along - distance / length, along + distance / length])
    low, high = np.clip(reach, 0, 1)
    beside = (
        np.abs(ways[:, 0] * (near - begins)[:, 1] - ways[:, 1] * (near - begins)[:, 0]) / length
    )
    kept = (low < high) & (beside < distance)
    ends = [begins[kept] + t[kept, None] * ways[kept] for t in (low, high)]
    return np.unique(np.vstack(ends), axis=0)


def _pose(offset: Floats, turn: float = 0.0) -> Any:  # noqa: ANN401  # DART has no types
    pose, cos, sin = dartpy.math.Isometry3(), np.cos(turn), np.sin(turn)
    pose.set_translation([*offset, 0.0])
    pose.set_rotation(np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]))
    return pose


def _upright(height: float) -> Any:  # noqa: ANN401
    """Where a capsule is whose own axis is z."""
    pose = _pose(np.array([0.0, height]))
    pose.set_rotation(np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]))
    return pose


def _touchable(body: Any, shape: Any) -> Any:  # noqa: ANN401
    """A shape that collides, and does not rub."""
    node = body.createShapeNode(shape)
    node.createCollisionAspect()
    node.createDynamicsAspect().setFrictionCoeff(0.0)
    return node
