"""MuJoCo's beams and the other engines: time a station, with the error beside it."""

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from rich.console import Console
from rich.table import Table

from analytic import Case, Readings, Sweep, circle, named_case, solve_sweep
from compare import compare
from compare.show.page import write_all
from engines import list_engines
from mujoco_models import Settings, available_beams, simulate_sweep

PLOT = Path("results/bench-exudyn.png")
CASE = Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(200, stop=-1.26))  # the fold: -1.2705
SEGMENTS = {"mujoco": (10, 20, 40, 80, 160), "exudyn": (5, 10, 20, 40)}
_TICKS = (1, 2, 5, 10, 20)  # ms
# Okabe and Ito's palette, and markers, so that colour is not needed.
_STYLES = {
    "MuJoCo chain, mesh": {"color": "#0072B2", "marker": "o"},
    "MuJoCo rod, mesh": {"color": "#D55E00", "marker": "s"},
    "MuJoCo cable, mesh": {"color": "#CC79A7", "marker": "D"},
    "MuJoCo chain, primitive": {"color": "#0072B2", "marker": "o", "linestyle": "--"},
    "exudyn": {"color": "#000000", "marker": "^", "label": "Exudyn, static ANCF cable"},
}


def beams(quick: bool) -> None:
    """Of MuJoCo, against segments and contour points, past the catenary."""
    case = named_case("catenary")
    case = replace(case, sweep=Sweep(20)) if quick else case
    exact = solve_sweep(case)
    table = Table(
        "beam", "segments", "contour points", "CPU ms a station", "largest rms", "unsettled",
        title=f"Catenary, {len(case.foot_x)} stations; building the model included",
    )  # fmt: skip
    sizes = [(40, 400), (40, 4000), *((n, 3200) for n in (20, 40, 80, 160, 320))]
    for beam in available_beams():
        for segments, points in [(10, 400)] if quick else sizes:
            settings = Settings(beam=beam, segments=segments, contour_points=points)
            took, worst, unsettled = _timed(exact, partial(simulate_sweep, case, settings))
            figures = f"{took:.1f}", f"{worst:.1e}", str(unsettled)
            table.add_row(beam, str(segments), str(points), *figures)
    Console().print(table)


def engines(quick: bool) -> None:
    """All that are installed, past a circle; with Exudyn a figure of error against time."""
    console, case = (
        Console(),
        replace(CASE, sweep=Sweep(12 if quick else 200, stop=-1.26)),
    )
    exact = solve_sweep(case)
    models = {
        f"MuJoCo {one.beam}, {one.obstacle}": ("mujoco", partial(simulate_sweep, case), one)
        for one in (*(Settings(beam=b) for b in available_beams()), Settings(obstacle="primitive"))
    }
    for found in list_engines():
        if found.engine is None or found.trouble is not None:
            console.print(f"{found.name}: skipped, {found.trouble}", markup=False)
        elif found.name != "mujoco":
            settings = Settings(obstacle="primitive")
            models[found.name] = found.name, partial(found.engine.sweep, case), settings
    table = Table(
        "model", "segments or elements", "CPU ms a station", "largest rms", "unsettled",
        title=f"{len(case.foot_x)} stations past a circle; building the model included",
    )  # fmt: skip
    runs: dict[str, dict[int, tuple[float, float, int]]] = {}
    for name, (engine, sweep, settings) in models.items():
        sizes = SEGMENTS.get(engine, (20, 40))[: 1 if quick else None]
        runs[name] = {
            n: _timed(exact, partial(sweep, replace(settings, segments=n))) for n in sizes
        }
        for n, (took, worst, unsettled) in runs[name].items():
            table.add_row(name, str(n), f"{took:.1f}", f"{worst:.1e}", str(unsettled))
    console.print(table)
    if "exudyn" in runs and not quick:
        (path,) = write_all(PLOT.parent, {PLOT.name: plot(runs)})
        console.print(f"wrote {path}")


def _timed(exact: Readings, produce: Callable[[], Readings]) -> tuple[float, float, int]:
    """CPU time a station [ms], largest relative rms of the clamp's readings, doubtful stations."""
    begin = time.process_time()
    readings = produce()
    took = time.process_time() - begin
    worst = max(d.rms for d in compare(exact, readings).disagreement.values())
    return 1e3 * took / len(readings.table), worst, int((~readings.trusted).sum())


def plot(runs: dict[str, dict[int, tuple[float, float, int]]]) -> Figure:
    """Error against time, a line a model."""
    figure = Figure(figsize=(7, 4.6), layout="constrained")
    ax = figure.subplots()
    for name in filter(runs.__contains__, _STYLES):
        took, error, _ = zip(*runs[name].values(), strict=True)
        ax.loglog(took, error, **{"label": name} | _STYLES[name])
        if "rod" in name or "cable, mesh" in name:
            continue  # next to the chain's, which has the same numbers
        aside = (-6, -11) if "primitive" in name else (6, 5)
        for n, x, y in zip(runs[name], took, error, strict=True):
            ax.annotate(str(n), (x, y), aside, textcoords="offset points", fontsize=8, ha="center")
    ax.set_title("Vibrissa past a circle: error against time on one core", fontsize=11)
    ax.set_xlabel("CPU time a station [ms]   (numbers: segments or elements)")
    ax.set_ylabel("largest rms of $F_{Ax}$, $F_{Ay}$, $M_{Az}$\nrelative to its largest magnitude")
    ax.set_xlim(left=1)
    ax.set_xticks(_TICKS, [f"{tick:g}" for tick in _TICKS])
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.grid(which="both", alpha=0.25)
    ax.legend(frameon=False, fontsize=9)
    return figure
