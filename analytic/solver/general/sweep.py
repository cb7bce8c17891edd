"""A sweep of the general vibrissa at given stations."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.case import Case
from analytic.problem.columns import COLUMNS
from analytic.problem.contours.contour import Contour
from analytic.problem.rest import first_touch
from analytic.solver.equilibria import Column
from analytic.solver.general.clearance import is_clear, is_rest_clear
from analytic.solver.general.columns import to_columns
from analytic.solver.general.path import follow
from analytic.solver.general.states import States, Vibrissa, states, with_rates
from analytic.solver.general.stations import solve_places

_ROUNDING = 4 * float(np.finfo(float).eps)  # of a foot position that stands on the snap-off
_STILL = 1e-8  # of the foot's way: slower, and the other way, the contact does not slide


class Solved(NamedTuple):
    """Columns of the stations that are not free, and where what happens happens [L]."""

    where: Booleans
    columns: dict[str, Column]
    events: dict[str, float | None]
    places: Floats
    """Contour parameter, normal force and excess at these stations, NaN where there is no state;
    shape (m, 3)."""


def solve(case: Case, stations: Floats | None = None) -> Solved:
    """Solve a sweep to the left."""
    beam = case.beam
    vibrissa = Vibrissa.of(beam, case.clamp_stiffness, case.friction)
    stations = case.foot_x if stations is None else stations
    centreline, foot_x = case.centreline, stations / beam.length
    touch = first_touch(centreline, case.reach, vibrissa.unloaded)
    path = follow(centreline, vibrissa, touch, case.reach)
    last = path.foot_x[path.snap_off]
    held = (foot_x < path.foot_x[0]) & (foot_x >= last - _ROUNDING * max(1.0, abs(last)))
    past = (foot_x < path.foot_x[0]) & ~held
    lost = past & (not path.complete)
    lost[past] |= ~is_rest_clear(centreline, vibrissa, foot_x[past])
    where = held | lost

    columns = _nothing(stations, "diverged" if not path.complete else "touches again")
    places = np.full((len(stations), 3), np.nan)
    if held.any():
        z, found = solve_places(centreline, vibrissa, path, foot_x[held])
        touching = states(centreline.at(z[:, 0]), z[:, 1], z[:, 2], vibrissa)
        places[held] = np.where(found[:, None], z, np.nan)
        solved = to_columns(touching, ~is_clear(centreline, touching), beam)
        solved["status"] = np.where(found, solved["status"], "diverged")
        solved["status"][(solved["status"] == "ok") & ~_slides(touching)] = "sticks"
        for name in COLUMNS[1:]:
            values = solved[name]
            number = name not in ("phase", "status")
            columns[name][held] = np.where(found, values, np.nan) if number else values
    points = {**path.events(), "out_of_plane": None}  # where it leaves the plane is not known
    del points["contact_length_minimum"]
    for name in ("phase_b_start", "phase_b_end"):
        i = points[name]
        if i is not None and not _is_clear_at(centreline, vibrissa, path.z[i : i + 1]):
            points[name] = None
    events = {n: None if i is None else float(path.foot_x[i]) for n, i in points.items()}
    some = {name: values[where] for name, values in columns.items()}
    return Solved(where, some, events, places[where])


def _is_clear_at(centreline: Contour, vibrissa: Vibrissa, z: Floats) -> bool:
    found = states(centreline.at(z[:, 0]), z[:, 1], z[:, 2], vibrissa)
    return bool(is_clear(centreline, found)[0])


def _nothing(foot_x: Floats, status: str) -> dict[str, Column]:
    columns: dict[str, Column] = {name: np.full(len(foot_x), np.nan) for name in COLUMNS}
    columns["foot_x"] = foot_x
    columns["phase"] = np.full(len(foot_x), "free", dtype="<U11")
    columns["status"] = np.full(len(foot_x), status, dtype="<U13")
    return columns


def _slides(found: States) -> Booleans:
    """Whether the vibrissa slides on along the object as its foot moves to the left.

    A place on it moves along the contour by what the contact does, less what the contact moves
    along the vibrissa.
    """
    if found.vibrissa.friction == 0:
        return np.ones(len(found.force), dtype=bool)
    _, rates = with_rates(found.point, found.force, found.excess, found.vibrissa)
    way = np.cross(rates.twist, rates.above)
    foot = np.einsum("nk,nk->n", rates.foot_x, way)
    slip = found.felt.stretch * way[:, 0] - np.where(found.tangent, way[:, 2], 0.0)
    return np.asarray(slip / foot >= -_STILL)
