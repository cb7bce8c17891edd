"""What friction does to a sweep: the way back is another one, and the vibrissa lets go elsewhere.

``python -m docs.figures.hysteresis FILE.png`` draws it.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from analytic import Case, find_events, named_case, solve_sweep, turn_back
from compare.show.page import write_all
from compare.show.style import FAINT, GREEN, GREY, INK, SMALL, YELLOW

_COEFFICIENTS = np.linspace(0, 0.6, 13)
_OBJECTS = {"catenary": INK, "parabola": GREEN, "two-circles": YELLOW}
_STATIONS = 400


def hysteresis(name: str = "rubbing", turns: tuple[float, ...] = (1.2, 0.2)) -> Figure:
    """Draw the clamp's moment there and back, and where the vibrissa lets go, with friction."""
    figure = Figure(figsize=(11, 3.8), layout="constrained")
    force, moment, snap_off = figure.subplots(1, 3)
    case = named_case(name)
    for ax, reading, symbol in (
        (force, "force_x", "force_x / ($EI/L^2$)"),
        (moment, "moment_z", "moment_z / ($EI/L$)"),
    ):
        _there_and_back(ax, case, turns, reading)
        ax.set_ylabel(symbol)
        ax.set_xlabel("foot_x / $L$   (on is to the left)")
    moment.legend(fontsize=SMALL, frameon=False, loc="lower center")
    for one, colour in _OBJECTS.items():
        smooth = named_case(one)
        ends = [
            find_events(smooth.profile, smooth.beam, friction=mu).snap_off.foot_x
            for mu in _COEFFICIENTS
        ]
        snap_off.plot(_COEFFICIENTS, np.array(ends) - ends[0], color=colour, label=one)
    snap_off.axhline(0, color=FAINT, linewidth=0.8)
    snap_off.set_xlabel(r"friction coefficient $\mu$")
    snap_off.set_ylabel("snap-off, less that without friction / $L$")
    snap_off.legend(fontsize=SMALL, frameon=False)
    return figure


def _there_and_back(ax: Axes, case: Case, turns: tuple[float, ...], reading: str) -> None:
    rubbing = solve_sweep(case)
    smooth = solve_sweep(replace(case, friction=0.0))
    ax.plot(
        smooth.values("foot_x"), smooth.values(reading), "--", color=GREY, label="without friction"
    )
    ax.plot(
        rubbing.values("foot_x"), rubbing.values(reading), color=INK,
        label=rf"on, $\mu$ = {case.friction:g}",
    )  # fmt: skip
    for number, turn_at in enumerate(turns):
        back = turn_back(case, turn_at, _STATIONS)
        slides = int(np.argmax(back["sliding"] == "back"))
        for part, colour, label in (
            (back[: slides + 1], YELLOW, "sticks"),
            (back[slides:], GREEN, "back"),
        ):
            ax.plot(part["foot_x"], part[reading], color=colour, label="" if number else label)


if __name__ == "__main__":
    out = Path(sys.argv[1])
    write_all(out.parent, {out.name: hysteresis()})
