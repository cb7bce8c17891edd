"""The body as a whole: that of a family which explains the clamp's six components best."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import least_squares

from analytic.from_clamp.calibration.best import explained_by_noise
from analytic.from_clamp.calibration.calibrate import Estimate
from analytic.from_clamp.calibration.measured import let_go
from analytic.from_clamp.contact import LONGEST
from analytic.from_clamp.correlated import Estimated, estimate
from analytic.from_clamp.fitted import Fitted, check_family, likeliest
from analytic.from_clamp.noise import DOUBLE_SIDED_95, IDLE, MEDIAN_OF_NORMAL
from analytic.from_clamp.passes import left_by_noise
from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.errors import InputError
from analytic.space.from_clamp.families import Family, families
from analytic.space.from_clamp.reconstruct import (
    COMPONENTS,
    ClampInSpace,
    component_noise,
    felt,
    least_force,
    of_one_vibrissa,
    over_units,
)
from analytic.space.problem.bodies.body import Body, across
from analytic.space.problem.readings import SpatialReadings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BODY_FAMILIES = ("sphere", "ellipsoid", "cylinder")
_FEWEST = 8  # contacts of each sweep: two more than an ellipsoid has numbers
_LEAST = 1e-9  # of the largest force or moment; readings without noise count as of so much
_ZERO = 1e-3  # of the same: what a sensor's zero is known to
_FAINT = 0.02  # of the largest force: where a zero that drifts looks like a contact
_CLEAR = 4.0  # standard deviations between a contact at the tip and one before it
_NEAR = 0.05  # L; noise that moves a contact farther is not where readings are linear in it
_BESIDE_SLIP_OFF = 0.02  # of the loaded stations: readings grow without bound there
_STEP = 1e-6  # of a component or a number, for a derivative
_FARTHEST = 8.0  # standard deviations that readings are off: not where it is linearised
_ROUNDS, _SETTLED = 60, 1e-10  # of Gauss and Newton's method; over L
_OFF = 0.03  # L; contacts that are farther off count for less
_KNOWN_TO = 0.5  # L; a length that is known to less is not determined


@dataclass(frozen=True, repr=False, kw_only=True)
class FittedBody(Fitted):
    """A body of a family, as sweeps past it show it, with what each `Fitted` has.

    What is found of an axis are the components of its unit vector.

    Parameters
    ----------
    body : Body
        The body.
    """

    body: Body

    def _draw(self, figure: "Figure") -> None:
        ax = figure.subplots()
        names = list(self.found)
        ends = [(one.value - one.lowest, one.highest - one.value) for one in self.found.values()]
        values = [one.value for one in self.found.values()]
        ax.errorbar(values, names, xerr=np.transpose(ends), fmt="o", capsize=3)
        ax.set(title=self.family, xlabel="value, and where it lies in 95 % of all cases")


class _Contacts(NamedTuple):
    """The stations of one pass that count, and on which side of the tip's release they are."""

    clamp: ClampInSpace
    places: Integers  # which of all they are
    tip: Booleans
    sides: Floats  # two unit vectors across the normal, shape (n, 2, 3)
    spread: Floats  # standard deviation of the six components, shape (6,)
    rests: int | None  # stations behind the contact; None if the noise is stated

    def constraints(self, readings: Floats, family: Family, numbers: Floats) -> Floats:
        """What vanishes if a vibrissa has such readings on such a body, shape (n, 6).

        The contact is on the surface, the force along its normal, the contact at the tip or before
        it without a moment, and no moment is along the clamp's tangent or the force.
        """
        clamp = self.clamp.feeling(readings)
        found = clamp.contacts()
        points, normals = found[:3].T, found[3:6].T
        height, expected = family.surface(numbers, points)
        turned = np.einsum("nik,nk->ni", self.sides, normals - expected)
        ends = np.where(self.tip, found[6] - 1, found[7])
        twist = clamp.moment @ clamp.tangent
        along = (clamp.moment * normals).sum(axis=1)
        return np.column_stack([height, turned, ends, twist, along])

    def expected(self, family: Family, numbers: Floats, near: Floats) -> tuple[Floats, Floats]:
        """The readings on a body to first order, and their derivatives by its numbers.

        From readings near them: shapes (n, 6) and (n, 6, k).
        """
        now = self.constraints(near, family, numbers)
        sizes = _STEP * np.maximum(np.abs(near).max(axis=0), _STEP)
        by_reading = _slopes(lambda step: self.constraints(near + step, family, numbers), sizes)
        sizes = np.full(len(numbers), _STEP)
        by_number = _slopes(lambda step: self.constraints(near, family, numbers + step), sizes)
        moved = np.linalg.solve(by_reading, np.concatenate([now[:, :, None], by_number], axis=2))
        return near - moved[:, :, 0], -moved[:, :, 1:]


