"""The compiled beam and obstacle: what MuJoCo says of a configuration at rest."""

from typing import NamedTuple

import mujoco
import numpy as np

from analytic.problem.arrays import Floats, Integers
from mujoco_models.beams.protocol import FOOT, Beam
from mujoco_models.obstacle import MESH_PREFIX, Obstacle

_CONTACT_GAP = 0.01  # L; how far ahead the solver sees contacts that carry no force yet
_NEAR = 1e-6  # L; beads that are nearer to the obstacle must be watched at rest
_OVERLOOKED = 1e-6  # L; how deep an unloaded bead may be in the obstacle
_IMPEDANCE = 0.9  # MuJoCo's d; with the stiffness set below it cancels out of the law at rest


class Contacts(NamedTuple):
    """The contacts that MuJoCo reports, loaded or within the gap; arrays of n contacts."""

    bead: Integers
    normal: Floats
    """Away from the obstacle, shape (n, 2)."""
    distance: Floats
    """Negative where the contact is loaded [L]."""


class Clamp(NamedTuple):
    """The clamp's action on the vibrissa, in the world frame, at the foot."""

    force_x: float
    force_y: float
    moment_z: float


class BeamModel:
    """MuJoCo's model and state; everything physical is asked of it.

    Parameters
    ----------
    beam : Beam
        Which beam, and where its joints and beads are.
    radius : float
        Of the vibrissa [L].
    obstacle : Obstacle
        What it is swept past.
    contact_stiffness : float
        Force over penetration at every bead [EI/L^3].
    """

    def __init__(
        self, beam: Beam, radius: float, obstacle: Obstacle, contact_stiffness: float
    ) -> None:
        self.beam = beam
        self.layout = beam.layout
        self._radius = radius
        self.obstacle = obstacle
        self.contact_stiffness = contact_stiffness
        self.evaluations = 0
        self.model = _spec(beam, radius, obstacle).compile()
        self.data = mujoco.MjData(self.model)
        self._foot = self.model.body(FOOT).id
        model = self.model
        self._windows = np.array(
            [model.geom(f"{MESH_PREFIX}{i}").id for i in range(len(obstacle.centres))]
        )
        self._beads = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)
        self._bead_of = np.full(model.ngeom, -1)
        self._bead_of[self._beads] = np.arange(len(self._beads))
        self._set_contact_stiffness()
        curvature = obstacle.curvature
        self.contact_curvature = curvature / (1 + radius * curvature)
        """Of the contour that the beads' centres feel, by vertex of the obstacle [1/L]."""
        self.window = -1
        self.use_window(0)
        self._trail: tuple[float, ...] = ()
        self.watched: frozenset[int] = frozenset()
        self.watch(frozenset(range(len(self._beads))))

    def _set_contact_stiffness(self) -> None:
        """The same stiffness at every bead, whatever the time step.

        At rest MuJoCo's contact force is -k/((1 - d) A) times the distance, with solref = (-k, -b),
        impedance d and A the body's `invweight0`: solved here for k.
        """
        weight = self.model.body_invweight0[self.model.geom_bodyid[self._beads], 0]
        k = self.contact_stiffness * (1 - _IMPEDANCE) * weight
        self.model.geom_solref[self._beads] = np.column_stack([-k, -2 * np.sqrt(k)])
        self.model.geom_solimp[self._beads] = [_IMPEDANCE, _IMPEDANCE, 1e-3, 0.5, 2]

    def use_window(self, window: int) -> None:
        """Let the obstacle's mesh with this window, and no other, take part in collisions."""
        if window != self.window:
            self.model.geom_contype[self._windows] = 0
            self.model.geom_contype[self._windows[window]] = 1
            self.window = window

    def anticipate_window(self) -> None:
        """Use the window towards which the contact has been moving."""
        if len(self._trail) == 2:
            before, last = self._trail
            self.use_window(self.obstacle.window_of(2 * last - before))

    def leave_trail(self, vertex: float) -> None:
        """Remember where the contact rests, for `anticipate_window`."""
        self._trail = (*self._trail[-1:], vertex)

    def watch(self, beads: frozenset[int]) -> None:
        """Let these beads, and no others, take part in collisions."""
        if beads != self.watched:
            self.model.geom_conaffinity[self._beads] = 0
            self.model.geom_conaffinity[self._beads[sorted(beads)]] = 1
            self.watched = beads

    def imbalance(self, foot_x: float, angles: Floats) -> Floats:
        """Moment out of balance at each joint, shape (n_joints,) [EI/L], at rest.

        Elasticity and contacts only: with zero velocity nothing else acts. Contacts and clamp
        readings are then those of this configuration.
        """
        data = self.data
        self.model.body_pos[self._foot, 0] = foot_x
        self.beam.place(data, angles)
        data.qvel[:] = 0
        mujoco.mj_forward(self.model, data)
        self.evaluations += 1
        return self.beam.moments(data.qfrc_passive + data.qfrc_constraint)

    def elastic_moments(self) -> Floats:
        """The beam's own moment at each joint, shape (n_joints,) [EI/L]."""
        return self.beam.moments(self.data.qfrc_passive)

    def contacts(self) -> Contacts:
        """All reported contacts of the last evaluated configuration."""
        contact = self.data.contact
        if self.data.ncon == 0:
            return Contacts(np.zeros(0, dtype=int), np.zeros((0, 2)), np.zeros(0))
        beads = self._bead_of[contact.geom]
        outward = np.where(beads[:, 0] >= 0, -1.0, 1.0)[:, None]
        return Contacts(beads.max(axis=1), outward * contact.frame[:, :2], contact.dist.copy())

    def joint_positions(self) -> Floats:
        """Shape (n_joints, 2) [L]."""
        return np.asarray(self.data.xanchor[:, :2])

    def bead_positions(self, beads: Integers) -> Floats:
        """Shape (n, 2) [L]."""
        return np.asarray(self.data.geom_xpos[self._beads[beads], :2])

    def near_the_obstacle(self) -> frozenset[int]:
        """Beads that touch the polygon or nearly do, whether or not MuJoCo looks at them."""
        positions = self.data.geom_xpos[self._beads, :2]
        return frozenset(self.obstacle.near(positions, self._radius + _NEAR).tolist())

    def overlooked(self) -> int | None:
        """The obstacle's vertex at a watched bead inside it that MuJoCo reports no load on.

        The mesh in use is too small away from its window: this is what makes sure, at every state
        at rest, that it has not let the beam through.
        """
        contacts = self.contacts()
        unloaded = np.setdiff1d(sorted(self.watched), contacts.bead[contacts.distance < 0])
        positions = self.bead_positions(unloaded)
        inside = self._radius - _OVERLOOKED
        for suspect in self.obstacle.near(positions, inside):
            clearance, vertex = self.obstacle.clearance(positions[suspect])
            if clearance < inside:
                return vertex
        return None

    def clamp(self) -> Clamp:
        """MuJoCo's force and torque sensors at the clamp, turned into the paper's frame.

        The site sits at the foot, its axes are those of the world: what it transmits to the beam
        is what the clamp does to the vibrissa.
        """
        fx, fy, _, _, _, mz = self.data.sensordata
        return Clamp(float(fx), float(fy), float(mz))

    def clamp_by_contacts(self) -> Clamp:
        """The wrench at the foot that holds all contact forces."""
        data = self.data
        foot = data.xpos[self._foot, :2]
        held = np.zeros(3)
        wrench = np.zeros(6)
        for i in range(data.ncon):
            mujoco.mj_contactForce(self.model, data, i, wrench)
            contact = data.contact[i]
            force = wrench[:3] @ contact.frame.reshape(3, 3)
            force *= 1.0 if self._bead_of[contact.geom[1]] >= 0 else -1.0
            arm = contact.pos[:2] - foot
            held += [force[0], force[1], arm[0] * force[1] - arm[1] * force[0]]
        return Clamp(*(-held).tolist())

    def discrepancy(self) -> float:
        """By how much three accounts of the clamp differ, the worst of all [EI/L^2, EI/L].

        The sensors, the contacts, and the beam's own moment at its first joint, to which the
        sensors' wrench is carried.
        """
        clamp = self.clamp()
        by_contacts = np.abs(np.subtract(clamp, self.clamp_by_contacts())).max()
        at_joint = clamp.moment_z + self.layout.joints[0] * clamp.force_x
        return float(max(by_contacts, abs(at_joint - self.elastic_moments()[0])))


