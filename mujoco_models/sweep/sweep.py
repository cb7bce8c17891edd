"""A sweep in MuJoCo: from case and settings to a walk through all stations."""

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

import mujoco

from analytic.problem.case import Case
from analytic.problem.readings import Readings
from analytic.problem.recorder import DIVERGED, Recorder
from mujoco_models.errors import DivergedError
from mujoco_models.model.model import BeamModel
from mujoco_models.model.parts import parts_at_rest
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
    beam, obstacle = parts_at_rest(case, settings)
    model = BeamModel(beam, case.radius, obstacle, settings.contact_stiffness)
    kind = Walk if settings.planar else SpatialWalk
    return kind(model, float(case.foot_x[0]) / case.beam.length, settings.tolerance, numerics)
