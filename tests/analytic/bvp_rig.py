"""Clamp readings past a circle by SciPy's boundary-value solver, which shares nothing with ours."""

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.integrate import solve_bvp
from scipy.interpolate import CubicSpline

from analytic import Beam, Readings
from analytic.problem.columns import units

BEAM = Beam(0.1, 1e-4, 2e-4, si=True)
RADIUS, CENTRE = 0.02, (0.005, 0.104)  # m
_MESH = np.linspace(0, 1, 21)


def _solve(guess, foot, radius, centre, angle, tangent):
    """One station [L]: contact at the tip, or tangential somewhere before; None if there is none.

    The state is x, y, slope and curvature; parameters are the normal force, the contact's angle on
    the circle and, if it is tangential, its arc length.
    """
    state, parameters = guess

    def rates(s, y, p):
        pull = p[0] * np.array([np.sin(p[1]), -np.cos(p[1])])
        length = p[2] if tangent else 1.0
        bend = pull[0] * np.sin(y[2]) - pull[1] * np.cos(y[2])
        return length * np.stack([np.cos(y[2]), np.sin(y[2]), y[3], bend])

    def ends(a, b, p):
        touched = np.array(centre) + radius * np.array([np.sin(p[1]), -np.cos(p[1])])
        found = [a[0] - foot, a[1], a[2] - np.pi / 2 - angle, b[3], *(b[:2] - touched)]
        return np.array([*found, b[2] - p[1]] if tangent else found)

    found = solve_bvp(rates, ends, _MESH, state, parameters[: 3 if tangent else 2], tol=1e-8)
    return (found.sol(_MESH), np.append(found.p, [] if tangent else 1.0)) if found.success else None


@cache
def circle_sweep(stations=240, radius=RADIUS, centre=CENTRE, angle=0.0):
    """foot_x and the clamp's readings of a sweep to the left, shape (4, n), up to the snap-off."""
    long = BEAM.length
    outer, middle = (radius + BEAM.radius) / long, np.array(centre) / long
    # First contact: the straight vibrissa's tip at the circle's right side, or its lower one.
    height = np.cos(angle)
    first = middle[0] + np.sqrt(max(outer**2 - (height - middle[1]) ** 2, 0)) + np.sin(angle)
    s = _MESH
    straight = np.stack(
        [first - np.sin(angle) * s, np.cos(angle) * s, np.pi / 2 + angle + 0 * s, 0 * s]
    )
    at = np.arctan2(first - np.sin(angle) - middle[0], middle[1] - height)
    guess, tangent, rows = (straight, np.array([0.05, at, 1.0])), False, []
    for foot in np.linspace(first - 1e-3, middle[0] - 1.2, stations):
        state = guess[0].copy()
        state[0] += foot - state[0, 0]
        found = _solve((state, guess[1]), foot, outer, middle, angle, tangent)
        if found is None or found[1][0] < 0:
            break
        over = found[0][2, -1] < found[1][1] if not tangent else found[1][2] > 1
        if over:
            found = _solve(found, foot, outer, middle, angle, not tangent)
            tangent = not tangent
        if found is None:
            break
        guess = found
        force, normal = found[1][:2]
        rows.append((foot, -force * np.sin(normal), force * np.cos(normal), -found[0][3, 0]))
    return np.array(rows).T


def one_pass(rng, rows, noise, sweep, zero=0.0, jitter=0.0, free=0.2):
    """Readings at even stations, with noise relative to the largest magnitudes.

    What their zeros are known to is handed on, as a rig's free stretches say it.
    """
    foot = np.linspace(sweep[0, 0] + free, sweep[0, -1] - free, rows)
    there = foot + jitter / BEAM.length * rng.standard_normal(rows)
    inside = (there < sweep[0, 0]) & (there > sweep[0, -1])
    exact = np.where(inside, CubicSpline(sweep[0, ::-1], sweep[1:, ::-1], axis=1)(there), 0.0)
    size = np.abs(exact).max(axis=1, keepdims=True)
    noisy = exact + size * (
        noise * rng.standard_normal(exact.shape) + zero * rng.standard_normal((3, 1))
    )
    columns = dict(zip(("foot_x", "force_x", "force_y", "moment_z"), [foot, *noisy], strict=True))
    scale = units(BEAM, tuple(columns))
    known = dict(zip(list(columns)[1:], (zero * size[:, 0] * scale[1:]).tolist(), strict=True))
    readings = Readings.of(
        {n: x * u for (n, x), u in zip(columns.items(), scale, strict=True)}, BEAM
    )
    return replace(readings, provenance={**readings.provenance, "zero_uncertainty": known})
