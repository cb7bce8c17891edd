"""A sweep in space in motion: the chain with its mass on a foot that slides, stepped by MuJoCo.

The links touch with their sides, capsules, and the last one with its round end. MuJoCo's elliptic
cone holds friction back alike in all directions; a pyramid does not.
"""

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.numerics.walk import WalkEvent
from analytic.problem.errors import InputError
from analytic.space.problem.case import SpatialCase
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FORCE,
    FRICTION,
    MOMENT,
    NORMAL,
    SpatialReadings,
)
from analytic.space.problem.recorder import SpatialRecorder
from mujoco_models.beams.kinds import build_spatial
from mujoco_models.beams.links import link_name
from mujoco_models.beams.protocol import FOOT, SpatialBeam
from mujoco_models.dynamics.model import give_mass, set_options
from mujoco_models.dynamics.moving import CARRIAGE, MASS, SteppedModel
from mujoco_models.dynamics.sweep import Drive, on_way, start_of
from mujoco_models.model.clamp import by_sensors
from mujoco_models.model.parts import require_radius
from mujoco_models.model.spec import compiled
from mujoco_models.model.stations import engine
from mujoco_models.motion import Motion
from mujoco_models.obstacles.protocol import GEOM
from mujoco_models.settings import SpatialSettings
from mujoco_models.space.assembly import stand
from mujoco_models.space.bodies import add_body

_AT_TIP = 1e-6  # of the last link's length


class MovingSpace(SteppedModel):
    """The chain in space; its foot goes along a straight way, which is to the left for it."""

    def __init__(
        self, case: SpatialCase, beam: SpatialBeam, settings: SpatialSettings, motion: Motion,
        before: float,
    ) -> None:  # fmt: skip
        way, self._radius = case.way, case.way.radius
        spec = beam.spec(self._radius)
        begin, end = case.way.foot(0.0), case.way.foot(float(way.marks[-1]))
        reach = 1 + float(way.marks[-1]) / 2
        shape = add_body(spec, way.body, (begin + end) / 2, reach, settings.contour_points)
        if shape.osculating is not None or shape.mesh is not None:
            allowed = "a sphere, an ellipsoid or a cylinder for MuJoCo in motion in space"
            raise InputError("body", case.body.label, allowed, "sweep it at rest, without friction")
        joints = beam.layout.joints
        _assemble(spec, len(joints), case.path.clamp_tangent, begin, way.onward(0.0), before)
        give_mass(spec, beam.layout, motion)
        set_options(spec, motion)
        super().__init__(compiled(spec), shape.label)
        model = self.model
        self._begins, self._ends = joints, np.append(joints[1:], 1.0)
        self._links = np.array([model.body(link_name(i)).id for i in range(len(joints))])
        self._sides = np.array([model.geom(f"side{i}").id for i in range(len(joints))])
        self._is_object = np.arange(model.ngeom) == model.geom(GEOM).id
        self._start = before
        self._set_contacts(motion, self._sides)
        mujoco.mj_forward(model, self.data)

    @property
    def p(self) -> float:
        """What is left of the way, so that it falls; 0 at the way's begin."""
        return self._start - float(self.data.qpos[0])

    def step(self, speed: float) -> None:
        """By the force on a heavy carriage that accelerates it so."""
        self._carry(np.array([speed]))
        self._advance()

    def clamp(self) -> tuple[float, ...]:
        """Force and moment, by MuJoCo's sensors, in the world's frame."""
        return tuple(by_sensors(self.data).ravel().tolist())

    @property
    def touches(self) -> bool:
        """Whether a contact is loaded."""
        return bool((self._forces(range(self.data.ncon))[:, 0] > 0).any())

    def state(self, speed: float) -> dict[str, Any]:
        """Contact of the last step, dimensionless: of several the mean by their forces."""
        forces = self._forces(range(self.data.ncon))
        which = np.flatnonzero(forces[:, 0] > 0)
        names = (*CONTACT_POINT, *NORMAL, *FRICTION, "contact_arc_length", "penetration")
        row: dict[str, Any] = dict.fromkeys(names, np.nan)
        row |= {"phase": "free", "status": "ok"}
        if not len(which):
            return row
        contact, forces = self.data.contact, forces[which]
        weights = forces[:, 0] / forces[:, 0].sum()
        frames = contact.frame[which].reshape(-1, 3, 3)
        mine = self._is_mine[contact.geom[which, 1]]
        frames = np.where(mine[:, None, None], frames, -frames)  # from the body to the vibrissa
        depth = -contact.dist[which]
        normals = frames[:, 0]
        places = contact.pos[which] + normals * depth[:, None] / 2
        axis = places + (self._radius - depth)[:, None] * normals
        geoms = np.where(mine, contact.geom[which, 1], contact.geom[which, 0])
        links = np.searchsorted(self._sides, geoms)
        bodies = self._links[links]
        along = self.data.xmat[bodies, 1::3]
        s = self._begins[links] + ((axis - self.data.xpos[bodies]) * along).sum(axis=1)
        arc = float(weights @ np.clip(s, self._begins[links], self._ends[links]))
        normal = weights @ normals
        shear = np.einsum("ik,ikc->c", forces[:, 1:], frames[:, 1:]) / forces[:, 0].sum()
        row |= dict(zip(CONTACT_POINT, weights @ places, strict=True))
        row |= dict(zip(NORMAL, normal / np.linalg.norm(normal), strict=True))
        row |= dict(zip(FRICTION, shear, strict=True))
        tip = arc > 1 - _AT_TIP * (1 - float(self._begins[-1]))
        return row | {
            "contact_arc_length": arc,
            "penetration": float(weights @ depth),
            "phase": "tip" if tip else "tangent",
            "status": "creeping" if self._creeps(speed) else "ok",
        }


