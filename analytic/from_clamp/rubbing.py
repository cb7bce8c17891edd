"""The friction coefficient from the clamp: Phase B shows it at every station."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from analytic.from_clamp.contact import SweptVibrissa, dimensionless
from analytic.from_clamp.correlated import estimate
from analytic.from_clamp.noise import (
    DOUBLE_SIDED_95,
    MEDIAN_OF_NORMAL,
    SIGMAS,
    checked_noise,
    largest,
    reading_noise,
    zero_uncertainty,
)
from analytic.from_clamp.passes import Consistency, as_passes, consistency
from analytic.from_clamp.phases import Judgement, judge_phases
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.beam import Beam
from analytic.problem.columns import CLAMP_READINGS, units
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings

_BELOW = 2.0  # half intervals of 95 %: so far below zero is no chance
_FEWEST = 5  # stations of Phase B: fewer do not show how much they scatter
_ROUNDS = 4  # of phases by the coefficient and the coefficient by the phases
_CLEARLY = 5.0  # standard deviations; a contact so far short of the tip is one of Phase B
_BESIDE = 3  # stations to either side, whose variances are alike
_LEAST = 1e-9  # of the largest magnitude; readings without noise count as of so much
_STEP = 0.1  # of a standard deviation, for a derivative
_MOST = 0.999  # sine of the friction angle: 22


@dataclass(frozen=True)
class FrictionFound:
    """The friction coefficient that readings show.

    Parameters
    ----------
    coefficient : float
        Of Coulomb's friction, for the sweep's sense of sliding.
    uncertainty : float
        The true one lies within this of `coefficient` in 95 % of all cases.
    stations : int
        How many of Phase B it is from.
    passes : Consistency or None
        Of several passes, whether each alone says the same.
    """

    coefficient: float
    uncertainty: float
    stations: int
    passes: Consistency | None = None


def estimate_friction(
    readings: Readings | Sequence[Readings], noise: Mapping[str, float] | None = None
) -> FrictionFound:
    """The friction coefficient of one or more sweeps, from their stations of Phase B.

    There the vibrissa is parallel to the object, so that force and moment alone give the angle
    between the force and the contour's normal: (M^2 - 2 F_y)/(2 f) = sin(arctan(mu)) for a thin
    vibrissa that is straight at rest, on a rigid clamp. With natural curvature kappa_0, radius r
    and rotation of the clamp it is the root x = sin(arctan(mu)) of

        sin(theta) + M/f (kappa_0 - M/2) + (1 - r kappa_0) x + r^2 f x^2/2 = 0,

    theta the slope angle of the clamp's end from the force's: the energy of the pendulum whose
    moment at the contact is r f x. One that varies along its length is marched along from the clamp
    to where the moment is no more than the couple of the friction assumed, and shows there how far
    it leans from the force. Which stations are of Phase B is judged by the contact's arc
    length first, and with the coefficient that follows by both conditions.

    Parameters
    ----------
    readings : Readings, or a sequence of them
        The four sensed columns are used, ``status`` to leave stations out, and of the provenance
        the clamp's stiffness; several are passes of one rig.
    noise : mapping, optional
        Standard deviation of each sensed column's noise, in the column's unit. If it is not given,
        it is what the readings themselves show.

    Returns
    -------
    FrictionFound
        The mean, weighted by what the noise does to each station. If the stations scatter more than
        the noise explains, or alike, the uncertainty grows with that; the zero of each reading
        counts as known as in `calibrate`.

    Raises
    ------
    InputError
        If fewer than five stations are of Phase B, what comes out is clearly negative, or the noise
        is no such mapping.
    """
    passes = as_passes(readings)
    each = [_Pass.of(one, noise) for one in passes]
    spread, zero = (
        np.sqrt(np.mean([getattr(one, name) ** 2 for one in each], axis=0))
        for name in ("spread", "zero")
    )
    found = FrictionFound(0.0, np.inf, 0)
    for number in range(_ROUNDS):
        rubbing = [one.with_friction(found.coefficient) for one in passes]
        tangent = [_of_phase_b(one, noise, number == 0) for one in rubbing]
        held = [SweptVibrissa.of(one) for one in rubbing]
        kept = [one.sensed[:, there] for one, there in zip(each, tangent, strict=True)]
        found = _mean(held, kept, spread, zero)
    if found.coefficient < -_BELOW * found.uncertainty:
        what = f"{found.coefficient:.3g} +- {found.uncertainty:.2g}"
        remedy = "state the noise, of which what remembers hardly jumps; check signs and vibrissa"
        raise InputError("friction that was found", what, "0 or more", remedy)
    return found


class _Pass(NamedTuple):
    """Dimensionless readings of one pass."""

    sensed: Floats
    spread: Floats  # standard deviation of the noise, shape (3,)
    zero: Floats  # the same of each zero

    @classmethod
    def of(cls, readings: Readings, noise: Mapping[str, float] | None) -> "_Pass":
        readings.require_sweep("an estimate of the friction")
        sensed, unit = dimensionless(readings), units(readings.beam, CLAMP_READINGS)
        sizes = np.array([largest(readings.values(name)) for name in CLAMP_READINGS])
        known = reading_noise(readings) if noise is None else checked_noise(noise)
        stated = np.array([known.get(name, 0.0) for name in CLAMP_READINGS]) / unit
        spread = np.maximum(stated, [_LEAST * largest(values) for values in sensed[1:]])
        return cls(sensed, spread, zero_uncertainty(readings, sizes) / unit)


def _of_phase_b(readings: Readings, noise: Mapping[str, float] | None, first: bool) -> Booleans:
    """Stations of Phase B, at `first` by the contact's arc length alone."""
    judged = judge_phases(readings, noise)
    tangent = judged.phase == "tangent"
    if first:
        size = _shown(judged, readings.beam) if noise is None else judged.shortfall_tolerance
        tangent = judged.shortfall > _CLEARLY * size
    return np.asarray(tangent & readings.trusted, dtype=bool)


