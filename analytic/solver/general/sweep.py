"""A sweep of the general vibrissa at given stations."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS, COLUMNS, CONTACT, STATUS_NUMBER
from analytic.problem.contours.contour import Contour
from analytic.problem.rest import first_touch
from analytic.solver.columns import ReadingColumns, Units, to_columns, unloaded_columns, without
from analytic.solver.general.clearance import is_clear, is_rest_clear
from analytic.solver.general.path import follow, located
from analytic.solver.general.states import States, Vibrissa, states_at, with_rates
from analytic.solver.general.stations import solve_places

_ROUNDING = 4 * float(np.finfo(float).eps)  # of a foot position that stands on the snap-off
_STILL = 1e-8  # of the foot's way: slower, and the other way, the contact does not slide


class Solved(NamedTuple):
    """A sweep to the left: its columns, and where what happens happens [L]."""

    columns: ReadingColumns
    events: dict[str, float | None]
    touching: Booleans  # the stations that are not free
    # contour parameter, normal force and excess at these, NaN where there is no state, (m, 3).
    places: Floats


def solve(case: Case, stations: Floats | None = None) -> Solved:
    """Solve a sweep to the left."""
    beam, vibrissa = case.beam, Vibrissa.of_case(case)
    stations = case.foot_x if stations is None else stations
    contour, foot_x = case.centreline, stations / beam.length
    touch = first_touch(contour, case.reach, vibrissa.unloaded)
    path = follow(contour, vibrissa, touch, case.reach)
    last = path.foot_x[path.snap_off]
    held = (foot_x < path.foot_x[0]) & (foot_x >= last - _ROUNDING * max(1.0, abs(last)))
    past = (foot_x < path.foot_x[0]) & ~held
    lost = past & (not path.complete)
    lost[past] |= ~is_rest_clear(contour, vibrissa, foot_x[past])

    rest_angle = float(vibrissa.unloaded.at(np.array(1.0))[2])
    columns = unloaded_columns(stations, rest_angle)
    columns = without(columns, lost, "diverged" if not path.complete else "touches again")
    columns["foot_x"] = stations
    places = np.full((len(stations), 3), np.nan)
    if held.any():
        z, found = solve_places(contour, vibrissa, path, foot_x[held])
        touching = states_at(contour, z, vibrissa)
        places[held] = np.where(found[:, None], z, np.nan)
        solved = to_columns(touching, Units.of(beam))
        sticks = (solved["status"] == STATUS_NUMBER["ok"]) & ~_slides(touching)
        solved["status"][sticks] = STATUS_NUMBER["sticks"]
        solved = without(solved, ~is_clear(contour, touching), "touches again")
        for name in COLUMNS[1:]:
            columns[name][held] = solved[name]
        for name in (*CLAMP_READINGS, *CONTACT):
            columns[name][held] = np.where(found, solved[name], np.nan)
        columns["status"][held] = np.where(found, solved["status"], STATUS_NUMBER["diverged"])
    points = {**path.events(), "out_of_plane": None}  # where it leaves the plane is not known
    del points["contact_length_minimum"]
    for name in ("phase_b_start", "phase_b_end", "back_start", "back_end"):
        i = points[name]
        if i is not None and not _is_clear_at(contour, vibrissa, path.z[i : i + 1]):
            points[name] = None
    return Solved(columns, located(points, path.foot_x), held | lost, places[held | lost])


def _is_clear_at(contour: Contour, vibrissa: Vibrissa, z: Floats) -> bool:
    found = states_at(contour, z, vibrissa)
    return bool(is_clear(contour, found)[0])


def _slides(found: States) -> Booleans:
    """Whether the vibrissa slides on along the object as its foot moves to the left.

    A place on it moves along the contour by what the contact does, less what the contact moves
    along the vibrissa.
    """
    if found.vibrissa.friction == 0:
        return np.ones(len(found.force), dtype=bool)
    _, rates = with_rates(found.point, found.force, found.excess, found.vibrissa)
    way = np.cross(rates.slope_residual, rates.height_residual)
    foot = np.einsum("nk,nk->n", rates.foot_x, way)
    slip = found.offset_point.stretch * way[:, 0] - np.where(found.tangent, way[:, 2], 0.0)
    return np.asarray(slip / foot >= -_STILL)
