"""Study files: a case file with tables that say what varies and what is recorded."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from pydantic import ValidationError

from analytic import NAMED_TABLES, InputError
from analytic.numerics.arrays import Floats
from analytic.problem.errors import unknown
from compare.read.complaints import complaint, shown
from compare.read.tables import PLACES
from compare.read.toml import TomlFile
from compare.study.grid import study
from engines.known import named_engines

Between: TypeAlias = Callable[[Floats], list[study.Value]]
"""The values of a range at fractions of it."""
_LONGEST_LIST = 10_000  # each value of a list is tried on the base case, at a millisecond
_RANGE_KEYS = frozenset(study.Range.model_json_schema()["properties"])


def shipped_studies() -> dict[str, Path]:
    folder = Path(str(files("compare.study") / "shipped"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_study(name_or_path: str) -> study.Study:
    """Read a study.

    Parameters
    ----------
    name_or_path : str
        A shipped study, or the path of a TOML file.

    Returns
    -------
    Study
        It is checked: every listed value and both ends of every range are tried on the base case.
        Combinations are not.

    Raises
    ------
    InputError
        If there is neither, or anything in the file cannot be used; the line is named.
    """
    shipped = shipped_studies()
    path = shipped.get(name_or_path, Path(name_or_path))
    if path.suffix != ".toml":
        raise unknown("study", name_or_path, shipped, more=", or the path of a .toml file")
    return _checked(TomlFile.read(path, "study file"))


def _checked(file: TomlFile) -> study.Study:
    # Without a name of its own the study is called like its file, under the same rules.
    tables = {"study": {}, **_without_model(file)}
    if isinstance(tables["study"], dict):
        tables["study"] = {"name": file.path.stem, **tables["study"]}
    try:
        content = study.StudyFile.model_validate(tables)
    except ValidationError as error:
        raise complaint(error, file.place) from error
    base, table = _Base(file, content), content.study
    beams = [base.values[study.BEAM]] if table.beams is None else table.beams
    beams = [str(base.tried(study.BEAM, beam, ["study", "beams"])) for beam in beams]
    return study.Study(
        name=str(table.name),
        base=base.values,
        axes=base.axes(),
        beams=tuple(dict.fromkeys(beams)),
        record=tuple(table.record or (study.RECORDS if beams else ("events",))),
        keep_readings=table.keep_readings,
        timeout=table.timeout,
        case=table.case or file.path.stem,
    )


def _without_model(file: TomlFile) -> dict[str, Any]:
    """The tables of a file; a model of the user's own is refused."""
    if "model" in file.tables:
        remedy = "a study sweeps our models; sweep yours in a loop over `simulate_model`"
        raise InputError(file.place(["model"]), "of a study", "left out", remedy)
    return file.tables


