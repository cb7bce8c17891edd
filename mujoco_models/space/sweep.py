"""A sweep in space in MuJoCo: from case and settings to readings."""

import platform
import time
from collections.abc import Callable
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

import mujoco
import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from analytic.problem.arrays import Floats
from analytic.problem.columns import units
from analytic.space.problem.case import SpatialCase
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FOOT,
    FORCE,
    MOMENT,
    NORMAL,
    SpatialReadings,
)
from mujoco_models.beams.kinds import build_spatial
from mujoco_models.beams.layout import MOST_BENT
from mujoco_models.errors import DivergedError
from mujoco_models.model.parts import require_radius
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
    way = case.way
    rest = Rest(model, settings.tolerance)
    walk = Walk(model, rest, way.foot, way.marks)
    rows: list[dict[str, Any]] = []

    def readings() -> SpatialReadings:
        provenance = {
            **case.provenance(),
            "engine": f"MuJoCo {mujoco.__version__}, vibrissa-testbed "
            f"{version('vibrissa-testbed')}",
            "settings": asdict(settings),
            "python": platform.python_version(),
            "obstacle": model.shape.label,
            "seconds": round(time.process_time() - begun, 3),
            "events": [
                {
                    "kind": event.kind,
                    "travel": event.travel * case.beam.length,
                    "foot": (way.foot(event.travel) * case.beam.length).tolist(),
                }
                for event in sorted(walk.events, key=lambda event: event.travel)
            ],
        }
        return _readings(case, rows, f"mujoco {settings.beam}", provenance)

    try:
        with threadpool_limits(1):  # the matrices are small
            for travel in case.path.travel / case.beam.length:
                station = walk.go_to(float(travel))
                rows.append(_row(rest, station, way.foot(float(travel)), settings.tolerance))
                rows[-1]["travel"] = travel
                advance()
    except BaseException as error:  # whatever it is, what there is must not be lost
        if len(rows) > 1:
            keep(readings())
        if isinstance(error, DivergedError):
            raise DivergedError(f"diverged at station {len(rows) + 1}: {error}") from error
        raise
    return readings()


def compiled(case: SpatialCase, settings: SpatialSettings) -> SpaceModel:
    """Beam and body of a case."""
    require_radius(case.beam.radius)
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
    row |= {"phase": "free", "status": station.status, **dict(zip(FOOT, foot, strict=True))}
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
    clamped = model.clamp()
    row |= dict(zip(FORCE, clamped.force, strict=True))
    row |= dict(zip(MOMENT, clamped.moment, strict=True))
    row["discrepancy"] = clamped.discrepancy
    force = 0.0 if found is None else found.state.force
    unavoidable = 2 * model.shape.blur * force
    if found is not None:
        unavoidable += model.shape.off * model.contact_stiffness
    if row["residual"] > tolerance * (1 + force) + unavoidable or _too_coarse(model, row):
        row["status"] = "unsettled"
    return row


def _too_coarse(model: SpaceModel, row: dict[str, Any]) -> bool:
    """Whether a joint bends much, or the contact is in the first cell from the clamp."""
    layout = model.layout
    softness = float(layout.compliances[int(layout.clamp_turns)])
    bend = softness * float(np.linalg.norm([row[name] for name in MOMENT]))
    return bend > MOST_BENT or row["contact_arc_length"] < layout.first_cell


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


def _readings(
    case: SpatialCase, rows: list[dict[str, Any]], source: str, provenance: dict[str, Any]
) -> SpatialReadings:
    """In the units of the case's beam."""
    table, beam = pd.DataFrame(rows), case.beam
    order = ["travel", *FOOT, "phase", *FORCE, *MOMENT, *CONTACT_POINT, *NORMAL]
    numbers = [name for name in (*order, *_NUMBERS) if name != "phase"]
    table[numbers] *= units(beam, numbers)
    table = table[[*order, *_NUMBERS, "status"]]
    return SpatialReadings(table, beam, case.path.clamp_tangent, source, provenance)
