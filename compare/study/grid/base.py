"""The base case of a study file: what each run is a variation of, and what a key of it may be."""

from collections.abc import Sequence
from dataclasses import asdict
from functools import partial
from typing import Any

from analytic import NAMED_TABLES, InputError
from analytic.problem.errors import unknown
from compare.read.complaints import shown
from compare.read.toml import TomlFile
from compare.study.grid.axes import Value
from compare.study.grid.study import (
    BEAM,
    COMPONENTS_OF,
    MESHES,
    RUN_TABLES,
    PlanarRun,
    SpatialRun,
    StudyFile,
    checked_run,
    flatten,
    replaced,
)
from engines.known import named_engines

_KEYS = {
    "clamp_stiffness": ["support", "rotational_stiffness"],
    "friction": ["contact", "friction"],
    "clamp_angle": ["support", "angle"],
    "engine": ["engine", "name"],
}


class Base:
    """The base case of a study file, and a trial of values on it."""

    def __init__(self, file: TomlFile, content: StudyFile) -> None:
        self._file = file
        self._folder = file.path.parent
        self._tables = self._overlaid(content)
        checked = checked_run(self._tables, file.place)
        try:
            self._built(checked)
        except InputError as error:
            named, _, _ = str(error).partition(" = ")
            table, _, key = named.partition("[")[0].partition(".")
            default = ["body" if "body" in self._tables else "profile"]
            keys = [table, key] if key and table in self._tables else default
            where = file.place(_KEYS.get(named, keys))
            raise InputError(where, "unusable", "usable", str(error)) from error
        flat = flatten(_plain(checked))
        self.values = {key: value for key, value in flat.items() if value is not None}
        for mesh in MESHES:
            if mesh in self.values:
                self.values[mesh] = self._path(self.values[mesh])

    def check_key(self, key: str, place: Sequence[str]) -> None:
        where = self._file.place(place)
        table, *inner = key.split(".")
        component = inner[1:]
        if (
            table not in RUN_TABLES
            or not 1 <= len(inner) <= 2
            or (component and component[0] not in COMPONENTS_OF)
        ):
            raise InputError(
                where, "an axis", f"a key of {', '.join(RUN_TABLES)}",
                "write it as in a case file, as beam.radius; path.tangent.x of what has x, y, z",
            )  # fmt: skip
        if component and len(self._components(table, inner[0])) != len(COMPONENTS_OF):
            raise InputError(where, "an axis", "a component of x, y, z", "leave the component out")
        if key == BEAM and place[0] == "axes":
            raise InputError(where, "an axis", "given as study.beams", "list the beams there")

    def tried(self, key: str, value: object, place: Sequence[str]) -> Value:
        """Try a value on the base case; combinations of values are not tried."""
        self.check_key(key, place)
        where = self._file.place(place)
        table, inner, *component = key.split(".")
        if component:
            whole = replaced(self._components(table, inner), component[0], value)
            plain = self._tried(table, inner, whole, place)
            # `check_key` has seen that there are as many as components.
            found = dict(zip(COMPONENTS_OF, plain, strict=True))[component[0]]  # type: ignore[call-overload]
        else:
            found = self._tried(table, inner, value, place)
        if isinstance(value, bool) != isinstance(found, bool):
            allowed = "true or false" if isinstance(found, bool) else "a number or a word"
            raise InputError(where, shown(value), allowed, "correct it")
        if not isinstance(found, int | float | str):
            raise InputError(
                where, shown(value), "one number or word", "this key cannot be an axis"
            )
        return self._path(str(found)) if key in MESHES else found

    def _tried(self, table: str, key: str, value: object, place: Sequence[str]) -> object:
        """What the base case holds with `value` for a key."""
        where = self._file.place(place)
        changed = {**self._tables, table: {**self._tables.get(table, {}), key: value}}
        checked = checked_run(changed, partial(_at, where))
        try:
            self._built(checked)
        except InputError as error:
            raise InputError(where, shown(value), "usable", str(error)) from error
        plain = _plain(checked)[table]
        if key not in plain:  # what only converts units of a motion
            raise InputError(where, shown(value), "in natural units", "vary what it is a unit of")
        return plain[key]

    def _components(self, table: str, key: str) -> Sequence[Any]:
        """What the file or else the case has for a key; nothing if that is no list."""
        given = self._tables.get(table, {}).get(key, self.values.get(f"{table}.{key}"))
        return given if isinstance(given, list | tuple) else ()

    def _built(self, case: PlanarRun | SpatialRun) -> None:
        """Raise if the parts of a case cannot be made."""
        if isinstance(case, SpatialRun):
            case.case(self._folder, "study")
            return
        case.physics(self._folder)
        case.way()
        if case.motion is not None:
            case.motion.build(case.beam.build())
        if len(names := named_engines(case.engine.name)) > 1:
            raise InputError("engine", names, "one in a run", "list them as an axis, engine.name")

    def _overlaid(self, content: StudyFile) -> dict[str, Any]:
        """The base case's tables with the study's own over them."""
        own = {name: table for name, table in content.__pydantic_extra__.items() if table}
        case = content.study.case
        if case is None:
            return dict(own)
        if case in NAMED_TABLES:
            base: dict[str, Any] = {k: dict(v) for k, v in NAMED_TABLES[case].items()}
        elif case.endswith(".toml"):
            file = TomlFile.read(self._folder / case, "case file")
            found = checked_run(file.tables, file.place)  # errors are on its own lines
            if isinstance(found, PlanarRun) and found.model is not None:
                raise InputError(
                    file.place(["model"]), "of a study", "left out", "a study sweeps our models"
                )
            base = {name: t for name, t in file.tables.items() if name in RUN_TABLES}
        else:
            here, more = self._file.place(["study", "case"]), ", or the path of a .toml file"
            remedy = "leave it out to describe the case here"
            raise unknown(here, case, NAMED_TABLES, more=more, remedy=remedy)
        return {name: {**base.get(name, {}), **own.get(name, {})} for name in {**base, **own}}

    def _path(self, name: str) -> str:
        """A mesh file's path, whole: a run may be done in another folder."""
        return str((self._folder / name).resolve())


def _plain(case: PlanarRun | SpatialRun) -> dict[str, Any]:
    """The tables of a case as plain numbers and words, a motion in natural units."""
    tables = case.model_dump(include={*RUN_TABLES} - {"motion"})
    if isinstance(case, SpatialRun):
        return {name: table for name, table in tables.items() if table is not None}
    del tables["whisk" if case.whisk is None else "sweep"]  # one of them is the way
    if case.motion is not None:
        tables["motion"] = asdict(case.motion.build(case.beam.build()))
    return tables


def _at(place: str, _: Sequence[str]) -> str:
    """What an error calls a value of an axis, whichever key of the case complains."""
    return place
