"""What varies in a study: lists, ranges and samples, each key with the values that it takes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Literal, TypeAlias

import numpy as np
from pydantic import Field

from analytic.problem.arrays import Floats
from compare.read.quantities import Table

Value: TypeAlias = bool | int | float | str
MOST_RUNS = 1_000_000
"""Largest number of runs of a study: an index of so many (about 300 MB) still fits in memory."""


class Range(Table):
    # First and last value (``from``, ``to``); a text has a unit.
    low: int | float | str = Field(alias="from")
    # First and last value (``from``, ``to``); a text has a unit.
    high: int | float | str = Field(alias="to")
    # Number of values; without it the range is sampled.
    count: Annotated[int, Field(ge=2, le=MOST_RUNS)] | None = None
    spacing: Literal["linear", "log"] = "linear"  # equal differences, or equal ratios


class Sample(Table):
    """How the ranges without a count are sampled, all together."""

    count: int = Field(ge=1, le=MOST_RUNS)  # number of points
    method: Literal["latin-hypercube", "random"] = "latin-hypercube"  # how they are drawn
    seed: int = Field(default=0, ge=0)  # the same seed draws the same points

    def draw(self, dimensions: int) -> Floats:
        if self.method == "latin-hypercube":
            from scipy.stats import qmc  # slow to load, and few studies draw samples

            return np.asarray(qmc.LatinHypercube(dimensions, rng=self.seed).random(self.count))
        return np.random.default_rng(self.seed).random((self.count, dimensions))


@dataclass(frozen=True)
class Interval:
    """A range whose ends are numbers, in the units that the case ends up in."""

    low: float  # first and last value
    high: float  # first and last value
    log: bool  # whether equal ratios follow each other, rather than equal differences
    whole: bool  # whether its values are whole numbers

    def at(self, fraction: Floats) -> list[Value]:
        """Take values between the ends."""
        if self.log:
            values = self.low * (self.high / self.low) ** fraction
        else:
            values = self.low + (self.high - self.low) * fraction
        if self.whole:
            return [int(value) for value in np.rint(values)]
        # Twelve digits: what was written comes back as written, on every machine.
        return [float(f"{value:.12g}") for value in values]


@dataclass(frozen=True)
class Axis:
    """Parameters that advance together, and every point that they take."""

    # Dotted keys of the case file; one, or several that are zipped or sampled together.
    keys: tuple[str, ...]
    points: tuple[tuple[Value, ...], ...]  # one value for each key; each point once

    def __post_init__(self) -> None:
        if not self.points or {len(point) for point in self.points} != {len(self.keys)}:
            raise ValueError("an axis needs a point, and each point a value for each key")

    @classmethod
    def of(cls, columns: Mapping[str, Sequence[Value]]) -> "Axis":
        """Make the axis that takes the values of several columns row by row."""
        return cls(tuple(columns), tuple(dict.fromkeys(zip(*columns.values(), strict=True))))
