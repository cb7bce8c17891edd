"""What the closed form alone knows of a disagreement: no simulator in it."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace

import numpy as np

from analytic import CLAMP_READINGS, Case, InputError, Readings, polygon, solve_sweep, with_friction
from analytic.numerics.arrays import Floats
from analytic.problem.quantities import QUANTITIES, shifted

STEP = 1e-3
"""Relative change of each quantity, from which its signature is taken."""
VARIED = (
    "flexural_rigidity",
    "length",
    "radius",
    "foot_x",
    "friction",
    "clamp_compliance",
    "natural_curvature",
    "clamp_angle",
)
"""What may differ in any case, but where it cannot; a cone's `tip_radius` comes beside them."""


def variations(case: Case) -> dict[str, Readings]:
    """The exact sweep over the case's stations with one thing of the physics changed, by name.

    ``flexural_rigidity``, ``length``, ``radius`` and ``tip_radius`` are larger by a thousandth,
    ``foot_x`` is by a thousandth of the length, ``natural_curvature`` by a thousandth over the
    length, ``clamp_compliance``, its rotation by moment, by a thousandth of L/EI, ``clamp_angle``
    by a milliradian, and ``friction`` is a coefficient larger by a thousandth. A tip is never
    thicker than the vibrissa, and one that is more curved towards the object may touch it twice: of
    those two the sweep is the exact one less what the opposite change does.
    """
    case = shifted(case)  # nearby cases start a little elsewhere by default
    beam, tip_radius = case.beam, QUANTITIES["tip_radius"].value(case)
    units = {name: quantity.unit(case) for name, quantity in QUANTITIES.items()}
    units |= {"radius": beam.radius, "tip_radius": -tip_radius}
    if case.direction == "left":
        units["natural_curvature"] *= -1

    def swept(name: str) -> Readings:
        # A sweep with friction ends where the vibrissa sticks or lets go; of a plain one there are
        # the states at all stations.
        if name == "friction" and case.is_plain:
            return with_friction(case, STEP)
        return solve_sweep(QUANTITIES[name].larger(case, STEP * units[name]))

    found = {name: swept(name) for name in VARIED if name != "clamp_angle"}
    with suppress(InputError):  # past a corner, a clamp that leans may stand over the object
        found["clamp_angle"] = swept("clamp_angle")
    exact = solve_sweep(case)
    if beam.radius > 0 and np.isfinite(tip_radius):
        found["tip_radius"] = swept("tip_radius")
    return {
        name: _opposite(exact, varied) if units[name] < 0 else varied
        for name, varied in found.items()
    }


def _opposite(exact: Readings, changed: Readings) -> Readings:
    """The sweep that differs from the exact one by the opposite."""
    columns = {name: 2 * exact.values(name) - changed.values(name) for name in CLAMP_READINGS}
    return replace(changed, table=changed.table.assign(**columns))


def on_polygon(case: Case, points: int) -> Readings:
    """The exact sweep past the polygon that a mesh of so many points of the contour is."""
    left, right = case.reach
    length = case.beam.length
    vertices = length * case.profile.scaled(1 / length).outline(left, right, points)
    return solve_sweep(replace(shifted(case), profile=polygon(vertices)))


def shifted_inward(signatures: Mapping[str, Floats], penetration: Floats, radius: float) -> Floats:
    """What a contact that gives way does, as if the contour lay deeper by the penetration."""
    return -signatures["radius"] * penetration / (STEP * radius)
