"""Least squares: the numbers with which the closed form comes nearest to a sweep's readings."""

import numpy as np
from scipy.optimize import least_squares

from analytic.from_clamp.calibration.expected import Expected, expected_readings
from analytic.from_clamp.calibration.measured import Measured
from analytic.from_clamp.calibration.unknowns import UNKNOWNS, Sought
from analytic.problem.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.errors import InputError

_STEP = 1e-5  # of a number, for a derivative; the solver's 1e-11 must not matter
_SETTLED = 1e-8  # relative, of the sum of squares and of the numbers: far below any noise
_AN_END = 1e-9  # a fit that stays inside comes so near to an end that is best
_MOST_SWEEPS = 40  # of a fit, without those for derivatives


class LeastSquaresFit:
    """The sum of squares over some unknowns, each station weighed by its noise.

    Noise of the foot position moves all three readings of its station along their slopes over the
    foot position; both enter the station's covariance.
    """

    def __init__(self, measured: Measured, given: Case, names: tuple[str, ...]) -> None:
        self.measured, self.given, self.names = measured, given, names
        self.kinds = [UNKNOWNS[name] for name in names]
        self.lowest = np.array([kind.lowest for kind in self.kinds])
        self.highest = np.array([kind.highest for kind in self.kinds])
        self.start = np.array([kind.now(Sought(given), given) for kind in self.kinds])
        self.whitening = np.asarray(np.linalg.inv(self._root(measured.readings)), dtype=float)
        self._last: tuple[Floats, Expected | None] = np.empty(0), None

    def sought(self, numbers: Floats) -> Sought:
        """The vibrissa with these numbers."""
        found = Sought(self.given)
        for kind, number in zip(self.kinds, numbers.tolist(), strict=True):
            found = kind.tried(found, self.given, number)
        return found

    def expected(self, numbers: Floats) -> Floats:
        """The readings that these numbers make one expect."""
        found = self._solved(numbers)
        return np.full_like(self.measured.readings, np.nan) if found is None else found.readings

    def misses(self, numbers: Floats) -> Floats:
        """What they differ from the measured ones by, over the noise."""
        return self._missed(self.expected(numbers))

    def jacobian(self, numbers: Floats) -> Floats:
        """Derivatives of the misses."""
        found = self._solved(numbers)
        columns = np.zeros((self.measured.readings.size, len(numbers)))
        if found is None:
            return columns
        here = self._missed(found.readings)
        for i, number in enumerate(numbers.tolist()):
            step = _STEP if number + _STEP <= self.highest[i] else -_STEP
            moved = numbers.copy()
            moved[i] = number + step
            sought = self.sought(moved)
            beside = found.beside(sought.case, self.measured.foot_x - sought.offset)
            columns[:, i] = (self._missed(beside) - here) / step
        return columns

    def scaled_rigidity(self, numbers: Floats) -> Floats:
        """The same with the rigidity that fits best if nothing else depended on it."""
        if "flexural_rigidity" not in self.names:
            return numbers
        zero = np.einsum("nij,jn->ni", self.whitening, -self.measured.readings).ravel()
        model = self.misses(numbers) - zero
        if not model.any():
            return numbers
        i = self.names.index("flexural_rigidity")
        factor = float(-(model @ zero) / (model @ model))
        scaled = numbers.copy()
        scaled[i] = np.clip(numbers[i] * factor, 2 * self.lowest[i], self.highest[i] / 2)
        return scaled

    def best_from(self, numbers: Floats) -> tuple[Floats, float]:
        """Least squares."""
        with np.errstate(divide="ignore", invalid="ignore"):  # where nothing touches, no slope
            found = least_squares(
                self.misses,
                numbers,
                self.jacobian,
                bounds=(self.lowest, self.highest),
                x_scale="jac",
                ftol=_SETTLED,
                xtol=_SETTLED,
                gtol=None,
                max_nfev=_MOST_SWEEPS,
            )
        numbers = np.where(found.x - self.lowest < _AN_END, self.lowest, found.x)
        return numbers, 2 * float(found.cost)

    def _solved(self, numbers: Floats) -> Expected | None:
        """The sweep of the vibrissa with these numbers; None if there is no such sweep."""
        before, found = self._last  # derivatives are asked for where the misses were
        if not np.array_equal(before, numbers):
            try:
                found = self._swept(numbers, before, found)
            except (InputError, ArithmeticError):
                found = None
            self._last = numbers.copy(), found
        return found

    def _swept(self, numbers: Floats, before: Floats, known: Expected | None) -> Expected:
        """The sweep, or the one before if that differs by the rigidity of the vibrissa alone."""
        sought, other = self.sought(numbers), np.array(self.names) != "flexural_rigidity"
        rigid = np.isinf(sought.case.clamp_stiffness)
        if known is not None and rigid and np.array_equal(numbers[other], before[other]):
            rigidity = sought.case.beam.base_rigidity
            return known.scaled(sought.case, rigidity / known.case.beam.base_rigidity)
        return expected_readings(sought.case, self.measured.foot_x - sought.offset)

    def _missed(self, found: Floats) -> Floats:
        known = np.asarray(np.isfinite(found).all(axis=0))
        order = np.arange(len(known))
        if known.any():
            found = np.stack([np.interp(order, order[known], row[known]) for row in found])
        else:
            found = np.zeros_like(found)
        missed = found - self.measured.readings
        return np.asarray(np.einsum("nij,jn->ni", self.whitening, missed).ravel())

    def _root(self, readings: Floats) -> Floats:
        """Root of the covariance of each station's three readings, shape (n, 3, 3)."""
        foot, *sizes = self.measured.spread
        slopes = np.gradient(readings, axis=1) / np.gradient(self.measured.foot_x)
        moved = foot * slopes.T
        covariance = np.diag(np.square(sizes)) + moved[:, :, None] * moved[:, None, :]
        return np.linalg.cholesky(covariance)
