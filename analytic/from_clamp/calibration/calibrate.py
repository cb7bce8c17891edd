"""Rigidity, clamp, natural curvature, taper and friction from a sweep past a known object."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from analytic.from_clamp.calibration.best import explained_by_noise, fitted_to_noise
from analytic.from_clamp.calibration.fit import LeastSquaresFit
from analytic.from_clamp.calibration.measured import Measured, check_size
from analytic.from_clamp.calibration.separating import Undistinguished, undistinguished
from analytic.from_clamp.calibration.unknowns import LAG, UNKNOWNS, checked_unknowns
from analytic.from_clamp.correlated import NoiseFound
from analytic.from_clamp.noise import DOUBLE_SIDED_95
from analytic.from_clamp.passes import (
    Consistency,
    as_passes,
    consistency,
    left_by_noise,
)
from analytic.from_clamp.reconstruct import Doubt, doubt, reconstruct
from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.clamp_path import Sweep
from analytic.problem.errors import InputError, because, require
from analytic.problem.readings import Readings
from analytic.problem.shown import Shown
from analytic.problem.support import support_record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_ALIKE = 0.9  # correlation of two unknowns that trade off


@dataclass(frozen=True)
class Estimate:
    """A quantity with its interval.

    Parameters
    ----------
    value : float
        In the unit of the case; infinite for a rigid clamp.
    lowest, highest : float
        The true one lies between them in 95 % of all cases.
    """

    value: float
    lowest: float
    highest: float

    def __str__(self) -> str:
        return f"{self.value:.5g} ({self.lowest:.5g} to {self.highest:.5g})"


@dataclass(frozen=True, repr=False)
class Calibration(Shown):
    """What sweeps past a known object say of the vibrissa.

    Parameters
    ----------
    found : dict
        `Estimate` by unknown.
    case : Case
        The case with the values found.
    offset, lag : float
        By how much the readings' ``foot_x`` is too large, and by how much it is along the motion,
        if that was asked for [length].
    correlation : array, shape (unknowns, unknowns)
        Of the errors, of the clamp's compliance in place of its stiffness.
    stations : int
        How many the values are from.
    misfit : float
        Root mean square of what the fit leaves, over the noise: 1 if the case is right in
        everything else, less for readings without noise. If it is more, noise that remembers makes
        the intervals wider; they still miss what a wrong object does to all stations alike.
    misfit_shows : bool
        Whether the fit leaves more than chance and the noise, known to a tenth, do.
    noise : NoiseFound
        What of the noise remembers: correlation, memory and hum, of force_x, force_y, moment_z.
    judged : bool
        Whether what the fit leaves can be judged: of noise that remembers and is not stated, only
        stations off the contact show the size.
    jitter : float
        Standard deviation of the foot's place, if the readings show any [length].
    passes : Consistency or None
        Of several passes: what each alone says, of the clamp's compliance in place of its
        stiffness and over the case's units, and whether these differ by noise alone.
    scatter : dict
        Standard deviation of what each pass alone says, by unknown; empty for one pass.
    both_ways : bool
        Whether there are passes to the left and to the right, which show a lag.
    undistinguished : Undistinguished or None
        Where two unknowns trade off (correlation beyond 0.9): the direction in which all unknowns
        may be off at once, and which further sweep would narrow it.
    """

    found: dict[str, Estimate]
    case: Case
    offset: float
    lag: float
    correlation: Floats
    stations: int
    misfit: float
    misfit_shows: bool
    noise: NoiseFound
    judged: bool
    jitter: float
    passes: Consistency | None
    scatter: dict[str, float]
    both_ways: bool
    undistinguished: Undistinguished | None

    @property
    def explains(self) -> bool:
        """Whether noise alone explains what the fit leaves, and what passes differ by.

        What remembers longer than a pass may be noise only if three passes differ in it.
        """
        of_noise = left_by_noise(self.noise, self.passes, self.misfit)
        return not self.misfit_shows and of_noise and (not self.passes or self.passes.consistent)

    def _tiles(self) -> dict[str, object]:
        return {
            **self.found,
            "misfit": f"{self.misfit:.3g}{'' if self.explains else ', not explained'}",
            "stations": self.stations,
        }

    def _draw(self, figure: "Figure") -> None:
        axes = figure.subplots(1, len(self.found), squeeze=False)[0]
        for ax, (name, one) in zip(axes, self.found.items(), strict=True):
            ends = [end for end in (one.lowest, one.highest) if np.isfinite(end)]
            ax.plot([0] * len(ends), ends, "_-", markersize=18, label="in 95 % of all cases")
            ax.plot(0, one.value, "o", color="black")
            ax.set(title=name, xticks=[])
        axes[0].legend(fontsize="small")


def calibrate(
    readings: Readings | Sequence[Readings],
    case: Case,
    unknowns: Sequence[str] = ("flexural_rigidity",),
    noise: Mapping[str, float] | None = None,
) -> Calibration:
    """Numbers of a vibrissa, its clamp or its friction, from sweeps past a known object.

    The closed form's readings are fitted to the measured ones by least squares, each weighed by its
    noise, over the stations under load; not next to the snap-off, where readings grow without
    bound. The intervals are those of the linearised fit, for noise that may remember
    (`analytic.from_clamp.correlated`), with the zero of each reading known as well as the free
    stretches of a rig's pass say, else to 0.1 % of its largest magnitude, and the foot's jitter,
    if it shows. Of several passes each has a zero of its own, and
    a slope of it over the pass, known as well.

    Parameters
    ----------
    readings : Readings, or a sequence of them
        The four sensed columns are used, in the case's units, and ``status`` to leave stations out.
        Several are passes of one rig, in either direction; their values are pooled.
    case : Case
        The object and all that is known of the vibrissa. What is unknown is first tried as it is
        there. Its stations do not matter.
    unknowns : sequence of str
        Some of ``flexural_rigidity`` (at the clamp), ``length``, ``clamp_stiffness``,
        ``clamp_angle``, ``natural_curvature``, ``tip_radius`` (of a cone whose rigidity follows
        it), ``friction``, ``offset``, by how much ``foot_x`` is too large, and ``lag``, by how much
        it is along the motion: how far the foot goes until a reading is there. That takes passes
        both ways.
    noise : mapping, optional
        Standard deviation of each sensed column's noise, in the column's unit. If it is not given,
        it is what the readings themselves show.

    Returns
    -------
    Calibration
        Values, intervals, and the case with the values.

    Raises
    ------
    InputError
        If an unknown is none, or none of the case's numbers, the noise is no such mapping, too few
        stations are under load, the readings do not distinguish the unknowns, are of no such
        vibrissa, or of different ones.
    """
    passes = as_passes(readings)
    require("case", case, Case, "named_case('catenary') makes one")
    case.require_sweep("a calibration")
    for one in passes:
        one.require_sweep("a calibration")
    names = checked_unknowns(unknowns, case)
    for one in passes:
        check_size(one, case.beam)
    measured = Measured.of(passes, case.support.carried(case.beam), noise, len(names))
    if LAG in names and len(set(measured.ways)) < 2:
        remedy = "leave it out, or take passes to the other side, too"
        raise InputError("unknowns", "lag", "of passes to the left and to the right", remedy)
    direction = measured.ways[0]
    if direction != case.sweep.direction:
        case = replace(case, sweep=Sweep(case.sweep.stations, direction=direction))
    kinds = [UNKNOWNS[name] for name in names]
    fit = LeastSquaresFit(measured, case, kinds)
    try:
        fit, numbers, misfit, known = fitted_to_noise(fit, noise is not None)
        for kind, number in zip(kinds, numbers.tolist(), strict=True):
            if kind.is_no_such(number):
                value = f"{kind.value(fit.sought(numbers)):g}"
                remedy = "the object, the units or something else of the case is not as stated"
                raise InputError(f"{kind.called} of the best fit", value, "a vibrissa's", remedy)
        covariance = known.covariance
        deviations = np.sqrt(np.diag(covariance))
        correlation = covariance / np.outer(deviations, deviations)
        hidden = None
        if np.abs(correlation - np.eye(len(names))).max() > _ALIKE:
            hidden = undistinguished(fit, numbers, covariance)
        for i, number in enumerate(numbers.tolist()):
            if not DOUBLE_SIDED_95 * deviations[i] <= kinds[i].widest * max(1.0, abs(number)):
                raise _not_distinguished(names, covariance, i, hidden)
    except InputError as error:
        if (why := doubt_of_case(passes[0], case)) is None:
            raise
        raise because(error, str(why)) from error
    sought = fit.sought(numbers)
    alike = consistency(known.by_pass, known.alike) if len(passes) > 1 else None

    def intervals(halves: Floats) -> dict[str, Estimate]:
        return {
            name: _interval(fit, numbers, i, float(half))
            for i, (name, half) in enumerate(zip(names, halves, strict=True))
        }

    scattered = {} if alike is None else intervals(alike.scatter)
    calibration = Calibration(
        intervals(DOUBLE_SIDED_95 * deviations),
        sought.case,
        sought.offset,
        sought.lag,
        correlation,
        len(fit.measured.foot_x),
        misfit,
        not explained_by_noise(misfit, fit.freedom, fit.measured.vague),
        known.noise,
        known.noise.judged_by(fit.measured.rests),
        fit.measured.jitter,
        alike,
        {name: (one.highest - one.lowest) / 2 for name, one in scattered.items() if name != LAG},
        len(set(measured.ways)) > 1,
        hidden,
    )
    if not calibration.explains:
        why = doubt_of_case(passes[0], case)
        if why is not None and why.mistakes:
            best = f"{misfit:.2g} times the noise away from the best fit"
            raise InputError("readings", best, "those of a vibrissa past an object", str(why))
    return calibration


def doubt_of_case(readings: Readings, case: Case) -> Doubt | None:
    """What may be mistaken in readings that are of no vibrissa as the case has, past any object."""
    held = {**readings.provenance, "support": {}, **support_record(case.support)}
    of_case = replace(readings, beam=case.beam, provenance=held)
    return doubt(reconstruct(of_case), of_case, unsure=True)


def _not_distinguished(
    names: tuple[str, ...], covariance: Floats, which: int, hidden: Undistinguished | None
) -> InputError:
    """The error for unknowns of which the readings say too little."""
    sizes = np.sqrt(np.diag(covariance))
    alike = np.abs(covariance[which] / sizes / sizes[which])
    alike[which] = 0
    other = int(np.argmax(alike))
    if alike[other] < _ALIKE:
        remedy = "leave it out, take less noise, or sweep further"
        allowed = "something that these readings determine"
        return InputError("unknowns", names[which], allowed, remedy)
    undone = f"a change of one undoes that of the other (correlation {alike[other]:.4f})"
    more = "" if hidden is None else f" ({'; '.join(hidden.said())})"
    remedy = f"{undone}: state one of them, take less noise, or sweep further{more}"
    both, allowed = f"{names[which]} and {names[other]}", "ones that these readings distinguish"
    return InputError("unknowns", both, allowed, remedy)


def _interval(fit: LeastSquaresFit, numbers: Floats, i: int, half: float) -> Estimate:
    kind = fit.unknowns[i]
    ends = []
    for number in (numbers[i] - half, numbers[i] + half):
        moved = numbers.copy()
        moved[i] = np.clip(number, kind.lowest, kind.highest)
        ends.append(kind.value(fit.sought(moved)))
    return Estimate(kind.value(fit.sought(numbers)), min(ends), max(ends))
