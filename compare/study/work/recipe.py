"""What the runs of a study have in common."""

from dataclasses import dataclass
from typing import Any

from compare.study.grid.study import Record, Study


@dataclass(frozen=True)
class Recipe:
    """What all runs of a study have in common; small, it travels with every run."""

    base: dict[str, Any]
    simulate: bool
    record: tuple[Record, ...]
    keep_readings: bool
    timeout: float

    @property
    def in_space(self) -> bool:
        """Whether the sweeps are in space."""
        return "body.kind" in self.base

    @property
    def events_only(self) -> bool:
        """Whether nothing has to be swept."""
        return set(self.record) == {"events"} and not self.simulate

    @classmethod
    def of(cls, study: Study) -> "Recipe":
        """Take from a study what its runs have in common."""
        return cls(study.base, bool(study.beams), study.record, study.keep_readings, study.timeout)
