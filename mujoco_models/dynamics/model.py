"""The beam with its mass on a foot that slides, stepped by MuJoCo."""

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.case import Case
from analytic.problem.clamp_path import Pose
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.links import about_z
from mujoco_models.beams.protocol import FOOT, Beam
from mujoco_models.dynamics.moving import CARRIAGE, MASS, SteppedModel
from mujoco_models.model.clamp import Clamp, by_sensors
from mujoco_models.model.contacts import Contacts
from mujoco_models.model.lookout import Lookout, MujocoScene
from mujoco_models.model.spec import assemble, set_weight
from mujoco_models.model.surface import Surface
from mujoco_models.model.weight import hang
from mujoco_models.motion import Motion
from mujoco_models.obstacles.corners import Corners
from mujoco_models.obstacles.protocol import Obstacle

_FIRST = 2 * np.pi  # rad/T1
# Of MuJoCo's solver; its cost goes with the square of what is out of balance. With 1e-10 a sweep of
# ten segments in `implicitfast` stayed 3.4e-4 off the one at rest, however slow it was.
_TOLERANCE = 1e-16
_DRIVES, _ANGLE = ("drive", "lift", "turn"), 2  # joints of the foot, one each a part of a pose
_STUB = 1e-4  # L, of a foot on which the vibrissa turns; it must have some mass
_AHEAD = 0.01  # L; beads that are nearer to the obstacle are looked at in each step
_CLEAR = 1e-5  # L; those that are farther off touch nothing, whatever single precision rounds
_INTEGRATORS = {
    "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
    "euler": mujoco.mjtIntegrator.mjINT_EULER,
    "rk4": mujoco.mjtIntegrator.mjINT_RK4,
}
_SOLVERS = {
    "newton": mujoco.mjtSolver.mjSOL_NEWTON,
    "cg": mujoco.mjtSolver.mjSOL_CG,
    "pgs": mujoco.mjtSolver.mjSOL_PGS,
}
_CONES = {
    "pyramidal": mujoco.mjtCone.mjCONE_PYRAMIDAL,
    "elliptic": mujoco.mjtCone.mjCONE_ELLIPTIC,
}


