"""What faults that need the contour do to the readings, from the closed form."""

from dataclasses import replace

import numpy as np
from scipy.interpolate import CubicSpline

from analytic import CLAMP_READINGS, Case, InputError, Readings, Sweep, solve_sweep, through_points
from analytic.problem.arrays import Floats

_STEP = 1e-3  # L; the change that a signature is taken from
_STATIONS = 1000  # of the sweeps between which it is interpolated
_BEYOND = 0.02  # L; what a slightly longer vibrissa would reach, beyond the contour that is known
_SAME = 1e-3  # of the largest magnitude; the contour must reproduce the reference so well (rms)


def contour_signatures(reference: Readings, foot_x: Floats) -> dict[str, Floats] | None:
    """Change of the clamp readings at `foot_x` with some quantities, by name.

    ``length`` by the vibrissa's, ``radius`` by its radius over its length, ``clamp`` by the share
    of the length that is rigid at the clamp. Shape (3, stations) each, NaN where one of the sweeps
    is free or in another phase.

    Parameters
    ----------
    reference : Readings
        Whose contour is in its provenance.
    foot_x : array, shape (stations,)
        [length]

    Returns
    -------
    dict or None
        None if the reference does not record its contour, or a smooth contour through the points
        that it records cannot be solved or does not reproduce its readings.
    """
    contour = reference.provenance.get("contour")
    if contour is None:
        return None
    beam, swept = reference.beam, reference.values("foot_x")
    sweep = Sweep(_STATIONS, direction="left" if swept[-1] < swept[0] else "right")
    points, step = _extended(np.transpose(contour), _BEYOND * beam.length), _STEP * beam.length
    down = points - [0.0, step]
    try:
        clamp_stiffness, friction = reference.support
        case = Case(
            beam,
            through_points(points),
            sweep,
            clamp_stiffness=clamp_stiffness,
            friction=friction,
        )
        cases = {
            "length": replace(case, beam=replace(beam, length=beam.length + step)),
            "radius": replace(case, beam=replace(beam, radius=beam.radius + step)),
            "clamp": replace(
                case,
                beam=replace(beam, length=beam.length - step),
                profile=through_points(down),
            ),
        }
        base = solve_sweep(case)
        changed = {name: solve_sweep(varied) for name, varied in cases.items()}
    except (InputError, ArithmeticError):
        return None
    seen = _at(base, foot_x)
    known = np.stack(
        [np.interp(foot_x, *_sorted(swept, reference.values(n))) for n in CLAMP_READINGS]
    )
    miss = (seen - known) / np.abs(known).max(axis=1, keepdims=True)
    if not np.sqrt(np.nanmean(miss**2)) < _SAME:
        return None
    # Past the rigid part the clamp's force acts at its end, while the moment is taken at its foot.
    lifted = changed["clamp"]
    moment = lifted.values("moment_z") - step * lifted.values("force_x")
    changed["clamp"] = replace(lifted, table=lifted.table.assign(moment_z=moment))
    return {name: (_at(sweep_, foot_x) - seen) / _STEP for name, sweep_ in changed.items()}


def _extended(points: Floats, beyond: float) -> Floats:
    """A contour, shape (points, 2), extrapolated at either end, unless it is vertical there."""
    way = np.append(0, np.cumsum(np.hypot(*np.diff(points, axis=0).T)))
    first, last = CubicSpline(way, points)([-beyond, way[-1] + beyond])
    before = [first] if first[0] < points[0, 0] else []
    after = [last] if last[0] > points[-1, 0] else []
    return np.vstack([*before, points, *after])


def _at(sweep: Readings, foot_x: Floats) -> Floats:
    """The clamp readings at `foot_x`, NaN where free and next to it."""
    x = sweep.values("foot_x")
    free = (sweep.table["phase"] == "free").to_numpy()
    rows = [np.where(free, np.nan, sweep.values(name)) for name in CLAMP_READINGS]
    return np.stack([np.interp(foot_x, *_sorted(x, row)) for row in rows])


def _sorted(x: Floats, values: Floats) -> tuple[Floats, Floats]:
    order = np.argsort(x)
    return x[order], values[order]
