"""A user's model swept past the case's object."""

import math
from collections.abc import Callable
from dataclasses import asdict, replace

from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.errors import InputError, require
from analytic.problem.readings import Readings
from mujoco_models.dynamics.record import StationMeans
from mujoco_models.dynamics.sweep import Passes, start_of
from mujoco_models.inspect.load import load
from mujoco_models.inspect.measure import hold, measure
from mujoco_models.inspect.measured import MeasuredBeam
from mujoco_models.inspect.parts import Names, find
from mujoco_models.motion import Motion
from mujoco_models.obstacles.prism import Prism
from mujoco_models.quiet import unlogged
from mujoco_models.settings import Settings
from mujoco_models.user_model.model import UserModelInMotion
from mujoco_models.user_model.names import OwnModel

_LONGEST = 0.1  # of the first period; a time step, as of `Motion`
_ALIKE = 0.1  # relative; a length that differs by more is in other units, or of another vibrissa


def run_user_model(
    case: Case,
    own: OwnModel,
    motion: Motion,
    settings: Settings,
    advance: Callable[[], None],
    keep: Callable[[Readings], None],
) -> Readings:
    """Sweep a user's model to the left; see `mujoco_models.simulate_model`."""
    require("model", own, OwnModel, "as OwnModel('my_whisker.xml')")
    model = load(own.file, own.site)
    parts = find(model, Names(own.foot, own.force, own.torque, own.geoms, own.site))
    with unlogged(), threadpool_limits(1):
        measured = measure(model, parts, own.file, own.site)
        held = hold(model, parts)
        held.unload()
    case.require_upright("a model of your own, whose clamp stands as it does,")
    _check(case, measured)
    moved = replace(
        motion, timestep=measured.timestep / measured.period, integrator=measured.integrator
    )
    if motion.solref is None:  # as stiff as is stated, or as this step allows
        stiffness = own.stiffness * moved.stiffness
        moved = replace(moved, contact_stiffness=min(max(stiffness, 1e3), 1e9))
    moved = replace(moved, timestep=own.timestep * moved.timestep)
    record = StationMeans(case.foot_x / case.beam.length, motion.average)
    in_motion = UserModelInMotion(
        own,
        held,
        measured,
        case.beam,
        Prism.of(case, settings.contour_points, settings.corner_radius),
        moved,
        start_of(record, moved),
    )
    about = {
        "model": {**asdict(own), "file": str(own.file)},
        "measured": {
            "length": measured.length,
            "tip_rigidity": measured.tip_rigidity,
            "period": measured.period,
            "damping_ratio": measured.damping_ratio,
        },
    }
    source = f"model {measured.model or own.file.stem}"
    passes = Passes(in_motion, case, moved, source, about)
    return passes.swept(record, advance, keep)


def _check(case: Case, measured: MeasuredBeam) -> None:
    ratio = measured.length / case.beam.length
    if abs(ratio - 1) > _ALIKE:
        guess = (
            "is the model in millimetres?"
            if math.isclose(ratio, 1e3, rel_tol=_ALIKE)
            else ("state the model's own length under [beam]: `vibrissa inspect` measures it")
        )
        raise InputError(
            "length of the model",
            f"{measured.length:.6g}",
            f"that of the case, {case.beam.length:.6g}, but for a tenth",
            guess,
        )
    step, longest = measured.timestep, _LONGEST * measured.period
    if step > longest:
        raise InputError(
            "time step of the model",
            f"{step:.4g}, {step / measured.period:.2g} of its first period",
            f"at most {longest:.3g}, a tenth of it",
            "shorten it, or see by `vibrissa inspect` whether it is as stiff as you meant",
        )
    for word, sensed in (("force", measured.force), ("torque", measured.torque)):
        if sensed is None:
            raise InputError(
                f"{word} sensor of the model",
                "missing",
                "one at the clamp",
                f"add a site there and <{word} site=.../>, or name the sensor or a site",
            )
        if not sensed.feels_contacts:
            raise InputError(
                f"{word} sensor of the model",
                f"{sensed.name!r}, which reads nothing of a flex's contacts",
                "one on another tree of bodies than the flex",
                "let the flex hang on a free body that is welded to the one with the sensors",
            )
    if not any(geom.meets and geom.stiffness < math.inf for geom in measured.geoms):
        raise InputError(
            "geoms of the vibrissa",
            f"{len(measured.geoms)} that meet nothing",
            "such that an object with MuJoCo's default contype and conaffinity can touch them",
            'set contype="1" conaffinity="1", and disable no contacts',
        )
    if measured.self_contacts:
        raise InputError(
            "contact in the first state",
            measured.self_contacts[0],
            "none on the vibrissa",
            "exclude the pair: <contact><exclude body1=... body2=.../></contact>",
        )
