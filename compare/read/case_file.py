"""Case files: TOML to a job, with units and with errors that a person can act on."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from analytic import Beam, InputError
from compare.judge.tolerances import Tolerances
from compare.read.case import Job
from compare.read.complaints import complaint, name_of
from compare.read.limits import tolerances_of
from compare.read.quantities import Table
from compare.read.tables import BeamFile, CaseFile
from compare.read.toml import Place, TomlFile
from compare.read.uncertainty import uncertainties_of
from engines.known import named_engines
from mujoco_models.motion import Motion

_WITH_UNITS = ("beam", "support", "profile", "sweep", "body", "path")
_Schema = TypeVar("_Schema", bound=Table)


def read_job(path: Path) -> Job:
    """The job that a case file states."""
    file = TomlFile.read(path, "case file")
    if "body" in file.tables:
        raise InputError(
            file.place(["body"]),
            "given",
            "left out in the plane",
            "`vibrissa space` and `vibrissa compare` take cases in space",
        )
    case_file = validate(file.tables, file.place)
    limits = tolerances_of(case_file.tolerances, file.place, Tolerances)
    name = case_file.name or name_of(path)
    case = case_file.case(path.parent, name)
    moved = case_file.motion
    motion = None if moved is None else moved.build(case.beam)
    own = case_file.model
    if own is not None:
        motion = Motion() if moved is None else moved.of_a_model(case.beam, file.place)
    stated = uncertainties_of(case_file.uncertainty, case, file.place)
    model = None if own is None else own.build(path.parent)
    engines, timeout = engines_of(case_file, file.place), case_file.engine.timeout
    return Job(case, case_file.mujoco, limits, motion, stated, model, engines, timeout)


def engines_of(case: CaseFile, place: Place) -> tuple[str, ...]:
    """The engines that a case file names."""
    try:
        return tuple(named_engines(case.engine.name))
    except InputError as error:
        raise InputError(
            place(["engine", "name"]), repr(case.engine.name), "names of engines", str(error)
        ) from error


def validate(tables: Mapping[str, Any], place: Place) -> CaseFile:
    """What a case file's tables say."""
    return _validated(CaseFile, tables, place)


def read_beam(path: Path) -> tuple[Beam, dict[str, Any]]:
    """The vibrissa of a file's ``[beam]``, ``[support]`` and ``[contact]`` tables.

    Other tables do not matter.
    """
    file = TomlFile.read(path, "beam file")
    if "beam" not in file.tables:
        raise InputError(f"{path}: [beam]", "missing", "given", "add the table")
    known = {name: file.tables[name] for name in BeamFile.model_fields if name in file.tables}
    found = _validated(BeamFile, known, file.place)
    return found.beam.build(), found.provenance()


def _validated(schema: type[_Schema], tables: Mapping[str, Any], place: Place) -> _Schema:
    try:
        file = schema.model_validate(tables)
    except ValidationError as error:
        raise complaint(error, schema, place) from error
    check_units(file, tables, place)
    return file


def check_units(file: Table, tables: Mapping[str, Any], place: Place) -> None:
    """Refuse dimensions with and without units side by side, also those left to a default."""
    bare: list[list[str]] = []
    united: list[list[str]] = []
    left_out: list[list[str]] = []
    for name in filter(type(file).model_fields.__contains__, _WITH_UNITS):
        if getattr(file, name) is None:
            continue
        given, schema = tables.get(name, {}), type(getattr(file, name))
        # A shape whose scale has a unit is itself in units of the scale.
        relative = name == "profile" and isinstance(given.get("scale"), str)
        for key in schema.quantities():
            number = key != "scale" and not relative
            if key not in given:  # a scale of 1 is a factor
                default = schema.model_fields[key].default
                left_out += [[name, key]] if number and any(_numbers(default)) else []
                continue
            for value in _numbers(given[key]):
                if isinstance(value, str):
                    united.append([name, key])
                elif value != 0 and (number or key == "scale"):  # 0 needs no unit
                    bare.append([name, key])
    if bare and united:
        raise InputError(
            place(bare[0]),
            "without a unit",
            f"given with a unit, as {united[0][-1]} is",
            "write all dimensions with units, or none",
        )
    if left_out and united:
        raise InputError(
            place(left_out[0]),
            "missing",
            f"given with a unit, as {united[0][-1]} is",
            "add it: its default is a number without a unit",
        )


def _numbers(value: Any) -> list[Any]:  # noqa: ANN401
    """The numbers of a quantity, a pair of them, or a list of pairs."""
    if isinstance(value, list | tuple):
        return [number for part in value for number in _numbers(part)]
    return [value]