def run_space_motion(
    case: SpatialCase,
    motion: Motion,
    settings: SpatialSettings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[SpatialReadings], None] = lambda _: None,
) -> SpatialReadings:
    """Sweep the chain in space in motion; see `mujoco_models.simulate_motion`."""
    require_radius(case.beam.radius)
    way = -case.path.travel / case.beam.length
    motion, record = on_way(way, motion, case.friction, (*FORCE, *MOMENT))
    _check(case, motion, settings)
    model = MovingSpace(case, build_spatial(settings), settings, motion, start_of(record, motion))
    about = {
        "engine": engine(),
        "settings": asdict(settings),
        "motion": asdict(motion),
        "obstacle": model.label,
    }
    source = f"mujoco {settings.beam} in motion"

    def events() -> list[WalkEvent]:
        both = ("touch", record.contact.first), ("slip-off", record.contact.last)
        return [WalkEvent(kind, -at) for kind, at in both if at is not None]

    recorder = SpatialRecorder(case, source, about, events, record.rows)
    return Drive(model, motion).recorded(recorder, record, advance, keep)


def _check(case: SpatialCase, motion: Motion, settings: SpatialSettings) -> None:
    if settings.beam != "chain" or settings.joints != "ball":
        what = f"{settings.beam} on {settings.joints} joints"
        raise InputError("mujoco.beam", what, "a chain on balls in motion in space", "choose it")
    if len(case.path.corners) > 2:
        corners = len(case.path.corners)
        allowed = "2 for a foot in motion, which cannot turn at once"
        raise InputError("path.points", corners, allowed, "take its legs one by one")
    if motion.friction and motion.cone != "elliptic":
        allowed = "'elliptic' in space: a pyramid rubs more in some directions"
        raise InputError("motion.cone", repr(motion.cone), allowed, "set it")


def _assemble(
    spec: mujoco.MjSpec, links: int, tangent: Floats, begin: Floats, onward: Floats, before: float
) -> None:
    """Sides that touch, sensors, and a carriage along the way."""
    for side in stand(spec, links, tangent):
        side.conaffinity = side.condim = side.priority = 1
    foot = spec.body(FOOT)
    foot.pos = begin - before * onward
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, foot.quat)
    axis = turn.reshape(3, 3).T @ onward
    kind = mujoco.mjtJoint.mjJNT_SLIDE
    foot.add_joint(name="drive", type=kind, axis=axis, armature=CARRIAGE * MASS)
