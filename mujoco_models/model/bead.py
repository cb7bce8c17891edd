"""The compiled beam with one bead that slides along it: what MuJoCo says of it at rest.

A bead is a sphere on the axis of the beam. The contact of the beam's whole side is that of the bead
in the one place of its link that is nearest to the obstacle.
"""

import math
from typing import NamedTuple

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.beams.protocol import FOOT, Beam
from mujoco_models.errors import DivergedError
from mujoco_models.model import clamp
from mujoco_models.model.spec import add_options, compiled
from mujoco_models.obstacles.protocol import GEOM, Obstacle

_IMPEDANCE = 0.9  # MuJoCo's d; with the stiffness set below it cancels out of the law at rest
_THINNEST = 1e-4  # L; the least radius of a link's capsule
_FAR = 10.0  # L; beyond, MuJoCo need not say how far
_WINDOWS = 8  # that are tried, until one has the contact in its midst
ROUNDING = 1e-13  # L, of a contact's depth: that of its place, which all joints before it add to


class Place(NamedTuple):
    """A place on the axis of the beam; lengths in L."""

    s: float  # arc length
    x: float
    y: float
    heading: float  # slope angle of the axis there, from the upright to the left [rad]
    bend: float  # its curvature, the link's own [1/L]
    radius: float  # of the beam there
    widening: float  # change of the radius along the axis


class Touch(NamedTuple):
    """The obstacle's nearest point to a bead; lengths in L."""

    normal: tuple[float, float]  # the obstacle's, outward, as it is in the plane
    distance: float  # between the two surfaces; negative if they overlap

    @property
    def slope(self) -> float:
        """Slope angle of the contour with this normal [rad]."""
        return math.atan2(self.normal[0], -self.normal[1])


