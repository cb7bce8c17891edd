"""A user's model in motion, with the case's object in its world."""

from typing import Any

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.beam import Beam
from analytic.problem.errors import InputError
from mujoco_models.dynamics.moving import SteppedModel
from mujoco_models.errors import DivergedError
from mujoco_models.inspect.axes import sweep_axes
from mujoco_models.inspect.held_rod import HeldRod
from mujoco_models.inspect.load import spec_of
from mujoco_models.inspect.measured import MeasuredBeam
from mujoco_models.inspect.moved import drive_to
from mujoco_models.inspect.sensors import Held
from mujoco_models.model.clamp import Clamp
from mujoco_models.model.contacts import NOWHERE
from mujoco_models.model.stiffness import IMPEDANCE
from mujoco_models.motion import Motion
from mujoco_models.obstacles.faceted import add_hull
from mujoco_models.obstacles.prism import Prism
from mujoco_models.obstacles.protocol import GEOM
from mujoco_models.user_model.names import OwnModel
from mujoco_models.user_model.skin import Edges, Links

_HALF_DEPTH = 1.5  # L; as of all prisms
_SPECK = 1e-4  # L
_LAGS = 0.1, 0.5  # L, and of the way: farther behind the foot does not follow
_WILD = 100.0  # EI/L^2 and EI/L; thirty times what a sweep takes
_AT_TIP = 1e-3  # L
_ITERATIONS, _TOLERANCE = 500, 1e-12  # of Newton's method, which takes two or three


