"""A sweep in MuJoCo: from case and settings to a walk through all stations."""

import time
from collections.abc import Callable
from dataclasses import asdict
from importlib.metadata import version

import mujoco
import numpy as np

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from mujoco_models.beams.kinds import build
from mujoco_models.beams.layout import bead_spacing
from mujoco_models.beams.protocol import Beam
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.model.bead import BeadModel
from mujoco_models.model.model import BeamModel
from mujoco_models.obstacles.kinds import place
from mujoco_models.obstacles.protocol import Obstacle
from mujoco_models.settings import Settings
from mujoco_models.sweep.bead.walk import BeadWalk
from mujoco_models.sweep.follow import Account, follow
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.spatial_walk import SpatialWalk
from mujoco_models.sweep.walk import Walk


def run_sweep(
    case: Case,
    settings: Settings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
    numerics: Numerics | None = None,
) -> Readings:
    """Sweep the beam to the left; see `mujoco_models.simulate_sweep`."""
    begun = time.process_time()
    alone = settings.touch == "bead"
    walk = with_one_bead(case, settings) if alone else set_out(case, settings, numerics)
    about = {
        "engine": f"MuJoCo {mujoco.__version__}, vibrissa-testbed {version('vibrissa-testbed')}",
        "settings": asdict(settings),
        "joints": walk.model.layout.joints.tolist(),
    }
    return follow(case, walk, Account(f"mujoco {settings.beam}", about, begun), advance, keep)


def set_out(case: Case, settings: Settings, numerics: Numerics | None = None) -> Walk[BeamModel]:
    """The beam, straight, with its foot at the first station of a sweep to the left."""
    beam, obstacle = parts(case, settings)
    model = BeamModel(beam, case.radius, obstacle, settings.contact_stiffness)
    kind = Walk if settings.planar else SpatialWalk
    return kind(model, float(case.foot_x[0]) / case.beam.length, settings.tolerance, numerics)


def with_one_bead(case: Case, settings: Settings) -> BeadWalk:
    """The same with one bead that slides along the beam."""
    _require_at_rest(case, "MuJoCo")
    beam = build(settings, np.inf, Vibrissa.of(case.beam, case.clamp_stiffness))
    model = BeadModel(beam, case.radius, place(case, settings), settings.contact_stiffness)
    return BeadWalk(model, float(case.foot_x[0]) / case.beam.length, settings.tolerance)


def parts(case: Case, settings: Settings, engine: str = "MuJoCo") -> tuple[Beam, Obstacle]:
    """The beam and the obstacle, before an engine makes a model of them."""
    _require_at_rest(case, engine)
    obstacle = place(case, settings)
    spacing = np.inf
    if len(obstacle.corners) == 0:
        thinnest = case.beam.unloaded.tip_radius
        spacing = bead_spacing(settings.segments, thinnest, obstacle.largest_curvature)
    return build(settings, spacing, Vibrissa.of(case.beam, case.clamp_stiffness)), obstacle


def _require_at_rest(case: Case, engine: str) -> None:
    """Refuse what no engine has at rest."""
    if case.friction != 0:
        raise InputError(
            "friction",
            case.friction,
            f"0 for {engine} at rest",
            "with friction many states are at rest, and the motion decides which: simulate_motion",
        )
    if case.radius == 0:
        raise InputError("beam.radius", 0, f"positive for {engine}", "it cannot collide a line")
