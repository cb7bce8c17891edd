"""From a case and settings to what a model is made of: a beam and an obstacle."""

from dataclasses import replace

import numpy as np

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.support import require_weightless
from mujoco_models.beams.kinds import build
from mujoco_models.beams.layout import bead_spacing
from mujoco_models.beams.protocol import Beam
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.obstacles.kinds import place
from mujoco_models.obstacles.protocol import GEOM, Obstacle
from mujoco_models.settings import Settings


def parts(
    case: Case, settings: Settings, engine: str = "MuJoCo"
) -> tuple[Beam, dict[str, Obstacle]]:
    """The beam and the obstacles, by their names, before an engine makes a model of them."""
    require_radius(case.radius, engine)
    if engine != "MuJoCo":
        require_weightless(engine, case.support)
    for who, tried in (
        ("a cable", settings.beam == "cable"),
        ("out of the plane", not settings.planar),
    ):
        if tried:
            case.require_upright(who)
    each = (replace(case, others=()), *case.alone)
    obstacles = {f"obstacle{i}": place(one, settings) for i, one in enumerate(each)}
    spacing, thinnest = np.inf, case.beam.unloaded.tip_radius
    for obstacle in obstacles.values():
        if len(obstacle.corners) == 0:
            own = bead_spacing(settings.segments, thinnest, obstacle.largest_curvature)
            spacing = min(spacing, own)
    return build(settings, spacing, Vibrissa.of(case.beam, case.support)), obstacles


def parts_at_rest(case: Case, settings: Settings, engine: str = "MuJoCo") -> tuple[Beam, Obstacle]:
    """Those of a sweep at rest, which is without friction, past one object."""
    require_no_friction(case.friction, engine)
    case.require_one_object(f"{engine} at rest")
    beam, obstacles = parts(case, settings, engine)
    return beam, obstacles[GEOM]


def require_no_friction(friction: float, engine: str = "MuJoCo") -> None:
    if friction != 0:
        allowed = f"0 for {engine} at rest"
        remedy = "with friction many states are at rest, and the motion decides which: give a case "
        remedy += "file [motion] (simulate_motion), or run the closed form alone, --engine exact"
        raise InputError("friction", friction, allowed, remedy)


def require_radius(radius: float, engine: str = "MuJoCo") -> None:
    """Refuse a vibrissa without a radius."""
    if radius == 0:
        raise InputError("beam.radius", 0, f"positive for {engine}", "it cannot collide a line")
