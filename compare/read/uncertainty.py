"""Uncertainties as data: the ``[uncertainty]`` table of a case file, every input with its unit."""

import math
from typing import Annotated, TypeAlias

from pydantic import ConfigDict, Field, model_validator

from analytic import CLAMP_READINGS, Case, InputError
from analytic.problem.errors import called, near
from compare.read.complaints import shown
from compare.read.quantities import EXAMPLES, Table
from compare.read.toml import KeyPlace
from compare.read.units import DIMENSIONS, in_si
from compare.validate.stated import GAINS, INPUTS, NAMES, Input, Uncertainties, nominal

_TABLE = "uncertainty"

Size: TypeAlias = float | str | None  # in the unit of the case, with a unit, or in per cent


_Pair = Annotated[tuple[str, str, float], Field(strict=False)]


class InputTable(Table):
    """How well an input is known: its standard uncertainty, or half the width of an interval."""

    standard: Size = None
    within: Size = None

    @model_validator(mode="after")
    def _require_one(self) -> "InputTable":
        if (self.standard is None) == (self.within is None):
            raise ValueError("say which of the two it is, { standard = ... } or { within = ... }")
        return self


class UncertaintyTable(Table):
    """What is uncertain: inputs by name, in the order of the file, and the readings."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, InputTable] = Field(init=False)
    noise: dict[str, Size] = Field(default_factory=dict)
    correlations: list[_Pair] = Field(default_factory=list)

    @classmethod
    def keys(cls) -> list[str]:
        return [*NAMES, *super().keys()]


def uncertainties_of(table: UncertaintyTable, case: Case, place: KeyPlace) -> Uncertainties | None:
    if not table.model_fields_set:
        return None
    stated = table.__pydantic_extra__
    inputs = {name: _input(name, said, case, place) for name, said in stated.items()}
    noise = {}
    for name, said in table.noise.items():
        here = place([_TABLE, "noise", name])
        if name not in CLAMP_READINGS:
            known = f"a reading, one of {', '.join(CLAMP_READINGS)}"
            raise InputError(here, "unknown", known, near(name, CLAMP_READINGS))
        noise[name] = _size(said, DIMENSIONS[name], 0.0, case, here)
    try:
        return Uncertainties(inputs, noise, tuple(table.correlations))
    except InputError as error:
        raise called(error, place(error.name.split("."))) from error


def _input(name: str, said: InputTable, case: Case, place: KeyPlace) -> Input:
    dimension = "" if name in GAINS else INPUTS[name].dimension
    value = 1.0 if name in GAINS else nominal(case, name)
    if not math.isfinite(value):
        allowed = f"left out: the case has no {name} that is a number"
        why = "a rigid clamp has no stiffness, a cylinder no radius of its tip"
        raise InputError(place([_TABLE, name]), "given", allowed, why)
    which, made = ("standard", Input) if said.within is None else ("within", Input.within)
    here = place([_TABLE, name, which])
    return made(_size(getattr(said, which), dimension, value, case, here))


def _size(said: Size, dimension: str, nominal: float, case: Case, here: str) -> float:
    """A number in the unit of the case, from 0 up."""
    in_units = case.beam.si and dimension
    size = math.nan
    try:
        if isinstance(said, str) and said.rstrip().endswith("%") and nominal:
            size = abs(nominal) * float(said.rstrip()[:-1]) / 100
        elif isinstance(said, str) and in_units:
            size = in_si(said, dimension)
        elif isinstance(said, float) and (said == 0 or not in_units):
            size = said
    except ValueError:
        pass
    if 0 <= size < math.inf:
        return size
    unit = f"with a unit of {dimension}" if in_units else "a plain number"
    share = " or in per cent" if nominal else ""
    remedy = f"as {EXAMPLES[dimension][1]!r}" if in_units else "as the case's own numbers"
    raise InputError(here, shown(said), f"{unit}{share}, from 0 up", remedy)
