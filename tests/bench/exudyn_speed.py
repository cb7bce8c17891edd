"""MuJoCo's beams and Exudyn's static ANCF cable past the same circle: error against time."""

import importlib.util
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from rich.console import Console
from rich.table import Table

from analytic import Case, Readings, Sweep, circle, solve_sweep
from compare import compare
from compare.show.page import save_figure
from engines import find_engine
from mujoco_models import Settings, available_beams, simulate_sweep

PLOT = Path("results/bench-exudyn.png")
LOWEST, RADIUS = (0.0, 0.4), 1.0
CASE = Case(profile=circle(RADIUS, LOWEST), sweep=Sweep(200, stop=-1.26))  # the fold is at -1.2705
SEGMENTS, ELEMENTS = (10, 20, 40, 80, 160), (5, 10, 20, 40)
_TICKS = (1, 2, 5, 10, 20)  # ms
# Okabe and Ito's palette, and markers, so that colour is not needed.
_STYLES = {
    "MuJoCo chain, mesh": {"color": "#0072B2", "marker": "o"},
    "MuJoCo rod, mesh": {"color": "#D55E00", "marker": "s"},
    "MuJoCo cable, mesh": {"color": "#CC79A7", "marker": "D"},
    "MuJoCo chain, primitive": {"color": "#0072B2", "marker": "o", "linestyle": "--"},
    "Exudyn, static ANCF cable": {"color": "#000000", "marker": "^"},
}


def main(quick: bool) -> None:
    console = Console()
    if importlib.util.find_spec("exudyn") is None:
        console.print(
            "exudyn: skipped, not installed; `.venv/bin/pip install '.[exudyn]'` gets it",
            markup=False,
        )
        return
    exact, engine = solve_sweep(CASE), find_engine("exudyn")
    runs: dict[str, dict[int, tuple[float, float]]] = {}
    models = [Settings(beam=beam) for beam in available_beams()] + [Settings(obstacle="primitive")]
    for model in models:
        runs[f"MuJoCo {model.beam}, {model.obstacle}"] = {
            n: _run(exact, partial(simulate_sweep, CASE, replace(model, segments=n)))
            for n in (SEGMENTS[:1] if quick else SEGMENTS)
        }
    runs["Exudyn, static ANCF cable"] = {
        n: _run(exact, partial(engine.sweep, CASE, Settings(segments=n)))
        for n in (ELEMENTS[:1] if quick else ELEMENTS)
    }
    table = Table(
        "model", "segments or elements", "CPU ms a station", "largest rms",
        title="200 stations past a circle; building the model included",
    )  # fmt: skip
    for name, sizes in runs.items():
        for n, (took, error) in sizes.items():
            table.add_row(name, str(n), f"{took:.1f}", f"{error:.1e}")
    console.print(table)
    if not quick:
        PLOT.parent.mkdir(exist_ok=True)
        console.print(f"wrote {save_figure(plot(runs), PLOT)}")


def _run(exact: Readings, produce: Callable[[], Readings]) -> tuple[float, float]:
    """CPU time a station [ms], and the largest relative rms of the clamp readings."""
    begin = time.process_time()
    readings = produce()
    took = time.process_time() - begin
    missing = len(exact.table) - int(readings.trusted.sum())
    if missing:
        raise RuntimeError(f"{readings.source}: {missing} stations did not come to rest")
    worst = max(d.rms for d in compare(exact, readings).disagreement.values())
    return 1e3 * took / len(exact.table), worst


def plot(runs: dict[str, dict[int, tuple[float, float]]]) -> Figure:
    """Error against time, a line a model."""
    figure = Figure(figsize=(7, 4.6), layout="constrained")
    ax = figure.subplots()
    for name, sizes in runs.items():
        took, error = zip(*sizes.values(), strict=True)
        ax.loglog(took, error, label=name, **_STYLES[name])
        if "rod" in name or "cable, mesh" in name:
            continue  # next to the chain's, which has the same numbers
        aside = (-6, -11) if "primitive" in name else (6, 5)
        for n, x, y in zip(sizes, took, error, strict=True):
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
