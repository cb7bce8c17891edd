"""Study files: a case file with tables that say what varies and what is recorded."""

import math
from collections.abc import Iterator, Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from analytic import InputError
from analytic.problem.errors import unknown
from compare.read.complaints import complaint, shown
from compare.read.toml import TomlFile
from compare.study.grid.axes import Axis, Interval, Range, Value
from compare.study.grid.base import Base
from compare.study.grid.study import BEAM, COMPONENTS_OF, RECORDS, Study, StudyFile


def shipped_studies() -> dict[str, Path]:
    """Find the studies that come with the package."""
    folder = Path(str(files("compare.study") / "shipped"))
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def load_study(name_or_path: str) -> Study:
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


def _checked(file: TomlFile) -> Study:
    # Without a name of its own the study is called like its file, under the same rules.
    tables = {"study": {}, **file.tables}
    if isinstance(tables["study"], dict):
        tables["study"] = {"name": file.path.stem, **tables["study"]}
    try:
        content = StudyFile.model_validate(tables)
    except ValidationError as error:
        raise complaint(error, file.place) from error
    base = Base(file, content)
    table = content.study
    beams = [base.values[BEAM]] if table.beams is None else table.beams
    beams = [str(base.tried(BEAM, beam, ["study", "beams"])) for beam in beams]
    return Study(
        name=str(table.name),
        base=base.values,
        axes=expand(file, content, base),
        beams=tuple(dict.fromkeys(beams)),
        record=tuple(table.record or (RECORDS if beams else ("events",))),
        keep_readings=table.keep_readings,
        timeout=table.timeout,
        case=table.case or file.path.stem,
    )


_LONGEST_LIST = 10_000  # each value of a list is tried on the base case, at a millisecond
_RANGE_KEYS = frozenset(Range.model_json_schema()["properties"])


def expand(file: TomlFile, content: StudyFile, base: Base) -> tuple[Axis, ...]:
    lists: list[dict[str, list[Value]]] = []
    sampled: dict[str, Interval] = {}
    reader = _AxisReader(file, base)
    for key, value in reader.items(content.axes or {}):
        base.check_key(key, _place(key))
        if isinstance(value, list):
            lists.append({key: reader.listed(key, value)})
            continue
        span = reader.span(key, value)
        interval = reader.interval(key, span)
        if span.count is None:
            sampled[key] = interval
        else:
            values = interval.at(np.linspace(0.0, 1.0, span.count))
            lists.append({key: list(dict.fromkeys(values))})
    for keys in content.study.zip:
        lists = _zipped(file, lists, keys)
    return (*map(Axis.of, lists), *_sampled(file, content, sampled))


class _AxisReader:
    """Lists and ranges of a file as numbers and words of its base case."""

    def __init__(self, file: TomlFile, base: Base) -> None:
        self._file = file
        self._base = base

    def items(self, axes: Mapping[str, Any]) -> Iterator[tuple[str, object]]:
        """Dotted keys and what is said of each."""
        seen: set[str] = set()
        for name, table in axes.items():
            dotted: dict[str, object] = {name: table}
            if isinstance(table, dict) and table and not _RANGE_KEYS & table.keys():
                dotted = {
                    whole: values
                    for key, value in table.items()
                    for whole, values in _components(f"{name}.{key}", value).items()
                }
            for key, value in dotted.items():
                if key in seen:
                    raise InputError(self._named(key), "given twice", "given once", "remove one")
                seen.add(key)
                yield key, value

    def listed(self, key: str, values: list[Any]) -> list[Value]:
        """The values of a list."""
        if not values or len(set(map(repr, values))) < len(values):
            raise InputError(
                self._named(key), shown(values), "a list of different values", "name each once"
            )
        if len(values) > _LONGEST_LIST:
            raise InputError(
                self._named(key), f"a list of {len(values)} values",
                f"a list of at most {_LONGEST_LIST}", "give a range with a count instead",
            )  # fmt: skip
        return [self._base.tried(key, value, _place(key)) for value in values]

    def span(self, key: str, value: object) -> Range:
        try:
            return Range.model_validate(value)
        except ValidationError as error:
            raise complaint(error, self._file.place, _place(key)) from error

    def interval(self, key: str, span: Range) -> Interval:
        """A range between two numbers."""
        ends = [self._base.tried(key, end, _place(key)) for end in (span.low, span.high)]
        numbers = [float(end) for end in ends if not isinstance(end, bool | str)]
        usable = len(numbers) == 2 and numbers[0] != numbers[1]
        if usable and span.spacing == "log":
            usable = min(numbers) > 0 and math.isfinite(numbers[1] / numbers[0])
        if not usable or not math.isfinite(numbers[1] - numbers[0]):
            raise InputError(
                self._named(key),
                f"from {shown(span.low)} to {shown(span.high)}",
                "two different numbers, both positive if the spacing is log",
                "correct the range",
            )
        whole = all(isinstance(end, int) for end in ends)
        return Interval(numbers[0], numbers[1], span.spacing == "log", whole)

    def _named(self, key: str) -> str:
        return self._file.place(_place(key))


def _components(key: str, value: object) -> dict[str, object]:
    """What is said of a key, or of its components by their own keys."""
    if isinstance(value, dict) and value and value.keys() <= {*COMPONENTS_OF}:
        return {f"{key}.{component}": inner for component, inner in value.items()}
    return {key: value}


def _place(key: str) -> list[str]:
    return ["axes", *key.split(".")]


def _zipped(
    file: TomlFile, lists: list[dict[str, list[Value]]], keys: list[str]
) -> list[dict[str, list[Value]]]:
    """The lists with those of `keys` joined into one."""
    chosen = [group for group in lists if group.keys() & set(keys)]
    lengths = [len(values) for group in chosen for values in group.values()]
    if len(chosen) < max(2, len(keys)) or len(set(lengths)) > 1:
        raise InputError(
            file.place(["study", "zip"]),
            shown(keys),
            "two or more axes with equally many values, each in one list only",
            f"these have {', '.join(map(str, lengths)) or 'none'}",
        )
    together = {key: values for group in chosen for key, values in group.items()}
    first = lists.index(chosen[0])
    rest = [group for group in lists if group not in chosen]
    return [*rest[:first], together, *rest[first:]]


def _sampled(
    file: TomlFile, content: StudyFile, intervals: Mapping[str, Interval]
) -> tuple[Axis, ...]:
    """The one axis of all ranges without a count."""
    sample = content.sample
    if sample is None and intervals:
        raise InputError(
            file.place(_place(next(iter(intervals)))), "without a count",
            "a range without a count together with the table [sample]",
            "give the range a count, or the file a [sample] with one",
        )  # fmt: skip
    if sample is None:
        return ()
    if not intervals:
        raise InputError(
            file.place(["sample"]), "given",
            "left out, or [sample] together with a range without a count",
            "take the count from the ranges to be sampled",
        )  # fmt: skip
    columns = sample.draw(len(intervals)).T
    drawn = zip(intervals.items(), columns, strict=True)
    return (Axis.of({key: interval.at(column) for (key, interval), column in drawn}),)
