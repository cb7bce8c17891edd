"""The deflected vibrissa, drawn from what its clamp feels."""

import numpy as np

from analytic.checks.integration import march
from analytic.checks.of_two import touches_twice
from analytic.from_clamp.contact import SweptVibrissa, located, shapes_turning
from analytic.numerics.arrays import Floats
from analytic.problem.along import Along
from analytic.problem.columns import SENSED
from analytic.problem.readings import Readings, require_readings

_STEPS = 64  # of a fourth-order method: far below the width of a line
_FREE = 16  # points of a free end that is an arc


def deflected_shapes(readings: Readings) -> tuple[Floats, Floats]:
    """Centrelines of the vibrissa at every station, from foot position, clamp force and moment.

    Integrates kappa(s) = kappa_0 + (-M_Az + F_Ay (x - x0) - F_Ax y)/EI from the clamp to the
    contact, beyond which the vibrissa is as it is at rest (paper, eqs. 4 and 14, with the natural
    curvature kappa_0 and the rigidity EI of each place): straight, or curved.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used, and a second contact where one is stated.

    Returns
    -------
    x, y : array, shape (stations, 66)
        Coordinates [length]; shape (stations, 81) if the vibrissa is curved at rest, and 64 points
        more if readings state a second contact.
    """
    if require_readings(readings).running != "foot_x":
        return shapes_turning(readings, deflected_shapes)
    beam = readings.beam
    held = SweptVibrissa.of(readings)
    natural = held.way * held.vibrissa.natural_curvature
    long = beam.length
    foot_x = readings.values("foot_x") / long
    w_x, w_y = (w * long / beam.force_unit for w in readings.support.weight)
    force_x = readings.values("force_x") / beam.force_unit
    force_y = readings.values("force_y") / beam.force_unit
    moment = readings.values("moment_z") / beam.moment_unit
    loaded = located(readings).arc_length
    loaded = np.minimum(np.nan_to_num(loaded, nan=1.0), 1.0)
    if (two := touches_twice(readings.table)).any():
        loaded = np.where(two, readings.values("contact_arc_length") / long, loaded)

    def rate(state: Floats) -> Floats:
        x, y, phi, s, carried = state
        kappa = natural - moment + force_y * x - force_x * y + carried
        if beam.varies:
            at_rest = beam.curvature_at(np.clip(s, 0, 1) * long) * long
            kappa = at_rest + (kappa - natural) * beam.base_rigidity / beam.rigidity_at(s * long)
        cos, sin = np.cos(phi), np.sin(phi)
        return np.stack([cos, sin, kappa, np.ones_like(s), s * (w_y * cos - w_x * sin)])

    clamp = np.stack(
        [
            np.zeros_like(foot_x),
            np.zeros_like(foot_x),
            np.pi / 2 + readings.support.clamp_angle - held.vibrissa.compliance * moment,
            np.zeros_like(foot_x),
            np.zeros_like(foot_x),
        ]
    )
    states = march(rate, clamp, loaded, _STEPS)
    if w_x or w_y:  # what is beyond the contact hangs
        return _drawn(_hanging(held, states, loaded), foot_x, long)
    if two.any():
        x, y = states[-1][:2]
        outer_x, outer_y = _outer_share(readings) / beam.force_unit
        moment = moment - ((force_y - outer_y) * x - (force_x - outer_x) * y)
        force_x, force_y = outer_x, outer_y
        outer = np.where(two, readings.values("second_contact_arc_length") / long, loaded)
        states = np.concatenate([states, march(rate, states[-1], outer - loaded, _STEPS)[1:]])
        loaded = outer
    return _drawn(np.concatenate([states[:, :2], _free_end(readings, states[-1])]), foot_x, long)


def _free_end(readings: Readings, contact: Floats) -> Floats:
    """Places beyond the last contact: the vibrissa at rest, moved to there and turned."""
    x, y, phi, s, _ = contact
    rest = readings.support.unloaded(readings.beam)
    straight = not isinstance(rest.natural, Along) and rest.natural == 0
    parts = np.ones(1) if straight else np.linspace(0, 1, _FREE + 1)[1:]
    at_x, at_y, slope = rest.at(s)
    to_x, to_y, _ = rest.at(s + (1 - s) * parts[:, None])
    cos, sin = np.cos(phi - slope), np.sin(phi - slope)
    to_x, to_y = to_x - at_x, to_y - at_y
    return np.stack([x + cos * to_x - sin * to_y, y + sin * to_x + cos * to_y], axis=1)


def _outer_share(readings: Readings) -> Floats:
    """What of the clamp's force holds against the outer one of two contacts, (2, stations)."""
    alpha, force = (readings.values(f"second_contact_{name}") for name in ("angle", "force"))
    mu = SweptVibrissa.of(readings).way * readings.support.friction
    sin, cos = np.sin(alpha), np.cos(alpha)
    return np.asarray(np.nan_to_num(force * np.array([-sin - mu * cos, cos - mu * sin])))


def _hanging(held: SweptVibrissa, states: Floats, loaded: Floats) -> Floats:
    """Places up to the contact, and of the end that hangs beyond it."""
    x, y, phi = states[-1, :3]
    hung = held.vibrissa.hung(phi if held.way > 0 else np.pi - phi, loaded)
    assert hung is not None
    beyond = np.stack([x + held.way * hung.x.T, y + hung.y.T], axis=1)
    return np.concatenate([states[:, :2], beyond])


def _drawn(states: Floats, foot_x: Floats, long: float) -> tuple[Floats, Floats]:
    path = np.moveaxis(states, 0, -1)
    return (path[0] + foot_x[:, None]) * long, path[1] * long


def curvatures(readings: Readings, x: Floats, y: Floats) -> Floats:
    """Curvature along the centrelines that `deflected_shapes` drew of these readings.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.
    x, y : array, shape (stations, points)
        Coordinates [length]; those beyond the contact carry their own weight at most.

    Returns
    -------
    array, shape (stations, points)
        kappa [1/length], positive where the vibrissa bends to the left of its way from clamp to
        tip.
    """
    beam = require_readings(readings).beam
    foot_x, force_x, force_y, moment = (readings.values(name)[:, None] for name in SENSED)
    steps = np.hypot(np.diff(x, prepend=x[:, :1]), np.diff(y, prepend=y[:, :1]))
    s = np.minimum(np.cumsum(steps, axis=1), beam.length)
    y = y - readings.foot_y[:, None]
    w_x, w_y = readings.support.weight
    turns = w_y * np.diff(x, prepend=x[:, :1]) - w_x * np.diff(y, prepend=y[:, :1])
    bends = force_y * (x - foot_x) - force_x * y - moment + np.cumsum(s * turns, axis=1)
    hanging = np.cumsum(((beam.length - s) * turns)[:, ::-1], axis=1)[:, ::-1]
    bends[:, _STEPS + 1 :] = hanging[:, _STEPS + 1 :]
    kappa = bends / beam.rigidity_at(s)
    if touches_twice(readings.table).any():
        along = slice(_STEPS + 1, 2 * _STEPS + 1)
        outer_x, outer_y = _outer_share(readings)[..., None]
        way_x, way_y = (v[:, along] - v[:, 2 * _STEPS, None] for v in (x, y))
        kappa[:, along] = (outer_y * way_x - outer_x * way_y) / beam.rigidity_at(s[:, along])
    return np.asarray(kappa + beam.curvature_at(s))
