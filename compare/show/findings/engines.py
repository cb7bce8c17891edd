"""What runs in many engines have left: each engine, and the split into implementation and model."""

from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from pydantic import BaseModel

from analytic import CASE_NAMES
from compare.explain.split import ROUNDING
from compare.show.findings.records import read_left
from compare.show.page import short

_Rms: TypeAlias = dict[str, float | None]  # by reading; None where nothing could be compared


class _Engine(BaseModel):
    name: str
    role: str
    version: str
    trouble: str | None
    rms: _Rms | None
    snap_off_apart: float | None
    seconds_a_station: float | None
    agrees: bool


class _Split(BaseModel):
    subject: str
    twin: str
    disagreement: _Rms
    implementation: _Rms
    model: _Rms
    others: dict[str, _Rms]
    blame: str


class EnginesFile(BaseModel):
    """What the findings need of an ``engines.json``."""

    case: str
    engines: list[_Engine]
    split: _Split | None


@dataclass(frozen=True)
class EnginesRecord:
    """One run in many engines."""

    folder: Path  # where it is
    content: EnginesFile  # its ``engines.json``

    @property
    def case(self) -> str:
        """Name of the case."""
        return self.content.case


def read_engines(folder: Path) -> list[EnginesRecord]:
    """All runs in many engines in the folders of `folder`."""
    found = [
        EnginesRecord(file.parent, read_left(file, EnginesFile))
        for file in sorted(folder.glob("*/engines.json"))
    ]
    order = {name: i for i, name in enumerate(CASE_NAMES)}
    return sorted(found, key=lambda one: (order.get(one.case, len(order)), one.case))


def split_overview(records: list[EnginesRecord]) -> str:
    """What of the disagreements is implementation, and what is the model, over all cases."""
    splits = [(one.case, one.content.split) for one in records if one.content.split is not None]
    if not splits:
        return ""
    apart = {case: _worst(split.implementation) for case, split in splits}
    model = max(_worst(split.model) for _, split in splits)
    subject, twin = splits[0][1].subject, splits[0][1].twin
    faulty = [case for case, worst in apart.items() if worst > ROUNDING]
    largest = short(max(apart.values()))
    if not faulty:
        said = (
            f"{subject} computes its model right: it and its twin {twin} are at most {largest} "
            f"apart. The model is the rod to {short(model)}."
        )
    else:
        said = (
            f"{subject} and its twin {twin} are up to {largest} apart, above rounding in "
            f"{', '.join(faulty)}; the twin's model is the rod to {short(model)}."
        )
    others = {
        name: max(_worst(split.others[name]) for _, split in splits if name in split.others)
        for name in dict.fromkeys(name for _, split in splits for name in split.others)
    }
    return " ".join(
        [said, *(f"{name}'s is it to {short(worst)}." for name, worst in others.items())]
    )


def _worst(rms: _Rms) -> float:
    """Of the readings that could be compared."""
    return max((one for one in rms.values() if one is not None), default=0.0)
