"""A disagreement against its uncertainty, for one reading or all of them, as one number."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaincinv

from analytic.problem.arrays import Floats

COVERED = 0.9545
"""Share of right models whose disagreement stays within the expanded uncertainty."""
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

    def shrink(self, error: float, name: str) -> float | None:
        """How small an uncertainty has to be for an error to stand out."""
        from scipy.optimize import brentq  # slow to load

        def beyond(factor: float) -> float:
            with_it = {} if name in (NOISE, NUMERICS) else {SECOND_ORDER: factor}
            u_val, expand = self.limits({name: factor, **with_it})
            return expand * u_val - error

        if beyond(1.0) < 0:
            return 1.0
        return None if beyond(0.0) >= 0 else float(brentq(beyond, 0.0, 1.0))
