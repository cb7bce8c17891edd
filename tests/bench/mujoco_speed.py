"""The beams: time a station against segments and contour points, with the error beside it."""

import time
from dataclasses import replace

from rich.console import Console
from rich.table import Table

from analytic import Sweep, named_case, solve_sweep
from compare import compare
from mujoco_models import Settings, available_beams, simulate_sweep


def main(quick: bool) -> None:
    case = named_case("catenary")
    case = replace(case, sweep=Sweep(20)) if quick else case
    exact = solve_sweep(case)
    table = Table(
        "beam", "segments", "contour points", "CPU ms a station", "largest rms", "unsettled",
        title=f"Catenary, {len(case.foot_x)} stations; building the model included",
    )  # fmt: skip
    sizes = [(40, 400), (40, 4000), *((n, 3200) for n in (20, 40, 80, 160, 320))]
    sizes = [(10, 400)] if quick else sizes
    for beam in available_beams():
        for segments, points in sizes:
            settings = Settings(beam=beam, segments=segments, contour_points=points)
            begin = time.process_time()
            sweep = simulate_sweep(case, settings)
            took = (time.process_time() - begin) / len(sweep.table)
            found = compare(exact, sweep)
            worst = max(d.rms for d in found.disagreement.values())
            unsettled = int((sweep.table["status"] != "ok").sum())
            table.add_row(
                beam,
                str(segments),
                str(points),
                f"{1e3 * took:.1f}",
                f"{worst:.1e}",
                str(unsettled),
            )
    Console().print(table)