class BeadModel:
    """MuJoCo's model and state; everything physical comes from it."""

    def __init__(
        self, beam: Beam, radius: float, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        self.beam, self.layout, self.radius = beam, beam.layout, radius
        self.obstacle, self.contact_stiffness = obstacle, contact_stiffness
        self.ends = np.append(self.layout.joints[1:], 1.0)
        """Arc length of each link's end [L]."""
        self.evaluations = 0
        self.model = compiled(_assembled(beam, radius, obstacle))
        self.data = mujoco.MjData(self.model)
        model = self.model
        self._foot, self._body = model.body(FOOT).id, model.geom(GEOM).id
        self._joints = np.unique(model.jnt_bodyid, return_index=True)[1]
        self._beads = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)
        bodies = model.geom_bodyid[self._beads]
        capsules = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE)
        self._sides = capsules[model.geom_bodyid[capsules].searchsorted(bodies)]
        (self._stub,) = capsules[model.geom_bodyid[capsules] == self._foot]
        self._widths = model.geom_size[self._sides, 0]
        self._begins: list[float] = self.layout.joints.tolist()
        self._nearest = np.zeros(6)
        weight = model.body_invweight0[bodies, 0]
        k = contact_stiffness * (1 - _IMPEDANCE) * weight
        model.geom_solref[self._beads] = np.column_stack([-k, -2 * np.sqrt(k)])
        model.geom_solimp[self._beads] = [_IMPEDANCE, _IMPEDANCE, 1e-3, 0.5, 2]
        model.geom_conaffinity[self._beads] = 0
        self._rest = self.layout.vibrissa.rest
        self._straight = self.layout.vibrissa.is_straight
        self._widening = self._rest.tip_radius - self._rest.base_radius
        self.longest = float(self.layout.lengths.max())
        """Length of the longest link [L]."""
        self._window = -1
        self.face(math.pi / 2)  # where a sweep to the left begins

    def place(self, foot_x: float, angles: Floats) -> None:
        """Put the beam there, and let MuJoCo evaluate links and springs."""
        model, data = self.model, self.data
        model.body_pos[self._foot, 0] = foot_x
        self.beam.place(data, angles)
        data.qvel[:] = 0
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        if model.nflex:
            mujoco.mj_flex(model, data)
        mujoco.mj_passive(model, data)
        self.evaluations += 1
        self.springs: Floats = self.beam.moments(data.qfrc_passive)
        self.joints: Floats = data.xanchor[self._joints, :2]
        self._headings = self.layout.headings + angles.cumsum()

    def at(self, link: int, s: float) -> Place:
        """A place on a link of the beam that has been placed."""
        heading = float(self._headings[link])
        across, along, own, bend = 0.0, s - self._begins[link], 0.0, 0.0
        if not self._straight:
            there = np.array([s])
            ((across,), (along,)) = self.layout.within(link, there).tolist()
            own = float(self.layout.vibrissa.turn(there)[0] - self.layout.headings[link])
            bend = float(self._rest.curvature(there)[0])
        cos, sin = math.cos(heading), math.sin(heading)
        x, y = self.joints[link].tolist()
        return Place(
            s,
            x + cos * across - sin * along,
            y + sin * across + cos * along,
            heading + own,
            bend,
            self.radius + self._widening * s,
            self._widening,
        )

    def touch(self, link: int, place: Place) -> Touch:
        """MuJoCo's nearest point of the obstacle to a bead."""
        bead = self._beads[link]
        self.data.geom_xpos[bead] = place.x, place.y, 0.0
        self.model.geom_size[bead, 0] = place.radius
        for _ in range(_WINDOWS):
            touch = self._ask(bead, place)
            if self.face(touch.slope):
                continue
            break
        return touch

    def _ask(self, bead: int, place: Place) -> Touch:
        distance = mujoco.mj_geomDistance(
            self.model, self.data, bead, self._body, _FAR, self._nearest
        )
        x, y, z = self._nearest[3:].tolist()
        dx, dy = place.x - x, place.y - y
        # The centre itself may be inside.
        away = math.sqrt(dx * dx + dy * dy + z * z) * (1.0 if distance > -place.radius else -1.0)
        return Touch((dx / away, dy / away), float(distance))

    def face(self, slope: float) -> bool:
        """Let the obstacle be as it is best for a contact at this slope; whether that is new."""
        obstacle = self.obstacle
        place = obstacle.place(np.array([slope]))
        if self._window >= 0 and obstacle.is_inside(self._window, place):
            return False
        window = obstacle.window_of(float(place[0]))
        if window == self._window:
            return False
        obstacle.show(self.model, self._body, window)
        self.data.geom_xpos[self._body] = self.model.geom_pos[self._body]
        self._window = window
        return True

    def stiffness(self, angles: Floats) -> Floats:
        """That of the beam's joints."""
        return self.beam.stiffness(angles)

    def distance_of(self, link: int) -> tuple[float, float]:
        """How far a link is from the obstacle, and where on it that is."""
        side = self._sides[link]
        distance = mujoco.mj_geomDistance(
            self.model, self.data, side, self._body, _FAR, self._nearest
        )
        x, y = (self._nearest[:2] - self.joints[link]).tolist()
        heading = float(self._headings[link])
        s = self._begins[link] + math.cos(heading) * y - math.sin(heading) * x
        s = min(max(s, self._begins[link]), float(self.ends[link]))
        return distance + float(self._widths[link]) - self.radius - self._widening * s, s

    def rigid_gap(self) -> float:
        """How far the obstacle is from the part of the beam before its first joint [L]."""
        return float(
            mujoco.mj_geomDistance(
                self.model, self.data, self._stub, self._body, _FAR, self._nearest
            )
        )

    def nearest(self) -> tuple[float, int, float]:
        """The link nearest to the obstacle, how far it is, and where on it that is.

        A link that is d away has none nearer than d less a link's length beside it.
        """
        best, found, at = math.inf, 0, 0.0
        link = len(self.ends) - 1
        while link >= 0:
            distance, s = self.distance_of(link)
            if distance < best:
                best, found, at = distance, link, s
            link -= max(1, int((distance - max(best, 0.0)) / self.longest))
        return best, found, at

    def evaluate(self, link: int | None, s: float, place: Place | None) -> float:
        """Let MuJoCo evaluate all its forces on what has been placed, with a bead on a link.

        Of `mj_forward` this is what does not need accelerations: they are zero.
        """
        model, data = self.model, self.data
        bead = None
        if link is not None and place is not None:
            bead = self._beads[link]
            model.geom_conaffinity[bead] = 1
            model.geom_pos[bead] = self.beam.within(link, np.array([s]))[0]
            model.geom_size[bead, 0] = model.geom_rbound[bead] = place.radius
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        mujoco.mj_makeConstraint(model, data)
        mujoco.mj_fwdVelocity(model, data)
        data.qacc[:] = 0
        mujoco.mj_invConstraint(model, data)
        self._relieve()
        if bead is not None:
            model.geom_conaffinity[bead] = 0
        moments = self.beam.moments(data.qfrc_passive + data.qfrc_constraint)
        imbalance = float(np.abs(moments).max())
        if not math.isfinite(imbalance):
            raise DivergedError("MuJoCo's moments at the joints are not finite")
        return imbalance

    def _relieve(self) -> None:
        """Let the contact give way, by no more than rounding, as leaves least out of balance.

        A force is the contact's stiffness times a depth, of which rounding is about 1e-15 L: 1e-8
        EI/L^2 at the usual stiffness. Forces and clamp readings are those then.
        """
        model, data = self.model, self.data
        if data.nefc == 1 and data.efc_force[0] > 0:
            levers = data.efc_J
            most = self.contact_stiffness * ROUNDING
            change = -float(levers @ (data.qfrc_passive + data.qfrc_constraint) / (levers @ levers))
            data.efc_force[0] = max(data.efc_force[0] + min(max(change, -most), most), 0.0)
            mujoco.mj_mulJacTVec(model, data, data.qfrc_constraint, data.efc_force)
        mujoco.mj_rnePostConstraint(model, data)
        mujoco.mj_sensorAcc(model, data)

    def clamp(self) -> clamp.Clamp:
        """The clamp's action on the vibrissa, by MuJoCo's sensors."""
        return clamp.by_sensors(self.data)

    def contact_place(self, place: Place, touch: Touch) -> tuple[float, float, float]:
        """Where MuJoCo has the contact, between the two surfaces, and how deep it is.

        Where rounding leaves it none, that is by its distance.
        """
        contact = self.data.contact
        if self.data.ncon:
            return float(contact.pos[0, 0]), float(contact.pos[0, 1]), float(-contact.dist[0])
        (nx, ny), out = touch.normal, place.radius + touch.distance / 2
        return place.x - out * nx, place.y - out * ny, -touch.distance

    def discrepancy(self) -> float:
        """By how much three accounts of the clamp differ, see `clamp.discrepancy`."""
        foot = self.data.xpos[self._foot, :2]
        moves = np.ones(self.model.ngeom, dtype=bool)
        moves[self._body] = False
        by_contacts = clamp.by_contacts(self.data, foot, moves)
        moment = float(self.beam.moments(self.data.qfrc_passive)[0])
        return clamp.discrepancy(self.clamp(), by_contacts, self.layout.base[0], moment)

    def extension(self) -> float:
        """By how much MuJoCo's beam is longer than it should be, over its length."""
        tip = self.at(len(self.ends) - 1, 1.0)
        ends = np.vstack([self.joints, [tip.x, tip.y]])
        bent = np.hypot(*np.diff(ends, axis=0).T).sum()
        return float(bent + self.layout.joints[0] - 1 + self.layout.arched)


def _assembled(beam: Beam, radius: float, obstacle: Obstacle) -> mujoco.MjSpec:
    """Beam, beads, sensors and obstacle."""

    def furnish(body: mujoco.MjsBody, link: int) -> None:
        bead = body.add_geom()
        bead.type, bead.size[0] = mujoco.mjtGeom.mjGEOM_SPHERE, radius
        bead.pos = [1e-3, 1e-3, 0]  # at the origin MuJoCo takes it that it never leaves it
        bead.contype, bead.conaffinity, bead.condim = 0, 1, 1
        bead.density, bead.priority = 0, 1

    spec = beam.spec(radius, furnish)
    add_options(spec)
    obstacle.add_to(spec)
    spec.body(FOOT).add_site(name="clamp")
    for kind in (mujoco.mjtSensor.mjSENS_FORCE, mujoco.mjtSensor.mjSENS_TORQUE):
        spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="clamp")
    return spec
