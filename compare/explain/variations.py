"""What the closed form alone knows of a disagreement: no simulator in it."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    Readings,
    polygon,
    solve_sweep,
    with_friction,
)
from analytic.problem.arrays import Floats

STEP = 1e-3
"""Relative change of each quantity, from which its signature is taken."""


def variations(case: Case) -> dict[str, Readings]:
    """The exact sweep over the case's stations with one thing of the physics changed, by name.

    ``flexural_rigidity``, ``length``, ``radius`` and ``tip_radius`` are larger by a thousandth,
    ``foot_x`` is by a thousandth of the length, ``natural_curvature`` by a thousandth over the
    length, ``clamp_compliance``, its rotation by moment, by a thousandth of L/EI, and ``friction``
    is a coefficient larger by a thousandth. A tip is never thicker than the vibrissa, and one that
    is more curved towards the object may touch it twice: of those two the sweep is the exact one
    less what the opposite change does.
    """
    beam, length = case.beam, case.beam.length
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    shift = STEP * length
    same = replace(case.sweep, start=start, stop=stop)
    cases = {
        "flexural_rigidity": replace(case, beam=beam.scaled(rigidity=1 + STEP)),
        "length": replace(case, beam=beam.scaled(length=1 + STEP)),
        "radius": replace(case, beam=replace(beam, radius=beam.radius * (1 + STEP))),
        "foot_x": case,
    }
    # Nearby cases start a little elsewhere by default; all are swept over the same stations.
    shifted = replace(same, start=start + shift, stop=stop + shift)
    found = {
        name: solve_sweep(replace(varied, sweep=shifted if name == "foot_x" else same))
        for name, varied in cases.items()
    }
    # Friction's closed form ends where the vibrissa sticks or lets go; the integration of a plain
    # one goes on over all stations.
    rubs = replace(case, friction=case.friction + STEP, sweep=same)
    found["friction"] = with_friction(case, STEP) if case.is_plain else solve_sweep(rubs)
    softer = 1 / case.clamp_stiffness + STEP / beam.moment_unit
    found["clamp_compliance"] = solve_sweep(replace(case, clamp_stiffness=1 / softer, sweep=same))
    exact = solve_sweep(replace(case, sweep=same))
    away = -1 if case.sweep.direction == "left" else 1
    bent = solve_sweep(replace(case, beam=_bent(beam, away * STEP / length), sweep=same))
    found["natural_curvature"] = bent if away > 0 else _opposite(exact, bent)
    if beam.radius > 0 and isinstance(beam.flexural_rigidity, float):
        tip_radius = (beam.radius if beam.tip_radius is None else beam.tip_radius) * (1 - STEP)
        thinner = replace(case, beam=replace(beam, tip_radius=tip_radius), sweep=same)
        found["tip_radius"] = _opposite(exact, solve_sweep(thinner))
    return found


def _bent(beam: Beam, by: float) -> Beam:
    """The vibrissa with another natural curvature, the same all along it more."""
    given = beam.natural_curvature
    bent = given + by if isinstance(given, float) else lambda s: beam.curvature_at(s) + by
    return replace(beam, natural_curvature=bent)


def _opposite(exact: Readings, changed: Readings) -> Readings:
    """The sweep that differs from the exact one by the opposite."""
    columns = {name: 2 * exact.values(name) - changed.values(name) for name in CLAMP_READINGS}
    return replace(changed, table=changed.table.assign(**columns))


def on_polygon(case: Case, points: int) -> Readings:
    """The exact sweep past the polygon that a mesh of so many points of the contour is."""
    left, right = case.reach
    length = case.beam.length
    vertices = length * case.profile.scaled(1 / length).outline(left, right, points)
    start, stop = (float(x) for x in case.foot_x[[0, -1]])
    sweep = replace(case.sweep, start=start, stop=stop)
    return solve_sweep(replace(case, profile=polygon(vertices), sweep=sweep))


def shifted_inward(signatures: Mapping[str, Floats], penetration: Floats, radius: float) -> Floats:
    """What a contact that gives way does, as if the contour lay deeper by the penetration."""
    return -signatures["radius"] * penetration / (STEP * radius)


def stretched(signatures: Mapping[str, Floats], extension: Floats) -> Floats:
    """What a vibrissa does that is stretched."""
    return np.asarray(signatures["length"] * extension / STEP)
