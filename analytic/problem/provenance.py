"""What readings carry along besides their table, in the form that they can use."""

from collections.abc import Mapping, Sequence
from typing import Any

from analytic.problem.errors import InputError
from analytic.problem.numbers import floats
from analytic.problem.support import RECORDED


def check_provenance(provenance: Mapping[str, Any]) -> None:
    for name, known in (("events", None), ("support", RECORDED)):
        value = provenance.get(name, {})
        fits = isinstance(value, Mapping) and (known is None or set(value) <= known)
        if not fits or not all(_is_number(x) for x in value.values()):
            allowed = "numbers or null by name"
            raise InputError(f"provenance.{name}", f"{value!r}"[:80], allowed, "drop it")
    contour, others = provenance.get("contour", [[], []]), provenance.get("others", [])
    for one in (contour, *(others if isinstance(others, list) else [others])):
        floats("provenance.contour", one, (2, None), "two lists of as many coordinates")


def recorded_contours(contours: Sequence[Any]) -> dict[str, Any]:
    """What the provenance says of the contours of objects, the first one and others."""
    named = {"contour": contours[0]} if contours else {}
    return named | ({"others": [*contours[1:]]} if contours[1:] else {})


def _is_number(value: object) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))
