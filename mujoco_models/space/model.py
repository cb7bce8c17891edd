"""The compiled beam and body: what MuJoCo says of a configuration at rest in space."""

import math
from typing import NamedTuple

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.space.problem.bodies.body import across
from analytic.space.problem.bodies.polyhedron import Polyhedron
from mujoco_models.beams.links import link_name
from mujoco_models.beams.protocol import FOOT, SpatialBeam
from mujoco_models.errors import DivergedError
from mujoco_models.model.clamp import by_contacts, by_sensors
from mujoco_models.model.stiffness import stiffen
from mujoco_models.obstacles.protocol import GEOM
from mujoco_models.space.assembly import assembled
from mujoco_models.space.bodies import OUTLINE, Circle, Shape

_FAR = 10.0  # L; beyond, MuJoCo need not say how far


class Touch(NamedTuple):
    """What MuJoCo says of the bead at some place of the vibrissa; lengths in L."""

    centre: Floats  # of the bead, shape (3,)
    normal: Floats  # the body's, outward, shape (3,)
    distance: float  # between the two surfaces; negative if they overlap


class SpaceModel:
    """MuJoCo's model and state; everything physical comes from it.

    The vibrissa touches with one bead, a sphere on its axis, which slides along the link that
    carries it to where that is nearest to the body.
    """

    def __init__(
        self,
        beam: SpatialBeam,
        spec: mujoco.MjSpec,
        shape: Shape,
        tangent: Floats,
        radius: float,
        contact_stiffness: float,
    ) -> None:
        self.beam, self.layout = beam, beam.layout
        self.shape, self.radius, self.contact_stiffness = shape, radius, contact_stiffness
        self.tangent = tangent
        self._flatter = 1.0  # how fast the body's normals turn, by those of the geom in its place
        self.ends = np.append(self.layout.joints[1:], 1.0)
        """Arc length of each link's end."""
        self.model = assembled(spec, len(self.ends), tangent, radius)
        self.data = mujoco.MjData(self.model)
        model = self.model
        self._foot, self._body = model.body(FOOT).id, model.geom(GEOM).id
        follows = shape.osculating is not None
        self._outline = model.geom(OUTLINE).id if follows else self._body
        numbers = range(len(self.ends))
        self._links = np.array([model.body(link_name(i)).id for i in numbers])
        self._beads = np.array([model.geom(f"bead{i}").id for i in numbers])
        self._moves = np.isin(np.arange(model.ngeom), self._beads)
        self._sides = np.array([model.geom(f"side{i}").id for i in numbers])
        self._ends = np.zeros(6)
        self.mesh = shape.mesh and self._as_it_is_held(shape.mesh)
        """The body, if it is a mesh."""
        self._begins: list[float] = self.layout.joints.tolist()
        self._widths: list[float] = model.geom_size[self._sides, 0].tolist()
        self.longest = float(self.layout.lengths.max())
        """Length of the longest link [L]."""
        self.joint_of = np.repeat(np.arange(len(self.ends)), model.nv // len(self.ends))
        """Number of the joint that each velocity belongs to."""
        self.shared = model.jnt_type[0] == mujoco.mjtJoint.mjJNT_BALL
        """Whether the velocities of a joint turn about axes that it carries along."""
        self._anchors = np.unique(model.jnt_bodyid, return_index=True)[1][self.joint_of]
        stiffen(model, self._beads, contact_stiffness)
        self.straight = model.qpos0.copy()

    def _as_it_is_held(self, mesh: Polyhedron) -> Polyhedron:
        """With MuJoCo's vertices, which are in single precision; MuJoCo touches these exactly."""
        model, data, geom = self.model, self.data, self._body
        mujoco.mj_kinematics(model, data)
        begin = model.mesh_vertadr[model.geom_dataid[geom]]
        held = model.mesh_vert[begin : begin + len(mesh.vertices)].astype(float)
        turn = data.geom_xmat[geom].reshape(3, 3)
        return mesh.with_vertices(data.geom_xpos[geom] + held @ turn.T)

    def place(self, foot: Floats, configuration: Floats) -> None:
        """Put the vibrissa there, and let MuJoCo evaluate links and springs."""
        model, data = self.model, self.data
        model.body_pos[self._foot] = foot
        data.qpos[:], data.qvel[:] = configuration, 0
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        if model.nflex:
            mujoco.mj_flex(model, data)
        mujoco.mj_passive(model, data)

    @property
    def springs(self) -> Floats:
        """MuJoCo's elastic moments, shape (nv,) [EI/L]."""
        return np.asarray(self.data.qfrc_passive)

    @property
    def axes(self) -> Floats:
        """What MuJoCo's velocities turn about, in the world's frame, shape (nv, 3)."""
        return np.asarray(self.data.cdof[:, :3])

    @property
    def anchors(self) -> Floats:
        """Where the joint of each velocity is, shape (nv, 3) [L]."""
        return np.asarray(self.data.xanchor[self._anchors])

    @property
    def tangents(self) -> Floats:
        """Unit vectors along the links, shape (n_links, 3)."""
        return np.array(self.data.xmat[self._links, 1::3])

    @property
    def frame(self) -> Floats:
        """The foot's axes in the world, in columns, shape (3, 3)."""
        return np.array(self.data.xmat[self._foot].reshape(3, 3))

    def direction(self, link: int) -> Floats:
        """Of a link's axis."""
        return np.asarray(self.data.xmat[self._links[link]].reshape(3, 3)[:, 1])

    def centre(self, link: int, s: float) -> Floats:
        """Of a bead."""
        start = self.data.xpos[self._links[link]]
        return np.asarray(start + (s - self._begins[link]) * self.direction(link))

    def touch(self, link: int, s: float) -> Touch:
        """MuJoCo's nearest point of the body to a bead on a link."""
        centre = self.centre(link, s)
        if self.shape.osculating is not None:
            self._put(self.shape.osculating(centre))
        return self.probe(link, centre)

    def contact(self, touch: Touch) -> Floats:
        """Where the body is touched."""
        return np.asarray(touch.centre - (self.radius + touch.distance) * touch.normal)

    def _put(self, circle: Circle) -> None:
        """Put MuJoCo's cylinder where it has the prism's circle of curvature."""
        model, body = self.model, self._body
        length = circle.radius * model.geom_size[body, 1] / model.geom_size[body, 0]
        model.geom_size[body, :2] = circle.radius, length
        model.geom_rbound[body] = np.hypot(circle.radius, length)
        model.geom_pos[body] = self.data.geom_xpos[body] = circle.centre
        nearer = circle.radius + self.radius
        self._flatter = circle.flatter * nearer / (circle.radius + circle.flatter * self.radius)

    def turning(self, link: int, touch: Touch) -> Floats:
        """How MuJoCo's normal turns as the bead's centre moves, by differences."""
        sides, step = across(touch.normal), self.shape.difference
        by_side = [
            sides @ (self._nearest(link, ahead)[0] - self._nearest(link, behind)[0])
            for ahead, behind in ((touch.centre + step * s, touch.centre - step * s) for s in sides)
        ]
        rates = self._flatter * np.array(by_side) / (4 * step)
        return np.asarray(sides.T @ (rates + rates.T) @ sides)

    def probe(self, link: int, centre: Floats) -> Touch:
        """The nearest point to a bead wherever it is."""
        return Touch(centre, *self._nearest(link, centre))

    def _nearest(self, link: int, centre: Floats) -> tuple[Floats, float]:
        bead = self._beads[link]
        self.data.geom_xpos[bead] = centre
        distance = mujoco.mj_geomDistance(self.model, self.data, bead, self._body, _FAR, self._ends)
        away = centre - self._ends[3:]
        outward = 1.0 if distance > -self.radius else -1.0  # the centre itself may be inside
        return away * (outward / math.sqrt(away @ away)), float(distance)

    def distance_of_link(self, link: int) -> tuple[float, float]:
        """How far a link is from the body, and where on it that is."""
        side = self._sides[link]
        distance = mujoco.mj_geomDistance(
            self.model, self.data, side, self._outline, _FAR, self._ends
        )
        apart = self._ends[:3] - self.data.xpos[self._links[link]]
        s = self._begins[link] + float(apart @ self.direction(link))
        s = min(max(s, self._begins[link]), float(self.ends[link]))
        return float(distance) + self._widths[link] - self.radius, s

    def nearest_link(self) -> tuple[float, int, float]:
        """The link nearest to the body.

        A link that is d away has none nearer than d less a link's length beside it, so that most
        need not be asked for.
        """
        best, found, at = np.inf, len(self.ends) - 1, 1.0
        link = len(self.ends) - 1
        while link >= 0:
            distance, s = self.distance_of_link(link)
            if distance < best:
                best, found, at = distance, link, s
            link -= max(1, int((distance - max(best, 0.0)) / self.longest))
        return best, found, at

    def deeper_link(self, touch: Touch, depth: float) -> tuple[float, int, float]:
        """The link nearest to the body, if one may be nearer than a contact.

        A convex body is on one side of the plane that touches it at the contact, so that a link is
        no nearer to the body than to that plane.
        """
        height = touch.normal @ touch.centre - touch.distance
        joints = self.data.xpos[self._links] @ touch.normal
        tip = self.centre(len(self.ends) - 1, 1.0) @ touch.normal
        if min(float(joints.min()), float(tip)) - height >= depth:
            return depth, len(self.ends) - 1, 1.0
        return self.nearest_link()

    def blocks(self) -> Floats:
        """Second derivative of each joint's energy, shape (n_joints, d, d) [EI/L]."""
        return self.beam.blocks(self.data.qpos)

    def rest(self, link: int | None, s: float) -> float:
        """Let MuJoCo evaluate all its forces on the configuration, with a bead in its place."""
        model, data = self.model, self.data
        model.geom_conaffinity[self._beads] = 0
        if link is not None:
            bead = self._beads[link]
            model.geom_conaffinity[bead] = 1
            model.geom_pos[bead, 1] = s - self.layout.joints[link]
        mujoco.mj_forward(model, data)
        found = data.qfrc_passive + data.qfrc_constraint
        if not np.isfinite(found).all():
            raise DivergedError("MuJoCo's moments at the joints are not finite")
        return float(np.abs(found).max())

    def clamp(self) -> Floats:
        """The clamp's force and moment by MuJoCo's sensors, shape (2, 3), of what `rest` has."""
        return by_sensors(self.data)

    def discrepancy(self) -> float:
        """By how much they differ from what holds the contacts' forces."""
        required = by_contacts(self.data, self.data.xpos[self._foot], self._moves)
        return float(np.abs(self.clamp() - required).max())
