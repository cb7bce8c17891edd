"""A sweep in which a second place touches: paths of one contact and of two, end to end."""

from collections.abc import Sequence

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.clamp_path import Poses
from analytic.problem.contours.contour import Contour
from analytic.solver.general.balance import states_at
from analytic.solver.general.clearance import bends_one_way, deepest, is_clear
from analytic.solver.general.curve import EquilibriumCurve, Point, turned_round
from analytic.solver.general.pair import Pair
from analytic.solver.general.path import Path, follow_from
from analytic.solver.general.states import States, Vibrissa
from analytic.solver.general.stations import solve_places

_LOOKS = (129, 33, 33)  # places of a path, and of the step between them, that are looked at
_AHEAD = 1e-3  # of the curve: there a state that has left a contact has it well behind
_MOST = 24  # paths, and corners; each costs a tenth of a second


def with_second_contacts(objects: Sequence[Contour], path: Path, poses: Poses) -> list[Path]:
    """A path of one contact up to its second one, and what follows as far as it is known.

    Round very many corners it is left as it is: it would be two contacts all along.
    """
    found: list[Path] = []
    alone, corners = path, sum(one.breaks().size // 2 for one in objects)
    while max(len(found), corners) <= _MOST:
        pair = _touched(objects, path, poses)
        if pair is None:
            return [*found, path]
        curve, start, before = pair
        found += [_up_to(path, poses, before), follow_from(curve, start)]
        after = _left_alone(objects, found[-1], poses)
        if after is None:
            return [*found[:-1], found[-1]._replace(complete=False)]
        path = after
    return [alone]


def joined(paths: Sequence[Path]) -> Path:
    """The contacts next to the clamp, of all paths, as one path."""
    z = [_inner(path.z, path.vibrissa) if path.z.shape[1] > 4 else path.z for path in paths]
    return paths[-1]._replace(z=np.concatenate(z))


def others_than(contour: Contour | Pair, objects: Sequence[Contour]) -> list[Contour]:
    """The objects that are not the one which is touched, or the outer one of two."""
    touched = contour if isinstance(contour, Contour) else contour.outer
    return [one for one in objects if one is not touched]


def clear_state(paths: Sequence[Path], i: int, objects: Sequence[Contour]) -> tuple[States, bool]:
    """The state at one of the points of all paths, and whether it touches nothing else."""
    for path in paths:
        if i < len(path.p):
            break
        i -= len(path.p)
    found = states_at(path.contour, path.z[i : i + 1, :-1], path.vibrissa)
    others = others_than(path.contour, objects)
    return found, bool(is_clear(path.contour, found, others)[0])


def second_contacts(paths: Sequence[Path]) -> dict[str, int | None]:
    """Where among the points of all paths, before the snap-off, a second contact comes and goes."""
    ends = np.cumsum([len(path.p) for path in paths]).tolist()
    last = joined(paths).snap_off
    each = zip(paths, [0, *ends[:-1]], ends, strict=True)
    two = [(begin, end) for path, begin, end in each if path.z.shape[1] > 4 and begin < last]
    if not two:
        return {}
    end = two[-1][1]
    return {"second_contact_start": two[0][0], "second_contact_end": end if end < last else None}


def _inner(z: Floats, vibrissa: Vibrissa) -> Floats:
    """The inner one of two contacts, in the numbers of one."""
    excess = vibrissa.arc_length(z[:, 2]) - z[:, 5] - 1
    return np.column_stack([z[:, 3], z[:, 4], excess, z[:, 6]])


def _touched(
    objects: Sequence[Contour], path: Path, poses: Poses
) -> tuple[EquilibriumCurve, Point, Floats] | None:
    """Where a path first comes to a second contact: the curve of two, its start, and the one."""
    vibrissa, contour = path.vibrissa, path.contour
    if vibrissa.rod is not None or not isinstance(contour, Contour):
        return None
    others = others_than(contour, objects)
    few = states_at(contour, path.z[:, :-1], vibrissa)
    if not others and bends_one_way(few).all():
        return None
    high, low = float(path.p[0]), float(path.p[path.snap_off])
    for looks in _LOOKS:
        p = np.linspace(high, low, looks)
        z, known = solve_places(path, poses, p[1:])
        wrong = known & ~is_clear(contour, states_at(contour, z, vibrissa), others)
        if not wrong.any():
            return None
        first = int(np.argmax(wrong))
        found = _begun(objects, path, poses, np.append(z[first], p[first + 1]))
        high, low = p[first], p[first + 1]
        if found is not None and low <= found[1].p <= high:
            return found
    return None


def _begun(
    objects: Sequence[Contour], path: Path, poses: Poses, z: Floats
) -> tuple[EquilibriumCurve, Point, Floats] | None:
    """Where a second place begins to touch, near a state of one contact in which it is inside."""
    vibrissa, contour = path.vibrissa, path.contour
    assert isinstance(contour, Contour)
    state = states_at(contour, z[None, :-1], vibrissa)
    which, s, near = deepest(objects, state)
    t_one, force, excess, p = z
    length = float(state.arc_length[0])
    if s < length:
        curve = _curve(Pair(contour, objects[which]), vibrissa, poses)
        for t in near:
            guess = np.array([t_one, force, excess, t, 0.0, length - s, p])
            start = curve.touched(guess, 4)
            if start is not None:
                return curve, start, start.z[[0, 1, 2, 6]]
        return None
    t = near[0]
    # The free end is not loaded: it has the same slope, relative to the contact, as at rest.
    slope = state.tip_angle[0] + float(vibrissa.natural_curvature) * (s - length)
    turned = slope - float(objects[which].at(np.array([t])).alpha[0])
    outer = max(turned, 0.0) if s == 1 else s - 1
    guess = np.array([t, 0.0, outer, t_one, force, s - length, p])
    curve = _curve(Pair(objects[which], contour), vibrissa, poses)
    start = curve.touched(guess, 1)
    return start and (curve, start, _inner(start.z[None], vibrissa)[0])


def _curve(contour: Contour | Pair, vibrissa: Vibrissa, poses: Poses) -> EquilibriumCurve:
    outer = contour if isinstance(contour, Contour) else contour.outer
    return EquilibriumCurve(contour, vibrissa, poses, outer.t_range, outer.breaks())


def _up_to(path: Path, poses: Poses, z: Floats) -> Path:
    here = _curve(path.contour, path.vibrissa, poses).onward(z)
    if here is None:
        raise ArithmeticError(f"one contact is lost at p = {z[-1]:.6g} L")
    cell = int(path.cells(z[-1:])[0])
    return path._replace(
        z=np.vstack([path.z[: cell + 1], here.z]),
        direction=np.vstack([path.direction[: cell + 1], here.direction]),
        complete=True,
    )


def from_there(path: Path, poses: Poses, p: float) -> Path:
    """A path of one contact from a parameter of the way on; itself, if it begins later."""
    if path.p[0] <= p:
        return path
    here = np.array([p])
    z = np.append(solve_places(path, poses, here)[0][0], p)
    point = _curve(path.contour, path.vibrissa, poses).onward(z)
    if point is None:
        return path._replace(complete=False)
    first = int(path.cells(here)[0]) + 1
    return path._replace(
        z=np.vstack([point.z, path.z[first:]]),
        direction=np.vstack([point.direction, path.direction[first:]]),
    )


def _left_alone(objects: Sequence[Contour], path: Path, poses: Poses) -> Path | None:
    """The path of the contact that is left where the other one's force has ended."""
    pair, vibrissa, last = path.contour, path.vibrissa, path.z[-1]
    assert isinstance(pair, Pair)
    if last[1] == 0:
        contour, z = pair.inner, _inner(last[None], vibrissa)[0]
    elif last[4] == 0:
        contour, z = pair.outer, last[[0, 1, 2, 6]]
    else:
        return None
    curve = _curve(contour, vibrissa, poses)
    here = curve.onward(z)
    others = others_than(contour, objects)
    for start in () if here is None else (here, turned_round(here)):
        ahead = curve.advance(None, start, _AHEAD)
        if ahead:
            state = states_at(contour, ahead[-1].z[None, :-1], vibrissa)
            if is_clear(contour, state, others)[0]:
                return follow_from(curve, start)
    return None
