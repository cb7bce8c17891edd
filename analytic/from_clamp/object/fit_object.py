"""The object as a whole: the contour of a family that explains the clamp's readings best."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from analytic.from_clamp.calibration.best import (
    as_likely_by,
    explained_by_noise,
    fitted_to_noise,
)
from analytic.from_clamp.calibration.calibrate import Estimate
from analytic.from_clamp.calibration.fit import LeastSquaresFit
from analytic.from_clamp.calibration.measured import Measured, check_size
from analytic.from_clamp.calibration.unknowns import LAG, UNKNOWNS, Family, Unknown
from analytic.from_clamp.correlated import Estimated
from analytic.from_clamp.fitted import Fitted, NoFamilyError, check_family, likeliest
from analytic.from_clamp.noise import DOUBLE_SIDED_95
from analytic.from_clamp.object.families import families
from analytic.from_clamp.passes import Consistency, as_passes, consistency, left_by_noise
from analytic.from_clamp.reconstruct import reconstruct, require_beam
from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.clamp_path import Sweep
from analytic.problem.contours.families import circle
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FAMILIES = ("circle", "ellipse", "superellipse", "convex")
_FEWEST = 8  # contact points
_WIDER = 1.0, 2.0, 4.0  # circles than that through points, from which a fit starts
_BAND = 181  # points of the band
_STEP = 1e-5  # of a number, for a derivative
_Fit: TypeAlias = tuple[LeastSquaresFit, Floats, float, Estimated]


@dataclass(frozen=True, repr=False, kw_only=True)
class FittedObject(Fitted):
    """An object of a family, as sweeps past it show it, with what each `Fitted` has.

    Parameters
    ----------
    case : Case
        The vibrissa of the readings, past this object.
    band : dict of array, shape (n,)
        The contour over the slope angles that are touched: ``slope_angle`` [rad], ``x``, ``y``, and
        ``half_width`` along the normal [length], within which the true one is in 95 % of all cases.
    passes : Consistency or None
        Of several passes, whether each alone says the same.
    """

    case: Case
    band: dict[str, Floats]
    passes: Consistency | None

    def _draw(self, figure: "Figure") -> None:
        ax = figure.subplots()
        x, y, half, angle = (self.band[n] for n in ("x", "y", "half_width", "slope_angle"))
        along, up = half * np.sin(angle), half * np.cos(angle)
        ax.fill(
            np.append(x + along, (x - along)[::-1]), np.append(y - up, (y + up)[::-1]), alpha=0.3
        )
        ax.plot(x, y)
        ax.set(aspect="equal", xlabel="x", ylabel="y", title=self.family)


def fit_object(
    readings: Readings | Sequence[Readings],
    family: str = "circle",
    noise: Mapping[str, float] | None = None,
    beside: Sequence[str] = (),
) -> FittedObject:
    """The object of a family whose closed form explains the clamp's readings best.

    Not the contact points are fitted but the readings, by the equations of the sweep: these know
    which phase each station is in and that a contact at the tip has no freedom, so noise makes no
    second phase and no points off the contour. The contact points of `reconstruct` are where the
    search starts. Intervals are of the linearised fit, for noise that may remember, as those of
    `calibrate`.

    Parameters
    ----------
    readings : Readings, or a sequence of them
        Only the four sensed columns are used; several are passes of one rig past one object.
    family : str
        ``"circle"``, ``"ellipse"`` with its axes along x and y, ``"superellipse"`` with an
        exponent, ``"convex"``, of any radius of curvature along the contour, or ``"auto"``: that
        of the least Schwarz criterion among those that explain the readings.
    noise : mapping, optional
        Standard deviation of each sensed column's noise, in the column's unit. If it is not given,
        it is what the readings themselves show.
    beside : sequence of str, optional
        What is unknown of the vibrissa, too, as ``"friction"``, by the names of `calibrate`. An
        estimate that the readings are given with is taken for exact otherwise.

    Returns
    -------
    FittedObject
        Parameters, intervals, and a band about the contour. Passes both ways have a ``lag``, too:
        how far the foot goes until a reading is there, as `calibrate` finds it.

    Raises
    ------
    InputError
        If there is no such family, too few contacts, or the readings are of no such vibrissa; with
        ``"auto"`` if no family explains them.
    """
    check_family(family, FAMILIES)
    passes = as_passes(readings)
    others = [UNKNOWNS[name] for name in (*beside, *late_if_both_ways(passes))]
    fit = families_fitted(passes, noise, others)
    return likeliest(
        family,
        FAMILIES,
        fit,
        "several objects, a corner, friction, a contact above the object's widest place, or a "
        "vibrissa or clamp that is not as stated",
    )


def late_if_both_ways(passes: Sequence[Readings]) -> tuple[str, ...]:
    """What passes both ways show of their readings, which would be misread without it."""
    return (LAG,) if len({one.runs_right for one in passes}) > 1 else ()


def families_fitted(
    passes: Sequence[Readings], noise: Mapping[str, float] | None, others: Sequence[Unknown]
) -> Callable[[str], FittedObject]:
    """The fit of each family by its name, beside some unknowns of the vibrissa and its foot."""
    x, y, angles = _contacts(passes)
    circles = _circles_through(x, y)
    known = families(angles)
    tried: dict[str, _Fit] = {}

    def fitted(name: str) -> _Fit:
        if name not in tried:
            one = known[name]
            simpler = circles
            if one.simpler:
                simpler = [fit.of_object(at) for fit, at, *_ in _some(fitted, one.simpler)]
            measured, case = _measured(passes, noise, len(one.kinds) + len(others))
            objects = [one.start(at) for at in simpler]
            fit = LeastSquaresFit(measured, case, others, one, objects)
            tried[name] = fitted_to_noise(fit, noise is not None)
        return tried[name]

    def found(name: str) -> FittedObject:
        fit, numbers, misfit, seen = fitted(name)
        given = _measured(passes, noise, 0)[0].spread
        if given[0] < fit.measured.spread[0]:  # a foot that jitters would excuse a wrong object
            seen = replace(seen, by_noise=as_likely_by(given, fit, numbers))
        return _object(known[name], fit, numbers, misfit, seen)

    return found


def _some(fitted: Callable[[str], _Fit], simpler: Sequence[str]) -> list[_Fit]:
    """The fits of the simpler families that there are."""
    found, refused = [], None
    for name in simpler:
        try:
            found.append(fitted(name))
        except InputError as error:  # as one that runs away
            refused = error
    if refused is not None and not found:
        raise refused
    return found


def _contacts(passes: Sequence[Readings]) -> tuple[Floats, Floats, Floats]:
    """Contact points and slope angles of all passes, over L."""
    tables = []
    for one in passes:
        one.require_sweep("the fit of an object")
        table = reconstruct(one)
        require_beam(table, one)
        tables.append(table[(table["status"] == "ok")])
    columns = ("contact_x", "contact_y", "contact_angle")
    x, y, angle = (np.concatenate([table[name] for table in tables]) for name in columns)
    if len(x) < _FEWEST:
        allowed = f"{_FEWEST} or more"
        raise InputError("contact points", len(x), allowed, "sweep further along the object")
    long = passes[0].beam.length
    return x / long, y / long, angle


def _circles_through(x: Floats, y: Floats) -> list[Floats]:
    """Radius and centre of circles near points, by linear least squares (Kasa 1976).

    Two rounds, the second one without points that are far off. Noise makes such a circle too small:
    wider ones with the same lowest point are as likely.
    """
    kept = np.full(len(x), True)
    for _ in range(2):
        design = np.column_stack([2 * x, 2 * y, np.ones_like(x)])[kept]
        a, b, c = np.linalg.lstsq(design, (x**2 + y**2)[kept], rcond=None)[0]
        radius = np.sqrt(max(c + a**2 + b**2, 0.0))
        off = np.abs(np.hypot(x - a, y - b) - radius)
        kept = off <= 4 * np.median(off)
    return [np.array([wide * radius, a, b + (wide - 1) * radius]) for wide in _WIDER]


def _measured(
    passes: Sequence[Readings], noise: Mapping[str, float] | None, numbers: int
) -> tuple[Measured, Case]:
    """The stations under load, and the case of the vibrissa past an object to be replaced."""
    beam, held = passes[0].beam, passes[0].support
    measured = Measured.of(passes, held.carried(beam), noise, numbers)
    case = Case(
        beam,
        circle(beam.length, (0.0, 0.5 * beam.length)),
        Sweep(direction=measured.ways[0]),
        **held._asdict(),
    )
    for one in passes:
        check_size(one, beam)
    return measured, case


def _object(
    family: Family,
    fit: LeastSquaresFit,
    numbers: Floats,
    misfit: float,
    known: Estimated,
) -> FittedObject:
    long, kinds, size = fit.given.beam.length, fit.kinds, len(family.kinds)
    deviations = np.sqrt(np.diag(known.covariance))
    found = {}
    for kind, number, deviation in zip(kinds, numbers, deviations, strict=True):
        unit = 1.0 if kind.name.startswith(("exponent", "log")) else long
        if isinstance(kind, Unknown):
            unit = kind.unit(fit.given)
        if kind.is_no_such(number):
            allowed = f"inside {unit * kind.lowest:g} to {unit * kind.highest:g}"
            remedy = f"it is no {family.name}, or the readings do not determine it"
            best = f"{kind.name} of the best {family.name}"
            raise NoFamilyError(best, f"{unit * number:g}", allowed, remedy)
        half = DOUBLE_SIDED_95 * deviation
        ends = number, number - half, number + half
        found[kind.name] = Estimate(*(float(unit * x) for x in ends))
    alike = consistency(known.by_pass, known.alike) if len(fit.measured.rows) > 1 else None
    stations = len(fit.measured.foot_x)
    data = fit.measured.readings.size
    return FittedObject(
        family=family.name,
        found=found,
        case=fit.sought(numbers).case,
        band=_band(family, fit, numbers, known.covariance[:size, :size]),
        misfit=misfit,
        explains=explained_by_noise(misfit, fit.freedom, fit.measured.vague)
        and left_by_noise(known.noise, alike, misfit),
        by_noise=known.by_noise,
        penalty=len(kinds) * float(np.log(data)),
        stations=stations,
        noise=known.noise,
        judged=known.noise.judged_by(fit.measured.rests),
        passes=alike,
    )


def _band(
    family: Family, fit: LeastSquaresFit, numbers: Floats, covariance: Floats
) -> dict[str, Floats]:
    """The contour over the angles that are touched, and how well it is known along its normal.

    Those of the fit: noise of single contacts would reach beyond them, along a flat side far.
    """
    length, angle = fit.given.beam.length, np.linspace(*fit.touched(numbers), _BAND)
    numbers = fit.of_object(numbers)

    def places(at: Floats) -> Floats:
        contour = family.profile(at)
        return np.stack(contour.place(contour.parameter(angle)))

    here = places(numbers)
    steps = _STEP * np.eye(len(numbers))
    slopes = np.stack(
        [(places(numbers + way) - places(numbers - way)) / (2 * _STEP) for way in steps]
    )
    normal = np.stack([np.sin(angle), -np.cos(angle)])
    along = np.einsum("kcn,cn->kn", slopes, normal)
    variance = np.einsum("kn,kl,ln->n", along, covariance, along)
    return {
        "slope_angle": angle,
        "x": length * here[0],
        "y": length * here[1],
        "half_width": length * (DOUBLE_SIDED_95 * np.sqrt(variance)),
    }
