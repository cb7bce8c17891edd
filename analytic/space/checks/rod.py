"""The vibrissa in space integrated from its clamp: what the closed form is checked against.

Kirchhoff's rod, isotropic and without twist: r' = t, t' = t x m, and the moment in the section is
m = M - (r - r0) x F with the clamp's force F and moment M (lengths in L, EI = 1). No elliptic
integral, no plane of bending and no normal enter.
"""

import numpy as np
from scipy.integrate import solve_ivp

from analytic.problem.arrays import Floats
from analytic.space.problem.readings import CONTACT_POINT, FOOT, FORCE, MOMENT, SpatialReadings

_TOLERANCE = 1e-13  # of the Dormand-Prince method of order 8
_SHOWN = 33  # points of a loaded part that is drawn


def integrate_rod(
    tangent: Floats, force: Floats, moment: Floats, length: float, points: int = 2
) -> tuple[Floats, Floats, Floats]:
    """March from the clamp.

    Parameters
    ----------
    tangent, force, moment : array, shape (3,)
        Of the clamp, dimensionless; force and moment act on the vibrissa.
    length : float
        Arc length to march [L].
    points : int
        How many states are wanted, at equal distances, both ends among them.

    Returns
    -------
    place, direction, moment : array, shape (points, 3)
        Relative to the foot [L], of length 1, and in the section [EI/L].
    """
    place, along, bending = integrate_rods(
        tangent, force[None], moment[None], np.array([length]), points
    )
    return place[0], along[0], bending[0]


def integrate_rods(
    tangent: Floats, force: Floats, moment: Floats, length: Floats, points: int = 2
) -> tuple[Floats, Floats, Floats]:
    """March many rods from the same clamp together, each by the same share of its length."""
    n = len(length)

    def rate(_: float, state: Floats) -> Floats:
        away, along = state.reshape(2, n, 3)
        bending = moment - np.cross(away, force)
        rates = length[:, None] * np.stack([along, np.cross(along, bending)])
        return np.asarray(rates.ravel())

    marched = solve_ivp(
        rate,
        (0.0, 1.0),
        np.concatenate([np.zeros(3 * n), np.tile(tangent, n)]),
        method="DOP853",
        rtol=_TOLERANCE,
        atol=_TOLERANCE,
        t_eval=np.linspace(0.0, 1.0, points),
    )
    place, along = marched.y.reshape(2, n, 3, points).swapaxes(2, 3)
    return place, along, moment[:, None] - np.cross(place, force[:, None])


def rod_residuals(readings: SpatialReadings) -> Floats:
    """What the contacts of a sweep miss, by integration from their clamp readings.

    Parameters
    ----------
    readings : SpatialReadings
        With contact, normal and phase.

    Returns
    -------
    array, shape (stations,)
        Largest of the misses of the contact's place [L], of the moment there, of the tangent's
        angle against the surface in Phase B, of the force's direction against the normal and, in
        Phase A, of what the tip points away from the body. Zero where the vibrissa is free, NaN
        where there are no readings.
    """
    beam = readings.beam
    missed = np.where(readings.trusted, 0.0, np.nan)
    foot, contact = readings.values(*FOOT), readings.values(*CONTACT_POINT)
    normal = readings.values("normal_x", "normal_y", "normal_z")
    force = readings.values(*FORCE) / beam.force_unit
    moment = readings.values(*MOMENT) / beam.moment_unit
    reach = readings.values("contact_arc_length") / beam.length
    phase = readings.table["phase"].to_numpy()
    touching = np.flatnonzero(readings.touching)
    if not touching.size:
        return missed
    marched = integrate_rods(
        readings.clamp_tangent, force[touching], moment[touching], reach[touching]
    )
    for i, place, along, end in zip(touching, *(states[:, -1] for states in marched), strict=True):
        axis = (contact[i] + beam.radius * normal[i] - foot[i]) / beam.length
        away = float(along @ normal[i])
        missed[i] = max(
            float(np.abs(place - axis).max()),
            float(np.abs(end).max()),
            float(np.abs(force[i] / np.linalg.norm(force[i]) + normal[i]).max()),
            abs(away) if phase[i] == "tangent" else max(0.0, away),
            max(0.0, reach[i] - 1),
        )
    return missed


def deflected_rods(readings: SpatialReadings) -> Floats:
    """Centrelines of the vibrissa at every station, by integration.

    Parameters
    ----------
    readings : SpatialReadings
        With the contact's arc length.

    Returns
    -------
    array, shape (stations, 34, 3)
        From clamp to tip [length]; NaN where there are no readings, or none of a contact.
    """
    beam, tangent = readings.beam, readings.clamp_tangent
    foot = readings.values(*FOOT)
    force = readings.values(*FORCE) / beam.force_unit
    moment = readings.values(*MOMENT) / beam.moment_unit
    reach = readings.values("contact_arc_length") / beam.length
    lines = np.full((len(foot), _SHOWN + 1, 3), np.nan)
    share = np.linspace(0, 1, _SHOWN + 1)[:, None]
    free = readings.trusted & ~readings.touching
    lines[free] = foot[free, None] + share * beam.length * tangent
    bent = np.flatnonzero(readings.touching & np.isfinite(reach))
    if bent.size:
        loaded = np.minimum(reach[bent], 1.0)
        place, along, _ = integrate_rods(tangent, force[bent], moment[bent], loaded, _SHOWN)
        tip = place[:, -1:] + (1 - loaded)[:, None, None] * along[:, -1:]
        lines[bent] = foot[bent, None] + beam.length * np.concatenate([place, tip], axis=1)
    return lines
