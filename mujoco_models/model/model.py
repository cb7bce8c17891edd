"""The compiled beam and obstacle: what MuJoCo says of a configuration at rest."""

import math
from dataclasses import replace

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.clamp_path import Pose
from mujoco_models.beams.layout import turned
from mujoco_models.beams.links import about_z
from mujoco_models.beams.protocol import FOOT, Beam
from mujoco_models.errors import DivergedError
from mujoco_models.model import clamp
from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts
from mujoco_models.model.lookout import Lookout, MujocoScene
from mujoco_models.model.search import Search
from mujoco_models.model.sides import FUSED, Sides
from mujoco_models.model.sliding import SlidingBeads
from mujoco_models.model.spec import assemble, compiled
from mujoco_models.model.stiffness import stiffen
from mujoco_models.model.surface import Surface
from mujoco_models.model.weight import hang, holding
from mujoco_models.obstacles.protocol import GEOM, Obstacle
from mujoco_models.quiet import has_diverged

STEP = 1e-3  # of MuJoCo's own motion
LONG_STEP = 5e-3  # of it, where nothing can be mistaken; 1e-2 would be too long for 3.17's cable
AT_REST = 1e-10  # of a coordinate, in a step: the motion has come to its end
_FULL = np.array([mujoco.mjtWarning.mjWARN_CONTACTFULL, mujoco.mjtWarning.mjWARN_CNSTRFULL], int)
ROUNDING = 1e-13  # L, of a contact's depth: that of its place, which all joints before it add to
_DISTINCT = 1e-2  # of the largest; beads side by side share a load in ways that hardly differ


