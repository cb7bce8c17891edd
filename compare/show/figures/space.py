"""A sweep in space: body, vibrissa and contacts as they stand, and the readings along the way."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D

from analytic.problem.arrays import Floats
from analytic.space import Body, SpatialReadings, deflected_rods
from analytic.space.problem.readings import CONTACT_POINT, FOOT, FORCE, MOMENT
from compare.show.style import (
    BLUE,
    BODY,
    FAINT,
    GREEN,
    GREY,
    INK,
    NORMAL,
    ORANGE,
    PAGE_WIDTH,
    PHASE_COLOURS,
    PHASE_NAMES,
    SMALL,
    label,
)
from compare.spatial.comparison import SpatialComparison, way

_SHAPES = 24  # drawn of a sweep
_DEPTH = 0.5  # of the scene, at least, over its longest side
_DARK = 0.35  # how much darker a patch is that looks away from the light
_LIGHT = np.array([0.4, -0.2, -0.9]) / np.linalg.norm([0.4, -0.2, -0.9])
_VIEW = {"elev": 12.0, "azim": -62.0}
_COLOURS = (BLUE, ORANGE, GREEN)


def sweep_in_space(readings: SpatialReadings, found: pd.DataFrame, body: Body) -> Figure:
    """Draw the body, the vibrissa at some stations, the contacts found, and the readings.

    Parameters
    ----------
    readings : SpatialReadings
        The sweep.
    found : pandas.DataFrame
        From `analytic.space.reconstruct_space`.
    body : Body
        In the unit of length of the readings.

    Returns
    -------
    Figure
        The scene, and below it force and moment over the way of the foot.
    """
    figure = Figure(figsize=(PAGE_WIDTH, 0.8 * PAGE_WIDTH), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.8, 1))
    scene = figure.add_subplot(grid[0, :], projection="3d", computed_zorder=False)
    _draw_scene(scene, readings, found, body.scaled(1 / readings.beam.length))
    left, right = (figure.add_subplot(grid[1, i]) for i in range(2))
    unit = readings.beam
    _draw_components(left, readings, FORCE, unit.force_unit, "$F$ / ($EI/L^2$)")
    _draw_components(right, readings, MOMENT, unit.moment_unit, "$M$ / ($EI/L$)")
    figure.suptitle(label(readings.source), x=0.01, ha="left", fontsize=NORMAL)
    handles = [
        Line2D([], [], color=colour, label=PHASE_NAMES[phase])
        for phase, colour in PHASE_COLOURS.items()
    ]
    handles.append(
        Line2D([], [], color=INK, marker="o", markersize=3, linestyle="", label="contact found")
    )
    handles.append(Line2D([], [], color=GREY, linestyle="--", label="way of the foot"))
    figure.legend(
        handles=handles, loc="outside lower center", ncols=5, fontsize=SMALL, frameon=False
    )
    return figure


def both_in_space(comparison: SpatialComparison) -> Figure:
    """Draw the six components of both sweeps over the way of the foot, and their differences.

    Parameters
    ----------
    comparison : SpatialComparison
        Of two sweeps.

    Returns
    -------
    Figure
        Force on the left, moment on the right, differences below.
    """
    figure = Figure(figsize=(PAGE_WIDTH, 0.6 * PAGE_WIDTH), layout="constrained")
    grid = figure.subplots(2, 2, sharex=True, height_ratios=(2, 1))
    one, other = comparison.reference, comparison.candidate
    beam = one.beam
    travel = way(one) / beam.length
    for column, (names, unit, title) in enumerate(
        (
            (FORCE, beam.force_unit, "$F$ / ($EI/L^2$)"),
            (MOMENT, beam.moment_unit, "$M$ / ($EI/L$)"),
        )
    ):
        above, below = grid[:, column]
        for name, colour in zip(names, _COLOURS, strict=True):
            exact, found = (r.values(name) / unit for r in (one, other))
            exact[~one.trusted], found[~other.trusted] = np.nan, np.nan
            above.plot(travel, exact, color=colour, linewidth=1, label=name[-1])
            above.plot(travel, found, color=colour, marker=".", markersize=3, linestyle="")
            off = np.where(comparison.compared, found - exact, np.nan)
            below.plot(travel, off, color=colour, marker=".", markersize=2.5, linewidth=0.8)
        above.set_ylabel(title)
        above.legend(fontsize=SMALL, frameon=False, ncols=3)
        below.set_ylabel("difference")
        below.set_xlabel("way of the foot / $L$")
        below.ticklabel_format(axis="y", style="sci", scilimits=(-2, 2))
        for ax in (above, below):
            ax.axhline(0, color=FAINT, linewidth=0.8, zorder=0)
    figure.suptitle(
        label(f"lines: {one.source}; dots: {other.source}"), x=0.01, ha="left", fontsize=NORMAL
    )
    return figure


def _draw_scene(ax: Axes3D, readings: SpatialReadings, found: pd.DataFrame, body: Body) -> None:
    length = readings.beam.length
    lines = deflected_rods(readings) / length
    foot = readings.values(*FOOT) / length
    contact = found[list(CONTACT_POINT)].to_numpy(dtype=float) / length
    shown = np.concatenate([lines[np.isfinite(lines).all(axis=2)], foot])
    low, high = shown.min(axis=0), shown.max(axis=0)
    widest = _DEPTH * float((high - low).max())  # a straight way has no depth
    middle = (low + high)[[0, 2]] / 2
    low[[0, 2]] = np.minimum(low[[0, 2]], middle - widest / 2)
    high[[0, 2]] = np.maximum(high[[0, 2]], middle + widest / 2)
    reach = 0.6 * float((high - low).max())
    patches = body.patches((low + high) / 2, reach)
    margin = 0.1
    inside = ((patches >= low - margin) & (patches <= high + margin)).all(axis=(1, 2))
    patches = patches[inside]
    if len(patches):
        across = np.cross(patches[:, 1] - patches[:, 0], patches[:, 2] - patches[:, 1])
        size = np.maximum(np.linalg.norm(across, axis=1), 1e-300)
        lit = np.abs(across @ _LIGHT) / size
        grey = (1 - _DARK) + _DARK * lit
        colours = np.column_stack(
            [np.repeat(0.87 * grey[:, None], 3, axis=1), np.full(len(grey), 0.6)]
        )
        ax.add_collection3d(
            Poly3DCollection(_up(patches), facecolors=colours, edgecolors=BODY, linewidths=0.2)
        )
    chosen = np.unique(np.linspace(0, len(lines) - 1, _SHAPES).round().astype(int))
    phases = readings.table["phase"].to_numpy(dtype=str) if "phase" in readings.table else None
    colours_of = [PHASE_COLOURS["free" if phases is None else phases[i]] for i in chosen]
    ax.add_collection3d(Line3DCollection(_up(lines[chosen]), colors=colours_of, linewidths=1.3))
    ax.plot(*_up(foot).T, color=GREY, linestyle="--", linewidth=1)
    ax.plot(*_up(contact).T, color=INK, marker="o", markersize=1.8, linestyle="")
    ax.set(
        xlim=(low[0] - margin, high[0] + margin),
        ylim=(high[2] + margin, low[2] - margin),
        zlim=(low[1] - margin, high[1] + margin),
        xlabel="$x$ / $L$",
        ylabel="$z$ / $L$",
        zlabel="$y$ / $L$",
    )
    ax.locator_params(nbins=5)
    extent = high - low + 2 * margin
    ax.set_box_aspect((extent[0], extent[2], extent[1]), zoom=1.45)
    ax.view_init(**_VIEW)


def _up(points: Floats) -> Floats:
    """From the case's axes, y up, to the picture's, whose third points up."""
    return points[..., [0, 2, 1]]


def _draw_components(
    ax: Axes, readings: SpatialReadings, names: tuple[str, ...], unit: float, title: str
) -> None:
    foot = readings.values(*FOOT) / readings.beam.length
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(foot, axis=0), axis=1))])
    values = readings.values(*names) / unit
    values[~readings.trusted] = np.nan
    for name, colour, column in zip(names, _COLOURS, values.T, strict=True):
        ax.plot(way, column, color=colour, marker=".", markersize=2.5, linewidth=1, label=name[-1])
    ax.axhline(0, color=FAINT, linewidth=0.8, zorder=0)
    ax.set_xlabel("way of the foot / $L$")
    ax.set_ylabel(title)
    ax.legend(fontsize=SMALL, frameon=False, ncols=3)
