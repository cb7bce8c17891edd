"""What a study is: the tables of its file, what varies in it, and what they are once checked."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import AfterValidator, ConfigDict, Field

from analytic import CLAMP_READINGS
from analytic.numerics.arrays import Floats
from compare.read.quantities import FileName, Table, validated
from compare.read.space import SpaceFile
from compare.read.tables import CaseFile
from compare.read.toml import KeyPlace

if TYPE_CHECKING:
    from analytic import Readings
    from analytic.space import SpatialReadings


Value: TypeAlias = bool | int | float | str
MOST_RUNS = 1_000_000
"""Largest number of runs of a study: an index of so many (about 300 MB) still fits in memory."""


class Range(Table):
    # First and last value (``from``, ``to``); a text has a unit.
    low: int | float | str = Field(alias="from")
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


def between(low: float, high: float, log: bool, whole: bool, fraction: Floats) -> list[Value]:
    """Values of a range: at equal ratios if `log`, else at equal differences."""
    values = low * (high / low) ** fraction if log else low + (high - low) * fraction
    if whole:
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


class SensorNoise(Table):
    """Gaussian noise of the sensor at the clamp."""

    # Standard deviation, relative to each reading's largest magnitude.
    relative: float = Field(default=0.0, ge=0, lt=1)
    seed: int = Field(default=0, ge=0, lt=2**63)  # the row's column has 64 bits

    def add_to(self, readings: "Readings | SpatialReadings") -> "Readings | SpatialReadings":
        """Add the noise to a sweep; in space to the forces and the moments, each as one reading."""
        if self.relative == 0:
            return readings
        from analytic.space import SpatialReadings  # pandas is slow to load, a check needs none
        from analytic.space.problem.readings import FORCE, MOMENT
        from compare.sense.noise import with_noise

        if not isinstance(readings, SpatialReadings):
            return with_noise(readings, dict.fromkeys(CLAMP_READINGS, self.relative), self.seed)
        table, random = readings.table.copy(), np.random.default_rng(self.seed)
        for names in (FORCE, MOMENT):
            values = readings.values(*names)
            size = self.relative * np.nanmax(np.abs(values))
            table[[*names]] = values + size * random.normal(size=values.shape)
        return replace(readings, table=table)


def _known(name: str) -> str:
    from analytic.from_clamp.earlier import NAMES  # slow to load, and few studies name one

    if name not in NAMES:
        raise ValueError(f"a method is one of {', '.join(NAMES)}")
    return name


class Estimator(Table):
    """The method that ``reconstruction`` is recorded of."""

    # Name of a method, as `analytic.reconstruct` takes it.
    method: Annotated[str, AfterValidator(_known)] = "elastica"


Record: TypeAlias = Literal["events", "disagreement", "reconstruction"]
RECORDS: tuple[Record, ...] = ("events", "disagreement", "reconstruction")
BEAM = "mujoco.beam"
ENGINE = "engine.name"
MESHES = ("profile.file", "body.file")
COMPONENTS_OF = ("x", "y", "z")
"""Of a place or direction: ``path.tangent.x`` is a key of its own."""
# A day: no sweep of this project takes so long, and the alarm that ends a run must not overflow.
_LONGEST = 86_400.0


@dataclass(frozen=True)
class Study:
    """A study, checked.

    Parameters
    ----------
    name : str
        What files and reports call it.
    base : dict
        Dotted keys of the base case, its simulation and the noise, in SI or without units.
    axes : tuple of Axis
        Crossed with each other.
    beams : tuple of str
        MuJoCo's beams, as a further axis; without any the runs are analytic only.
    record : tuple of str
        What is computed.
    keep_readings : bool
        Whether the readings of every run are kept.
    timeout : float
        A run that takes longer is ended [s].
    case : str
        What reports call the base case.
    """

    name: str
    base: dict[str, Any]
    axes: tuple[Axis, ...]
    beams: tuple[str, ...]
    record: tuple[Record, ...]
    keep_readings: bool
    timeout: float
    case: str = "case"

    @property
    def in_space(self) -> bool:
        return "body.kind" in self.base

    @property
    def events_only(self) -> bool:
        """Whether nothing has to be swept in the plane."""
        return set(self.record) == {"events"} and not self.beams

    @property
    def recipe(self) -> "Study":
        """What all runs have in common, without what varies: small, it travels with every run."""
        return replace(self, axes=())

    @property
    def crossed(self) -> tuple[Axis, ...]:
        """All axes, that of the beams included."""
        return (*self.axes, Axis.of({BEAM: self.beams})) if self.beams else self.axes

    @property
    def engines(self) -> tuple[str, ...]:
        """The engines that sweep at rest in any of its runs; without a beam there are none."""
        if not self.beams:
            return ()
        found = {str(self.base.get(ENGINE, "mujoco"))}
        for axis in self.axes:
            if ENGINE in axis.keys:
                found = {str(point[axis.keys.index(ENGINE)]) for point in axis.points}
        return tuple(sorted(found))


class PlanarRun(CaseFile):
    noise: SensorNoise = SensorNoise()
    reconstruction: Estimator = Estimator()


class SpatialRun(SpaceFile):
    noise: SensorNoise = SensorNoise()
    reconstruction: Estimator = Estimator()


def run_of(parameters: Mapping[str, Any]) -> PlanarRun | SpatialRun:
    tables: dict[str, dict[str, Any]] = {}
    for dotted, value in parameters.items():
        name, key, *component = dotted.split(".")
        table = tables.setdefault(name, {})
        table[key] = replaced(table[key], component[0], value) if component else value
    return checked_run(tables, ".".join)


def checked_run(tables: Mapping[str, Any], place: KeyPlace) -> PlanarRun | SpatialRun:
    """The run of some tables, in space if it has a body."""
    if "body" in tables:
        return validated(SpatialRun, tables, place)
    return validated(PlanarRun, tables, place)


def replaced(values: Sequence[Any], component: str, value: object) -> list[Any]:
    """A place or direction with another component."""
    found = list(values)
    found[COMPONENTS_OF.index(component)] = value
    return found


class StudyTable(Table):
    name: FileName | None = None
    case: str | None = None
    beams: list[str] | None = None
    record: Annotated[list[Record], Field(min_length=1)] | None = None
    keep_readings: bool = False
    timeout: Annotated[float, Field(gt=0, le=_LONGEST)] = 600.0
    zip: list[list[str]] = Field(default_factory=list)


_ALIKE = ("name", "model", "tolerances", "uncertainty")  # in all runs, or in none
RUN_TABLES = tuple(
    name
    for name in dict.fromkeys((*PlanarRun.model_fields, *SpatialRun.model_fields))
    if name not in _ALIKE
)
"""Those of a run that a study may have, and vary."""


class StudyFile(Table):
    """A whole study file; those of a run are checked as those of a case file are."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, dict[str, Any]] = Field(init=False)
    study: StudyTable = StudyTable()
    axes: Annotated[dict[str, Any], Field(min_length=1)] | None = None
    sample: Sample | None = None

    @classmethod
    def keys(cls) -> list[str]:
        return [*super().keys(), *RUN_TABLES]