class _Base:
    """The base case of a study file, on which every value of its axes is tried."""

    def __init__(self, file: TomlFile, content: study.StudyFile) -> None:
        self._file, self._content = file, content
        self._tables = self._overlaid()
        try:
            checked = study.checked_run(self._tables, file.place)
        except InputError:  # what varies need not stand in the case, too
            self._tables = self._with_first_values()
            checked = study.checked_run(self._tables, file.place)
        try:
            self._built(checked)
        except InputError as error:
            table, _, key = error.name.partition("[")[0].partition(".")
            default = ["body" if "body" in self._tables else "profile"]
            keys = [table, key] if key and table in self._tables else default
            keys = [*PLACES.get(error.name, keys)]
            raise self._wrong(keys, "unusable", "usable", str(error)) from error
        self.values = {
            f"{name}.{key}": value
            for name, table in _plain(checked).items()
            for key, value in table.items()
            if value is not None
        }
        for mesh in study.MESHES:
            if mesh in self.values:
                self.values[mesh] = self._path(self.values[mesh])

    def axes(self) -> tuple[study.Axis, ...]:
        """What the file says of its axes: lists, ranges with a count, samples of those without."""
        lists: list[dict[str, list[study.Value]]] = []
        sampled: dict[str, Between] = {}
        for key, value in self._items():
            self._check_key(key, _place(key))
            if isinstance(value, list):
                lists.append({key: self._listed(key, value)})
                continue
            try:
                span = study.Range.model_validate(value)
            except ValidationError as error:
                raise complaint(error, self._file.place, _place(key)) from error
            values_at = self._between(key, span)
            if span.count is None:
                sampled[key] = values_at
            else:
                values = values_at(np.linspace(0.0, 1.0, span.count))
                lists.append({key: list(dict.fromkeys(values))})
        for keys in self._content.study.zip:
            lists = self._zipped(lists, keys)
        return (*map(study.Axis.of, lists), *self._sampled(sampled))

    def tried(self, key: str, value: object, place: Sequence[str]) -> study.Value:
        """Try a value on the base case; combinations of values are not tried."""
        self._check_key(key, place)
        table, inner, *component = key.split(".")
        if component:
            whole = study.replaced(self._components(table, inner), component[0], value)
            plain = self._tried(table, inner, whole, place)
            found = plain[study.COMPONENTS_OF.index(component[0])]  # type: ignore[index]
        elif parts := self._components_of(table, inner):
            remedy = f"vary {key}.{parts[0]}"
            raise self._wrong(place, shown(value), "one number or word", remedy)
        else:
            found = self._tried(table, inner, value, place)
        if isinstance(value, bool) != isinstance(found, bool):
            allowed = "true or false" if isinstance(found, bool) else "a number or a word"
            raise self._wrong(place, shown(value), allowed)
        if not isinstance(found, int | float | str):
            remedy = "this key cannot be an axis"
            raise self._wrong(place, shown(value), "one number or word", remedy)
        return self._path(str(found)) if key in study.MESHES else found

    def _wrong(
        self, keys: Sequence[str], given: str, allowed: str, remedy: str = "correct it"
    ) -> InputError:
        return InputError(self._file.place(keys), given, allowed, remedy)

    def _items(self) -> Iterator[tuple[str, dict[str, Any] | list[Any]]]:
        """Dotted keys of the axes and what is said of each."""
        seen: set[str] = set()
        for name, table in (self._content.axes or {}).items():
            dotted: dict[str, object] = {name: table}
            if isinstance(table, dict) and table and not _RANGE_KEYS & table.keys():
                dotted = {
                    whole: values
                    for key, value in table.items()
                    for whole, values in _by_component(f"{name}.{key}", value).items()
                }
            for key, value in dotted.items():
                if key in seen:
                    raise self._wrong(_place(key), "given twice", "given once", "remove one")
                if not isinstance(value, dict) and not (isinstance(value, list) and value):
                    allowed = (
                        "a list of different values, or a range as { from = 1, to = 2, count = 3 }"
                    )
                    remedy = "state what does not vary as a case file does"
                    raise self._wrong(_place(key), shown(value), allowed, remedy)
                seen.add(key)
                yield key, value

    def _listed(self, key: str, values: list[Any]) -> list[study.Value]:
        if len(set(map(repr, values))) < len(values):
            allowed = "a list of different values"
            raise self._wrong(_place(key), shown(values), allowed, "name each once")
        if len(values) > _LONGEST_LIST:
            given, allowed = f"a list of {len(values)} values", f"a list of at most {_LONGEST_LIST}"
            raise self._wrong(_place(key), given, allowed, "give a range with a count instead")
        return [self.tried(key, value, _place(key)) for value in values]

    def _between(self, key: str, span: study.Range) -> Between:
        """The values of a range between two numbers, in the units that the case ends up in."""
        ends = [self.tried(key, end, _place(key)) for end in (span.low, span.high)]
        numbers = [float(end) for end in ends if not isinstance(end, bool | str)]
        usable = len(numbers) == 2 and numbers[0] != numbers[1]
        if usable and span.spacing == "log":
            usable = min(numbers) > 0 and math.isfinite(numbers[1] / numbers[0])
        if not usable or not math.isfinite(numbers[1] - numbers[0]):
            given = f"from {shown(span.low)} to {shown(span.high)}"
            allowed = "two different numbers, both positive if the spacing is log"
            raise self._wrong(_place(key), given, allowed, "correct the range")
        whole = all(isinstance(end, int) for end in ends)
        return partial(study.between, numbers[0], numbers[1], span.spacing == "log", whole)

    def _zipped(
        self, lists: list[dict[str, list[study.Value]]], keys: list[str]
    ) -> list[dict[str, list[study.Value]]]:
        """The lists with those of `keys` joined into one."""
        chosen = [group for group in lists if group.keys() & set(keys)]
        lengths = [len(values) for group in chosen for values in group.values()]
        if len(chosen) < max(2, len(keys)) or len(set(lengths)) > 1:
            allowed = "two or more axes with equally many values, each in one list only"
            remedy = f"these have {', '.join(map(str, lengths)) or 'none'}"
            raise self._wrong(["study", "zip"], shown(keys), allowed, remedy)
        together = {key: values for group in chosen for key, values in group.items()}
        first = lists.index(chosen[0])
        rest = [group for group in lists if group not in chosen]
        return [*rest[:first], together, *rest[first:]]

    def _sampled(self, ranges: Mapping[str, Between]) -> list[study.Axis]:
        """The one axis of all ranges without a count, if there are any."""
        sample = self._content.sample
        if sample is None and ranges:
            allowed = "a range without a count together with the table [sample]"
            remedy = "give the range a count, or the file a [sample] with one"
            raise self._wrong(_place(next(iter(ranges))), "without a count", allowed, remedy)
        if sample is None:
            return []
        if not ranges:
            allowed = "left out, or [sample] together with a range without a count"
            remedy = "take the count from the ranges to be sampled"
            raise self._wrong(["sample"], "given", allowed, remedy)
        drawn = zip(ranges.items(), sample.draw(len(ranges)).T, strict=True)
        return [study.Axis.of({key: values_at(column) for (key, values_at), column in drawn})]

    def _check_key(self, key: str, place: Sequence[str]) -> None:
        table, *inner = key.split(".")
        component = inner[1:]
        if (
            table not in study.RUN_TABLES
            or not 1 <= len(inner) <= 2
            or (component and component[0] not in study.COMPONENTS_OF)
        ):
            remedy = (
                "write it as in a case file, as beam.radius; path.tangent.x of what has x and y"
            )
            raise self._wrong(place, "an axis", f"a key of {', '.join(study.RUN_TABLES)}", remedy)
        if component and component[0] not in (there := self._components_of(table, inner[0])):
            allowed = f"{inner[0]} whole, or its {', '.join(there)}" if there else "without a part"
            raise self._wrong(place, "an axis", allowed, "leave the component out")
        if key == study.BEAM and place[0] == "axes":
            raise self._wrong(place, "an axis", "given as study.beams", "list the beams there")

    def _tried(self, table: str, key: str, value: object, place: Sequence[str]) -> object:
        """What the base case holds with `value` for a key."""
        changed = {**self._tables, table: {**self._tables.get(table, {}), key: value}}
        # An error is called by the axis, whichever key of the case complains.
        checked = study.checked_run(changed, lambda _: self._file.place(place))
        try:
            self._built(checked)
        except InputError as error:
            raise self._wrong(place, shown(value), "usable", str(error)) from error
        plain = _plain(checked)[table]
        if key not in plain:  # what only converts units of a motion
            remedy = "vary what it is a unit of"
            raise self._wrong(place, shown(value), "in natural units", remedy)
        return plain[key]

    def _components_of(self, table: str, key: str) -> Sequence[str]:
        """Names of the components, where a key holds a place or direction."""
        whole = self._components(table, key)
        if len(whole) not in (2, 3) or any(isinstance(one, list | dict) for one in whole):
            return ()
        return study.COMPONENTS_OF[: len(whole)]

    def _components(self, table: str, key: str) -> Sequence[Any]:
        """What the file or else the case has for a key; nothing if that is no list."""
        given = self._tables.get(table, {}).get(key, self.values.get(f"{table}.{key}"))
        return given if isinstance(given, list | tuple) else ()

    def _built(self, case: study.PlanarRun | study.SpatialRun) -> None:
        folder = self._file.path.parent
        if isinstance(case, study.SpatialRun):
            case.case(folder, "study")
            return
        case.physics(folder)
        case.way()
        if case.motion is not None:
            case.motion.build(case.beam.build())
        if len(names := named_engines(case.engine.name)) > 1:
            raise InputError("engine", names, "one in a run", "list them as an axis, engine.name")

    def _overlaid(self) -> dict[str, Any]:
        """The base case's tables with the study's own over them."""
        own = {name: t for name, t in self._content.__pydantic_extra__.items() if t}
        case = self._content.study.case
        if case is None:
            return own
        if case in NAMED_TABLES:
            base: dict[str, Any] = {k: dict(v) for k, v in NAMED_TABLES[case].items()}
        elif case.endswith(".toml"):
            file = TomlFile.read(self._file.path.parent / case, "case file")
            study.checked_run(_without_model(file), file.place)  # errors are on its own lines
            base = {name: t for name, t in file.tables.items() if name in study.RUN_TABLES}
        else:
            here, more = self._file.place(["study", "case"]), ", or the path of a .toml file"
            remedy = "leave it out to describe the case here"
            raise unknown(here, case, NAMED_TABLES, more=more, remedy=remedy)
        return {name: {**base.get(name, {}), **own.get(name, {})} for name in {**base, **own}}

    def _with_first_values(self) -> dict[str, Any]:
        """The base case's tables, with the first value of each axis that has no other there."""
        found = {name: dict(table) for name, table in self._tables.items()}
        for dotted, values in self._items():
            table, *key = dotted.split(".")
            if len(key) < 2:  # a component alone makes no place
                self._check_key(dotted, _place(dotted))
                first = values.get("from") if isinstance(values, dict) else values[0]
                found.setdefault(table, {}).setdefault(key[0], first)
        return found

    def _path(self, name: str) -> str:
        """A mesh file's path, whole: a run may be done in another folder."""
        return str((self._file.path.parent / name).resolve())


def _plain(case: study.PlanarRun | study.SpatialRun) -> dict[str, Any]:
    """The tables of a case as plain numbers and words, a motion in natural units."""
    tables = case.model_dump(include={*study.RUN_TABLES} - {"motion"})
    if isinstance(case, study.SpatialRun):
        return {name: table for name, table in tables.items() if table is not None}
    del tables["whisk" if case.whisk is None else "sweep"]  # one of them is the way
    if case.motion is not None:
        tables["motion"] = asdict(case.motion.build(case.beam.build()))
    return tables


def _by_component(key: str, value: object) -> dict[str, object]:
    """What is said of a key, or of its components by their own keys."""
    if isinstance(value, dict) and value and value.keys() <= {*study.COMPONENTS_OF}:
        return {f"{key}.{component}": inner for component, inner in value.items()}
    return {key: value}


def _place(key: str) -> list[str]:
    return ["axes", *key.split(".")]
