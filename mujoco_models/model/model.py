"""The compiled beam and obstacle: what MuJoCo says of a configuration at rest."""

from typing import NamedTuple

import mujoco
import numpy as np

from analytic.problem.arrays import Floats, Integers
from mujoco_models.beams.protocol import FOOT, Beam
from mujoco_models.errors import DivergedError
from mujoco_models.obstacles.protocol import GEOM_PREFIX, Obstacle

_CONTACT_GAP = 0.01  # L; how far ahead the solver sees contacts that carry no force yet
_NEAR = 1e-6  # L; beads that are nearer to the obstacle must be watched at rest
_OVERLOOKED = 1e-6  # L; how deep an unloaded bead may be in the obstacle
STEP = 1e-3  # of MuJoCo's own motion
LONG_STEP = 5e-3  # of it, where nothing can be mistaken; 1e-2 would be too long for 3.17's cable
AT_REST = 1e-10  # of a coordinate, in a step: the motion has come to its end
_BAD_STATES = [getattr(mujoco.mjtWarning, f"mjWARN_BADQ{name}") for name in ("POS", "VEL", "ACC")]
_FULL = [getattr(mujoco.mjtWarning, f"mjWARN_{name}FULL") for name in ("CONTACT", "CNSTR")]
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
        self._obstacle_geoms = np.array(
            [model.geom(f"{GEOM_PREFIX}{i}").id for i in range(obstacle.geoms)]
        )
        self._beads = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_SPHERE)
        self._bead_of = np.full(model.ngeom, -1)
        self._bead_of[self._beads] = np.arange(len(self._beads))
        # One of those at each of the beam's joints: a universal joint has two of MuJoCo's.
        self._joints = np.unique(model.jnt_bodyid, return_index=True)[1]
        self._set_contact_stiffness()
        self.window = -1
        right_end = obstacle.place(np.array([np.pi / 2]))
        self.use_window(obstacle.window_of(float(right_end[0])))
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
        """Let MuJoCo see what the obstacle has for this window."""
        if window != self.window:
            self.obstacle.show(self.model, self._obstacle_geoms, window)
            self.window = window

    def anticipate_window(self) -> None:
        """Use the window towards which the contact has been moving."""
        if len(self._trail) == 2:
            before, last = self._trail
            self.use_window(self.obstacle.window_of(2 * last - before))

    def follow_contact(self) -> None:
        """Use the window that is nearest to the deepest contact, if there is a loaded one."""
        contacts = self.contacts()
        if contacts.distance.size and contacts.distance.min() < 0:
            x, y = contacts.normal[np.argmin(contacts.distance)]
            place = self.obstacle.place(np.arctan2([x], [-y]))
            if not self.obstacle.is_inside(self.window, place):
                self.use_window(self.obstacle.window_of(float(place[0])))

    def leave_trail(self, place: float) -> None:
        """Remember where the contact rests, for `anticipate_window`."""
        self._trail = (*self._trail[-1:], place)

    def contact_curvature(self, slope: Floats) -> Floats:
        """Of the contour that the beads' centres feel, at these slope angles [1/L]."""
        curvature = self.obstacle.curvature(slope)
        return np.asarray(curvature / (1 + self._radius * curvature))

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

        Raises
        ------
        DivergedError
            If a moment is not finite.
        MemoryError
            If MuJoCo has no room for all contacts: it leaves some out and only warns.
        """
        self.move_foot(foot_x)
        self.beam.place(self.data, angles)
        self.evaluate()
        self.evaluations += 1
        if any(self.data.warning[full].number for full in _FULL):
            raise MemoryError(f"MuJoCo's own memory does not hold all of {self.data.ncon} contacts")
        moments = self.beam.moments(self.moments())
        if not np.isfinite(moments).all():
            raise DivergedError("MuJoCo's moments at the joints are not finite")
        return moments

    def move_foot(self, foot_x: float) -> None:
        """Put the foot there [L]."""
        self.model.body_pos[self._foot, 0] = foot_x

    def evaluate(self) -> None:
        """Let MuJoCo evaluate the configuration that the beam is in, at rest."""
        self.data.qvel[:] = 0
        mujoco.mj_forward(self.model, self.data)

    def moments(self) -> Floats:
        """Elasticity and contacts in all of MuJoCo's coordinates, shape (nv,) [EI/L]."""
        return np.asarray(self.data.qfrc_passive + self.data.qfrc_constraint)

    def turn(self, start: Floats, turns: Floats) -> None:
        """Evaluate the configuration that these turns, shape (nv,) [rad], make of `start`."""
        configuration = start.copy()
        mujoco.mj_integratePos(self.model, configuration, turns, 1.0)
        self.data.qpos[:] = configuration
        self.evaluate()

    def elastic_moments(self) -> Floats:
        """The beam's own moment at each joint, shape (n_joints,) [EI/L]."""
        return self.beam.moments(self.data.qfrc_passive)

    def creep(self, timestep: float) -> float:
        """One step of MuJoCo's own motion without momentum; the largest change of a coordinate.

        Raises
        ------
        DivergedError
            If MuJoCo warns of a bad state, which it then sets back to the straight beam.
        """
        model, data = self.model, self.data
        model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_DISCRETE, timestep
        before = data.qpos.copy()
        data.qvel[:] = 0
        mujoco.mj_step(model, data)
        if any(data.warning[bad].number for bad in _BAD_STATES):
            raise DivergedError("MuJoCo's own motion does not stay finite")
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
        return float(np.abs(data.qpos - before).max())

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
        return np.asarray(self.data.xanchor[self._joints, :2])

    def out_of_plane(self) -> float:
        """Largest distance of a bead from the plane of the sweep [L]."""
        return float(np.abs(self.data.geom_xpos[self._beads, 2]).max())

    def contact_rise(self) -> Floats:
        """How fast the loaded contacts' mean place leaves the plane with each turn, shape (nv,)."""
        contacts = self.contacts()
        loaded = np.minimum(contacts.distance, 0)
        rise, jacobian = np.zeros(self.model.nv), np.zeros((3, self.model.nv))
        for bead, weight in zip(contacts.bead, loaded / loaded.sum(), strict=True):
            geom = self._beads[bead]
            body, place = self.model.geom_bodyid[geom], self.data.geom_xpos[geom]
            mujoco.mj_jac(self.model, self.data, jacobian, None, place, body)
            rise += weight * jacobian[2]
        return rise

    def bead_positions(self, beads: Integers) -> Floats:
        """Shape (n, 2) [L]."""
        return np.asarray(self.data.geom_xpos[self._beads[beads], :2])

    def extension(self) -> float:
        """By how much MuJoCo's beam is longer than it should be, over its length."""
        ends = [*self.data.xanchor, self.data.geom_xpos[self._beads[-1]]]
        bent = np.linalg.norm(np.diff(ends, axis=0), axis=1).sum()
        return float(bent + self.layout.joints[0] - 1)

    def near_the_obstacle(self) -> frozenset[int]:
        """Beads that touch the obstacle or nearly do, whether or not MuJoCo looks at them."""
        positions = self.data.geom_xpos[self._beads, :2]
        return frozenset(self.obstacle.near(positions, self._radius + _NEAR).tolist())

    def overlooked(self) -> float | None:
        """The place at which a watched bead is in the obstacle and MuJoCo reports no load on it.

        What collides is true to the contour near its window only: this is what makes sure, at every
        state at rest, that it has not let the beam through.
        """
        contacts = self.contacts()
        unloaded = np.setdiff1d(sorted(self.watched), contacts.bead[contacts.distance < 0])
        positions = self.bead_positions(unloaded)
        inside = self._radius - _OVERLOOKED
        for suspect in self.obstacle.near(positions, inside):
            clearance, place = self.obstacle.clearance(positions[suspect])
            if clearance < inside:
                return place
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
