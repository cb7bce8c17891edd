"""Study files: a case file with tables that say what varies and what is recorded."""

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial, reduce
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from analytic import NAMED_PROFILES, InputError
from compare.read.case import CaseFile, validate
from compare.read.toml import TomlFile
from compare.study.grid.axes import Axis, Interval, Range, Sample, Value, flatten, nest
from compare.study.grid.noise import Noise

Record: TypeAlias = Literal["events", "disagreement", "reconstruction"]
RECORDS: tuple[Record, ...] = ("events", "disagreement", "reconstruction")
BEAM = "mujoco.beam"
MESH = "profile.file"
_CASE_TABLES = ("beam", "profile", "sweep", "mujoco")


class _StudyTable(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    name: str | None = None
    case: str | None = None
    beams: list[str] | None = None
    record: Annotated[list[Record], Field(min_length=1)] | None = None
    keep_readings: bool = False
    timeout: Annotated[float, Field(gt=0)] = 600.0
    zip: list[list[str]] = []


class _StudyFile(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    study: _StudyTable = _StudyTable()
    axes: dict[str, Any] = {}
    sample: Sample | None = None
    noise: Noise = Noise()
    beam: dict[str, Any] = {}
    profile: dict[str, Any] = {}
    sweep: dict[str, Any] = {}
    mujoco: dict[str, Any] = {}


_TABLES: dict[str, type[BaseModel]] = {
    "": _StudyFile,
    "study": _StudyTable,
    "sample": Sample,
    "noise": Noise,
    "axes": Range,
}


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
        After so many seconds a run is ended.
    """

    name: str
    base: dict[str, Any]
    axes: tuple[Axis, ...]
    beams: tuple[str, ...]
    record: tuple[Record, ...]
    keep_readings: bool
    timeout: float

    @property
    def crossed(self) -> tuple[Axis, ...]:
        """All axes, that of the beams included."""
        return (*self.axes, Axis.of({BEAM: self.beams})) if self.beams else self.axes


def shipped_studies() -> dict[str, Path]:
    """The studies that come with the package, by name."""
    folder = Path(str(files("compare.study") / "shipped"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_study(name_or_path: str) -> Study:
    """The shipped study of that name, or the study of that TOML file.

    Raises
    ------
    InputError
        If there is neither, or anything in the file cannot be used; the line is named. Every value
        of every axis is tried on the base case; combinations are not.
    """
    shipped = shipped_studies()
    path = shipped.get(name_or_path, Path(name_or_path))
    if path.suffix != ".toml":
        near = difflib.get_close_matches(name_or_path, shipped, n=1)
        raise InputError(
            "study",
            repr(name_or_path),
            f"one of {', '.join(shipped)}, or the path of a .toml file",
            f"did you mean {near[0]}?" if near else "name one of them",
        )
    return _Reader(TomlFile.read(path, "study file")).study()


class _Reader:
    """One study file on its way to a `Study`."""

    def __init__(self, file: TomlFile) -> None:
        self._file = file
        self._folder = file.path.parent
        try:
            self._said = _StudyFile.model_validate(file.tables)
        except ValidationError as error:
            raise self._told(error, []) from error
        tables = self._case_tables()
        self._tables = flatten(tables)
        checked = validate(tables, file.place)
        try:
            checked.physics(self._folder)
        except InputError as error:
            named, _, _ = str(error).partition(" = ")
            where = file.place(named.split(".") if "." in named else ["profile"])
            raise InputError(where, "unusable", "usable", str(error)) from error
        base = flatten(checked.model_dump(exclude={"name"})) | self._noise({})
        self._base = {key: value for key, value in base.items() if value is not None}
        if MESH in base:
            self._base[MESH] = str((self._folder / base[MESH]).resolve())

    def study(self) -> Study:
        said = self._said.study
        axes = self._axes()
        beams = [self._base[BEAM]] if said.beams is None else said.beams
        beams = [str(self._checked(BEAM, beam, ["study", "beams"])) for beam in beams]
        return Study(
            name=said.name or self._file.path.stem,
            base=self._base,
            axes=tuple(axes),
            beams=tuple(beams),
            record=tuple(said.record or (RECORDS if beams else ("events",))),
            keep_readings=said.keep_readings,
            timeout=said.timeout,
        )

    def _case_tables(self) -> dict[str, Any]:
        """The base case's tables with the study's own over them."""
        own = {name: getattr(self._said, name) for name in _CASE_TABLES}
        own = {name: table for name, table in own.items() if table}
        case = self._said.study.case
        if case is None:
            return own
        if case in NAMED_PROFILES:
            base: dict[str, Any] = {"profile": dict(NAMED_PROFILES[case])}
        elif case.endswith(".toml"):
            file = TomlFile.read(self._file.path.parent / case, "case file")
            validate(file.tables, file.place)  # its errors are on its own lines
            base = {name: table for name, table in file.tables.items() if name in _CASE_TABLES}
        else:
            raise InputError(
                self._file.place(["study", "case"]),
                repr(case),
                f"one of {', '.join(NAMED_PROFILES)}, or the path of a .toml file",
                "leave it out to describe the case here",
            )
        return {name: {**base.get(name, {}), **own.get(name, {})} for name in {**base, **own}}

    def _axes(self) -> list[Axis]:
        """The axes in the file's order; those zipped or sampled together are one."""
        groups: list[dict[str, list[Value]]] = []
        sampled: dict[str, Interval] = {}
        found = flatten(self._said.axes, frozenset(Range.model_json_schema()["properties"]))
        for key, value in found.items():
            place = ["axes", *key.split(".")]
            if isinstance(value, list):
                groups.append({key: self._listed(key, value)})
                continue
            try:
                span = Range.model_validate(value)
            except ValidationError as error:
                raise self._told(error, place) from error
            interval = self._interval(key, span)
            if span.count is None:
                sampled[key] = interval
            else:
                fractions = np.linspace(0.0, 1.0, span.count)
                groups.append({key: list(dict.fromkeys(interval.at(fractions)))})
        for keys in self._said.study.zip:
            groups = self._zipped(groups, keys)
        return [Axis.of(group) for group in groups] + self._sampled(sampled)

    def _listed(self, key: str, values: list[Value]) -> list[Value]:
        place = ["axes", *key.split(".")]
        if not values or len(set(map(repr, values))) < len(values):
            raise InputError(
                self._file.place(place), values, "a list of different values", "name each once"
            )
        return [self._checked(key, value, place) for value in values]

    def _interval(self, key: str, span: Range) -> Interval:
        place = ["axes", *key.split(".")]
        ends = [self._checked(key, end, place) for end in (span.low, span.high)]
        low, high = (float(end) for end in ends)
        if low == high or (span.spacing == "log" and min(low, high) <= 0):
            raise InputError(
                self._file.place(place),
                f"from {span.low} to {span.high}",
                "two different ends, both positive if the spacing is log",
                "mend the range",
            )
        whole = all(isinstance(end, int) for end in ends)
        return Interval(low, high, span.spacing == "log", whole)

    def _zipped(
        self, groups: list[dict[str, list[Value]]], keys: list[str]
    ) -> list[dict[str, list[Value]]]:
        chosen = [group for group in groups if group.keys() & set(keys)]
        lengths = [len(values) for group in chosen for values in group.values()]
        if len(chosen) < max(2, len(keys)) or len(set(lengths)) > 1:
            raise InputError(
                self._file.place(["study", "zip"]),
                keys,
                "two or more axes with equally many values, each in one list only",
                f"these have {', '.join(map(str, lengths)) or 'none'}",
            )
        together = {key: values for group in chosen for key, values in group.items()}
        first = groups.index(chosen[0])
        rest = [group for group in groups if group not in chosen]
        return [*rest[:first], together, *rest[first:]]

    def _sampled(self, intervals: Mapping[str, Interval]) -> list[Axis]:
        sample = self._said.sample
        if sample is None and not intervals:
            return []
        if sample is None or not intervals:
            raise InputError(
                self._file.place(["axes", *next(iter(intervals)).split(".")])
                if intervals
                else self._file.place(["sample"]),
                "without a count" if intervals else "given",
                "a range without a count together with the table [sample]",
                "give the range a count, or the file a [sample] with one"
                if intervals
                else "take the count from the ranges to be sampled",
            )
        points = sample.draw(len(intervals))
        drawn = zip(intervals.items(), points.T, strict=True)
        return [Axis.of({key: interval.at(column) for (key, interval), column in drawn})]

    def _checked(self, key: str, value: object, place: list[str]) -> Value:
        """`value` of `key` tried on the base case, as the number or word that the case holds."""
        where = partial(_at, self._file.place(place))
        table, *_ = names = key.split(".")
        if table not in (*_CASE_TABLES, "noise") or len(names) < 2:
            raise InputError(
                where([]),
                "an axis",
                f"a key of {', '.join((*_CASE_TABLES, 'noise'))}",
                "write it as in a case file, as beam.radius",
            )
        if key == BEAM and place[0] == "axes":
            raise InputError(where([]), value, "given as study.beams", "list the beams there")
        if table == "noise":
            found = self._noise({names[1]: value}, place)[key]
        else:
            checked = validate(nest({**self._tables, key: value}), where)
            try:
                checked.physics(self._folder)
                checked.sweep.build()
            except InputError as error:
                raise InputError(where([]), value, "usable", str(error)) from error
            found = reduce(getattr, names, checked)
        if not isinstance(found, int | float | str):
            raise InputError(where([]), value, "one number or word", "this key cannot be an axis")
        return str((self._folder / str(found)).resolve()) if key == MESH else found

    def _noise(self, changed: dict[str, Any], place: list[str] | None = None) -> dict[str, Any]:
        try:
            noise = Noise.model_validate(self._said.noise.model_dump() | changed)
        except ValidationError as error:
            raise self._told(error, place or ["noise"]) from error
        return flatten({"noise": noise.model_dump()})

    def _told(self, error: ValidationError, outer: list[str]) -> InputError:
        """A validation error of the study's own tables in one line."""
        # A misspelt key also leaves one missing: the misspelling is the cause.
        first = min(error.errors(), key=lambda found: found["type"] != "extra_forbidden")
        where = outer or [str(part) for part in first["loc"]]
        name, value = self._file.place(where), repr(first["input"])
        if first["type"] == "extra_forbidden":
            wrong = str(first["loc"][-1])
            table = _TABLES["" if len(where) == 1 else where[0]]
            allowed = [field.alias or key for key, field in table.model_fields.items()]
            near = difflib.get_close_matches(wrong, allowed, n=1)
            remedy = f"did you mean {near[0]}?" if near else f"remove {wrong}"
            return InputError(name, value, f"one of the keys {', '.join(allowed)}", remedy)
        if first["type"] == "missing":
            return InputError(name, "without " + str(first["loc"][-1]), "complete", "add it")
        return InputError(name, value, first["msg"].removeprefix("Input should be "), "mend it")


def _at(place: str, keys: Sequence[str]) -> str:
    """What an error calls a value of an axis, whichever key of the case complains."""
    return place


def case_file(parameters: Mapping[str, Any]) -> tuple[CaseFile, Noise]:
    """The case and the noise that dotted keys describe."""
    tables = nest(parameters)
    noise = Noise(**tables.pop("noise"))
    return validate(tables, ".".join), noise
