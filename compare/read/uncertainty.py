"""Uncertainties as data: the ``[uncertainty]`` table of a case file, every input with its unit."""

import math
from collections.abc import Mapping
from typing import Any

from analytic import CLAMP_READINGS, Case, InputError
from compare.read.complaints import shown
from compare.read.toml import Place
from compare.read.units import DIMENSIONS, in_si
from compare.validate.inputs import GAINS, INPUTS, nominal
from compare.validate.stated import NAMES, Input, Uncertainties

_TABLE = "uncertainty"
_SAYS = ("standard", "within")
_EXAMPLES = {
    "": "0.05",
    "N": "0.2 mN",
    "m": "0.1 mm",
    "1/m": "0.5 1/m",
    "N m": "1 N mm",
    "N m^2": "1 N mm^2",
}


def uncertainties_of(table: Mapping[str, Any], case: Case, place: Place) -> Uncertainties | None:
    """What an ``[uncertainty]`` table says."""
    if not table:
        return None
    inputs, noise = {}, {}
    correlations: tuple[tuple[str, str, float], ...] = ()
    for name, said in table.items():
        here = place([_TABLE, name])
        if name == "noise":
            noise = _noise(said, case, place)
        elif name == "correlations":
            correlations = _correlations(said, here)
        elif name in NAMES:
            inputs[name] = _input(name, said, case, here)
        else:
            known = ", ".join((*NAMES, "noise", "correlations"))
            raise InputError(here, shown(said), f"one of the keys {known}", "correct the name")
    try:
        return Uncertainties(inputs, noise, correlations)
    except InputError as error:
        raise InputError(
            place([_TABLE]), "unusable", "such that errors can be", str(error)
        ) from error


def _input(name: str, said: object, case: Case, here: str) -> Input:
    kinds = [key for key in _SAYS if isinstance(said, Mapping) and key in said]
    if not isinstance(said, Mapping) or len(said) != 1 or not kinds:
        raise InputError(
            here,
            shown(said),
            "{ standard = ... }, a standard uncertainty, or { within = ... }, half the width of an "
            "interval",
            "say which of the two it is",
        )
    dimension = "" if name in GAINS else INPUTS[name].dimension
    value = 1.0 if name in GAINS else nominal(case, name)
    if not math.isfinite(value):
        raise InputError(
            here,
            shown(said),
            f"left out: the case has no {name} that is a number",
            "a rigid clamp has no stiffness, a cylinder no radius of its tip",
        )
    size = _size(said[kinds[0]], dimension, value, case, f"{here}.{kinds[0]}")
    return Input(size) if kinds[0] == "standard" else Input.within(size)


def _size(said: object, dimension: str, nominal: float, case: Case, here: str) -> float:
    """A number in the unit of the case, from 0 up."""
    unit = f"with a unit of {dimension}" if case.beam.si and dimension else "a plain number"
    share = " or in per cent" if nominal else ""
    wrong = InputError(
        here,
        shown(said),
        f"{unit}{share}, from 0 up",
        f"as {_EXAMPLES[dimension]!r}"
        if case.beam.si and dimension
        else "as the case's own numbers",
    )
    size = math.nan
    if isinstance(said, str) and said.rstrip().endswith("%") and nominal:
        try:
            size = abs(nominal) * float(said.rstrip()[:-1]) / 100
        except ValueError as error:
            raise wrong from error
    elif isinstance(said, str) and case.beam.si and dimension:
        try:
            size = in_si(said, dimension)
        except InputError as error:
            raise wrong from error
    elif isinstance(said, int | float) and not isinstance(said, bool):
        size = float(said) if said == 0 or not (case.beam.si and dimension) else math.nan
    if not 0 <= size < math.inf:
        raise wrong
    return size


def _noise(said: object, case: Case, place: Place) -> dict[str, float]:
    here = place([_TABLE, "noise"])
    if not isinstance(said, Mapping) or set(said) - set(CLAMP_READINGS):
        known = ", ".join(CLAMP_READINGS)
        raise InputError(here, shown(said), f"a table of {known}", 'as force_x = "0.2 mN"')
    return {
        name: _size(value, DIMENSIONS[name], 0.0, case, place([_TABLE, "noise", name]))
        for name, value in said.items()
    }


def _correlations(said: object, here: str) -> tuple[tuple[str, str, float], ...]:
    pairs: list[Any] = said if isinstance(said, list) else [said]
    for pair in pairs:
        if not (
            isinstance(pair, list)
            and len(pair) == 3
            and all(isinstance(name, str) for name in pair[:2])
            and isinstance(pair[2], int | float)
            and not isinstance(pair[2], bool)
        ):
            raise InputError(
                here, shown(said), "lists of two names and a number", '[["length", "radius", 0.5]]'
            )
    return tuple((one, other, float(share)) for one, other, share in pairs)