def _shown(judged: Judgement, beam: Beam) -> Floats:
    """Standard deviation of each shortfall, by what lies beyond the tip if that is more.

    Noise that remembers is more than its jumps say. A friction that is not known moves a contact,
    too, by less than the radius: that is none.
    """
    below, stated = judged.shortfall < 0, judged.shortfall_tolerance
    if not below.any():
        return stated
    moved = np.hypot(stated, beam.radius / beam.length)
    shown = np.median(-judged.shortfall[below] / moved[below]) / MEDIAN_OF_NORMAL
    return np.asarray(max(1.0, float(shown)) * stated)


def _mean(
    held: Sequence[SweptVibrissa], sensed: Sequence[Floats], spread: Floats, zero: Floats
) -> FrictionFound:
    each = [_sines(*one, spread) for one in zip(held, sensed, strict=True)]
    rows = [one.shape[1] for one in each if one.size]
    sine, deviation, *by_reading = np.concatenate(each, axis=1)
    if len(sine) < _FEWEST:
        remedy = "let the vibrissa touch along its side: a lower object, or more stations"
        raise InputError("stations of Phase B", len(sine), f"{_FEWEST} or more", remedy)
    known = estimate(
        (sine / deviation)[:, None],
        (1 / deviation)[:, None, None],
        (by_reading / deviation).T[:, None],
        zero / spread,
        least=1.0,
        rows=rows,
    )
    mean = float(np.clip(known.numbers[0], -_MOST, _MOST))
    cosine_squared = 1 - mean**2
    return FrictionFound(
        float(mean / np.sqrt(cosine_squared)),
        float(DOUBLE_SIDED_95 * np.sqrt(known.covariance[0, 0]) / cosine_squared**1.5),
        len(sine),
        consistency(known.by_pass) if len(rows) > 1 else None,
    )


def _sines(held: SweptVibrissa, sensed: Floats, spread: Floats) -> Floats:
    """Sine of a pass's stations, its deviation, and its slopes over the noise: shape (5, n)."""
    # The readings, and each of them moved by a part of its noise, all in one solution.
    every = np.repeat(sensed[:, None], 4, axis=1)
    every[[1, 2, 3], [1, 2, 3]] += _STEP * spread[:, None]
    sines = _sine(held, every)
    usable = np.isfinite(sines[0]) & (np.abs(sines[0]) < _MOST)
    if not usable.any():
        return np.empty((5, 0))
    sine, moved = sines[0, usable], sines[1:, usable]
    by_reading = np.nan_to_num((moved - sine) / _STEP)
    deviation = np.sqrt(_beside((by_reading**2).sum(axis=0)))
    # Next to no load noise that hardly jumps is taken for a contact, and says anything.
    off = np.abs(sine - np.median(sine)) / deviation
    near = off <= SIGMAS * max(1.0, float(np.median(off)) / MEDIAN_OF_NORMAL)
    return np.stack([sine, deviation, *by_reading])[:, near]


def _beside(variance: Floats) -> Floats:
    """The mean of what the stations beside each have: its own noise must not weigh it."""
    padded = np.pad(variance, _BESIDE, mode="reflect")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * _BESIDE + 1)
    return np.asarray((windows.sum(axis=1) - variance) / (2 * _BESIDE))


def _sine(held: SweptVibrissa, sensed: Floats) -> Floats:
    """Sine of the friction angle, if the station is of Phase B."""
    clamped = held.clamp_end(sensed)
    if held.vibrissa.rod is not None:
        sine = clamped.sine_at_contact(clamped.contact_arc_length())
        return np.asarray(np.sin(held.vibrissa.lean - np.arcsin(sine)))
    natural, radius = held.vibrissa.natural_curvature, held.vibrissa.radius
    force, moment = clamped.force, clamped.moment
    with np.errstate(divide="ignore", invalid="ignore"):
        constant = np.sin(clamped.theta) + moment / force * (natural - moment / 2)
        slope = 1 - radius * natural
        root = np.sqrt(slope**2 - 2 * radius**2 * force * constant)
        return np.asarray(-2 * constant / (slope + root))
