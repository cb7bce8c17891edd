"""What varies in a study: lists, ranges and samples, each key with the values that it takes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import BaseModel, ConfigDict, Field
from scipy.stats import qmc

from analytic.problem.arrays import Floats

Value: TypeAlias = int | float | str
Parameters: TypeAlias = Mapping[str, Value]


class Range(BaseModel):
    """Values from one end to the other.

    Parameters
    ----------
    low, high : float or str
        First and last value (``from``, ``to``); a text has a unit.
    count : int, optional
        Number of values; without it the range is sampled.
    spacing : {"linear", "log"}
        Equal differences, or equal ratios.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    low: float | str = Field(alias="from")
    high: float | str = Field(alias="to")
    count: Annotated[int, Field(ge=2)] | None = None
    spacing: Literal["linear", "log"] = "linear"


class Sample(BaseModel):
    """How the ranges without a count are sampled, all together.

    Parameters
    ----------
    count : int
        Number of points.
    method : {"latin-hypercube", "random"}
        How they are drawn.
    seed : int
        The same seed draws the same points.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    count: int = Field(ge=1)
    method: Literal["latin-hypercube", "random"] = "latin-hypercube"
    seed: int = Field(default=0, ge=0)

    def draw(self, dimensions: int) -> Floats:
        """Points in the unit cube, shape (count, dimensions)."""
        if self.method == "latin-hypercube":
            return np.asarray(qmc.LatinHypercube(dimensions, rng=self.seed).random(self.count))
        return np.random.default_rng(self.seed).random((self.count, dimensions))


@dataclass(frozen=True)
class Interval:
    """A range whose ends are numbers, in the units that the case ends up in."""

    low: float
    high: float
    log: bool
    whole: bool

    def at(self, fraction: Floats) -> list[Value]:
        """Values at fractions of the way from one end to the other, shape (n,)."""
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
    """Parameters that advance together, and every point that they take.

    Parameters
    ----------
    keys : tuple of str
        Dotted keys of the case file; one, or several that are zipped or sampled together.
    points : tuple of tuple
        One value for each key; each point once.
    """

    keys: tuple[str, ...]
    points: tuple[tuple[Value, ...], ...]

    @classmethod
    def of(cls, columns: Mapping[str, Sequence[Value]]) -> "Axis":
        """The axis that takes the values of all `columns` row by row; a repeated row counts once.

        Rounding to whole numbers is what repeats them.
        """
        return cls(tuple(columns), tuple(dict.fromkeys(zip(*columns.values(), strict=True))))


def flatten(tables: Mapping[str, Any], stop: frozenset[str] = frozenset()) -> dict[str, Any]:
    """Nested tables as one with dotted keys; a table with a key in `stop` is a value."""
    flat: dict[str, Any] = {}
    for key, value in tables.items():
        if isinstance(value, Mapping) and not stop & value.keys():
            flat |= {f"{key}.{inner}": x for inner, x in flatten(value, stop).items()}
        else:
            flat[key] = value
    return flat


def nest(flat: Mapping[str, Any]) -> dict[str, Any]:
    """The reverse of `flatten`."""
    tables: dict[str, Any] = {}
    for key, value in flat.items():
        *outer, last = key.split(".")
        table = tables
        for name in outer:
            table = table.setdefault(name, {})
        table[last] = value
    return tables
