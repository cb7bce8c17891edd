"""Files of a rig, as the options of several commands say how to read them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from analytic import Beam, Direction, InputError, Readings
from compare.align.frames import Frame
from compare.read.rig import read_measured


@dataclass(frozen=True)
class RigFiles:
    """How files that no engine wrote are to be read."""

    columns: Sequence[str]
    beam: Path | None
    direction: Direction | None
    frame: Frame

    def read(self, file: Path, otherwise: Beam | None = None) -> Readings:
        """A sweep in the plane, of that vibrissa if nothing else says."""
        return read_measured(file, self.beam, self.columns, otherwise, self.direction)

    def read_all(self, files: Sequence[Path], otherwise: Beam | None = None) -> list[Readings]:
        """The sweeps of some files, of passes those in the direction that is asked for."""
        found = [self.read(file, otherwise) for file in files]
        kept = [
            one
            for one in found
            if self.direction in (None, one.provenance.get("direction", self.direction))
        ]
        if not kept:
            went = "they all go the other way: choose it, or leave --direction out"
            raise InputError("--direction", self.direction, "that of a pass", went)
        return kept
