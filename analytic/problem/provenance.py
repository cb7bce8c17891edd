"""What readings carry along besides their table, in the form that they can use."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from analytic.problem.errors import InputError


def check_provenance(provenance: Mapping[str, Any]) -> None:
    """Refuse what readings could not use."""
    events = provenance.get("events", {})
    if not isinstance(events, Mapping) or not all(_is_place(x) for x in events.values()):
        raise InputError(
            "provenance.events", _short(events), "foot positions or null by name", "drop it"
        )
    support = provenance.get("support", {})
    if not _is_held(support):
        raise InputError(
            "provenance.support", _short(support), "clamp_stiffness and friction", "drop it"
        )
    contour = provenance.get("contour", [[], []])
    try:
        right = np.ndim(contour) == 2 and len(contour) == 2 and np.isfinite(contour).all()
    except (TypeError, ValueError):
        right = False
    if not right:
        raise InputError(
            "provenance.contour", _short(contour), "two lists of as many coordinates", "drop it"
        )


def _is_held(value: object) -> bool:
    """Whether a value is a clamp's stiffness, None if rigid, and friction, by name."""
    if not isinstance(value, Mapping):
        return False
    known = set(value) <= {"clamp_stiffness", "friction"}
    return known and all(_is_place(number) for number in value.values())


def _is_place(value: object) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:80]}..."
