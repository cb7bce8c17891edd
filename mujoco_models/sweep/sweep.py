"""A sweep in MuJoCo: from case and settings to a walk through all stations."""

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

import mujoco
import numpy as np

from analytic.problem.case import Case
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from analytic.problem.recorder import DIVERGED, Recorder
from mujoco_models.beams.kinds import build
from mujoco_models.beams.layout import bead_spacing
from mujoco_models.beams.protocol import Beam
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.errors import DivergedError
from mujoco_models.model.model import BeamModel
from mujoco_models.obstacles.kinds import place
from mujoco_models.obstacles.protocol import Obstacle
from mujoco_models.settings import Settings
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.spatial_walk import SpatialWalk
from mujoco_models.sweep.walk import Model, Walk


def run_sweep(
    case: Case,
    settings: Settings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
    numerics: Numerics | None = None,
) -> Readings:
    """Sweep the beam to the left; see `mujoco_models.simulate_sweep`."""
    begun = time.process_time()
    walk = set_out(case, settings, numerics)
    about = {
        "engine": f"MuJoCo {mujoco.__version__}, vibrissa-testbed {version('vibrissa-testbed')}",
        "settings": asdict(settings),
        "joints": walk.model.layout.joints.tolist(),
    }
    return follow(case, walk, f"mujoco {settings.beam}", about, begun, advance, keep)


def follow(
    case: Case,
    walk: Walk[Model],
    source: str,
    about: Mapping[str, Any],
    begun: float,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> Readings:
    """Go to all stations, one after the other."""
    doubts: dict[str, int] = {}
    about = {**about, "obstacle": walk.model.obstacle.label, "unsettled": doubts}
    recorder = Recorder(case, source, about, lambda: walk.events, case.foot_x, begun=begun)
    rows, count = recorder.rows, len(case.foot_x)
    with recorder.rescued(keep):
        for number, target in enumerate(case.foot_x / case.beam.length, start=1):
            try:
                walk.go_to(float(target))
                if walk.doubt:
                    doubts[walk.doubt] = doubts.get(walk.doubt, 0) + 1
                rows.append(walk.row())
            except DivergedError as error:
                rows.append(DIVERGED)
                place_ = f"station {number} of {count}, foot_x = {target:.6g} L"
                raise DivergedError(f"diverged at {place_}: {error}") from error
            advance()
    return recorder.readings()


def set_out(case: Case, settings: Settings, numerics: Numerics | None = None) -> Walk[BeamModel]:
    """The beam, straight, with its foot at the first station of a sweep to the left."""
    beam, obstacle = parts(case, settings)
    model = BeamModel(beam, case.radius, obstacle, settings.contact_stiffness)
    kind = Walk if settings.planar else SpatialWalk
    return kind(model, float(case.foot_x[0]) / case.beam.length, settings.tolerance, numerics)


def parts(case: Case, settings: Settings, engine: str = "MuJoCo") -> tuple[Beam, Obstacle]:
    """The beam and the obstacle, before an engine makes a model of them."""
    if case.friction != 0:
        raise InputError(
            "friction",
            case.friction,
            f"0 for {engine} at rest",
            "with friction many states are at rest, and the motion decides which: simulate_motion",
        )
    if case.radius == 0:
        raise InputError("beam.radius", 0, f"positive for {engine}", "it cannot collide a line")
    obstacle = place(case, settings)
    spacing = np.inf
    if len(obstacle.corners) == 0:
        thinnest = case.beam.unloaded.tip_radius
        spacing = bead_spacing(settings.segments, thinnest, obstacle.largest_curvature)
    return build(settings, spacing, Vibrissa.of(case.beam, case.clamp_stiffness)), obstacle
