"""The sweep: a walk through all stations, and its readings in the units of the case."""

import platform
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

import mujoco
import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from analytic.problem.case import Case
from analytic.problem.columns import COLUMNS
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings
from mujoco_models.beams.kinds import build
from mujoco_models.beams.layout import bead_spacing
from mujoco_models.beams.vibrissa import Vibrissa
from mujoco_models.errors import DivergedError
from mujoco_models.model.model import BeamModel
from mujoco_models.obstacles.kinds import place
from mujoco_models.settings import Settings
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.spatial_walk import SpatialWalk
from mujoco_models.sweep.walk import Walk

_DIVERGED = {"phase": "free", "status": "diverged"}  # the row of a station without numbers


def run_sweep(
    case: Case,
    settings: Settings,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
    numerics: Numerics | None = None,
) -> Readings:
    """Sweep the beam to the left; see `mujoco_models.simulate_sweep`.

    Parameters
    ----------
    case, settings, advance, keep
        As there; the case is one of a sweep to the left.
    numerics : Numerics, optional
        Constants of the rest solver, which no reading should depend on.

    Returns
    -------
    Readings
        As there.

    Raises
    ------
    InputError, DivergedError, MemoryError, ClampError
        As there.
    """
    begun = time.process_time()
    walk = set_out(case, settings, numerics)
    rows: list[dict[str, Any]] = []
    doubts: Counter[str] = Counter()
    try:
        # The matrices are small: more threads only wait for each other, on a busy machine for long.
        with threadpool_limits(1):
            for target in case.foot_x / case.beam.length:
                walk.go_to(float(target))
                doubts.update([walk.doubt] if walk.doubt else [])
                rows.append(walk.row())
                advance()
    except BaseException as error:  # whatever it is, what there is must not be lost
        if isinstance(error, DivergedError):
            rows.append(_DIVERGED)
        if len(rows) > 1:
            keep(_readings(case, settings, walk, rows, doubts, begun))
        if isinstance(error, DivergedError):
            place = f"station {len(rows)} of {len(case.foot_x)}, foot_x = {target:.6g} L"
            raise DivergedError(f"diverged at {place}: {error}") from error
        raise
    return _readings(case, settings, walk, rows, doubts, begun)


def set_out(case: Case, settings: Settings, numerics: Numerics | None = None) -> Walk:
    """The beam, straight, with its foot at the first station of a sweep to the left.

    Parameters
    ----------
    case : Case
        The problem.
    settings : Settings
        The numerics that are the user's.
    numerics : Numerics, optional
        Those that are not.

    Returns
    -------
    Walk
        At the first station, not yet at rest.

    Raises
    ------
    InputError
        If the case's beam has no radius, the object rubs, or MuJoCo has no such beam or obstacle.
    """
    if case.friction != 0:
        raise InputError(
            "friction",
            case.friction,
            "0 for MuJoCo at rest",
            "with friction many states are at rest, and the motion decides which: simulate_motion",
        )
    if case.radius == 0:
        raise InputError("beam.radius", 0, "positive for MuJoCo", "it cannot collide a line")
    obstacle = place(case, settings)
    spacing = np.inf
    if len(obstacle.corners) == 0:
        thinnest = case.beam.unloaded.tip_radius
        spacing = bead_spacing(settings.segments, thinnest, obstacle.largest_curvature)
    beam = build(settings, spacing, Vibrissa.of(case.beam, case.clamp_stiffness))
    model = BeamModel(beam, case.radius, obstacle, settings.contact_stiffness)
    kind = Walk if settings.planar else SpatialWalk
    return kind(model, float(case.foot_x[0]) / case.beam.length, settings.tolerance, numerics)


def _readings(
    case: Case,
    settings: Settings,
    walk: Walk,
    rows: list[dict[str, Any]],
    doubts: Counter[str],
    begun: float,
) -> Readings:
    """In the units of the case's beam."""
    table = pd.DataFrame(rows)
    beam = case.beam
    for name in ("force_x", "force_y"):
        table[name] *= beam.force_unit
    for name in ("moment_z", "residual"):
        table[name] *= beam.moment_unit
    for name in ("contact_arc_length", "contact_x", "contact_y", "penetration"):
        table[name] *= beam.length
    if not settings.planar:
        table["out_of_plane"] *= beam.length
        table["sideways_stiffness"] *= beam.force_unit / beam.length
    table.insert(0, "foot_x", case.foot_x[: len(rows)])
    provenance = {
        **case.provenance(),
        "engine": f"MuJoCo {mujoco.__version__}, vibrissa-testbed {version('vibrissa-testbed')}",
        "python": platform.python_version(),
        "settings": asdict(settings),
        "obstacle": walk.model.obstacle.label,
        "seconds": round(time.process_time() - begun, 3),
        "unsettled": dict(doubts),
        "events": {name: None if x is None else x * beam.length for name, x in walk.events.items()},
    }
    extra = [name for name in table if name not in COLUMNS]
    return Readings(table[[*COLUMNS, *extra]], beam, f"mujoco {settings.beam}", provenance)
