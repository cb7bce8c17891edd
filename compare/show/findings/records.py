"""What runs have left behind in their folders."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from analytic import CASE_NAMES, CLAMP_READINGS, InputError


@dataclass(frozen=True)
class RunRecord:
    """One run: the contents of its ``comparison.json`` and, if there is one, ``budget.json``."""

    folder: Path
    comparison: dict[str, Any]
    budget: dict[str, Any] | None

    @property
    def _origin(self) -> dict[str, Any]:
        return dict(self.comparison["candidate"]["provenance"])

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
        return str(self.settings.get("beam", self.comparison["candidate"]["source"]))

    @property
    def engine(self) -> str:
        """Which version of what, as far as it was recorded."""
        return str(self._origin.get("engine", "not recorded"))

    @property
    def settings(self) -> dict[str, Any]:
        """The numerics of the candidate."""
        return dict(self._origin.get("settings", {}))

    @property
    def agrees(self) -> bool:
        """Whether no tolerance is exceeded."""
        return bool(self.comparison["verdict"] == "agrees")

    @property
    def rms(self) -> dict[str, float]:
        """Disagreement by reading."""
        return {name: self.comparison["disagreement"][name]["rms"] for name in CLAMP_READINGS}

    @property
    def worst(self) -> str:
        """The reading that disagrees most."""
        return max(CLAMP_READINGS, key=lambda name: self.rms[name])

    @property
    def length(self) -> float:
        """Of the vibrissa."""
        return float(self.comparison["candidate"]["beam"]["length"])

    @property
    def snap_off(self) -> float | None:
        """By how much the snap-offs differ [L]; None unless both sweeps have one."""
        apart = self.comparison["snap_off"]["difference"]
        return None if apart is None else float(apart) / self.length

    @property
    def phases_right(self) -> float | None:
        """Share of stations whose phase is rightly judged from the clamp, in the worse sweep."""
        share = self.comparison["phases"]["agreement"]
        return None if share is None else float(share)

    @property
    def stations(self) -> int:
        """Of the candidate's sweep."""
        return int(self.comparison["candidate"]["stations"])

    @property
    def seconds_a_station(self) -> float | None:
        """Time of the simulation; None where it was not taken."""
        seconds = self._origin.get("seconds")
        return None if seconds is None else float(seconds) / self.stations

    def part(self, name: str) -> float | None:
        """The largest of the three readings' rms of a part of the budget."""
        if self.budget is None:
            return None
        return max(float(part["rms"]) for part in self.budget["parts"][name].values())


def read_records(folder: Path) -> list[RunRecord]:
    """All runs in the folders of `folder`: the named cases first, in their order.

    Raises
    ------
    InputError
        If there is none, or what one has left cannot be read.
    """
    runs = [
        RunRecord(file.parent, _read(file), _read(budget) if budget.exists() else None)
        for file in sorted(folder.glob("*/comparison.json"))
        for budget in [file.with_name("budget.json")]
    ]
    if not runs:
        raise InputError(
            "DIR",
            folder,
            "a folder with runs in it",
            "make one: vibrissa run CASE --budget --out DIR/CASE",
        )
    order = {name: i for i, name in enumerate(CASE_NAMES)}
    return sorted(runs, key=lambda run: (order.get(run.case, len(order)), run.case))


def _read(file: Path) -> dict[str, Any]:
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(
            "file", file, "JSON that a run has written", "run it again, or remove its folder"
        ) from error
    return dict(found)
