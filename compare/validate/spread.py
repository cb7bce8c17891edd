"""A disagreement against its uncertainty, for one reading or all of them, as one number."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaincinv

from analytic.numerics.arrays import Floats

COVERED = 0.9545
"""Share of right models whose disagreement stays within the expanded uncertainty."""
# Of what stays: stations next to the snap-off count again once it is known better, and are off by
# more; without this what was stated resolved 9 of 15 validations with another height.
_LEFT = 0.85
_LEAST = 1e-3  # of an uncertainty: nobody knows anything so much better
_SURELY = 1.645  # standard deviations, one-sided, of 95 %
NOISE, NUMERICS, SECOND_ORDER = "noise", "numerics", "second order"


@dataclass(frozen=True)
class Spread:
    """What the errors of a validation make of the differences, all relative to the readings."""

    names: tuple[str, ...]  # what each mode is of; several may be of one
    # Shape (modes, differences); What one standard uncertainty of an input, or of a part of the
    # numerics, adds to every difference at once: such errors are the same at all stations.
    modes: Floats
    correlation: Floats  # shape (modes, modes); Coefficients of correlation of the modes' errors
    noise: Floats  # shape (differences,); Standard deviation of the data's noise
    # Shape (differences,); The sum of the noise's squared correlations with all of its reading: 1
    # for white noise.
    alike: Floats

    def part(self, where: slice) -> "Spread":
        noise, alike = self.noise[where], self.alike[where]
        return Spread(self.names, self.modes[:, where], self.correlation, noise, alike)

    def shares(self) -> dict[str, float]:
        """How much of the mean variance each name makes."""
        made = ((self.modes @ self.modes.T) * self.correlation).sum(axis=1)
        parts = dict.fromkeys((*self.names, NOISE), 0.0)
        for name, size in zip(self.names, made.tolist(), strict=True):
            parts[name] += size
        parts[NOISE] = float(np.sum(self.noise**2))
        total = sum(parts.values())
        return {name: part / total if total > 0 else 0.0 for name, part in parts.items()}

    def variance(self) -> Floats:
        return np.asarray(((self.correlation @ self.modes) * self.modes).sum(axis=0))

    def limits(self, scale: Mapping[str, float] | None = None) -> tuple[float, float]:
        """The rms of the differences' standard uncertainties, and the factor that expands it.

        The mean square of correlated differences is no normal number: it is spread as one of chi
        square, whose degrees of freedom follow from mean and variance (F. E. Satterthwaite, An
        approximate distribution of estimates of variance components, Biometrics Bulletin 2, 1946).
        Of one dominant input there is one degree and the factor is 2; of white noise alone it tends
        to 1. Noise that remembers has fewer degrees (Bayley and Hammersley 1946).
        """
        scale = {} if scale is None else scale
        factor = np.array([scale.get(name, 1.0) for name in self.names])
        modes = factor[:, None] * self.modes
        gram = self.correlation @ (modes @ modes.T)
        together = ((self.correlation @ modes) * modes).sum(axis=0)
        independent = (scale.get(NOISE, 1.0) * self.noise) ** 2
        trace = float(np.trace(gram) + independent.sum())
        if trace == 0:
            return 0.0, 2.0
        square = np.trace(gram @ gram) + np.sum(
            (2 * together + independent) * independent * self.alike
        )
        degrees = trace**2 / float(square)
        expand = np.sqrt(2 * gammaincinv(degrees / 2, COVERED) / degrees)
        return float(np.sqrt(trace / len(self.noise))), float(expand)

    def stays(self, error: Floats, names: Collection[str]) -> float:
        """The root mean square that differences keep, whatever errors are by these names.

        Noise adds its variance to the mean square, by chance more or less than that.
        """
        modes = self.modes[[name in names and name != SECOND_ORDER for name in self.names]].T
        left = error - modes @ np.linalg.lstsq(modes, error)[0]
        rest = float(np.mean(left**2))
        if NOISE in names:
            own = self.noise**2
            rest = max(rest - float(np.mean(own)), 0.0)
            chance = np.sqrt(np.sum((2 * own + 4 * rest) * own * self.alike)) / len(own)
            rest = max(rest - _SURELY * float(chance), 0.0)
        return float(np.sqrt(rest))

    def shrink(self, error: Floats, names: Collection[str]) -> float | None:
        """How small the uncertainties by these names have to be for an error to stand out.

        Who knows an input better corrects it, and less noise is less of the error, too: what stands
        out is what `stays`. None if that does not.
        """
        from scipy.optimize import brentq  # slow to load

        if np.sqrt(np.mean(error**2)) > np.prod(self.limits()):
            return 1.0
        stays, noise = _LEFT * self.stays(error, names), float(np.mean(self.noise**2))
        shrunk = {*names} if {*names} <= {NOISE, NUMERICS} else {*names, SECOND_ORDER}

        def beyond(factor: float) -> float:
            u_val, expand = self.limits(dict.fromkeys(shrunk, factor))
            own = factor**2 * noise if NOISE in names else 0.0
            return float((expand * u_val) ** 2 - own - stays**2)

        return None if beyond(_LEAST) >= 0 else float(brentq(beyond, _LEAST, 1.0))
