"""A sweep of the general vibrissa at given stations."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.batches import take
from analytic.problem.case import Case
from analytic.problem.clamp_path import Poses
from analytic.problem.columns import SECOND_CONTACT, STATUS_NUMBER
from analytic.problem.contours.contour import Contour
from analytic.problem.reach import contact_range
from analytic.solver.general.balance import rates_at, states_at
from analytic.solver.general.chain import (
    clear_state,
    from_there,
    joined,
    others_than,
    second_contacts,
    with_second_contacts,
)
from analytic.solver.general.clearance import has_passed, is_clear, is_rest_clear
from analytic.solver.general.columns import (
    ReadingColumns,
    Units,
    columns_at_rest,
    to_columns,
    without,
)
from analytic.solver.general.path import EVENTS, Path, follow, located
from analytic.solver.general.states import States, Vibrissa
from analytic.solver.general.stations import solve_places

_ROUNDING = 4 * float(np.finfo(float).eps)  # of a foot position that stands on the snap-off
_CONTOUR = 257  # places of a contour, of which the nearest to the foot is sought
_SHARES = np.linspace(0, 1, 9)  # of a vibrissa, where it may be curved
AT_ONCE = 16_384  # stations: what is between them and their results needs little memory
_LOOKS = 2000  # states of two contacts; between two of so many nothing comes and goes
_ALIKE = 1e-9  # of the way; a path's end that was found twice
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
    first = follow(contour, vibrissa, case.touch, case.reach, poses)
    others = case.alone
    objects = contour, *(other.centreline for other in others)
    paths, alone = with_second_contacts(objects, first, poses), [first]
    while others and paths[-1].complete:
        # Let go by what was before, the vibrissa comes to another object, or swings to it.
        if len(alone) == 1:
            alone += [
                follow(line, vibrissa, other.touch, other.reach, poses)
                for line, other in zip(objects[1:], others, strict=True)
                if other.touch
            ]
        onward = _onward(objects, paths, alone, poses)
        if onward is None:
            break
        paths += with_second_contacts(objects, onward, poses)
    holder = _holders(paths, p)
    held = holder >= 0
    past = (p < first.p[0]) & ~held
    lost = past & (not paths[-1].complete)
    lost[past] |= _on_it_again(objects, vibrissa, paths[-1], poses, p[past])

    unknown = len(paths) == 1 and not first.complete
    columns = without(columns, lost, "diverged" if unknown else "touches again")
    columns["foot_x"] = pose.foot_x * beam.length
    if len(paths) > 1:
        columns |= {name: np.full(len(p), np.nan) for name in SECOND_CONTACT}
    places = np.full((len(p), 3), np.nan)
    every = 1 + len(p) // _LOOKS
    for path, here in _pieces(paths, holder):
        z, found = solve_places(path, poses, p[here])
        touching = states_at(path.contour, z, vibrissa)
        if touching.inner is None:
            places[here] = np.where(found[:, None], z, np.nan)
        solved = to_columns(touching, Units.of(beam))
        which = _statuses(path, objects, touching, z, poses, p[here], every)
        sticks = (solved["status"] == STATUS_NUMBER["ok"]) & (which == STATUS_NUMBER["sticks"])
        solved["status"][sticks] = STATUS_NUMBER["sticks"]
        solved = without(solved, which == STATUS_NUMBER["touches again"], "touches again")
        words = {"phase": solved.pop("phase"), "status": solved.pop("status")}
        for name in solved.keys() - {"foot_x"}:
            columns[name][here] = np.where(found, solved[name], np.nan)
        columns["phase"][here] = words["phase"]
        columns["status"][here] = np.where(found, words["status"], STATUS_NUMBER["diverged"])
    return Solved(columns, _events(paths, objects), held | lost, places[held | lost])


def _onward(
    objects: Sequence[Contour], paths: Sequence[Path], alone: Sequence[Path], poses: Poses
) -> Path | None:
    """The path of the object that holds the vibrissa next, or catches it as it swings."""
    last = min(float(path.p.min()) for path in paths)
    ahead = [path for path in alone if path.p.min() < last - _ALIKE]
    if not ahead:
        return None
    begin = min(last, max(float(path.p[0]) for path in ahead))
    found = [from_there(path, poses, begin) for path in ahead if path.p[0] >= begin]
    if begin < last:
        return found[0]
    for path in found:
        state = states_at(path.contour, path.z[:1, :-1], path.vibrissa)
        others = others_than(path.contour, objects)
        left = [one for one in others if any(other.contour is one for other in found)]
        passed = any(has_passed(one, state)[0] for one in left)
        if not passed and is_clear(path.contour, state, others)[0]:
            return path
    return found[0]._replace(complete=False)


def _pieces(paths: Sequence[Path], holder: Integers) -> Iterator[tuple[Path, Integers]]:
    for i, path in enumerate(paths):
        held = np.flatnonzero(holder == i)
        for first in range(0, len(held), AT_ONCE):
            yield path, held[first : first + AT_ONCE]


def _on_it_again(
    objects: Sequence[Contour], vibrissa: Vibrissa, last: Path, poses: Poses, p: Floats
) -> Booleans:
    """Where a vibrissa that has let go touches once more, and nobody knows how."""
    snap_off = last.p[last.snap_off]
    places = np.append(p, np.nextafter(snap_off, -np.inf))
    pose = poses.at(places)
    clear, reached = np.ones(len(places), dtype=bool), np.zeros(len(places), dtype=bool)
    for one in objects:
        clear &= is_rest_clear(one, vibrissa, pose)
        x, y = one.place(np.linspace(*contact_range(one), _CONTOUR))
        far = np.hypot(x[:, None] - pose.foot_x, y[:, None] - pose.foot_y).min(axis=0)
        reached |= far < 1
    curved = vibrissa.at_rest.shape.curvature(_SHARES).any()
    begins = places[~clear].max(initial=-np.inf) if curved else -np.inf
    return np.asarray(~clear | (reached & (places <= begins)))[:-1]


def _holders(paths: Sequence[Path], p: Floats) -> Integers:
    """Which path has the state at each parameter of the way; -1 where none has."""
    holder = np.full(len(p), -1)
    for i, path in enumerate(paths):
        last = path.p[path.snap_off]
        here = (p < path.p[0]) & (p >= last - _ROUNDING * max(1.0, abs(last)))
        holder[here & (holder < 0)] = i
    return holder


def _events(paths: Sequence[Path], objects: Sequence[Contour]) -> dict[str, float | None]:
    path = joined(paths)
    points = {**path.events(), "out_of_plane": None}  # where it leaves the plane is not known
    del points["contact_length_minimum"]
    for name in ("phase_b_start", "phase_b_end", "back_start", "back_end"):
        i = points[name]
        if i is not None and not clear_state(paths, i, objects)[1]:
            points[name] = None
    return located(points | second_contacts(paths), path.p)


def _statuses(
    path: Path,
    objects: Sequence[Contour],
    found: States,
    z: Floats,
    poses: Poses,
    p: Floats,
    every: int,
) -> Integers:
    """Which states on a path are ok, which stick and which touch again; of many, one in so many."""

    def looked_at(which: Integers) -> Integers:
        state = take(found, which)
        clear = is_clear(path.contour, state, others_than(path.contour, objects))
        slides = _slides(path, z[which], poses, p[which])
        held = np.where(slides, STATUS_NUMBER["ok"], STATUS_NUMBER["sticks"])
        return np.where(clear, held, STATUS_NUMBER["touches again"])

    order = np.argsort(p)
    looks = np.append(np.arange(0, len(p) - 1, 1 if found.inner is None else every), len(p) - 1)
    looked = looked_at(order[looks])
    while (differ := np.flatnonzero((np.diff(looks) > 1) & (np.diff(looked) != 0))).size:
        middle = (looks[differ] + looks[differ + 1]) // 2
        looked = np.insert(looked, differ + 1, looked_at(order[middle]))
        looks = np.insert(looks, differ + 1, middle)
    statuses = np.empty_like(order)
    statuses[order] = looked[np.searchsorted(looks, np.arange(len(p)))]
    return statuses


def _slides(path: Path, z: Floats, poses: Poses, p: Floats) -> Booleans:
    """Whether the vibrissa slides on along the object as its clamp moves on."""
    vibrissa = path.vibrissa
    if vibrissa.friction == 0:
        return np.ones(len(z), dtype=bool)
    found, rates = rates_at(path.contour, z, vibrissa)
    step, moved = poses.rate(p), np.zeros_like(z)
    moved[:, :3] = np.stack([step.angle, -step.foot_y, step.foot_x], axis=1)
    change = np.linalg.solve(rates, moved[..., None])[..., 0]
    onward = np.where(found.tangent, change[:, 2], 0.0)
    slip = found.offset_point.stretch * change[:, 0] - onward
    if found.inner is not None:
        slips = found.inner.point.stretch * change[:, 3] - (onward - change[:, 5])
        slip = np.minimum(slip, slips)
    return np.asarray(slip >= -_STILL)