def fit_body(
    readings: SpatialReadings | Sequence[SpatialReadings],
    family: str = "sphere",
    noise: Mapping[str, float] | None = None,
) -> FittedBody:
    """The body of a family on which the closed form explains the clamp's readings best.

    Not the contact points are fitted but all six components, by what a straight vibrissa on such a
    body has to have: contact on its surface, force along its normal, at the tip or without a moment
    there. Intervals are of the linearised fit, for noise that may remember, and for a zero of each
    component that is known to 0.1 % of the largest force or moment.

    Parameters
    ----------
    readings : SpatialReadings, or a sequence of them
        Only the nine sensed columns are used, and status; several are sweeps past one body.
    family : str
        ``"sphere"``, ``"ellipsoid"`` with its axes along x, y and z, ``"cylinder"`` without ends,
        or ``"auto"``: that of the least Schwarz criterion among those that explain the readings.
    noise : mapping, optional
        Standard deviations of the six components by name, each in its unit. If not given, they are
        what the readings themselves show.

    Returns
    -------
    FittedBody
        Parameters with intervals, and the body.

    Raises
    ------
    InputError
        If there is no such family, too few contacts, the vibrissa is not straight and uniform, or
        the readings do not determine such a body; with ``"auto"`` if no family explains them.
    """
    check_family(family, BODY_FAMILIES)
    sweeps = of_one_vibrissa(readings)
    passes = [_contacts(one, noise) for one in sweeps]
    fewest = min(len(one.tip) for one in passes)
    if fewest < _FEWEST:
        remedy = "take more stations along the body, or leave the sweep out"
        raise InputError("contacts of a sweep", fewest, f"{_FEWEST} or more", remedy)
    found = np.concatenate([one.clamp.contacts() for one in passes], axis=1)
    points, normals = found[:3].T, found[3:6].T
    known = families(points, normals)
    length, stated = sweeps[0].beam.length, noise is not None

    def fit(name: str) -> FittedBody:
        start = _through_points(known[name], points, normals)
        return _fitted(passes, known[name], start, length, stated)

    remedy = "edges, friction, or a vibrissa or clamp that is not as stated"
    return likeliest(family, BODY_FAMILIES, fit, remedy)


def _contacts(readings: SpatialReadings, noise: Mapping[str, float] | None) -> _Contacts:
    """The stations of a sweep whose contact is clearly at the tip or clearly before it."""
    seen = component_noise(readings, noise)
    clamp = ClampInSpace.of(readings)
    force = np.linalg.norm(clamp.force, axis=1)
    loaded = felt(readings, seen)
    least = least_force(readings, seen) / readings.beam.force_unit
    end = np.append(np.flatnonzero(loaded), -1)[let_go(force[loaded], least) - 1] + 1
    idle = np.abs(readings.values(*COMPONENTS)[end:])
    idle = idle[np.isfinite(idle).all(axis=1)]
    if noise is None and len(idle) >= IDLE:
        # Of noise that remembers, which hardly jumps, what is read off the body says more.
        shown = np.median(idle, axis=0) / MEDIAN_OF_NORMAL
        seen = {
            name: max(seen[name], float(size)) for name, size in zip(COMPONENTS, shown, strict=True)
        }
    spread = over_units(seen, readings.beam)
    loaded = felt(readings, seen) & (np.arange(len(force)) < end)
    on = np.flatnonzero(loaded & (force > _FAINT * force[loaded].max(initial=0.0)))
    if len(on) and on[-1] < len(readings.table) - 1:  # it slips off
        on = on[: len(on) - int(np.ceil(_BESIDE_SLIP_OFF * len(on)))]
    clamp = clamp.at(on)
    largest = [np.abs(part).max(initial=0.0) for part in (clamp.force, clamp.moment)]
    spread = np.maximum(spread, _LEAST * np.repeat(largest, 3))
    found = clamp.contacts()
    variance = np.zeros((2, len(on)))
    for i, size in enumerate(spread):
        beside = clamp.feeling(clamp.components + size * np.eye(6)[i]).contacts()
        variance += (beside[6:] - found[6:]) ** 2
    reach, release = found[6:]
    before = reach < 1 - _CLEAR * np.sqrt(variance[0])
    at_tip = release > _CLEAR * np.sqrt(variance[1])
    kept = (reach >= 0) & (reach <= LONGEST) & (before | at_tip) & (variance[0] < _NEAR**2)
    rests = len(idle) if noise is None else None
    return _Contacts(
        clamp.at(kept), on[kept], ~before[kept], across(found[3:6, kept].T), spread, rests
    )


