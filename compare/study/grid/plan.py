"""The runs of a study, one after the other."""

import hashlib
import itertools
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

from pydantic import TypeAdapter

from compare.study.grid.axes import Value
from compare.study.grid.file import MESH, Study


class Run(NamedTuple):
    """One point of a study.

    ``id`` is a hash of everything that the result depends on; ``parameters`` are what the axes say.
    """

    id: str
    parameters: dict[str, Value]


@dataclass(frozen=True)
class Plan:
    """The runs of a study: counted at once, made one at a time.

    Parameters
    ----------
    study : Study
        What varies.
    versions : dict
        Of the engines. They are part of a run's id, so that what another version computed is not
        taken for this one's.
    """

    study: Study
    versions: dict[str, str]

    @classmethod
    def of(cls, study: Study) -> "Plan":
        """The plan for the engines that are installed here."""
        engines = ["vibrissa-testbed", *(["mujoco"] if study.beams else [])]
        return cls(study, {name: version(name) for name in engines})

    def to_json(self) -> str:
        """What `from_json` reads."""
        return TypeAdapter(Plan).dump_json(self, indent=1).decode()

    @classmethod
    def from_json(cls, text: str | bytes) -> "Plan":
        """A plan from what `to_json` wrote."""
        return TypeAdapter(Plan).validate_json(text)

    def __len__(self) -> int:
        return math.prod(len(axis.points) for axis in self.study.crossed)

    def __iter__(self) -> Iterator[Run]:
        axes = self.study.crossed
        keys = [key for axis in axes for key in axis.keys]
        for points in itertools.product(*(axis.points for axis in axes)):
            parameters = dict(zip(keys, itertools.chain(*points), strict=True))
            yield Run(self._id(parameters), parameters)

    def _id(self, parameters: dict[str, Value]) -> str:
        """The same for the same problem, wherever in the file its numbers stand."""
        study = self.study
        described = {**study.base, **parameters}
        if MESH in described:
            described[MESH] = _content(str(described[MESH]))
        if not study.beams:
            described = {k: v for k, v in described.items() if not k.startswith("mujoco.")}
        content = [described, sorted(study.record), study.keep_readings, self.versions]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:16]


@cache
def _content(path: str) -> str:
    """A hash of a mesh file: what is in it matters, not where it is."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
