"""What may be uncertain, the inputs of a case and measured readings, and what a user states."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias, get_args

import numpy as np

from analytic import CLAMP_READINGS, Case, InputError
from analytic.numerics.arrays import Floats
from analytic.problem.errors import unknown
from analytic.problem.numbers import within
from analytic.problem.quantities import QUANTITIES

GAINS = tuple(f"gain_{name}" for name in CLAMP_READINGS)
"""Of each reading's sensor, relative: its calibration."""

INPUTS = {name: one for name, one in QUANTITIES.items() if name != "clamp_compliance"}
"""By name; of a clamp it is the stiffness that is stated."""


def nominal(case: Case, name: str) -> float:
    """An input's value in a case; not finite if the case has no such number."""
    if name == "tip_radius" and case.beam.tip_radius is None:
        return math.nan
    return INPUTS[name].value(case)


def possible(case: Case, name: str, error: float) -> float:
    """An input's error that it can have: what would be negative has the other sign.

    So friction that is 0 by the case and uncertain is at most as large as stated.
    """
    if name in GAINS or not INPUTS[name].positive:
        return error
    value = nominal(case, name)
    return abs(value + error) - value


Distribution: TypeAlias = Literal["normal", "uniform"]

NAMES = (*INPUTS, *GAINS)
"""What may be uncertain: inputs of a case, and the gain of each reading's sensor."""


@dataclass(frozen=True)
class Input:
    """How well an input is known.

    Parameters
    ----------
    standard : float
        Standard uncertainty, in the unit of the case; of a gain relative to 1.
    distribution : {"normal", "uniform"}
        Of the values that the input may have.
    """

    standard: float
    distribution: Distribution = "normal"

    def __post_init__(self) -> None:
        within("standard uncertainty", self.standard, 0.0, remedy="check the units")
        if self.distribution not in get_args(Distribution):
            raise unknown("distribution", self.distribution, get_args(Distribution))

    @classmethod
    def within(cls, half_width: float) -> "Input":
        """An input that certainly lies within an interval, and nowhere in it more likely.

        The standard uncertainty is the half-width over sqrt(3): Evaluation of measurement data,
        Guide to the expression of uncertainty in measurement, JCGM 100:2008, section 4.3.7.

        Parameters
        ----------
        half_width : float
            Of the interval, in the unit of the case.

        Returns
        -------
        Input
            Uniformly distributed.
        """
        return cls(half_width / math.sqrt(3), "uniform")


@dataclass(frozen=True)
class Uncertainties:
    """All that is uncertain about a validation but its numerics.

    Parameters
    ----------
    inputs : mapping of Input
        By name, of `NAMES`.
    noise : mapping
        Standard deviation of each clamp reading's noise, in its unit. What is left out is
        estimated from the measured readings.
    correlations : tuple of (str, str, float)
        Pairs of normal inputs whose errors go together, with the coefficient of correlation.

    Raises
    ------
    InputError
        If a name is unknown, a number cannot be, or no errors can be correlated so.
    """

    inputs: Mapping[str, Input] = field(default_factory=dict)
    noise: Mapping[str, float] = field(default_factory=dict)
    correlations: tuple[tuple[str, str, float], ...] = ()

    def __post_init__(self) -> None:
        for name, one in self.inputs.items():
            if name not in NAMES:
                raise unknown(f"uncertainty.{name}", name, NAMES)
            if not isinstance(one, Input):
                raise InputError(f"uncertainty.{name}", repr(one), "an Input", "as Input(1e-3)")
        for name, size in self.noise.items():
            if name not in CLAMP_READINGS:
                raise unknown(f"uncertainty.noise.{name}", name, CLAMP_READINGS)
            within(f"uncertainty.noise.{name}", size, 0.0, remedy="check the units")
        normal = [n for n, x in self.inputs.items() if x.distribution == "normal"]
        for first, second, coefficient in self.correlations:
            if first == second or not {first, second} <= set(normal) or not -1 <= coefficient <= 1:
                what = f"[{first}, {second}, {coefficient}]"
                allowed = "two inputs with a standard uncertainty, and a number from -1 to 1"
                remedy = f"those are {', '.join(normal) or 'none'}"
                raise InputError("uncertainty.correlations", what, allowed, remedy)
        if np.linalg.eigvalsh(self.correlation).min(initial=0.0) < -1e-9:  # rounding
            given = [list(x) for x in self.correlations]
            allowed = "such that errors can have them all"
            raise InputError("uncertainty.correlations", given, allowed, "make them smaller")

    @property
    def standard(self) -> Floats:
        """Standard uncertainties of the inputs, shape (inputs,)."""
        return np.array([one.standard for one in self.inputs.values()])

    @property
    def correlation(self) -> Floats:
        """Coefficients of correlation, shape (inputs, inputs)."""
        place = {name: i for i, name in enumerate(self.inputs)}
        matrix = np.eye(len(place))
        for one, other, coefficient in self.correlations:
            matrix[place[one], place[other]] = matrix[place[other], place[one]] = coefficient
        return matrix

    def draws(self, count: int, rng: "np.random.Generator") -> Floats:
        """Errors of the inputs, as they are stated.

        Parameters
        ----------
        count : int
            How many sets.
        rng : numpy.random.Generator
            Their source.

        Returns
        -------
        array, shape (count, inputs)
            In the units of the inputs.
        """
        values, vectors = np.linalg.eigh(self.correlation)
        root = vectors * np.sqrt(np.maximum(values, 0.0))
        normal = rng.standard_normal((count, len(values))) @ root.T
        uniform = math.sqrt(3) * rng.uniform(-1, 1, normal.shape)
        flat = [one.distribution == "uniform" for one in self.inputs.values()]
        return np.asarray(np.where(flat, uniform, normal) * self.standard)
