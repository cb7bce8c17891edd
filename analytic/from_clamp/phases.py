"""Contact phases from the clamp readings alone, each judged by what noise makes of it."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from analytic.from_clamp.contact import LONGEST, UNLOADED, SweptVibrissa, as_upright, dimensionless
from analytic.from_clamp.noise import (
    MEDIAN_OF_NORMAL,
    SIGMAS,
    checked_noise,
    largest,
    reading_noise,
    resting_noise,
)
from analytic.numerics.arrays import Booleans, Floats, Words
from analytic.problem.columns import CLAMP_READINGS, units
from analytic.problem.readings import Readings

_BEYOND_TIP = -0.1  # what lies farther beyond the tip is not located
_UNKNOWN = 1e-3  # of the largest magnitude; too few stations show no noise: alike in all readings
_STEP = 0.05  # of the largest magnitude, at most, for a derivative
_SHORT = 0.1  # L; a contact that is clearly short of the tip by more is not at it
# An unstated coefficient of friction of 1 leaves a criterion of sin(45 degrees) in Phase B, other
# vibrissae than the stated one less: what clearly has more is not tangential.
_OBLIQUE = 0.7
_MODEL = 0.03  # as far as a coarse beam's error moves either condition
_UNRESOLVED = 0.1  # standard deviations; what meets its phase's condition better shows no noise


class Judgement(NamedTuple):
    """Phases of one sweep, and what they were decided by; arrays of shape (stations,)."""

    phase: Words  # ``"free"``, ``"tip"``, ``"tangent"``
    # (2 F_y - M^2)/(2 f) = sin(phi_1 - alpha) of eq. 26, and what it becomes with friction, an
    # elastic clamp and a natural curvature (`SweptVibrissa`): zero in Phase B.
    criterion: Floats
    criterion_tolerance: Floats  # its standard deviation
    shortfall: Floats  # 1 - s1/L: zero in Phase A
    shortfall_tolerance: Floats  # its standard deviation

    @property
    def neither(self) -> Booleans:
        """Whether the contact is neither at the tip nor tangential, shape (stations,)."""
        oblique = np.maximum(_OBLIQUE, SIGMAS * self.criterion_tolerance)
        short = _short_of_tip(self.shortfall, self.shortfall_tolerance)
        return np.asarray(short & (np.abs(self.criterion) > oblique))

    @property
    def explained(self) -> Booleans:
        """Whether noise, or a model's error, explains all that is missed of a phase's condition."""
        at_tip = np.maximum(_MODEL, SIGMAS * self.shortfall_tolerance)
        parallel = np.maximum(_MODEL, SIGMAS * self.criterion_tolerance)
        tangent = (self.shortfall > 0) & (np.abs(self.criterion) <= parallel)
        return np.asarray((np.abs(self.shortfall) <= at_tip) | tangent)


@np.errstate(divide="ignore", over="ignore", invalid="ignore")  # next to no load: no contact
def judge_phases(readings: Readings, noise: Mapping[str, float] | None = None) -> Judgement:
    """Decide each station's phase by which phase's own condition its readings meet better.

    In Phase B the criterion (26) vanishes and the contact lies short of the tip; in Phase A it is
    the other way round. Each deviation is measured in standard deviations, which the noise of the
    readings gives; the smaller one wins. So no tolerance has to be chosen, and readings that are
    all a little off, as a coarse beam's are, still fall on the right side. Only a contact that is
    short of the tip by more than a tenth of the length, and by more than noise explains, is never
    taken to be at it.

    The noise is what the readings themselves show (`reading_noise`, `resting_noise`), and what is
    stated if that is more. Stations that lie too far apart seem to jump; but then their readings
    meet the conditions far better than such noise allows, and no contact is taken for none. Nor is
    it where stations without contact show no noise at all, as a simulator's, whose readings may
    jump amid contact.
    """
    if readings.running != "foot_x":
        leftward = readings.mirrored() if readings.runs_right else readings
        return judge_phases(as_upright(leftward), noise)
    sensed = dimensionless(readings)
    _, force_x, force_y, moment = sensed
    seen = np.array(list(reading_noise(readings).values()))
    given = {} if noise is None else checked_noise(noise)
    stated = np.array([given.get(name, 0.0) for name in CLAMP_READINGS])
    unit = units(readings.beam, CLAMP_READINGS)
    magnitudes = np.array([largest(values) for values in sensed[1:]])
    seen, stated = resting_noise(sensed[1:, readings.trusted], seen / unit), stated / unit
    known = np.maximum(seen, stated)
    noise_x, noise_y, noise_m = known if known.any() else _UNKNOWN * magnitudes

    trusted, f = readings.trusted, np.hypot(force_x, force_y)
    felt = f > UNLOADED
    held = SweptVibrissa.of(readings)
    # What each reading's noise does, all in one solution: the readings, and each of them moved.
    noises = np.array([noise_x, noise_y, noise_m])
    step = np.where(noises > 0, np.minimum(1.0, _STEP * magnitudes / noises), 1.0)[:, None]
    every = np.repeat(sensed[:, None], 4, axis=1)
    every[[1, 2, 3], [1, 2, 3]] += step * noises[:, None]
    touching = np.where(np.hypot(every[1], every[2]) > UNLOADED, every, np.nan)
    arc_length, criteria = held.arc_length_and_criterion(touching)
    shortfalls, criterion = _shortfall(arc_length), criteria[0]
    shortfall = shortfalls[0]
    shortfall_tolerance = _spread(shortfalls, step)
    if held.plain:
        by_x = criterion * force_x / f**2
        by_y = 1 / f - criterion * force_y / f**2
        by_m = moment / f
        criterion_tolerance = np.sqrt(
            (by_x * noise_x) ** 2 + (by_y * noise_y) ** 2 + (by_m * noise_m) ** 2
        )
    else:
        criterion_tolerance = _spread(criteria, step)

    of_criterion = np.abs(criterion) / criterion_tolerance
    of_shortfall = np.abs(shortfall) / shortfall_tolerance
    better = np.fmin(of_criterion, of_shortfall)[felt & trusted]
    better = better[~np.isnan(better)]
    met = float(np.median(better)) / MEDIAN_OF_NORMAL if better.size else 1.0
    drowning = np.maximum(stated, seen * (met if met < _UNRESOLVED else 1.0))
    least = max(SIGMAS * np.hypot(*drowning[:2]), UNLOADED)
    if _silent(f[trusted], least):
        least = max(SIGMAS * np.hypot(*stated[:2]), UNLOADED)
    loaded = f > least

    tangent = (of_criterion < of_shortfall) | _short_of_tip(shortfall, shortfall_tolerance)
    # A negative deviation belongs to neither phase: it is noise about zero, evidence for its own.
    tangent = np.where(shortfall <= 0, False, np.where(criterion <= 0, True, tangent))
    return Judgement(
        np.where(loaded, np.where(tangent, "tangent", "tip"), "free"),
        np.where(loaded, criterion, np.nan),
        np.where(loaded, criterion_tolerance, np.nan),
        np.where(loaded, shortfall, np.nan),
        np.where(loaded, shortfall_tolerance, 0.0),
    )


def beyond_one_contact(readings: Readings, noise: Mapping[str, float] | None = None) -> Floats:
    """How badly one contact explains each station: above 4, it touches in two places.

    One contact is at the tip, or tangential: force and moment then meet one of two conditions. Of
    two contacts they meet neither, by 1e-3 to 1e-2 if the vibrissa is curved towards the object.

    In standard deviations of what the noise makes of what the better condition misses; NaN where no
    force acts.
    """
    judged = judge_phases(readings, noise)
    with np.errstate(divide="ignore", invalid="ignore"):
        by_slope = np.abs(judged.criterion) / judged.criterion_tolerance
        by_length = np.abs(judged.shortfall) / judged.shortfall_tolerance
    return np.where(judged.shortfall == 0, 0.0, np.fmin(by_slope, by_length))


def _shortfall(arc_length: Floats) -> Floats:
    """NaN where no elastica has such readings; a contact beyond the tip is short by less than 0."""
    short = np.where(arc_length >= 0, 1 - arc_length, np.nan)
    return np.where(arc_length > LONGEST, _BEYOND_TIP, short)


def _silent(force: Floats, least: float) -> bool:
    """Whether readings have no noise without a contact: what jumps amid contact hides no touch.

    The forces that seem too small are then nothing at all, but for a few next to the contact: of a
    noisy sensor some would be nothing on both sides of some that are not.
    """
    force = force[np.isfinite(force)]
    nothing = force <= UNLOADED
    felt = np.flatnonzero(~nothing)
    between = felt.size > 0 and bool(nothing[felt[0] : felt[-1] + 1].any())
    return not between and 2 * int(nothing.sum()) > int((force <= least).sum())


def _short_of_tip(shortfall: Floats, tolerance: Floats) -> Booleans:
    """Whether contacts are so far from the tip that nothing else than another place explains it."""
    return np.asarray(shortfall > np.maximum(_SHORT, SIGMAS * tolerance))


def _spread(of: Floats, step: Floats) -> Floats:
    """Standard deviation of what is given for the readings and for each of three moved."""
    return np.asarray(np.sqrt((np.nan_to_num((of[1:] - of[0]) / step) ** 2).sum(axis=0)))
