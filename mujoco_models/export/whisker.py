"""The vibrissa in motion as a model file, to paste into a robot.

What our own sweeps do to a model between steps (contacts follow the inertia, the obstacle's
facets the contact) is left out: what is written is stepped by `mj_step` alone.
"""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.recorder import leftward
from mujoco_models.beams.kinds import build
from mujoco_models.beams.protocol import FOOT, Beam
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.dynamics.model import give_mass, set_options
from mujoco_models.dynamics.moving import MASS
from mujoco_models.inspect.probe import probe_in
from mujoco_models.model.spec import compiled
from mujoco_models.motion import Motion
from mujoco_models.obstacles.faceted import add_hull
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import GEOM
from mujoco_models.settings import Settings

PREFIX = "whisker_"
PASTE = f"""\
In a robot: <asset><model name="whisker" file="whisker.xml"/></asset> and, in what holds it,
<attach model="whisker" body="{PREFIX}foot" prefix="left_"/>, or MjSpec's attach_body. Carriage and
motor stay behind; the robot's own <option> needs this time step, integrator, Jacobian and flag.
The motor's ctrl is the foot's velocity, not its place."""
_INERTIA = 1e6  # of the carriage, in masses of the vibrissa, which does nothing to it
_GAIN = _INERTIA * MASS / 0.01  # of the motor, which has the carriage at its speed in T1/100
_HALF_DEPTH = 0.5  # L, of the obstacle
_BALL = 0.02  # L, of the carriage
_SPECK = 1e-4  # L; see `add_hull`
_LEAST = 1.01e-15  # MuJoCo's least inertia of a body that moves