class MovingModel(SteppedModel):
    """Our vibrissa in motion; L = EI = T1 = 1 in MuJoCo, too."""

    def __init__(
        self,
        beam: Beam,
        obstacles: Mapping[str, Obstacle],
        motion: Motion,
        case: Case,
        begin: float,
    ) -> None:
        self._layout, self._radius = beam.layout, case.radius
        self._obstacles = tuple(obstacles.values())
        self._poses, self._at, self._ahead = case.poses, begin, begin
        # Of foot_x, foot_y and the angle those that change.
        self._driven = np.flatnonzero([np.ptp(x) > 0 for x in case.poses.at(case.way)])
        compiled = _spec(beam, motion, obstacles, case, self._pose, self._driven).compile()
        super().__init__(compiled, "; ".join(obstacle.label for obstacle in self._obstacles))
        links = len(beam.layout.joints)
        corners = Corners.of_all([obstacle.corners for obstacle in self._obstacles])
        self._surface = Surface.of(self.model, links, corners, case.radius)
        self._object_of = self._surface.objects(self.model, obstacles)
        self._is_object = ~self._surface.moves
        geoms = np.concatenate([self._surface.beads, self._surface.sides])
        self._set_contacts(motion, geoms, corners=len(self._surface.sides) > 0)
        self.model.geom_gap[geoms] = 0  # a contact that carries no force costs time
        # Runge and Kutta's method looks for contacts on the way of a step, too.
        upright = all(obstacle.upright for obstacle in self._obstacles)
        self._leaves_out = upright and motion.integrator != "rk4"
        beads = self._surface.beads
        scenes = [
            MujocoScene(self.model, self.data, beads, o, name) for name, o in obstacles.items()
        ]
        self._lookouts = [
            Lookout(scene, obstacle, case.radius, beam.layout)
            for scene, obstacle in zip(scenes, self._obstacles, strict=True)
        ]
        if any(beam.layout.vibrissa.weight):
            self._hang(beam)
        mujoco.mj_forward(self.model, self.data)
        self._look()

    def _hang(self, beam: Beam) -> None:
        """Start with the vibrissa at rest under its weight, as no object holds it."""
        model, data, count = self.model, self.data, len(self._driven)

        def imbalance(angles: Floats) -> Floats:
            data.qpos[count:] = angles
            mujoco.mj_forward(model, data)
            return np.asarray(data.qfrc_passive - data.qfrc_bias)[count:]

        data.qpos[count:] = hang(model, beam, float(self._pose.angle), imbalance)

    @property
    def p(self) -> float:
        return self._at

    @property
    def _pose(self) -> Pose:
        return self._poses.at(np.array(self._at))

    @property
    def tip_angle(self) -> float:
        """Slope angle of the last link [rad]."""
        bends = self.data.qpos[len(self._driven) :]
        return self._layout.tip_angle(bends) + float(self._pose.angle)

    def step(self, speed: float) -> None:
        """By forces on a heavy carriage that accelerate it so."""
        begin, self._ahead = self._ahead, self._ahead - speed * self.model.opt.timestep
        self._at = begin
        rate = np.array(self._poses.rate(np.array((begin + self._ahead) / 2)))
        self._carry(-speed * rate[self._driven])
        if self._leaves_out:
            self._leave_out()
        self._advance()
        moved = self._positions() - self._seen
        if max(moved.max(), -moved.min()) > _AHEAD / 4:
            self._look()

    def _look(self) -> None:
        """Let what may touch before long, and nothing else, take part in collisions."""
        self._seen = self._positions()
        near = self._near_any(self._seen[:, :2], self._radius + _AHEAD)
        self._lookouts[0].watch(frozenset(near.tolist()))  # beads meet all objects, or none
        self._near = near
        contacts, of = self.contacts(), self._met()
        for number, lookout in enumerate(self._lookouts):
            lookout.follow_contact(contacts.only(of == number))

    def _near_any(self, points: Floats, distance: float | Floats) -> Integers:
        """Which of the points may be nearer to an object than a distance."""
        near = [obstacle.near(points, distance) for obstacle in self._obstacles]
        return near[0] if len(near) == 1 else np.unique(np.concatenate(near))

    def _met(self) -> Integers:
        """The number of the object of each contact."""
        return np.asarray(self._object_of[self.data.contact.geom].max(axis=1, initial=-1))

    def _leave_out(self) -> None:
        """Let no bead collide that touches nothing: MuJoCo takes longer to find that."""
        model, data, near = self.model, self.data, self._near
        mujoco.mj_kinematics(model, data)
        geoms = self._surface.beads[near]
        reach = self._lookouts[0].radii[near] + _CLEAR
        collides = np.zeros(len(near), dtype=int)
        collides[self._near_any(data.geom_xpos[geoms, :2], reach)] = 1
        model.geom_conaffinity[geoms] = collides

    def _positions(self) -> Floats:
        """Of the beads, shape (n_beads, 3) [L]."""
        return np.asarray(self.data.geom_xpos.take(self._surface.beads, axis=0))

    def contacts(self) -> Contacts:
        """What MuJoCo reports of the last step, loaded or not."""
        joints = np.asarray(self.data.xanchor[len(self._driven) :, :2])
        return Contacts.of(self.data, self._surface, self._layout, joints)

    def clamp(self) -> Clamp:
        return Clamp.of(by_sensors(self.data))

    @property
    def touches(self) -> bool:
        if self.data.ncon == 0:
            return False
        if len(self._surface.sides) == 0:
            return bool(self.data.contact.dist.min() < 0)
        return bool(self.contacts().loaded.any())

    @property
    def touches_twice(self) -> bool | None:
        if len(self._obstacles) == 1:  # where links show one place of two, no step knows
            return None
        return self.data.ncon > 1 and len(self._places(self.contacts())) > 1

    def state(self, speed: float) -> dict[str, Any]:
        """Contact and energy of the last step, dimensionless."""
        contacts = self.contacts()
        return {
            "tip_angle": self.tip_angle,
            "status": "creeping" if self._creeps(speed) else "ok",
            "kinetic_share": self.kinetic_share(),
            **contacts.of_places(self.data.contact.pos[:, :2], self._places(contacts), self._push),
        }

    def _places(self, contacts: Contacts) -> list[Booleans]:
        """Which contacts are in one place and which in another, from the clamp on."""
        if len(self._obstacles) == 1:
            return contacts.places(self._layout)
        of, loaded = self._met(), contacts.loaded
        places = [loaded & (of == number) for number in np.unique(of[loaded])]
        return sorted(places, key=lambda one: contacts.arc_length[one].min()) or [loaded]

    def _push(self, which: Booleans) -> float:
        """The force of some contacts along their normals."""
        return float(self._forces(np.flatnonzero(which).tolist())[:, 0].sum())

    def kinetic_share(self) -> float:
        """Kinetic energy, seen from the clamp, over kinetic and elastic energy."""
        seen, count = self.data.qvel.copy(), len(self._driven)
        seen[:count] = 0
        model, data = self.model, self.data
        lifted = float(model.body_mass @ (data.xipos @ model.opt.gravity))  # against the weight
        return self._share_of_kinetic(seen, slice(count, None), float(data.energy[0]) + lifted)


