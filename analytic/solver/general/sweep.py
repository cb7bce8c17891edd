"""A sweep of the general vibrissa at given stations."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS, COLUMNS, CONTACT, STATUS_NUMBER
from analytic.problem.contours.contour import Contour
from analytic.problem.poses import Pose, Poses
from analytic.solver.columns import ReadingColumns, Units, columns_at_rest, to_columns, without
from analytic.solver.general.clearance import is_clear, is_rest_clear
from analytic.solver.general.path import EVENTS, follow, located
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


def solve(case: Case, way: Floats | None = None) -> Solved:
    """Solve a sweep to the left, at its stations or at other parameters of its way."""
    beam, vibrissa, contour, poses = case.beam, Vibrissa.of_case(case), case.centreline, case.poses
    p = case.way if way is None else way
    pose = poses.at(p)
    columns = columns_at_rest(vibrissa, pose.foot_x * beam.length, Units.of(beam))
    columns["tip_angle"] = columns["tip_angle"] - vibrissa.clamp_angle + pose.angle
    if case.touch is None:
        none = np.zeros(len(p), dtype=bool)
        return Solved(columns, dict.fromkeys(EVENTS), none, np.empty((0, 3)))
    path = follow(contour, vibrissa, case.touch, case.reach, poses)
    last = path.p[path.snap_off]
    held = (p < path.p[0]) & (p >= last - _ROUNDING * max(1.0, abs(last)))
    past = (p < path.p[0]) & ~held
    lost = past & (not path.complete)
    beyond = Pose(*(values[past] for values in pose))
    lost[past] |= ~is_rest_clear(contour, vibrissa, beyond)

    columns = without(columns, lost, "diverged" if not path.complete else "touches again")
    columns["foot_x"] = pose.foot_x * beam.length
    places = np.full((len(p), 3), np.nan)
    if held.any():
        z, found = solve_places(contour, vibrissa, path, poses, p[held])
        touching = states_at(contour, z, vibrissa)
        places[held] = np.where(found[:, None], z, np.nan)
        solved = to_columns(touching, Units.of(beam))
        sticks = (solved["status"] == STATUS_NUMBER["ok"]) & ~_slides(touching, poses, p[held])
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
    return Solved(columns, located(points, path.p), held | lost, places[held | lost])


def _is_clear_at(contour: Contour, vibrissa: Vibrissa, z: Floats) -> bool:
    found = states_at(contour, z, vibrissa)
    return bool(is_clear(contour, found)[0])


def _slides(found: States, poses: Poses, p: Floats) -> Booleans:
    """Whether the vibrissa slides on along the object as its clamp moves on.

    A place on it moves along the contour by what the contact does, less what the contact moves
    along the vibrissa.
    """
    if found.vibrissa.friction == 0:
        return np.ones(len(found.force), dtype=bool)
    _, rates = with_rates(found.point, found.force, found.excess, found.vibrissa)
    step = poses.rate(p)
    moved = np.stack([step.angle, -step.foot_y, step.foot_x], axis=1)
    change = np.linalg.solve(np.stack(rates, axis=1), moved[..., None])[..., 0]
    slip = found.offset_point.stretch * change[:, 0] - np.where(found.tangent, change[:, 2], 0.0)
    return np.asarray(slip >= -_STILL)