class BeamModel(Balance):
    """MuJoCo's model and state; everything physical comes from it."""

    def __init__(
        self, beam: Beam, radius: float, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        self.beam = beam
        self.layout = replace(beam.layout, beads=beam.layout.beads.copy())  # beads may slide
        self.radius = radius
        self.obstacle = obstacle
        self.contact_stiffness = contact_stiffness
        self.pose = Pose(*np.zeros(3))
        self.evaluations = 0
        self.model = compiled(assemble(beam, radius, {GEOM: obstacle}))
        self.data = mujoco.MjData(self.model)
        model = self.model
        self._foot = model.body(FOOT).id
        self._surface = Surface.of(model, len(self.layout.joints), obstacle.corners, radius)
        self._search = Search(self._surface, obstacle, self.layout, model)
        self.beads: Integers = self._surface.beads
        # One of those at each of the beam's joints: a universal joint has two of MuJoCo's.
        self._joints = np.unique(model.jnt_bodyid, return_index=True)[1]
        # The same stiffness at every contact, whatever the time step.
        geoms = np.concatenate([self._surface.beads, self._surface.sides])
        stiffen(model, geoms, contact_stiffness)
        self._sliding = SlidingBeads(model, self.beads, self.layout, obstacle)
        sharpest = obstacle.largest_curvature
        self._slides = self._sliding.needed(sharpest / (1 + radius * sharpest))
        self._sides: Sides | None = None  # of the configuration that was evaluated last
        scene = MujocoScene(model, self.data, self.beads, obstacle)
        self.lookout = Lookout(scene, obstacle, radius, self.layout)

    def imbalance(self, pose: Pose, angles: Floats) -> Floats:
        """Moment out of balance at each joint, at rest.

        Elasticity, contacts and weight: with zero velocity nothing else acts. Contacts and clamp
        readings are then those of this configuration.
        """
        self.move_clamp(pose)
        self.beam.place(self.data, angles)
        self.evaluate()
        self.evaluations += 1
        if self.data.warning.number.take(_FULL).any():
            raise MemoryError(f"MuJoCo's own memory does not hold all of {self.data.ncon} contacts")
        moments = self.beam.moments(self.moments())
        if not math.isfinite(moments.sum()):
            raise DivergedError("MuJoCo's moments at the joints are not finite")
        return moments

    def move_clamp(self, pose: Pose) -> None:
        """Put the foot there, and turn the clamp."""
        self.pose = pose
        self.model.body_pos[self._foot, :2] = pose.foot_x, pose.foot_y
        self.model.body_quat[self._foot] = about_z(float(pose.angle))

    def evaluate(self) -> None:
        """Let MuJoCo evaluate the configuration that the beam is in, at rest.

        Of `mj_forward` this is what does not need accelerations: they are zero. Inertia, whose
        factor costs the cube of the segments, takes no part in it. A corner that is next to a joint
        is touched once, see `mujoco_models.model.sides`.
        """
        model, data = self.model, self.data
        self._sides = None
        data.qvel[:] = 0
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_flex(model, data)
        self._search(model, data, self.joint_positions())
        if len(self._surface.sides) and data.ncon:
            # Left out of the balance are contacts that only repeat another one.
            self._sides = Sides.of(data, self._surface, self.layout, self.joint_positions())
            data.contact.exclude[self._sides.fused(data, self._surface)] = FUSED
        mujoco.mj_makeConstraint(model, data)
        mujoco.mj_fwdVelocity(model, data)
        data.qacc[:] = 0
        mujoco.mj_invConstraint(model, data)
        mujoco.mj_rnePostConstraint(model, data)
        mujoco.mj_sensorAcc(model, data)

    def relieved(self, rounding: float = ROUNDING) -> Floats:
        """Moment out of balance at each joint, but for what rounding of depths makes of it.

        A force is the contact's stiffness times a depth, of which rounding is about 1e-15 L: 1e-8
        EI/L^2 at the usual stiffness. So loaded contacts give way, by no more than rounding, as
        leaves least out of balance. Forces and clamp readings are those then.
        """
        model, data = self.model, self.data
        loaded = np.flatnonzero(data.efc_force)
        if len(loaded):
            levers = data.efc_J.reshape(-1, model.nv)[loaded]
            most, force = self.contact_stiffness * rounding, data.efc_force[loaded]
            change = np.linalg.lstsq(levers.T, -self.moments(), rcond=_DISTINCT)[0]
            data.efc_force[loaded] = np.maximum(force + np.clip(change, -most, most), 0)
            mujoco.mj_mulJacTVec(model, data, data.qfrc_constraint, data.efc_force)
            mujoco.mj_rnePostConstraint(model, data)
            mujoco.mj_sensorAcc(model, data)
        return self.beam.moments(self.moments())

    def moments(self) -> Floats:
        """Elasticity, contacts and weight in all of MuJoCo's coordinates."""
        data = self.data
        return np.asarray(data.qfrc_passive + data.qfrc_constraint - data.qfrc_bias)

    def turn(self, start: Floats, turns: Floats) -> None:
        """Evaluate the configuration that small turns make of another one."""
        configuration = start.copy()
        mujoco.mj_integratePos(self.model, configuration, turns, 1.0)
        self.data.qpos[:] = configuration
        self.evaluate()

    def stiffness(self, angles: Floats) -> Floats:
        return self.beam.stiffness(angles)

    def elastic_moments(self) -> Floats:
        return self.beam.moments(self.data.qfrc_passive)

    def creep(self, timestep: float) -> float:
        """One step of MuJoCo's own motion without momentum."""
        model, data = self.model, self.data
        model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_DISCRETE, timestep
        before = data.qpos.copy()
        self._sides = None
        data.qvel[:] = 0
        mujoco.mj_step(model, data)
        if has_diverged(data):
            raise DivergedError("MuJoCo's own motion does not stay finite")
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
        return float(np.abs(data.qpos - before).max())

    def contacts(self) -> Contacts:
        """All reported contacts of the last evaluated configuration."""
        joints = self.joint_positions()
        return Contacts.of(self.data, self._surface, self.layout, joints, self._sides)

    def contact_places(self) -> Floats:
        """Where MuJoCo has each contact: between the two surfaces."""
        return np.asarray(self.data.contact.pos[:, :2])

    def slide_beads(self, contacts: Contacts) -> bool:
        """Let a bead be where the beam is tangential, if beads are too far apart."""
        if not self._slides:
            return False
        curvature = self.contact_curvature(contacts.slope)
        return self._sliding.slide(contacts, curvature, self.joint_positions())

    def hold_beads(self) -> bool:
        """Let all beads be where they were at first."""
        return self._sliding.hold()

    def slides(self, contacts: Contacts) -> Booleans:
        """Which contacts are of a link whose beads slide."""
        return self._sliding.slides(contacts)

    def contact_rise(self) -> Floats:
        """How fast the loaded contacts' mean place leaves the plane with each turn."""
        contacts = self.contacts()
        loaded = np.minimum(contacts.distance, 0)
        rise, jacobian = np.zeros(self.model.nv), np.zeros((3, self.model.nv))
        bodies = self.model.geom_bodyid[self.data.contact.geom].max(axis=1)
        for point, body, weight in zip(contacts.point, bodies, loaded / loaded.sum(), strict=True):
            place = np.append(point, 0.0)
            mujoco.mj_jac(self.model, self.data, jacobian, None, place, body)
            rise += weight * jacobian[2]
        return rise

    def joint_positions(self) -> Floats:
        return np.asarray(self.data.xanchor[self._joints, :2])

    def bead_positions(self, beads: Integers) -> Floats:
        return np.asarray(self.data.geom_xpos[self.beads[beads], :2])

    def out_of_plane(self) -> float:
        """Largest distance of a bead from the plane of the sweep."""
        return float(np.abs(self.data.geom_xpos[self.beads, 2]).max())

    def extension(self) -> float:
        """By how much MuJoCo's beam is longer than it should be, over its length."""
        ends = np.concatenate([self.data.xanchor, self.data.geom_xpos[self.beads[-1:]]])
        chords = ends[1:] - ends[:-1]
        bent = np.sqrt(np.einsum("ij,ij->i", chords, chords)).sum()
        return float(bent + self.layout.joints[0] - 1 + self.layout.arched)

    def clamp(self) -> clamp.Clamp:
        """The clamp's action on the vibrissa, by MuJoCo's sensors."""
        return clamp.Clamp.of(clamp.by_sensors(self.data))

    def discrepancy(self) -> float:
        """By how much three accounts of the clamp differ, see `clamp.discrepancy`."""
        model, data = self.model, self.data
        foot = data.xpos[self._foot]
        numbers = np.arange(model.nbody)
        base = holding(model, data, foot, numbers == self._foot)
        required = clamp.by_contacts(data, foot, self._surface.moves)
        required += holding(model, data, foot, model.body_rootid == self._foot)
        moment = float(self.elastic_moments()[0])
        joint = turned(self.layout.base[0], self.pose.angle)
        account, own = clamp.Clamp.of(required), clamp.Clamp.of(base)
        return clamp.discrepancy(self.clamp(), account, joint, moment, own)

    def hang(self) -> Floats:
        """Joint angles of the vibrissa under its weight, in the pose that the clamp has."""

        def imbalance(angles: Floats) -> Floats:
            self.beam.place(self.data, angles)
            self.evaluate()
            return self.beam.moments(self.data.qfrc_passive - self.data.qfrc_bias)

        return hang(self.model, self.beam, float(self.pose.angle), imbalance)
