"""A sweep in MuJoCo: from case and settings to a walk through all stations."""

import time
from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

from analytic.problem.case import Case
from analytic.problem.readings import Readings
from analytic.problem.recorder import Recorder
from mujoco_models.model.model import BeamModel
from mujoco_models.model.parts import parts_at_rest
from mujoco_models.model.stations import engine, visit
from mujoco_models.settings import Settings
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.spatial_walk import SpatialWalk
from mujoco_models.sweep.state import State
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
        "engine": engine(),
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
    recorder = Recorder(case, source, about, lambda: walk.events, begun=begun)

    def row_at(p: float) -> dict[str, Any]:
        walk.go_to(p)
        if walk.doubt:
            doubts[walk.doubt] = doubts.get(walk.doubt, 0) + 1
        return walk.row()

    return visit(case.way, row_at, recorder, advance, keep)


def set_out(case: Case, settings: Settings, numerics: Numerics | None = None) -> Walk[BeamModel]:
    """The beam, as it hangs, with its clamp at the first station of a sweep to the left."""
    beam, obstacle = parts_at_rest(case, settings)
    model = BeamModel(beam, case.radius, obstacle, settings.contact_stiffness)
    if not settings.planar:
        return SpatialWalk(model, case, settings.tolerance, numerics)
    start = None
    if any(case.weight):
        model.move_clamp(case.poses.at(case.way[0]))
        start = State(model.hang(), {})
    return Walk(model, case, settings.tolerance, numerics, start)
