"""Numbers and names as people read them."""

import math
from typing import Any, Literal, TypeAlias

from analytic import Beam, Readings
from analytic.space import SpatialReadings

Kind: TypeAlias = Literal["length", "force", "moment"]

_UNITS: dict[Kind, str] = {"length": "m", "force": "N", "moment": "N m"}
_PREFIXES = {"": 1.0, "m": 1e-3, "µ": 1e-6}
_SMALLEST = 0.1  # that is written without a smaller unit
_DECIMALS = 5  # beyond them an uncertainty is a power of ten


def short(x: float | None, unit: str = "") -> str:
    """Two digits and a power of ten."""
    if x is None or x != x:
        return "none"
    return (f"{x:.1e}".replace("e-0", "e-").replace("e+0", "e+") if x else "0") + unit


def place(x: float | None) -> str:
    """A position, to what a picture could show."""
    return "none" if x is None or x != x else f"{x:.5g}"


def percent(x: float) -> str:
    return f"{100 * x:.1f} %"


def words(name: str) -> str:
    return name.replace("_", " ").replace("phase b", "Phase B")


def sentence(text: str) -> str:
    """A clause as a sentence, without the marks of code that a terminal and Markdown have."""
    text = text.replace("`", "")
    return text and f"{text[0].upper()}{text[1:].rstrip('.')}."


def picked(of: object, *names: str) -> dict[str, Any]:
    """Some of a record's fields, as a file holds them."""
    return {name: getattr(of, name) for name in names}


def object_of(readings: Readings | SpatialReadings) -> str:
    """What a sweep's object is, if its source recorded that; its numbers are in the case's unit."""
    name = "profile" if isinstance(readings, Readings) else "body"
    if not (said := readings.provenance.get(name)):
        return "Object not recorded"
    return f"{said}, lengths in {'m' if readings.beam.si else 'units of the case'}"


def quantity(value: float, kind: Kind, beam: Beam) -> str:
    """A number with its unit, where that is known: in SI, with the prefix that suits it."""
    size, unit = _unit(value, kind, beam)
    return f"{value / size:.4g}{unit}"


def uncertain(value: float, half: float, kind: Kind, beam: Beam) -> str:
    """A number and its uncertainty in one unit, to two digits of the latter."""
    size, unit = _unit(max(value, -value, half), kind, beam)
    value, half = value / size, half / size
    if not half:
        return f"{value:.4g}{unit}"
    decimals = max(0, 1 - math.floor(math.log10(half)))
    if decimals > _DECIMALS:
        return f"{place(value)} ± {short(half)}{unit}"
    return f"{value:.{decimals}f} ± {half:.{decimals}f}{unit}"


def _unit(value: float, kind: Kind, beam: Beam) -> tuple[float, str]:
    if not beam.si:
        return 1.0, ""
    sizes = [(prefix, size) for prefix, size in _PREFIXES.items() if abs(value) >= _SMALLEST * size]
    prefix, size = sizes[0] if sizes and value else ("", 1.0)
    return size, f" {prefix}{_UNITS[kind]}"
