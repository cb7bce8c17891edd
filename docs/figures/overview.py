"""The README's picture: the sweep, the signs, and both models' readings.

Run as ``python -m docs.figures.overview FILE``.
"""

import sys
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc

from analytic import (
    CLAMP_READINGS,
    Case,
    Readings,
    Sweep,
    deflected_shapes,
    named_case,
    solve_sweep,
)
from compare.show import style
from compare.show.figures.over_foot import LINE, foot, shade_phases, with_fold
from mujoco_models import simulate_sweep

_FORCE = style.GREEN
_ARROW = {"arrowstyle": "-|>", "color": _FORCE, "linewidth": 1.8}


def overview(case: Case) -> Figure:
    """The sweep with the paper's sign convention, and the readings over the foot position."""
    exact = solve_sweep(case)
    simulated = simulate_sweep(replace(case, sweep=Sweep(stations=60)))
    figure = Figure(figsize=(11, 6.4), layout="constrained")
    grid = figure.add_gridspec(2, 3, height_ratios=[1.15, 1])
    _sketch(figure.add_subplot(grid[0, :]), exact)
    plots = [figure.add_subplot(grid[1, i]) for i in range(3)]
    _plots(plots, exact, simulated)
    handles, labels = plots[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)
    return figure


def _sketch(ax: Axes, exact: Readings) -> None:
    x, y = deflected_shapes(exact)
    phase = exact.table["phase"].to_numpy()
    named = set()
    for i in np.linspace(3, len(phase) - 1, 17).astype(int):
        name = str(phase[i])
        label = None if name in named else style.PHASE_NAMES[name]
        ax.plot(x[i], y[i], color=style.PHASE_COLOURS[name], linewidth=1.2, label=label)
        named.add(name)
    xi, eta = (np.asarray(c) for c in exact.provenance["contour"])
    ax.fill_between(xi, eta, eta.max(), color=style.BODY, linewidth=0)
    ax.plot(xi, eta, color=style.GREY, linewidth=2)
    ax.text(0, 0.75, "rigid, strictly convex object", ha="center", color=style.GREY)
    ax.axhline(0, color=style.FAINT, linewidth=0.8)
    ax.annotate(
        "", (-3.05, -0.22), (-2.25, -0.22), arrowprops={"arrowstyle": "-|>", "color": style.INK}
    )
    ax.text(-2.2, -0.22, "the foot (foot_x) is swept this way", va="center", color=style.INK)
    ax.set_aspect("equal")
    ax.set_xlim(-3.1, 4.35)
    ax.set_ylim(-0.35, 1.12)
    ax.axis("off")
    ax.legend(loc="upper left", fontsize=8.5, frameon=False, bbox_to_anchor=(0.37, 0.13), ncols=3)
    _signs(ax, x0=3.3)


def _signs(ax: Axes, x0: float) -> None:
    """One vibrissa apart, with everything that the paper measures and names."""
    case = Case(profile=named_case("catenary").profile, sweep=Sweep(stations=120))
    sweep = solve_sweep(case)
    i = int(np.argmin(np.abs(sweep.values("foot_x") - 1.9)))
    row = sweep.table.iloc[i]
    x, y = (path[i] for path in deflected_shapes(sweep))
    x = x - row["foot_x"] + x0
    cx, cy, alpha = row["contact_x"] - row["foot_x"] + x0, row["contact_y"], row["contact_angle"]
    ax.plot(x, y, color=style.INK, linewidth=2)
    ax.plot([x0 - 0.12, x0 + 0.12], [0, 0], color=style.INK, linewidth=3)
    span = np.linspace(-0.45, 0.45, 2)
    ax.plot(cx + span * np.cos(alpha), cy + span * np.sin(alpha), color=style.GREY, linewidth=1.2)
    ax.plot([cx, cx + 0.45], [cy, cy], color=style.GREY, linewidth=0.8, linestyle=":")
    ax.add_patch(Arc((cx, cy), 0.6, 0.6, theta1=0, theta2=np.rad2deg(alpha), color=style.GREY))
    ax.text(cx + 0.33, cy + 0.05, r"$\alpha$")
    ax.text(cx - 0.02, cy + 0.12, r"$(\xi, \eta)$", ha="right")
    ax.text(x[30] + 0.05, y[30] - 0.08, "$s$")
    push = 0.32 * np.array([np.sin(alpha), -np.cos(alpha)])
    ax.annotate("", (cx + push[0], cy + push[1]), (cx, cy), arrowprops=_ARROW)
    ax.text(cx + push[0] + 0.04, cy + push[1] - 0.02, "$f$", color=_FORCE)
    ax.annotate("", (x0 - 0.06, 0), (x0 - 0.42, 0), arrowprops=_ARROW)
    ax.text(x0 - 0.44, 0.02, "force_x", color=_FORCE, ha="right", va="bottom")
    ax.annotate("", (x0, 0.42), (x0, 0.02), arrowprops=_ARROW)
    ax.text(x0 - 0.05, 0.36, "force_y", color=_FORCE, ha="right")
    ax.annotate(
        "",
        (x0 + 0.02, 0.17),
        (x0 + 0.17, -0.06),
        arrowprops={**_ARROW, "connectionstyle": "arc3,rad=0.5"},
    )
    ax.text(x0 + 0.2, 0.03, "moment_z", color=_FORCE, va="bottom")
    ax.text(x0 - 0.62, -0.22, "clamp on vibrissa, counted positive", color=_FORCE, fontsize=9)


def _plots(axes: list[Axes], exact: Readings, simulated: Readings) -> None:
    phase = exact.table["phase"].to_numpy(dtype=str)
    for ax, name in zip(axes, CLAMP_READINGS, strict=True):
        shade_phases(ax, foot(exact), phase)
        curve = with_fold(exact, phase, foot(exact), exact.values(name))
        ax.plot(*curve, **LINE | {"linewidth": 1.8}, label="analytic")
        ax.plot(
            foot(simulated),
            simulated.values(name),
            "o",
            color=style.CANDIDATE,
            markersize=3.6,
            markeredgewidth=0,
            label="mujoco chain, 40 segments",
        )
        ax.set_title(style.axis_label(name), fontsize=10)
        ax.set_xlabel(style.FOOT)


if __name__ == "__main__":
    overview(named_case("catenary")).savefig(sys.argv[1], dpi=110)
