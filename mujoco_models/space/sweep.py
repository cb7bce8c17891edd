"""A sweep in space in MuJoCo: from case and settings to readings."""

import time
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.space.problem.case import SpatialCase
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FORCE,
    MOMENT,
    NORMAL,
    SpatialReadings,
)
from analytic.space.problem.recorder import SpatialRecorder
from mujoco_models.beams.kinds import build_spatial
from mujoco_models.beams.layout import MOST_BENT
from mujoco_models.model.parts import require_no_friction, require_radius
from mujoco_models.model.stations import engine, visit
from mujoco_models.settings import SpatialSettings
from mujoco_models.space.bodies import add_body
from mujoco_models.space.model import SpaceModel
from mujoco_models.space.rest import Rest, Settled
from mujoco_models.space.walk import Station, Walk

_NUMBERS = (
    "contact_angle",
    "contact_arc_length",
    "stability",
    "residual",
    "discrepancy",
    "penetration",
)


def run_space(
    case: SpatialCase,
    settings: SpatialSettings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[SpatialReadings], None] = lambda _: None,
) -> SpatialReadings:
    """Sweep the beam in space; see `mujoco_models.simulate_space`."""
    begun = time.process_time()
    model = compiled(case, settings)
    way, rest = case.way, Rest(model, settings.tolerance)
    walk = Walk(model, rest, way.foot, way.marks)
    about = {"engine": engine(), "settings": asdict(settings), "obstacle": model.shape.label}
    source = f"mujoco {settings.beam}"
    recorder = SpatialRecorder(case, source, about, lambda: walk.events, begun=begun)

    def row_at(travel: float) -> dict[str, Any]:
        return _row(rest, walk.go_to(travel), way.foot(travel), settings.tolerance)

    return visit(case.path.travel / case.beam.length, row_at, recorder, advance, keep)


def compiled(case: SpatialCase, settings: SpatialSettings) -> SpaceModel:
    """Beam and body of a case."""
    require_radius(case.beam.radius)
    require_no_friction(case.friction)
    beam, way = build_spatial(settings), case.way
    radius = case.beam.radius / case.beam.length
    spec = beam.spec(radius)
    corners = case.path.corners / case.beam.length
    centre = (corners.min(axis=0) + corners.max(axis=0)) / 2
    reach = 1 + float(np.linalg.norm(corners - centre, axis=1).max())
    shape = add_body(spec, way.body, centre, reach, settings.contour_points)
    return SpaceModel(
        beam, spec, shape, case.path.clamp_tangent, radius, settings.contact_stiffness
    )


def _row(rest: Rest, station: Station, foot: Floats, tolerance: float) -> dict[str, Any]:
    """One station; lengths in L, forces and moments in EI/L^2 and EI/L."""
    model = rest.model
    row: dict[str, Any] = dict.fromkeys(
        (*FORCE, *MOMENT, *CONTACT_POINT, *NORMAL, *_NUMBERS), np.nan
    )
    row |= {"phase": "free", "status": station.status}
    found = station.settled
    if found is None and station.status != "ok":
        return row
    if found is None:
        model.place(foot, model.straight)
        row["residual"] = model.rest(None, 1.0)
    else:
        row["stability"], _ = rest.softest(found, foot)
        row["residual"] = _rest(model, found)
        row |= _contact(model, found)
    row |= dict(zip((*FORCE, *MOMENT), model.clamp().ravel(), strict=True))
    row["discrepancy"] = model.discrepancy()
    force = 0.0 if found is None else found.state.force
    unavoidable = 2 * model.shape.blur * force
    if found is not None:
        unavoidable += model.shape.off * model.contact_stiffness
    if row["residual"] > tolerance * (1 + force) + unavoidable or _too_coarse(model, row):
        row["status"] = "unsettled"
    return row


def _too_coarse(model: SpaceModel, row: dict[str, Any]) -> bool:
    """Whether a joint bends much, or the contact is too near the clamp."""
    layout = model.layout
    softness = float(layout.compliances[int(layout.clamp_turns)])
    bend = softness * float(np.linalg.norm([row[name] for name in MOMENT]))
    return bend > MOST_BENT or row["contact_arc_length"] < layout.too_near


def _rest(model: SpaceModel, found: Settled) -> float:
    """What is out of balance, of the joints and of the bead along its link."""
    state = found.state
    skewed = 0.0
    if state.sliding:
        skewed = abs(float(found.touch.normal @ model.direction(state.link))) * state.force
    return max(model.rest(state.link, state.s), skewed * float(model.layout.lengths[state.link]))


def _contact(model: SpaceModel, found: Settled) -> dict[str, Any]:
    touch, state = found.touch, found.state
    along = float(touch.normal @ model.tangent)
    across = float(np.linalg.norm(touch.normal - along * model.tangent))
    return {
        **dict(zip(CONTACT_POINT, model.contact(touch), strict=True)),
        **dict(zip(NORMAL, touch.normal, strict=True)),
        "contact_angle": float(np.arctan2(across, -along)),
        "contact_arc_length": state.s,
        "penetration": -touch.distance,
        "phase": "tip" if state.s == 1.0 and not state.sliding else "tangent",
    }
