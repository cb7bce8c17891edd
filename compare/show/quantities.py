"""Numbers with their unit, where it is known: in SI, with the prefix that keeps them readable."""

from typing import Literal, TypeAlias

from analytic import Beam

Kind: TypeAlias = Literal["length", "force", "moment"]

_UNITS: dict[Kind, str] = {"length": "m", "force": "N", "moment": "N m"}
_PREFIXES = {"": 1.0, "m": 1e-3, "µ": 1e-6}
_SMALLEST = 0.1  # that is written without a smaller unit


def quantity(value: float, kind: Kind, beam: Beam) -> str:
    """A number of a sweep as reports write it."""
    if not beam.si:
        return f"{value:.4g}"
    sizes = [(prefix, size) for prefix, size in _PREFIXES.items() if abs(value) >= _SMALLEST * size]
    prefix, size = sizes[0] if sizes and value else ("", 1.0)
    return f"{value / size:.4g} {prefix}{_UNITS[kind]}"
