"""What runs have left behind in their folders."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, Field, ValidationError

from analytic import CASE_NAMES, CLAMP_READINGS, InputError
from compare.explain.suspects import Suspect


class _Beam(BaseModel):
    length: float = Field(gt=0)


class _Sweep(BaseModel):
    source: str
    beam: _Beam
    stations: int = Field(gt=0)
    provenance: dict[str, Any]


class _Disagreement(BaseModel):
    rms: float | None


class _Disagreements(BaseModel):
    force_x: _Disagreement
    force_y: _Disagreement
    moment_z: _Disagreement


class _SnapOff(BaseModel):
    difference: float | None


class _Phases(BaseModel):
    agreement: float | None


class ComparisonFile(BaseModel):
    """What the findings need of a ``comparison.json``."""

    verdict: str
    disagreement: _Disagreements
    snap_off: _SnapOff
    phases: _Phases
    candidate: _Sweep


class _Part(BaseModel):
    rms: float


class BudgetFile(BaseModel):
    """What the findings need of a ``budget.json``."""

    parts: dict[str, dict[str, _Part]]
    blame: str
    closes: bool
    undecided: bool = False  # files of older versions do not say
    order: float
    suspects: list[Suspect]


_File = TypeVar("_File", bound=BaseModel)


@dataclass(frozen=True)
class RunRecord:
    """One run: what its ``comparison.json`` and, if there is one, its ``budget.json`` hold."""

    folder: Path
    comparison: ComparisonFile
    budget: BudgetFile | None

    @property
    def _origin(self) -> dict[str, Any]:
        return self.comparison.candidate.provenance

    @property
    def case(self) -> str:
        """Name of the case."""
        return str(self._origin.get("case", self.folder.name))

    @property
    def profile(self) -> str:
        """What the object is."""
        return str(self._origin.get("profile", "contour not recorded"))

    @property
    def beam(self) -> str:
        """MuJoCo's beam, or whoever else produced the readings."""
        return str(self.settings.get("beam", self.comparison.candidate.source))

    @property
    def engine(self) -> str:
        """Which version of what, as far as it was recorded."""
        return str(self._origin.get("engine", "not recorded"))

    @property
    def settings(self) -> dict[str, Any]:
        """The numerics of the candidate."""
        settings = self._origin.get("settings")
        return settings if isinstance(settings, dict) else {}

    @property
    def agrees(self) -> bool:
        """Whether no tolerance is exceeded."""
        return self.comparison.verdict == "agrees"

    @property
    def rms(self) -> dict[str, float | None]:
        """Disagreement by reading; None where nothing could be compared."""
        return {n: getattr(self.comparison.disagreement, n).rms for n in CLAMP_READINGS}

    @property
    def worst(self) -> str:
        """The reading that disagrees most."""
        return max(CLAMP_READINGS, key=lambda name: _size(self.rms[name]))

    @property
    def error(self) -> float:
        """Disagreement of that reading; infinite if nothing could be compared."""
        return _size(self.rms[self.worst])

    @property
    def snap_off(self) -> float | None:
        """By how much the snap-offs differ [L]; None unless both sweeps have one."""
        apart = self.comparison.snap_off.difference
        return None if apart is None else apart / self.comparison.candidate.beam.length

    @property
    def phases_right(self) -> float | None:
        """Share of stations whose phase is rightly judged from the clamp, in the worse sweep."""
        return self.comparison.phases.agreement

    @property
    def seconds_a_station(self) -> float | None:
        """Time of the simulation; None where it was not taken."""
        seconds = self._origin.get("seconds")
        if not isinstance(seconds, int | float):
            return None
        return seconds / self.comparison.candidate.stations

    def part(self, name: str) -> float | None:
        """The largest of the three readings' rms of a part of the budget."""
        if self.budget is None or name not in self.budget.parts:
            return None
        return max((part.rms for part in self.budget.parts[name].values()), default=None)


def read_records(folder: Path) -> list[RunRecord]:
    """All runs in the folders of `folder`: the named cases first, in their order."""
    runs = [
        RunRecord(
            file.parent,
            read_left(file, ComparisonFile),
            read_left(budget, BudgetFile) if budget.exists() else None,
        )
        for file in sorted(folder.glob("*/comparison.json"))
        for budget in [file.with_name("budget.json")]
    ]
    order = {name: i for i, name in enumerate(CASE_NAMES)}
    return sorted(runs, key=lambda run: (order.get(run.case, len(order)), run.case))


def read_left(file: Path, kind: type[_File]) -> _File:
    """What a run has left in a file."""
    try:
        return kind.model_validate(json.loads(file.read_text(encoding="utf-8")))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "the whole"
        fault = f"damaged ({where}: {first['msg']})"
    except (OSError, ValueError, RecursionError) as error:
        fault = f"unreadable ({type(error).__name__})"
    raise InputError(
        f"file {file}", fault, "JSON that a run has written", "run it again, or remove its folder"
    )


def _size(rms: float | None) -> float:
    return math.inf if rms is None or math.isnan(rms) else rms