def _spec(
    beam: Beam,
    motion: Motion,
    obstacles: Mapping[str, Obstacle],
    case: Case,
    start: Pose,
    driven: Integers,
) -> mujoco.MjSpec:
    """The model at rest, with masses, dampers, and a foot that slides and turns."""
    spec = assemble(beam, case.radius, obstacles)
    angle = float(start.angle)
    sin, cos = np.sin(angle), np.cos(angle)
    foot = spec.body(FOOT)
    foot.pos, foot.quat = [start.foot_x, start.foot_y, 0], about_z(angle)
    # Forces accelerate it, so that the vibrissa feels the start; the joints' own inertia is no
    # part of what the sensors at the clamp feel. They are in this order: it turns about its place.
    for axis in driven.tolist():
        foot.add_joint(
            name=_DRIVES[axis],
            type=mujoco.mjtJoint.mjJNT_HINGE if axis == _ANGLE else mujoco.mjtJoint.mjJNT_SLIDE,
            axis=[[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]][axis],
            armature=CARRIAGE * MASS,
        )
    give_mass(spec, beam.layout, motion)
    set_weight(spec, beam.layout, MASS)
    set_options(spec, motion)
    spec.option.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    return spec


def give_mass(spec: mujoco.MjSpec, layout: Layout, motion: Motion) -> None:
    """Give the links of a beam their masses, and its joints dampers and armature."""
    stub = float(layout.joints[0]) or _STUB
    # A weight by length is of a mass by length.
    thickness = 1.0 if any(layout.vibrissa.weight) else layout.thickness**2
    volumes = [stub, *(layout.lengths * thickness).tolist()]
    capsule, world = mujoco.mjtGeom.mjGEOM_CAPSULE, spec.worldbody.name  # there are the corners
    capsules = [g for g in spec.geoms if g.type == capsule and g.parent.name != world]
    for link, volume in zip(capsules, volumes[-len(capsules) :], strict=True):
        link.mass = MASS * volume
    dampers = 2 * motion.damping_ratio / _FIRST
    drives = mujoco.mjtJoint.mjJNT_SLIDE
    bends = [j for j in spec.joints if j.type != drives and j.name not in _DRIVES]
    for joint, compliance in zip(bends, layout.compliances.tolist(), strict=True):
        joint.armature = motion.armature * motion.timestep**2 / compliance
        joint.damping[0] = dampers / compliance


def set_options(spec: mujoco.MjSpec, motion: Motion) -> None:
    """How MuJoCo steps the model."""
    option = spec.option
    option.timestep = motion.timestep
    option.integrator = _INTEGRATORS[motion.integrator]
    option.solver, option.cone = _SOLVERS[motion.solver], _CONES[motion.cone]
    option.tolerance, option.impratio = _TOLERANCE, motion.impratio
