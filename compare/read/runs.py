"""What many runs have left: of each what a page about all of them shows."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, TypeAlias, TypeVar

from pydantic import AliasPath, BaseModel, BeforeValidator, Field

from analytic import CASE_NAMES
from compare.explain.budget import Budget
from compare.explain.parts import Parted
from compare.explain.split import Split
from compare.read.run_folder import read_stored, read_stored_if_there

_Record = TypeVar("_Record", "RunRecord", "EnginesRecord")
_Number: TypeAlias = Annotated[float, BeforeValidator(lambda x: math.nan if x is None else x)]
"""As a file holds it, where null is no number."""


def _at(*keys: str, **limits: Any) -> Any:  # noqa: ANN401  # as `Field`
    return Field(validation_alias=AliasPath(*keys), **limits)


class _Disagreement(BaseModel):
    rms: float | None


class RunRecord(BaseModel):
    """One run: what is looked at of its ``comparison.json``, and its budget."""

    verdict: str
    disagreement: dict[str, _Disagreement]
    apart: float | None = _at("snap_off", "difference", default=None)
    # Share of stations whose phase is rightly judged from the clamp, in the worse sweep.
    phases_right: float | None = _at("phases", "agreement")
    running: str = "foot_x"  # the column over which it runs
    source: str = _at("candidate", "source")
    length: float = _at("candidate", "beam", "length", gt=0)
    stations: int = _at("candidate", "stations", gt=0)
    provenance: dict[str, Any] = _at("candidate", "provenance")
    folder: Path = Path()
    budget: Parted | None = None  # if it was measured

    @property
    def case(self) -> str:
        return str(self.provenance.get("case", self.folder.name))

    @property
    def profile(self) -> str:
        return str(self.provenance.get("profile", self.provenance.get("body", "not recorded")))

    @property
    def beam(self) -> str:
        """MuJoCo's beam, or whoever else produced the readings."""
        return str(self.settings.get("beam", self.source))

    @property
    def engine(self) -> str:
        """Which version of what, as far as it was recorded."""
        return str(self.provenance.get("engine", "not recorded"))

    @property
    def settings(self) -> dict[str, Any]:
        settings = self.provenance.get("settings")
        return settings if isinstance(settings, dict) else {}

    @property
    def agrees(self) -> bool:
        return self.verdict == "agrees"

    @property
    def rms(self) -> dict[str, float | None]:
        """Disagreement by reading; None where nothing could be compared."""
        return {name: one.rms for name, one in self.disagreement.items()}

    @property
    def worst(self) -> tuple[float, str]:
        """The largest disagreement, infinite if nothing could be compared, and its reading."""
        sizes = {name: math.inf if rms is None else rms for name, rms in self.rms.items()}
        name = max(sizes, key=sizes.__getitem__)
        return sizes[name], name

    @property
    def snap_off(self) -> float | None:
        """By how much the snap-offs differ [L, rad]; None unless both sweeps have one."""
        size = 1.0 if self.running == "clamp_angle" else self.length
        return None if self.apart is None else self.apart / size

    @property
    def seconds_a_station(self) -> float | None:
        """Time of the simulation; None where it was not taken."""
        seconds = self.provenance.get("seconds")
        return None if seconds is None else seconds / self.stations


@dataclass(frozen=True)
class EngineOutcome:
    """What one engine, or one file of readings, came to."""

    name: str
    role: str = ""  # of an engine, beside MuJoCo
    version: str = ""
    tuned: str = ""  # what was set for it, as it says itself
    trouble: str | None = None  # why there are no readings
    rms: dict[str, _Number] | None = None  # from the closed form's readings
    snap_off_apart: float | None = None  # less that of the closed form [L, rad]
    seconds_a_station: float | None = None  # of processor time
    agrees: bool = False
    likely: str = ""  # why it disagrees, or why stations are not to be trusted

    @property
    def label(self) -> str:
        """Its name, with version and role if it is an engine's."""
        return f"{self.name} {self.version}, {self.role}" if self.role else self.name


@dataclass(frozen=True)
class EnginesRecord:
    case: str
    engines: list[EngineOutcome]
    split: Split | None


def read_runs(folder: Path) -> list[RunRecord]:
    """All runs in the folders of `folder`: the named cases first, in their order."""
    return _in_order([_read(file) for file in sorted(folder.glob("*/comparison.json"))])


def _read(file: Path) -> RunRecord:
    run = read_stored(file, RunRecord)
    kind = Parted if "force_z" in run.rms else Budget
    budget = read_stored_if_there(file.with_name("budget.json"), kind)
    return run.model_copy(update={"folder": file.parent, "budget": budget})


def read_engines(folder: Path) -> list[EnginesRecord]:
    """All runs in many engines in the folders of `folder`, in the same order."""
    files = sorted(folder.glob("*/engines.json"))
    return _in_order([read_stored(file, EnginesRecord) for file in files])


def _in_order(found: list[_Record]) -> list[_Record]:
    order = {name: i for i, name in enumerate(CASE_NAMES)}
    return sorted(found, key=lambda one: (order.get(one.case, len(order)), one.case))