def add_options(spec: mujoco.MjSpec) -> None:
    """What every model needs for its forces to be right to rounding."""
    option = spec.option
    option.gravity = [0, 0, 0]
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE  # 4.0.0: wrong Hessian with sparse ones
    option.tolerance = 1e-14
    option.ccd_tolerance = 1e-12
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MULTICCD
    # The midphase's tree tests every bead against every window: seven times the cost of a step.
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MIDPHASE


def _spec(beam: Beam, radius: float, obstacle: Obstacle) -> mujoco.MjSpec:
    """The beam with its beads, the clamp's sensors and the obstacle.

    The beam touches the obstacle with spheres on its axis, not with capsules: the distance of a
    point to a convex body has a continuous derivative, so an equilibrium exists at every station; a
    capsule that lies along a facet has no single nearest point, its contact jumps from end to end,
    and nothing comes to rest.
    """
    spec = beam.spec(radius)
    add_options(spec)
    obstacle.add_to(spec)
    for s, link in zip(beam.layout.beads, beam.layout.links.tolist(), strict=True):
        body, place = beam.mount(spec, link, float(s))
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            pos=place,
            size=[radius, 0, 0],
            contype=0,
            conaffinity=1,
            condim=1,
            density=0,
            gap=_CONTACT_GAP,
            priority=1,
        )
    spec.body(FOOT).add_site(name="clamp")
    for kind in (mujoco.mjtSensor.mjSENS_FORCE, mujoco.mjtSensor.mjSENS_TORQUE):
        spec.add_sensor(type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="clamp")
    return spec
