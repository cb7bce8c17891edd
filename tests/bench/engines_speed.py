"""The engines beside MuJoCo on the same case and settings: time a station, with the error."""

import time
from dataclasses import replace

from rich.console import Console
from rich.table import Table

from analytic import Sweep, named_case, solve_sweep
from compare import compare
from engines import list_engines
from mujoco_models import Settings

STATIONS, SEGMENTS = 40, (20, 40)


def main(quick: bool) -> None:
    console, case = Console(), named_case("parabola")
    case = replace(case, sweep=Sweep(5 if quick else STATIONS))
    exact = solve_sweep(case)
    table = Table(
        "engine", "segments or elements", "CPU ms a station", "over MuJoCo's", "largest rms",
        title=f"Parabola, {len(case.foot_x)} stations, smooth; building the model included",
    )  # fmt: skip
    base: dict[int, float] = {}
    for found in list_engines():
        if found.engine is None or found.trouble is not None:
            console.print(f"{found.name}: skipped, {found.trouble}", markup=False)
            continue
        for segments in SEGMENTS[:1] if quick else SEGMENTS:
            begin = time.process_time()
            sweep = found.engine.sweep(case, Settings(segments=segments, obstacle="primitive"))
            took = (time.process_time() - begin) / len(sweep.table)
            worst = max(d.rms for d in compare(exact, sweep).disagreement.values())
            ratio = took / base.setdefault(segments, took)  # MuJoCo is the first
            cells = (f"{1e3 * took:.1f}", f"{ratio:.1f}", f"{worst:.1e}")
            table.add_row(found.name, str(segments), *cells)
    console.print(table)
