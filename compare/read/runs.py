"""What many runs have left: of each what a page about all of them shows."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, TypeAlias, TypeVar

from pydantic import BaseModel, Field

from analytic import CASE_NAMES, CLAMP_READINGS
from compare.explain.budget import Budget
from compare.explain.split import Split
from compare.read.run_folder import read_stored, read_stored_if_there

_Rms: TypeAlias = dict[str, float | None]  # by reading; None where nothing could be compared
_Numbers: TypeAlias = dict[str, Any]
_Record = TypeVar("_Record", "RunRecord", "EnginesRecord")


class _Beam(BaseModel):
    length: Annotated[float, Field(gt=0)]


class _Sweep(BaseModel):
    source: str
    beam: _Beam
    stations: Annotated[int, Field(gt=0)]
    provenance: _Numbers


class _Disagreement(BaseModel):
    rms: float | None


class _SnapOff(BaseModel):
    difference: float | None


class _Phases(BaseModel):
    agreement: float | None


class ComparisonFile(BaseModel):
    """What is looked at of a ``comparison.json``."""

    verdict: str
    disagreement: dict[str, _Disagreement]
    snap_off: _SnapOff
    phases: _Phases
    candidate: _Sweep


@dataclass(frozen=True)
class RunRecord:
    """One run: what its ``comparison.json`` and, if there is one, its ``budget.json`` hold."""

    folder: Path
    comparison: ComparisonFile
    budget: Budget | None

    @property
    def _origin(self) -> _Numbers:
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
    def settings(self) -> _Numbers:
        """The numerics of the candidate."""
        settings = self._origin.get("settings")
        return settings if isinstance(settings, dict) else {}

    @property
    def agrees(self) -> bool:
        """Whether no tolerance is exceeded."""
        return self.comparison.verdict == "agrees"

    @property
    def rms(self) -> _Rms:
        """Disagreement by reading; None where nothing could be compared."""
        return {name: self.comparison.disagreement[name].rms for name in CLAMP_READINGS}

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


@dataclass(frozen=True)
class EngineOutcome:
    """What one engine came to."""

    name: str
    role: str
    version: str
    tuned: str  # what was set for it, as it says itself
    trouble: str | None  # why there are no readings
    rms: dict[str, float] | None = None  # from the closed form's readings
    snap_off_apart: float | None = None  # less that of the closed form [L]
    seconds_a_station: float | None = None  # of processor time
    agrees: bool = False


@dataclass(frozen=True)
class EnginesRecord:
    """One run in many engines."""

    case: str
    engines: list[EngineOutcome]
    split: Split | None


def read_runs(folder: Path) -> list[RunRecord]:
    """All runs in the folders of `folder`: the named cases first, in their order."""
    return _in_order(
        [
            RunRecord(
                file.parent,
                read_stored(file, ComparisonFile),
                read_stored_if_there(file.with_name("budget.json"), Budget),
            )
            for file in sorted(folder.glob("*/comparison.json"))
        ]
    )


def read_engines(folder: Path) -> list[EnginesRecord]:
    """All runs in many engines in the folders of `folder`, in the same order."""
    files = sorted(folder.glob("*/engines.json"))
    return _in_order([read_stored(file, EnginesRecord) for file in files])


def _in_order(found: list[_Record]) -> list[_Record]:
    order = {name: i for i, name in enumerate(CASE_NAMES)}
    return sorted(found, key=lambda one: (order.get(one.case, len(order)), one.case))


def _size(rms: float | None) -> float:
    return math.inf if rms is None or math.isnan(rms) else rms
