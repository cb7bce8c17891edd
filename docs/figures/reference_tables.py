"""Reference tables that any engine can be held against, without this project installed.

``python -m docs.figures.reference_tables DIR`` writes them.
"""

import hashlib
import sys
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from analytic import (
    CASE_NAMES,
    Beam,
    Case,
    Sweep,
    Whisk,
    find_events,
    named_case,
    solve_contact,
    solve_sweep,
)
from analytic.problem.files import write_whole
from analytic.space import FootPath, SpatialCase, ellipsoid, solve_space, sphere

VERSION = "2"
_LICENCE = "MIT"
_SOURCE = "vibrissa-testbed: elastica in elliptic integrals with E I = L = 1"
_THIN = Beam(radius=0.0)
_NUMBERS = "%.13e"  # 14 digits
_FRICTION = {"free of friction": 0.0, "held back": 0.2, "driven": -0.2}
_ANGLES = np.deg2rad(np.arange(40, -41, -4))
_STATIONS = 40
_CURVED = (
    0.9,
    0.95,
    1.1,
)  # towards the catenary: it stays on the near side, or lies down on the other
_LEANING = -0.2, 0.2  # the clamp [rad]
# Where a foot stands [L] so that a whisk starts clear of the contour.
_FEET = {"catenary": 0.5, "parabola": 0.0, "two-circles": 0.0, "shallow-catenary": 1.5}
_COLUMNS = Path(__file__).with_name("columns.csv")  # their units and signs
_SAID = ("status", "residual", "stability")  # of the numbers' quality
_PRIME, _BASIS, _WORD = 0x100000001B3, 0xCBF29CE484222325, 2**64  # of the FNV-1a hash
_PROFILES = {name: named_case(name).profile for name in CASE_NAMES}
_BODIES = {
    "sphere": sphere(1.0, centre=(0, 1.4, 0)),
    "ellipsoid": ellipsoid((1.0, 0.7, 1.6), centre=(0.0, 1.1, 0.0)),
}


def write_tables(folder: Path) -> list[Path]:
    """The tables, their columns and a manifest with checksums; bit for bit the same each time."""
    written, lines = [], []
    for name, table in _tables():
        floats = list(table.select_dtypes("float").columns)
        table[floats] += 0.0  # no minus before a zero
        content = table.to_csv(
            index=False, float_format=_NUMBERS, na_rep="nan", lineterminator="\n"
        )
        written.append(write_whole(folder / f"{name}.csv", content))
        data = content.encode()
        sums = hashlib.sha256(data).hexdigest(), f"{_fnv(data):016x}"
        lines.append((f"{name}.csv", VERSION, len(table), *sums, _SOURCE, _LICENCE))
    head = ["file", "version", "rows", "sha256", "fnv1a", "source", "licence"]
    manifest = pd.DataFrame(lines, columns=head).to_csv(index=False, lineterminator="\n")
    return [*written, write_whole(folder / "MANIFEST.csv", manifest)]


def _tables() -> Iterator[tuple[str, pd.DataFrame]]:
    parts: dict[str, list[pd.DataFrame]] = {}
    for kind, table in _parts():
        trusted = table[table["status"] == "ok"]
        said = [name for name in map(str, table) if name.startswith(_SAID)]
        parts.setdefault(kind, []).append(trusted.drop(columns=said))
    for kind, tables in parts.items():
        yield kind, pd.concat(tables, ignore_index=True)
    yield "columns", pd.read_csv(_COLUMNS, keep_default_na=False)


def _parts() -> Iterator[tuple[str, pd.DataFrame]]:
    """Tables of single cases by what they belong to."""
    for case, profile in _PROFILES.items():
        for way, friction in _FRICTION.items():
            table = solve_contact(profile, _ANGLES, _THIN, friction=friction)
            labels = {"case": case, "kind": way, "friction": friction}
            yield "friction" if friction else "contact", _labelled(table, labels)
        table = solve_sweep(Case(_THIN, profile, Sweep(stations=_STATIONS))).table
        yield "sweep", _labelled(table, {"case": case, "station": range(len(table))})
        events = vars(find_events(profile, _THIN)).items()
        happened = {event: asdict(found) for event, found in events if found is not None}
        table = pd.DataFrame(list(happened.values()))
        yield "event", _labelled(table, {"case": case, "event": list(happened)})
    for number, curvature in enumerate(_CURVED):
        beam = Beam(radius=0.0, natural_curvature=curvature)
        table = solve_sweep(Case(beam, _PROFILES["catenary"], Sweep(stations=_STATIONS))).table
        labels = {"case": f"catenary {number}", "natural_curvature": curvature}
        yield "curved", _labelled(table, labels | {"station": range(len(table))})
    for case, profile in _PROFILES.items():
        for angle in _LEANING:
            swept = Case(_THIN, profile, Sweep(stations=_STATIONS), clamp_angle=angle)
            table = solve_sweep(swept).table
            labels = {"case": case, "kind": "left" if angle > 0 else "right", "clamp_angle": angle}
            yield "leaning", _labelled(table, labels | {"station": range(len(table))})
        table = solve_sweep(
            Case(_THIN, profile, Whisk(_FEET.get(case, 0.0), stations=_STATIONS))
        ).table
        yield "whisking", _labelled(table, {"case": case, "station": range(len(table))})
    for case, body in _BODIES.items():
        path = FootPath([[1.3, 0.3], [-0.2, 0.1]], tangent=(0.1, 1, 0.05), stations=_STATIONS)
        for kind, friction in (("space", 0.0), ("space-friction", 0.3)):
            oblique = SpatialCase(_THIN, body=body, path=path, friction=friction)
            table = solve_space(oblique).table
            yield kind, _labelled(table, {"case": case, "station": range(len(table))})


def _labelled(table: pd.DataFrame, labels: dict[str, Any]) -> pd.DataFrame:
    return pd.concat([pd.DataFrame(labels, index=table.index), table], axis=1)


def _fnv(data: bytes) -> int:
    found = _BASIS
    for byte in data:
        found = (found ^ byte) * _PRIME % _WORD
    return found


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for path in write_tables(folder):
        print(path)