def _through_points(family: Family, points: Floats, normals: Floats) -> Floats:
    """The numbers whose body is nearest to the contacts: where the fit of the readings starts."""

    def apart(numbers: Floats) -> Floats:
        height, expected = family.surface(numbers, points)
        return np.concatenate([height, (expected - normals).ravel()])

    found = least_squares(apart, family.start, loss="soft_l1", f_scale=_OFF)
    return np.asarray(found.x)


def _fitted(
    passes: Sequence[_Contacts], family: Family, numbers: Floats, length: float, stated: bool
) -> FittedBody:
    near = [one.clamp.components for one in passes]
    measured = np.concatenate(near)
    over = np.concatenate(
        [np.broadcast_to(one.spread, one.clamp.components.shape) for one in passes]
    )

    def expected() -> tuple[Floats, Floats]:
        each = [
            one.expected(family, numbers, here) for one, here in zip(passes, near, strict=True)
        ]  # fmt: skip
        readings, slopes = (np.concatenate(both) for both in zip(*each, strict=True))
        return readings, slopes

    ends = np.cumsum([len(one) for one in near])[:-1]
    with np.errstate(all="ignore"):
        for _ in range(_ROUNDS):
            readings, slopes = expected()
            if not (np.isfinite(readings).all() and np.isfinite(slopes).all()):
                raise _undetermined(family)
            design = (slopes / over[:, :, None]).reshape(-1, len(numbers))
            left = ((measured - readings) / over).ravel()
            step = np.linalg.lstsq(design, left, rcond=None)[0]
            step *= min(1.0, _KNOWN_TO / np.abs(step).max())
            numbers = numbers + step
            moved = readings + slopes @ step
            beyond = _FARTHEST * over
            near = np.split(measured + np.clip(moved - measured, -beyond, beyond), ends)
            if np.abs(step).max() < _SETTLED:
                break
        else:
            raise _undetermined(family)
    known = _with_noise((measured - moved) / over, slopes / over[:, :, None], passes, stated)
    numbers = numbers + known.numbers
    square = float((((measured - moved) / over) ** 2).sum()) - stated * known.of_hum
    misfit = float(np.sqrt(max(square, 0.0) / (left.size - len(numbers))))
    found = _estimates(family, numbers, known.covariance, length)
    return FittedBody(
        family=family.name,
        found=found,
        body=family.body(numbers).scaled(length),
        misfit=misfit,
        explains=explained_by_noise(misfit, left.size - len(numbers))
        and left_by_noise(known.noise, None, misfit),
        by_noise=known.by_noise,
        penalty=len(numbers) * float(np.log(left.size)),
        stations=len(measured),
        noise=known.noise,
        judged=known.noise.judged_by(None if stated else sum(one.rests or 0 for one in passes)),
    )


def _with_noise(
    left: Floats, slopes: Floats, passes: Sequence[_Contacts], stated: bool
) -> Estimated:
    """What is left over the noise, explained by the numbers, by zeros, and by noise as it is."""
    zeros, known_to = [], []
    for one in passes:
        largest = [np.abs(part).max() for part in (one.clamp.force, one.clamp.moment)]
        zeros.append(np.broadcast_to(np.diag(1 / one.spread), (len(one.tip), 6, 6)))
        known_to.append(_ZERO * np.repeat(largest, 3))
    return estimate(
        left,
        slopes,
        np.concatenate(zeros),
        np.max(known_to, axis=0),
        1.0 if stated else 0.0,
        rows=[len(one.tip) for one in passes],
        since=np.concatenate([np.diff(one.places, prepend=one.places[0] - 1) for one in passes]),
    )


def _estimates(
    family: Family, numbers: Floats, covariance: Floats, length: float
) -> dict[str, Estimate]:
    """What is reported of the body, with intervals, in the unit of the readings."""
    found = {}
    slopes = _slopes(
        lambda step: np.array([*family.reported(numbers + step).values()]),
        np.full(len(numbers), _STEP),
    )
    for (name, value), slope in zip(family.reported(numbers).items(), slopes, strict=True):
        half = DOUBLE_SIDED_95 * float(np.sqrt(slope @ covariance @ slope))
        if not half < _KNOWN_TO:
            raise _undetermined(family)
        unit = 1.0 if name.startswith("axis") else length
        found[name] = Estimate(*(unit * x for x in (value, value - half, value + half)))
    return found


def _slopes(function: Callable[[Floats], Floats], sizes: Floats) -> Floats:
    """Derivatives by central differences, the last axis by what the steps are along."""
    steps = zip(np.diag(sizes), sizes, strict=True)
    changes = [(function(step) - function(-step)) / (2 * size) for step, size in steps]
    return np.stack(changes, axis=-1)


def _undetermined(family: Family) -> InputError:
    remedy = "sweep along other lines past it, too, or fit a simpler family"
    return InputError("family", family.name, "one that these readings determine", remedy)
