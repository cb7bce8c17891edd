"""The runs of a study, one after the other."""

import hashlib
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

import numpy as np
from pydantic import TypeAdapter

from analytic import InputError
from compare.study.grid.study import MESHES, MOST_RUNS, Axis, Study, Value
from engines.found import list_engines


class PlannedRun(NamedTuple):
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
        Of the engines, and a digest of this package's sources. They are part of a run's id, so that
        what other code computed is not taken for this one's.

    Raises
    ------
    InputError
        If there are more than `MOST_RUNS` runs.
    """

    study: Study
    versions: dict[str, str]

    def __post_init__(self) -> None:
        count = math.prod(len(axis.points) for axis in self._axes)  # may be too large for len()
        if count > MOST_RUNS:
            raise InputError(
                "study", f"{count:.3g} runs" if count < 1e300 else "more than 1e300 runs",
                f"at most {MOST_RUNS:,}", "take fewer values an axis, or [sample] the ranges",
            )  # fmt: skip

    @classmethod
    def of(cls, study: Study) -> "Plan":
        """Plan a study for the engines that are installed here.

        Parameters
        ----------
        study : Study
            What varies.

        Returns
        -------
        Plan
            Its runs.

        Raises
        ------
        InputError
            If there are more than `MOST_RUNS` of them.
        """
        known = {found.name: found.version or "none" for found in list_engines()}
        versions = {"vibrissa-testbed": version("vibrissa-testbed")}
        versions |= {name: known[name] for name in study.engines}
        packages = ["analytic", "compare", *(["mujoco_models"] if study.beams else [])]
        if any(name != "mujoco" for name in study.engines):
            packages.append("engines")
        return cls(study, versions | {"sources": sources_digest(*packages)})

    @cached_property
    def _axes(self) -> tuple[Axis, ...]:
        return self.study.crossed

    def __len__(self) -> int:
        return math.prod(len(axis.points) for axis in self._axes)

    def __getitem__(self, index: int) -> PlannedRun:
        parameters = self.parameters(index)
        return PlannedRun(self._id(parameters), parameters)

    def __iter__(self) -> Iterator[PlannedRun]:
        return (self[index] for index in range(len(self)))

    def parameters(self, index: int) -> dict[str, Value]:
        """Say what the axes are at in a run.

        Parameters
        ----------
        index : int
            Number of the run, from 0; the last axis varies fastest.

        Returns
        -------
        dict
            Values by dotted key.

        Raises
        ------
        IndexError
            If there is no such run.
        """
        if not 0 <= index < len(self):
            raise IndexError(index)
        places = np.unravel_index(index, [len(axis.points) for axis in self._axes])
        return {
            key: value
            for axis, place in zip(self._axes, places, strict=True)
            for key, value in zip(axis.keys, axis.points[place], strict=True)
        }

    def _id(self, parameters: dict[str, Value]) -> str:
        """The same for the same problem, wherever in the file its numbers stand."""
        study = self.study
        described = {**study.base, **parameters}
        for mesh in MESHES:
            if mesh in described:
                described[mesh] = _content(str(described[mesh]))
        if not study.beams:
            described = {
                k: v for k, v in described.items() if not k.startswith(("mujoco.", "engine."))
            }
        content = [described, sorted(study.record), study.keep_readings, self.versions]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:16]


PLAN = TypeAdapter(Plan)
"""Writes a plan as JSON, and reads it with the same ids."""


@cache
def _content(path: str) -> str:
    """A hash of a mesh file: what is in it matters, not where it is."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


# What reads, shows or stores results does not change them.
_WITHOUT_EFFECT = ("commands", "show", "testing", "simulate", "study/keep", "study/show")


@cache
def sources_digest(*packages: str) -> str:
    """Digest of the modules whose code a run's numbers depend on."""
    digest = hashlib.sha256()
    for package in packages:
        root = Path(str(files(package)))
        for path in sorted(root.rglob("*.py")):
            name = path.relative_to(root).as_posix()
            if package != "compare" or not name.startswith(_WITHOUT_EFFECT):
                digest.update(f"{package}/{name}\n".encode() + path.read_bytes())
    return digest.hexdigest()[:12]
