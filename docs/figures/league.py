"""The engines side by side: ``python -m docs.figures.league DIR`` writes ``league.csv`` and page.

Every engine that is installed sweeps four small cases, smooth ones on the primitive. Beside these
stand those that were evaluated outside (`docs/evaluations`), with their defaults' error. Times are
ratios to MuJoCo's in the same run, too: a busy machine makes all of them slow.
"""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, Case, Readings, Sweep, named_case, polygon, solve_sweep
from analytic.problem.files import write_whole
from compare import compare
from compare.show.document import Block, Document, Section, Table, Text, Verdict
from compare.show.numbers import percent, short
from docs.figures.markdown import MARK, markdown
from docs.figures.quasi_static import STOCK
from engines import list_engines
from engines.apart import sweep_apart
from mujoco_models import Settings, simulate_motion

_SEGMENTS = (10, 20, 40)
_SHOWN = 20  # on the page
_STATIONS = 15
_PAGE = "league.md"


def cases() -> list[Case]:
    """Three smooth objects, and one with corners."""
    turns = 0.1 + 2 * np.pi * np.arange(6) / 6
    corners = np.column_stack([0.5 * np.cos(turns), 0.9 + 0.5 * np.sin(turns)])
    named = [named_case(name) for name in ("catenary", "parabola", "tip-only")]
    found = [*named, Case(name="hexagon", profile=polygon(corners))]
    return [replace(case, sweep=Sweep(_STATIONS)) for case in found]


def measured(timeout: float = 300.0) -> pd.DataFrame:
    """A row an engine, a case and a number of segments; engines that are missing have none."""
    rows = []
    for case in cases():
        for segments in _SEGMENTS:
            settings = Settings(segments=segments)
            if case.name != "hexagon":
                settings = replace(settings, obstacle="primitive")
            rows += _side_by_side(case, settings, timeout)
    return pd.DataFrame(rows)


def _side_by_side(case: Case, settings: Settings, timeout: float) -> list[dict[str, object]]:
    """MuJoCo first, in whose time the others' are given."""
    there = [found for found in list_engines() if found.engine is not None and not found.trouble]
    exact, rows, unit = solve_sweep(case), [], math.nan
    for found in sorted(there, key=lambda one: one.name != "mujoco"):
        outcome = sweep_apart(found.name, case, settings, timeout)
        row: dict[str, object] = {"case": case.name, "engine": f"{found.name} {found.version}"}
        row |= {"model": found.role, "segments": settings.segments}
        if outcome.readings is not None:
            took = 1e3 * float(outcome.readings.provenance["seconds"]) / _STATIONS
            unit = took if found.name == "mujoco" else unit
            row |= _read(exact, outcome.readings) | {"ms": took, "times_mujoco": took / unit}
        if found.name == "mujoco":
            stock = compare(exact, simulate_motion(case, STOCK, settings)).disagreement
            row["default_error"] = max(stock[key].rms for key in CLAMP_READINGS)
        row["settings"] = found.tuned
        rows.append({**row, "trouble": outcome.trouble})
        print(*rows[-1].values(), flush=True)
    return rows


def _read(exact: Readings, swept: Readings) -> dict[str, object]:
    one = compare(exact, swept)
    apart = one.snap_off.difference
    return {
        **{key: one.disagreement[key].rms for key in CLAMP_READINGS},
        "snap_off": None if apart is None else apart / exact.beam.length,
        "trusted": float(swept.trusted.mean()),
    }


def evaluated(file: Path) -> pd.DataFrame:
    """The rows of engines that were evaluated outside, as well as they get, with their defaults."""
    table = pd.read_csv(file)
    at = ["engine", "case"]
    defaults = table[table["settings"] == "defaults"].set_index(at)[[*CLAMP_READINGS]].max(axis=1)
    best = table[table["settings"] == "tuned"].copy()
    best["default_error"] = [
        defaults.get(key) for key in zip(best["engine"], best["case"], strict=True)
    ]
    best["trusted"] = 1 - best["doubted"] / best["stations"]
    best["case"] = "circle, " + best["case"]
    best["model"], best["settings"] = "evaluated", "see docs/evaluations"
    columns = ["case", "engine", "model", "segments", *CLAMP_READINGS, "trusted"]
    return best[[*columns, "times_mujoco", "settings", "default_error"]]


def page(table: pd.DataFrame) -> Document:
    """The table as a page."""
    finest = table[table["segments"] == _SHOWN]
    errors = finest.assign(worst=finest[[*CLAMP_READINGS]].max(axis=1))
    of_engine = errors.groupby(["engine", "model"], sort=False)
    worst = of_engine.agg(
        {"worst": "max", "trusted": "min", "times_mujoco": "max", "default_error": "max"}
    ).reset_index()
    rows = [
        (
            row["engine"], row["model"], _number(row["worst"]), percent(row["trusted"]),
            f"{row['times_mujoco']:.3g}", _number(row["default_error"]),
        )
        for row in worst.to_dict("records")
    ]  # fmt: skip
    head = ("engine", "model", "worst rms", "trusted", "times MuJoCo", "by default")
    caption = "Worst case"
    said = Text(
        f"{_SHOWN} segments, {_STATIONS} stations of catenary, parabola, tip-only, hexagon "
        "(evaluated: 30, four circles); league.csv has each. trusted: stations that are ok. times "
        "MuJoCo: of processors. by default: with the engine's settings; MuJoCo in motion."
    )
    blocks: list[Block] = [
        said,
        Table(caption, head, rows, words=(0, 1)),
    ]
    claim = f"All are within {short(worst['worst'].max())} of the closed form, as well as they get."
    verdict = Verdict(True, claim)
    return Document(
        "Engines side by side", "", verdict, [Section("league", "League table", blocks)]
    )


def _number(value: object) -> str:
    number = float("nan") if value is None else float(str(value))
    return "" if math.isnan(number) else short(number)


def main(out: Path) -> None:
    """Measure, and write both."""
    table = pd.concat([measured(), evaluated(out / "evaluations.csv")], ignore_index=True)
    write_whole(out / "league.csv", table.to_csv(index=False, float_format="%.4g").encode())
    write_whole(out / _PAGE, (MARK + markdown(page(table))).encode())


if __name__ == "__main__":
    main(Path(sys.argv[1]))
