"""Quantities with units, as files and commands give them; SI inside.

A quantity is a number and a unit, nothing to be evaluated: ``"9**9**9 m"`` is refused.
"""

import math
import re
from functools import cache
from typing import TYPE_CHECKING

from analytic.problem.columns import SCHEMA
from analytic.problem.errors import InputError

if TYPE_CHECKING:
    import pint

OWN_UNITS = "units_of_the_file"
"""In the provenance of a sweep: units that nobody named, but its file."""

_SI = {"length": "m", "force": "N", "moment": "N m"}
DIMENSIONS = {name: _SI[one.dimension] for name, one in SCHEMA.items() if one.dimension in _SI}
"""An SI unit of each column that has one of these, in the plane and in space."""

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)", re.DOTALL)
_LONGEST = 60  # characters of a unit
_EXAMPLE = "check the unit, as in '50 mm'"
# Nm and Nmm, as instruments write them; elsewhere Nm is a unit of yarn.
_JOINED = re.compile(r"(?<!\w)([kmcµμ]?N)([mcµμ]?m)(?![^\W²³⁴])")
# Names, products, quotients, parentheses, and powers of at most two digits, not raised again.
_UNIT = re.compile(
    r"(?:[^\W\d]\w*|[²³⁴°]|[()·⋅*/ ]|(?:\^|\*\*) ?-?\d{1,2}(?!\d| ?\^| ?\*\*)|(?<![\d.])1(?= ?/))+"
)

_IN_NAME = re.compile(r"[\[(]([^\])]*)[\])]\s*$")  # as in "Fx [mN]"


@cache
def _registry() -> "pint.UnitRegistry[float]":
    import pint  # takes half a second to load, and most files have no units

    return pint.UnitRegistry()


def in_si(text: str, dimension: str) -> float:
    """The number of SI units in a quantity, as ``in_si("50 mm", "m")``."""
    parts = _NUMBER.fullmatch(text[:200])
    number = float(parts[1]) * unit_in_si(parts[2], dimension) if parts else math.nan
    if not math.isfinite(number):
        raise _refused(text, f"a finite number with a unit of {dimension}")
    return number


def unit_in_si(unit: str, dimension: str, called: str = "quantity") -> float:
    """How many SI units a unit is, as ``unit_in_si("mN mm", "N m")``."""
    found = _parsed(unit)
    if found is None or not found.is_compatible_with(dimension):
        wanted, fall = (_registry()(text).dimensionality for text in (dimension, "m/s^2"))
        weighed = found is not None and found.dimensionality * fall == wanted
        remedy = "a gram of force is written gf" if weighed else _EXAMPLE
        raise _refused(unit.strip(), f"a unit of {dimension}", called, remedy)
    return found.to(dimension).magnitude


def is_unit(text: str) -> bool:
    return _parsed(text) is not None


def check_unit(unit: str, column: str, written: str, dimension: str, of: str = "") -> None:
    """Refuse a unit of which the file itself says, over a column or in its name, that it is not."""
    in_name = _IN_NAME.search(column)
    said = written or (in_name[1] if in_name else "")
    own = _parsed(said)
    if own is None or not own.is_compatible_with(dimension):
        return
    if not math.isclose(own.to(dimension).magnitude, unit_in_si(unit, dimension)):
        allowed = f"in {said}, as the file says"
        raise InputError(
            f"column {column!r}{of}", f"in {unit}", allowed, "correct the one that is wrong"
        )


def _parsed(text: str) -> "pint.Quantity[float] | None":
    """One of a unit; None if it is not known."""
    unit = _JOINED.sub(r"\1 \2", text.strip())
    balanced = unit.count("(") == unit.count(")")
    if not (balanced and len(unit) <= _LONGEST and _UNIT.fullmatch(unit)):
        return None
    try:
        return _registry().Quantity(1.0, _registry().parse_units(unit))
    except Exception:  # pint has no common base of what a malformed unit raises
        return None


def _refused(
    text: str, allowed: str, called: str = "quantity", remedy: str = _EXAMPLE
) -> InputError:
    shown = repr(text if len(text) <= _LONGEST else f"{text[:_LONGEST]}...")
    return InputError(called, shown, allowed, remedy)
