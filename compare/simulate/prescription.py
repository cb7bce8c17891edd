"""The coarsest model in motion with a wanted error, by sweeping what would be written.

No closed form is asked: the reference is MuJoCo at rest, with many segments and hard contacts.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from analytic import Case, InputError, Readings
from analytic.problem.recorder import leftward
from compare.explain.parts import Shared
from compare.measure.disagreement import rms
from mujoco_models import simulate_sweep
from mujoco_models.allowed import BeamKind
from mujoco_models.errors import DivergedError
from mujoco_models.export.sweep import sweep_exported
from mujoco_models.export.whisker import Whisker
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings

# Segments at rest, and their rms: past ten cases, under MuJoCo 3.17 and 4.0, what was exported was
# up to 5.2e-4 farther off than from them.
REFERENCE, REFERENCE_OFF = 80, 6e-4
_SHARE = 0.8  # of the wanted error; the rest is for what rounds the file
# Segments, time step [T1] and contact stiffness [EI/L^3], from coarse to fine: as stiff as a sweep
# at 0.1 L/T1 takes without chatter, and then harder, for slower ones.
LADDER = (
    (10, 1 / 25, 2.5e3),
    (20, 1 / 25, 2.5e3),
    (20, 1 / 50, 1e4),
    (20, 1 / 100, 1e4),
    (40, 1 / 50, 1e4),
    (40, 1 / 100, 1e4),
    (40, 1 / 100, 4e4),
    (80, 1 / 100, 4e4),
    (80, 1 / 200, 4e4),
    (80, 1 / 200, 1.6e5),
    (160, 1 / 200, 1.6e5),
)
_IN_VAIN = 4  # rungs without a better one: what is left is the speed's
_POINTS = 400, 4.0, 3200  # of the contour: at least, over the wanted error, and at most


@dataclass(frozen=True)
class Prescription:
    whisker: Whisker
    # Of the worst reading at most, relative to its largest magnitude: the rms from the reference,
    # and the reference's own.
    error: float


def prescribe(
    case: Case,
    beam: BeamKind,
    motion: Motion,
    period: float,
    error: float,
    advance: Callable[[], None] = lambda: None,
) -> Prescription:
    """Refine segments, time step and contacts until the error is reached."""
    if case.friction or motion.friction:
        raise InputError(
            "friction", motion.friction or case.friction, "0 where a model is chosen by its error",
            "leave it out, and set condim and friction of the written geoms",
        )  # fmt: skip
    if error <= REFERENCE_OFF:
        raise InputError(
            "--error", error, f"above {REFERENCE_OFF:g}, which the reference may be off itself",
            "ask for a larger error",
        )  # fmt: skip
    least, over_error, most = _POINTS
    settings = Settings(beam=beam, contour_points=int(min(max(over_error / error, least), most)))
    case = leftward(case)
    reference = simulate_sweep(case, replace(settings, beam="chain", segments=REFERENCE))
    found = []
    for segments, step, stiffness in LADDER:
        moved = replace(motion, timestep=step, contact_stiffness=stiffness, solref=None)
        whisker = Whisker(case, replace(settings, segments=segments), moved, period)
        try:
            off = _error(reference, sweep_exported(whisker))
        except DivergedError:
            off = math.inf
        advance()
        if _least(off) <= error:
            return Prescription(whisker, off + REFERENCE_OFF)
        found.append(off)
        if len(found) - int(np.argmin(found)) > _IN_VAIN:
            break
    raise InputError(
        "--error", error, f"at least {_least(min(found)):.1e} at {motion.speed:g} L/T1",
        "ask for a larger error, or a lower --speed; cables also slip off sideways",
    )  # fmt: skip


def _least(off: float) -> float:
    """The least error that may be asked for, of what is so far from the reference."""
    return max(off / _SHARE, off + REFERENCE_OFF)


def _error(reference: Readings, moved: Readings) -> float:
    """The rms of the worst reading wherever the reference touches.

    What chatters there, or has lost its contact, counts as it is.
    """
    off = float(rms(Shared.of(reference).off(moved)).max())
    return math.inf if math.isnan(off) else off