class UserModelInMotion(SteppedModel):
    """A user's model, in its own units."""

    def __init__(
        self,
        own: OwnModel,
        held: Held,
        measured: MeasuredBeam,
        beam: Beam,
        obstacle: Prism,
        motion: Motion,
        foot_x: float,
    ) -> None:
        self._parts, self._beam = held.parts, beam
        self._axes, self._start, self._origin = sweep_axes(held), foot_x, held.clamp
        ours = own.contact == "ours"
        model = self._with_object(own, obstacle)
        super().__init__(model, obstacle.label, measured.period)
        self._foot = self._parts.foot
        place, turn = self._pose(held.data)
        self._clamp = turn.T @ (held.clamp - place)
        self._object = self.model.geom(GEOM).id
        # The object is one more geom of the world, and the world's come first.
        self._geoms = frozenset(g + (g >= self._object) for g in self._parts.geoms)
        self._is_mine = np.isin(np.arange(self.model.ngeom), [*self._geoms])
        self._is_object = np.arange(self.model.ngeom) == self._object
        self._felt = self._beyond_sensors()
        self._skin = self._skin_of(held, measured)
        self._drive = drive_to(self.model, self._foot, -self._axes[0])
        self._change(own, held)
        if ours and self._parts.rod is not None:
            raise InputError(
                "model.contact", "ours", "own, for a flex, all of whose edges have one solref",
                "state solref and solimp in its <contact>",
            )  # fmt: skip
        if ours:  # frictionless, and as stiff at every geom
            self._set_stiffness(motion.stiffness * beam.base_rigidity / beam.length**3, IMPEDANCE)
            self._follows_inertia = model.opt.integrator == int(mujoco.mjtIntegrator.mjINT_DISCRETE)
            self.model.geom_condim[self._is_mine] = 1
        self.model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
        self._dofs = held.dofs
        self._way = 0.0
        mujoco.mj_forward(self.model, self.data)
        self._still = self._skin.elastic_energy()

    def _with_object(self, own: OwnModel, obstacle: Prism) -> mujoco.MjModel:
        """The model with the object in its world, in memory."""
        spec = spec_of(own.file, own.site)
        length = self._beam.length
        polygon = np.vstack([obstacle.vertices, obstacle.outline[-1]])
        inner = np.append((polygon[len(polygon) // 2] + polygon.mean(axis=0)) / 2, 0.0)
        ends = [np.insert(polygon, 2, z, axis=1) for z in (-_HALF_DEPTH, _HALF_DEPTH)]
        points = self._in_world(np.concatenate(ends))
        add_hull(spec, points, self._in_world(inner[None])[0], _SPECK * length)
        # MuJoCo refuses a volume below 1e-15, which the speck has for a vibrissa of 50 mm.
        spec.mesh(GEOM).inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        geom = spec.geom(GEOM)
        geom.conaffinity, geom.priority = 1, -1  # the vibrissa's own contact parameters count
        try:
            return spec.compile()
        except (ValueError, mujoco.FatalError) as error:
            said = " ".join(str(error).split())[:200]
            raise InputError(
                "model",
                own.file,
                "one that an object can be added to",
                f"rename what clashes ({said})",
            ) from error

    def _skin_of(self, held: Held, measured: MeasuredBeam) -> Edges | Links:
        nodes = np.append([joint.s for joint in measured.joints], measured.length)
        if isinstance(held, HeldRod):
            compliances = np.array([joint.compliance for joint in measured.joints])
            return Edges(self.model, self.data, held.rod, nodes, compliances)
        chain, tip = held.parts.chain, held.tip_in_body
        return Links(self.model, self.data, chain, self._geoms, nodes, tip)

    def _in_world(self, points: Floats) -> Floats:
        """Points of the case's frame [L] in the model's world."""
        off = self._beam.length * (points - [self._start, 0, 0])
        return np.asarray(self._origin + off @ self._axes)

    def _pose(self, data: mujoco.MjData) -> tuple[Floats, Floats]:
        return np.array(data.xpos[self._parts.foot]), data.xmat[self._parts.foot].reshape(3, 3)

    def _change(self, own: OwnModel, held: Held) -> None:
        option = self.model.opt
        option.timestep *= own.timestep
        self.model.dof_damping[held.dofs] *= own.damping
        if own.solver == "newton":
            option.solver = mujoco.mjtSolver.mjSOL_NEWTON
            option.iterations, option.tolerance = _ITERATIONS, _TOLERANCE

    @property
    def clamp_at(self) -> Floats:
        """Where the vibrissa begins, in the world, shape (3,)."""
        place, turn = self._pose(self.data)
        return np.asarray(place + turn @ self._clamp)

    @property
    def p(self) -> float:
        """Where the foot is, in the case's frame [L]."""
        moved = (self.clamp_at - self._origin) @ self._axes[0]
        return float(self._start + moved / self._beam.length)

    def step(self, speed: float) -> None:
        """As far as the model's own drive follows."""
        self.time = self.now
        self._way += speed * self.model.opt.timestep / self._period
        unit = self._beam.length
        self._drive(self.data, self._way * unit, speed * unit / self._period)
        self._advance()
        behind = self._way - (self._start - self.p)
        if abs(behind) > _LAGS[0] + _LAGS[1] * self._way:
            if np.abs(self.clamp()).max() > _WILD:
                raise DivergedError("the vibrissa throws its foot about")
            raise InputError(
                "foot", f"{behind:.2g} L behind where it should be", "one that follows its drive",
                "look at its actuator's gain and ctrlrange, its joint's range or its weld's solref",
            )  # fmt: skip

    def clamp(self) -> Clamp:
        """The clamp's action on the vibrissa, by the model's own sensors."""
        force, _ = self._sensed(self._parts.force)
        moment, at = self._sensed(self._parts.torque)
        carried = np.empty(3)
        mujoco.mju_cross(carried, at - self.clamp_at, force)  # np.cross takes ten times as long
        moment = moment + carried
        fx, fy, _ = self._axes @ force / self._beam.force_unit
        return Clamp(float(fx), float(fy), float(self._axes[2] @ moment / self._beam.moment_unit))

    def _sensed(self, sensor: int | None) -> tuple[Floats, Floats]:
        """What a sensor reads, in the world, and where its site is."""
        first = self.model.sensor_adr[sensor]
        site = self.model.sensor_objid[sensor]
        turn = self.data.site_xmat[site].reshape(3, 3)
        return turn @ self.data.sensordata[first : first + 3], self.data.site_xpos[site].copy()

    @property
    def touches(self) -> bool:
        """Whether a contact of vibrissa and object is loaded."""
        return len(self._loaded()[0]) > 0

    def _loaded(self) -> tuple[Integers, Floats]:
        """The contacts of vibrissa and object that carry a force, and how much."""
        met = (self.data.contact.geom == self._object).any(axis=1)
        on_skin = [i for i in np.flatnonzero(met).tolist() if self._skin.has(i)]
        forces = self._forces(on_skin)[:, 0]
        return np.array(on_skin, dtype=int)[forces > 0], forces[forces > 0]

    def state(self, speed: float) -> dict[str, Any]:
        """Contact and energy of the last step, dimensionless."""
        return {
            **self._touched(),
            "tip_angle": self._tip_angle(),
            "status": "touches another" if self._touches_another() else "ok",
            "kinetic_share": self._kinetic_share(),
        }

    def _touches_another(self) -> bool:
        """Whether the vibrissa touches more than the object, or the object more that is felt."""
        geoms = self.data.contact.geom
        of_object = (geoms == self._object).any(axis=1)
        felt = (of_object & (self._felt[geoms] & (geoms >= 0)).any(axis=1)).tolist()
        other = [
            i for i, on_object in enumerate(of_object.tolist())
            if (felt[i] if not self._skin.has(i) else not on_object)
        ]  # fmt: skip
        return bool((self._forces(other)[:, 0] > 0).any())

    def _beyond_sensors(self) -> Booleans:
        """Geoms whose contacts the sensors feel, the vibrissa's or not."""
        model, felt = self.model, np.zeros(self.model.nbody, dtype=bool)
        for sensor in (self._parts.force, self._parts.torque):
            felt[model.site_bodyid[model.sensor_objid[sensor]]] = True
        for body in range(1, model.nbody):
            felt[body] |= felt[model.body_parentid[body]]
        return np.asarray(felt[model.geom_bodyid])

    def _touched(self) -> dict[str, Any]:
        numbers, forces = self._loaded()
        if not len(numbers):
            return {"phase": "free", **NOWHERE, "penetration": 0.0}
        weight = forces / forces.sum()
        contact, unit = self.data.contact, self._beam.length
        place = weight @ contact.pos[numbers]
        # MuJoCo's normal goes from the first geom to the second.
        sense = np.where(contact.geom[numbers, 0] == self._object, 1.0, -1.0)
        normal = self._axes @ (weight * sense @ contact.frame[numbers, :3])
        inward = sense[:, None] * contact.frame[numbers, :3]
        s = weight @ [self._skin.arc_length(i, way) for i, way in zip(numbers, inward, strict=True)]
        x, y, _ = self._axes @ (place - self._origin) / unit
        return {
            "phase": "tip" if s > 1 - _AT_TIP else "tangent",
            "contact_angle": float(np.arctan2(normal[0], -normal[1])),
            "contact_arc_length": float(s),
            "contact_x": float(self._start + x),
            "contact_y": float(y),
            "penetration": float(-weight @ contact.dist[numbers] / unit),
        }

    def _tip_angle(self) -> float:
        """Slope angle of the last link, in the case's frame [rad]."""
        x, y, _ = self._axes @ self._skin.tip_direction()
        return float(np.arctan2(y, x))

    def _kinetic_share(self) -> float:
        speeds = np.zeros(self.model.nv)
        speeds[self._dofs] = self.data.qvel[self._dofs]
        elastic = max(self._skin.elastic_energy() - self._still, 0.0)
        return self._share_of_kinetic(speeds, self._dofs, elastic)
