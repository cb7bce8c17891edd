"""The vibrissa in space integrated from its clamp: what the closed form is checked against.

Kirchhoff's rod, isotropic and without twist: r' = t, t' = t x m, and the moment in the section is
m = M - (r - r0) x F with the clamp's force F and moment M (lengths in L, EI = 1). No elliptic
integral, no plane of bending and no normal enter.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from analytic.numerics.arrays import Floats
from analytic.problem.errors import require
from analytic.space.problem.readings import (
    CONTACT_POINT,
    FOOT,
    FORCE,
    FRICTION,
    MOMENT,
    NORMAL,
    SpatialReadings,
)

_TOLERANCE = 1e-13  # of the Dormand-Prince method of order 8
_LOADS = 4  # steps to the whole load, each the start of the next
_MISSED = 1e-11  # of the moments at the tip, relative to those at the clamp
_SHOWN = 33  # points of a loaded part that is drawn


def integrate_rod(
    tangent: Floats, force: Floats, moment: Floats, length: float, points: int = 2
) -> tuple[Floats, Floats, Floats]:
    """Places, directions and moments in the section of one rod, each of shape (points, 3)."""
    place, along, bending = integrate_rods(
        tangent, force[None], moment[None], np.array([length]), points
    )
    return place[0], along[0], bending[0]


def integrate_rods(
    tangent: Floats, force: Floats, moment: Floats, length: Floats, points: int = 2
) -> tuple[Floats, Floats, Floats]:
    """March rods from the same clamp, by its force and moment, (n, 3), to places (n, points, 3)."""
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
        angle against the surface in Phase B, of the force's direction against the normal and the
        friction recorded and, in Phase A, of what the tip points away from the body. Zero where the
        vibrissa is free, NaN where there are no readings.
    """
    beam = require("readings", readings, SpatialReadings, "as solve_space gives them").beam
    missed = np.where(readings.trusted, 0.0, np.nan)
    foot, contact = readings.values(*FOOT), readings.values(*CONTACT_POINT)
    normal = pushes = readings.values(*NORMAL)
    if set(FRICTION) <= set(readings.table):
        pushes = normal + readings.values(*FRICTION)
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
            float(np.abs(_unit(force[i]) + _unit(pushes[i])).max()),
            abs(away) if phase[i] == "tangent" else max(0.0, away),
            max(0.0, reach[i] - 1),
        )
    return missed


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))


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
    require("readings", readings, SpatialReadings, "as solve_space gives them")
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


@dataclass(frozen=True)
class Cantilever:
    """A rod that stretches, shears, bends and twists (Simo, 1985; Antman, 2005), from x = 0 on."""

    length: float  # of the parameter along it
    stretching: Floats  # compliances 1/EA, 1/GA_y, 1/GA_z
    bending: Floats  # compliances 1/GJ, 1/EI_y, 1/EI_z
    force: Floats = field(default_factory=lambda: np.zeros(3))  # dead, at the tip
    moment: Floats = field(default_factory=lambda: np.zeros(3))  # likewise
    weight: Floats = field(default_factory=lambda: np.zeros(3))  # by length
    curvature: Callable[[float], float] = lambda s: 0.0  # about z, at rest
    speed: Callable[[float], float] = lambda s: 1.0  # of arc length with the parameter
    turned: float = 0.0  # at the clamp, about z [rad]

    @property
    def largest(self) -> float:
        """Of the moments that the loads can cause."""
        across = self.force + self.length * self.weight
        return float(np.linalg.norm(across) * self.length + np.linalg.norm(self.moment))

    def march(self, moment: Floats, load: float = 1.0) -> tuple[Floats, Floats]:
        """Place of the tip and moment there, of a moment in the section at the clamp."""

        def rate(s: float, state: Floats) -> Floats:
            frame = state[3:12].reshape(3, 3)
            force = load * (self.force + (self.length - s) * self.weight)
            along = frame @ (np.eye(3)[0] + self.stretching * (frame.T @ force))
            bent = self.bending * (frame.T @ state[12:])
            bent[2] += self.curvature(s)
            turning = np.cross(frame, bent)  # each row: frame times the matrix of bent x
            rates = [along, turning.ravel(), -np.cross(along, force)]
            return np.asarray(self.speed(s) * np.concatenate(rates))

        sine, cosine = np.sin(self.turned), np.cos(self.turned)
        frame = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        begin = np.concatenate([np.zeros(3), frame.ravel(), moment])
        scale = np.ones(15)
        scale[:3], scale[12:] = self.length, self.largest
        marched = solve_ivp(
            rate, (0, self.length), begin, "DOP853", rtol=_TOLERANCE, atol=_TOLERANCE * scale
        ).y[:, -1]
        return marched[:3], marched[12:]

    def tip(self) -> Floats:
        """Where its tip rests, by shooting from the clamp; certified by the moment there."""
        scaled = np.zeros(3)
        for load in np.linspace(0, 1, _LOADS + 1)[1:]:
            found = root(self._missed, scaled, args=(load,), tol=_TOLERANCE)
            scaled = found.x
        missed = float(np.abs(found.fun).max())
        if not missed <= _MISSED:
            raise ArithmeticError(f"a rod's tip misses its moment by {missed:.1e}")
        return self.march(self.largest * scaled)[0]

    def _missed(self, scaled: Floats, load: float) -> Floats:
        """Of the tip's moment, over the loads'."""
        missed = self.march(self.largest * scaled, load)[1] - load * self.moment
        return np.asarray(missed / self.largest)
