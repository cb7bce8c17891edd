"""Compares two stored sets, item by item."""

import json
import math
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]

ERRORS = (
    *("compare/*", "budget/*", "study/*"),
    *("*residual*", "*.discrepancy", "*.penetration", "*.extension", "*.out_of_plane"),
    *("*.torsion", "*.along_force", "*.joints.angle"),
)
"""What is itself an error or rounding, of quantities of order 1: a difference counts as it is."""


@dataclass(frozen=True)
class Difference:
    """At one place of an item; what is no number, or not there, differs by infinity."""

    place: str
    size: float
    what: str = ""

    def __str__(self) -> str:
        return f"{self.place} {self.what or f'{self.size:.1e}'}"


@dataclass(frozen=True)
class Allowed:
    """A difference on purpose, by patterns of ``ROOM/NAME`` and of the place in it."""

    items: str
    largest: float
    reason: str
    places: str = "*"

    def covers(self, item: str, one: Difference) -> bool:
        return (
            fnmatch(item, self.items)
            and fnmatch(one.place, self.places)
            and one.size <= self.largest
        )


def on_purpose() -> list[Allowed]:
    text = Path(__file__).with_name("on_purpose.toml").read_text()
    return [Allowed(**entry) for entry in tomllib.loads(text).get("difference", [])]


def compare_sets(old: Path, new: Path, tolerance: float) -> int:
    """Print a line for each item that differs and a summary by room; 1 if one differs."""
    allowed = on_purpose()
    counts: Counter[tuple[str, str]] = Counter()
    for item in sorted(
        {f"{p.parent.name}/{p.stem}" for a in (old, new) for p in a.glob("*/*.json")}
    ):
        files, room = [folder / f"{item}.json" for folder in (old, new)], item.partition("/")[0]
        if not files[1].exists():  # `make --only` makes a part
            counts[room, "not made"] += 1
            continue
        one, other = ({"": json.loads(f.read_text())} if f.exists() else {} for f in files)
        beyond = [d for d in differences(item, one, other) if d.size > tolerance]
        beyond.sort(key=lambda d: -d.size)
        meant = [a for a in allowed if any(a.covers(item, d) for d in beyond)]
        others = [d for d in beyond if not any(a.covers(item, d) for a in meant)]
        if others:
            more = f"; {len(others) - 3} places more" if len(others) > 3 else ""
            print(f"{item}: {'; '.join(map(str, others[:3]))}{more}")
        for reason in dict.fromkeys(a.reason for a in meant):
            print(f"{item}, on purpose, at most {beyond[0].size:.1e}: {reason}")
        verdict = "differ" if others else "differ on purpose" if meant else "equal"
        counts[room, verdict] += 1
    for (room, verdict), count in counts.items():
        print(f"{room:14} {count:4} {verdict}")
    return int(any(verdict == "differ" for _, verdict in counts))


def differences(
    item: str, old: Any, new: Any, place: str = "", scale: float = 0.0
) -> Iterator[Difference]:
    """Walk through both; a number is held against the largest of its column, or `scale` if more."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(old.keys() | new.keys()):
            inner = f"{place}.{key}".lstrip(".")
            if key not in old or key not in new:
                yield Difference(inner, math.inf, "is gone" if key in old else "is new")
            else:
                yield from differences(item, old[key], new[key], inner, _of_vector(old, key))
        return
    one, other = _numbers(old), _numbers(new)
    if one is None or other is None:
        yield from _unequal(item, old, new, place)
    elif one.shape != other.shape:
        yield Difference(place, math.inf, f"has the shape {one.shape} -> {other.shape}")
    elif not np.array_equal(_kinds(one), _kinds(other), equal_nan=True):
        yield Difference(place, math.inf, "is a number in one where it is none in the other")
    else:
        error = any(fnmatch(f"{item}:{place}", name) for name in ERRORS)
        yield Difference(place, _apart(one, other, max(scale, 1.0) if error else scale))


def _unequal(item: str, old: Any, new: Any, place: str) -> Iterator[Difference]:
    """Where one is text, or a list with texts in it."""
    if not (isinstance(old, list) and isinstance(new, list) and len(old) == len(new)):
        if old != new:
            yield Difference(place, math.inf, f"{str(old)[:60]!r} -> {str(new)[:60]!r}")
    elif any(isinstance(value, list | dict) for value in old + new):
        for row, (one, other) in enumerate(zip(old, new, strict=True)):
            yield from differences(item, one, other, f"{place}.{row}")
    elif old != new:
        count = sum(one != other for one, other in zip(old, new, strict=True))
        yield Difference(place, math.inf, f"differs in {count} of {len(old)} rows")


def _of_vector(columns: dict[str, Any], key: str) -> float:
    """The largest number of all components of a vector, one of which is the column `key`.

    A component that is zero but for rounding has no size of its own.
    """
    if key[-2:] not in ("_x", "_y", "_z"):
        return 0.0
    components = (_numbers(columns[name]) for name in columns if name[:-1] == key[:-1])
    return max((_largest(one) for one in components if one is not None), default=0.0)


def _numbers(value: Any) -> Floats | None:
    try:
        return None if isinstance(value, str) else np.array(value, dtype=float)
    except (TypeError, ValueError):  # text, or rows of different lengths
        return None


def _kinds(values: Floats) -> Floats:
    """Zero for numbers; what is not finite is itself."""
    return np.where(np.isfinite(values), 0.0, values)


def _largest(values: Floats) -> float:
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _apart(one: Floats, other: Floats, scale: float) -> float:
    finite = np.isfinite(one)
    difference = _largest(np.where(finite, other, 0.0) - np.where(finite, one, 0.0))
    return difference and difference / max(_largest(one), _largest(other), scale)