@dataclass(frozen=True)
class Whisker:
    """A vibrissa with its numerics, to be written in the units of its case."""

    case: Case
    settings: Settings
    motion: Motion
    period: float  # T1 in the case's unit of time
    start: float | None = None  # of the foot, with the obstacle in its place [L]; None without

    @property
    def beam(self) -> Beam:
        """Chain, rod or cable, dimensionless."""
        vibrissa = Vibrissa.of(self.case.beam, self.case.support)
        return build(self.settings, np.inf, vibrissa)

    def xml(self, *said: str) -> str:
        """As MJCF, with lines that say what it is."""
        comment = "\n".join(("<!--", *said, PASTE, "-->\n")) if said else ""
        return f"{comment}{self.spec().to_xml()}"

    def spec(self) -> mujoco.MjSpec:
        """The vibrissa on a carriage that a motor moves, and the obstacle."""
        if self.case.radius == 0:
            raise InputError("beam.radius", 0, "positive for MuJoCo", "it cannot collide a line")
        self.case.require_upright("an exported whisker, which is mounted at any angle,")
        beam = self.beam
        own = beam.spec(self.case.radius)
        give_mass(own, beam.layout, self.motion)
        if self.settings.beam == "cable":  # its first segment begins before the clamp
            half = float(beam.layout.joints[int(beam.layout.clamp_turns)])
            own.body("B_first").geoms[0].fromto = [half, 0, 0, 2 * half, 0, 0]
        _name(own, beam)
        spec = mujoco.MjSpec()
        spec.modelname = "whisker"
        carriage = spec.worldbody.add_body(name="carriage", pos=[self.start or 0.0, 0, 0])
        carriage.add_joint(
            name="rail", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0], armature=_INERTIA * MASS
        )
        # It needs a mass of its own, where the clamp turns and what is fixed to it is next to none.
        carriage.add_geom(
            type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[_BALL, 0, 0], pos=[0, -_BALL, 0], mass=MASS,
            contype=0, conaffinity=0,
        )  # fmt: skip
        carriage.add_frame().attach_body(own.body(FOOT), PREFIX, "")
        motor = spec.add_actuator(
            name="motor", trntype=mujoco.mjtTrn.mjTRN_JOINT, target="rail",
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        )  # fmt: skip
        motor.gainprm[0], motor.biasprm[2] = _GAIN, -_GAIN
        set_options(spec, self.motion)
        spec.option.gravity = [0, 0, 0]
        spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE  # 4.0.0: wrong with sparse ones
        # One contact a link past meshes, as past primitives: the error is that of either.
        spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MULTICCD
        self._scale(spec)
        self._touch(spec)
        if self.start is not None:
            self._add_obstacle(spec)
        compiled(spec)
        return spec

    def _scale(self, spec: mujoco.MjSpec) -> None:
        """From L = EI = T1 = 1 to the units of the case."""
        length, force, time = self.case.beam.length, self.case.beam.force_unit, self.period
        moment, mass = force * length, force * time**2 / length
        for body in spec.bodies:
            body.pos = body.pos * length
        for site in spec.sites:
            site.pos, site.size = site.pos * length, site.size * length
        for geom in spec.geoms:
            geom.pos, geom.size, geom.fromto = (
                x * length for x in (geom.pos, geom.size, geom.fromto)
            )
            geom.mass *= mass
        for joint in spec.joints:
            slides = joint.type == mujoco.mjtJoint.mjJNT_SLIDE
            joint.pos = joint.pos * length
            joint.armature *= mass if slides else mass * length**2
            joint.stiffness[0] *= moment
            joint.damping[0] *= moment * time
        for motor in spec.actuators:
            gain = force * time / length
            motor.gainprm, motor.biasprm = motor.gainprm * gain, motor.biasprm * gain
        for flex in getattr(spec, "flexes", ()):
            flex.vert = np.array(flex.vert) * length
            flex.radius, flex.young = flex.radius * length, flex.young * force / length**2
        for plugin in spec.plugins:
            plugin.config = {
                key: repr(float(text) * force / length**2) for key, text in plugin.config.items()
            }
        spec.option.timestep *= time
        spec.compiler.boundinertia = _LEAST

    def _touch(self, spec: mujoco.MjSpec) -> None:
        """Let links touch objects, but not each other, as hard as stated."""
        capsules = [g for g in spec.geoms if g.type == mujoco.mjtGeom.mjGEOM_CAPSULE]
        impedance = self.motion.solimp
        for capsule in capsules:
            capsule.contype, capsule.conaffinity, capsule.priority = 0, 1, 1
            capsule.condim, capsule.friction[0] = 1, 0
            capsule.solimp[:3] = [impedance, impedance, 1e-3 * self.case.beam.length]
        for capsule, weight in zip(capsules, self._weights(spec).tolist(), strict=True):
            soft = self.contact_stiffness * (1 - impedance) * weight
            capsule.solref = -soft, -2 * math.sqrt(soft)

    def _weights(self, spec: mujoco.MjSpec) -> Floats:
        """Inverse masses that MuJoCo takes for contacts of the capsules, from clamp to tip."""
        model = compiled(spec)
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        geoms = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE)
        weights = model.body_invweight0[model.geom_bodyid[geoms], 0]
        probe = probe_in(spec.copy(), float(model.geom_size[geoms[-1], 0]))
        if probe is not None:
            across = np.array([1.0, 0.0, 0.0])
            weights = np.array([
                probe.weight(geom, data.geom_xpos[geom], across, model.geom_size[geom, 0]) or weight
                for geom, weight in zip(geoms.tolist(), weights, strict=True)
            ])  # fmt: skip
        weights[0] = weights[1]  # that of the clamp, which hardly moves
        return np.asarray(weights)

    @property
    def contact_stiffness(self) -> float:
        """Of a link, force over depth at rest [force/length]."""
        return self.motion.stiffness * self.case.beam.force_unit / self.case.beam.length

    def _add_obstacle(self, spec: mujoco.MjSpec) -> None:
        """As a prism whose contour has the settings' points."""
        prism = Prism.of(
            leftward(self.case), self.settings.contour_points, self.settings.corner_radius
        )
        length = self.case.beam.length
        polygon = length * np.vstack([prism.vertices, prism.outline[-1]])
        if self.case.sweep.direction == "right":
            polygon[:, 0] *= -1
        inner = np.append((polygon[len(polygon) // 2] + polygon.mean(axis=0)) / 2, 0.0)
        depth = _HALF_DEPTH * length
        ends = [np.insert(polygon, 2, z, axis=1) for z in (-depth, depth)]
        add_hull(spec, np.concatenate(ends), inner, _SPECK * length)
        # MuJoCo refuses a volume below 1e-15, which the speck may have.
        spec.mesh(GEOM).inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL


def _name(spec: mujoco.MjSpec, beam: Beam) -> None:
    """Links, joints and geoms by number, and the sensors at the clamp."""
    foot = spec.body(FOOT)
    foot.add_site(name="clamp")
    for word, kind in (
        ("force", mujoco.mjtSensor.mjSENS_FORCE), ("torque", mujoco.mjtSensor.mjSENS_TORQUE),
    ):  # fmt: skip
        spec.add_sensor(name=word, type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="clamp")
    names = {}
    for i in range(len(beam.layout.joints)):
        body = beam.body(spec, i)
        names[body.name] = f"link{i + 1}"
        for geom in body.geoms:
            geom.name = f"side{i + 1}"
        for joint in body.joints:
            joint.name = f"bend{i + 1}"
    for old, new in names.items():
        spec.body(old).name = new
    for flex in getattr(spec, "flexes", ()):
        flex.vertbody = [names.get(name, name) for name in flex.vertbody]
