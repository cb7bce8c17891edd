"""A sweep in space: body, vibrissa and contacts as they stand, and the readings along the way."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D

from analytic.numerics.arrays import Floats
from analytic.space.problem.readings import FORCE, MOMENT
from compare.align.frames import components
from compare.comparison import SpatialComparison
from compare.show import style
from compare.show.figures.over_foot import in_unit, key_below, phase_handles, unit
from compare.show.scene import SweepScene, normals

_SHAPES = 24  # drawn of a sweep
_AROUND = 0.12  # opacity of what the body is inside of
_DARK = 0.35  # how much darker a face is that looks away from the light
_LIGHT = np.array([0.4, -0.2, -0.9]) / np.linalg.norm([0.4, -0.2, -0.9])
_VIEW = {"elev": 12.0, "azim": -62.0}
COLOURS = (style.BLUE, style.ORANGE, style.GREEN)
"""Of the components in x, y and z."""
_LEAST = 1e-12  # L; contacts that are closer are drawn at this
_EVENT: dict[str, Any] = {"color": style.INK, "marker": "|", "linestyle": ""}
LOADS = {"$F$ / ($EI/L^2$)": FORCE, "$M$ / ($EI/L$)": MOMENT}
"""Force and moment by the labels of their axes."""


def sweep_in_space(scene: SweepScene, around: Floats | None = None) -> Figure:
    """Draw the body, the vibrissa at some stations, the contacts found, and the readings.

    And, around the body, the triangles of one that it is inside of.
    """
    readings = scene.readings
    figure = Figure(figsize=(style.PAGE_WIDTH, 0.8 * style.PAGE_WIDTH), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.8, 1))
    ax = figure.add_subplot(grid[0, :], projection="3d", computed_zorder=False)
    draw_scene(ax, scene)
    if around is not None:
        ax.add_collection3d(
            Poly3DCollection(upright(around), facecolors=style.BLUE, alpha=_AROUND, linewidths=0)
        )
    chosen = np.unique(np.linspace(0, len(scene.lines) - 1, _SHAPES).round().astype(int))
    colours = [style.PHASE_COLOURS[phase] for phase in scene.phase[chosen]]
    ax.add_collection3d(
        Line3DCollection(upright(scene.lines[chosen]), colors=colours, linewidths=1.3)
    )
    ax.plot(*upright(scene.contact).T, color=style.INK, marker="o", markersize=1.8, linestyle="")
    for i, (title, names) in enumerate(LOADS.items()):
        below = figure.add_subplot(grid[1, i])
        travel = readings.running_values / readings.beam.length
        for name, colour in zip(names, COLOURS, strict=True):
            values = in_unit(readings, name)
            below.plot(travel, values, ".-", color=colour, markersize=2.5, label=name[-1])
        label_axes(below, title)
    figure.suptitle(style.label(readings.source), x=0.01, ha="left", fontsize=style.NORMAL)
    found = Line2D([], [], color=style.INK, marker="o", markersize=3, ls="", label="contact found")
    way = Line2D([], [], color=style.GREY, linestyle="--", label="way of the foot")
    key_below(figure, [*phase_handles(), found, way], 5)
    return figure


def both_in_space(comparison: SpatialComparison) -> Figure:
    figure = Figure(figsize=(style.PAGE_WIDTH, 0.6 * style.PAGE_WIDTH), layout="constrained")
    grid = figure.subplots(2, 2, sharex=True, height_ratios=(2, 1))
    one, other = comparison.reference, comparison.candidate
    beam = one.beam
    travel = comparison.travel / beam.length
    values = [components(r, comparison.frame) for r in (one, other)]
    for (above, below), (title, names) in zip(grid.T, LOADS.items(), strict=True):
        for name, colour in zip(names, COLOURS, strict=True):
            exact, found = (value[name] / unit(one, name) for value in values)
            exact[~one.trusted], found[~other.trusted] = np.nan, np.nan
            above.plot(travel, exact, color=colour, linewidth=1, label=name[-1])
            above.plot(travel, found, color=colour, marker=".", markersize=3, linestyle="")
            off = np.where(comparison.compared, found - exact, np.nan)
            below.plot(travel, off, color=colour, marker=".", markersize=2.5, linewidth=0.8)
        label_axes(above, title)
        above.set_xlabel("")
        below.set_ylabel("difference")
        below.set_xlabel("way of the foot / $L$")
        below.ticklabel_format(axis="y", style="sci", scilimits=(-2, 2))
        below.axhline(0, color=style.FAINT, linewidth=0.8, zorder=0)
    title = style.label(f"lines: {one.source}; dots: {other.source}")
    figure.suptitle(title, x=0.01, ha="left", fontsize=style.NORMAL)
    return figure


def contacts_in_space(comparison: SpatialComparison) -> Figure:
    """Draw when both sweeps touch, in which phase, and how far their contacts are apart."""
    figure = Figure(figsize=(style.PAGE_WIDTH, 0.4 * style.PAGE_WIDTH), layout="constrained")
    strips, below = figure.subplots(2, 1, sharex=True, height_ratios=(1, 1.6))
    length = comparison.reference.beam.length
    travel = comparison.travel / length
    edges = np.concatenate([travel[:1], (travel[1:] + travel[:-1]) / 2, travel[-1:]])
    sides = (comparison.reference, comparison.candidate)
    for row, (readings, on) in enumerate(zip(sides, comparison.touching[:2], strict=True)):
        phase = np.where(on, "touching", "free").astype(object)
        if "phase" in readings.table:
            phase = readings.table["phase"].to_numpy()
        phase = np.where(readings.trusted, phase, "")
        for name, colour in {**style.PHASE_COLOURS, "touching": style.GREEN}.items():
            spans = [(edges[i], edges[i + 1] - edges[i]) for i in np.flatnonzero(phase == name)]
            strips.broken_barh(spans, (0.6 - row, 0.8), facecolors=colour, linewidth=0)
        which = ("reference", "candidate")[row]
        events = [getattr(pair, which) for pair in comparison.events.values()]
        at = [event / length for event in events if event is not None]
        strips.plot(at, [1 - row] * len(at), **_EVENT, markersize=18)
    strips.set_yticks([1, 0], [style.label(readings.source) for readings in sides])
    strips.set_ylim(-0.6, 1.6)
    leaves = Line2D([], [], **_EVENT, markersize=9, label="touches or leaves")
    strips.legend(
        handles=[*phase_handles(linewidth=5), leaves], fontsize=style.SMALL, frameon=False, ncols=4,
        loc="lower left", bbox_to_anchor=(0, 1),
    )  # fmt: skip
    far = np.maximum(comparison.contact.distance, _LEAST)
    below.semilogy(travel, far, color=style.INK, marker=".", markersize=3, linewidth=0.8)
    below.axhline(comparison.tolerances.contact, color=style.GREY, linestyle="--", linewidth=1)
    below.set_ylabel("contacts apart / $L$")
    below.set_xlabel("way of the foot / $L$")
    return figure


def draw_scene(ax: Axes3D, scene: SweepScene) -> None:
    """Draw what does not move: the body and the way of the foot, with axes of equal scale."""
    faces = scene.faces
    if len(faces):
        grey = 0.87 * ((1 - _DARK) + _DARK * np.abs(normals(faces) @ _LIGHT))
        colours = np.column_stack([grey, grey, grey, np.full(len(grey), 0.6)])
        shown = {"facecolors": colours, "edgecolors": style.BODY, "linewidths": 0.2}
        ax.add_collection3d(Poly3DCollection(upright(faces), **shown))
    ax.plot(*upright(scene.foot).T, color=style.GREY, linestyle="--", linewidth=1)
    low, high = scene.low, scene.high
    ax.set(xlim=(low[0], high[0]), ylim=(high[2], low[2]), zlim=(low[1], high[1]))
    ax.set(xlabel="$x$ / $L$", ylabel="$z$ / $L$", zlabel="$y$ / $L$")
    extent = high - low
    for axis, size in zip("xzy", extent / extent.max(), strict=True):
        ax.locator_params(axis=axis, nbins=max(2, round(5 * size)))
    ax.set_box_aspect((extent[0], extent[2], extent[1]), zoom=1.45)
    ax.view_init(**_VIEW)


def upright(points: Floats) -> Floats:
    """From the case's axes, y up, to the picture's, whose third points up."""
    return points[..., [0, 2, 1]]


def label_axes(ax: Axes, title: str) -> None:
    """Say what axes of a force or a moment over the way of the foot show, once it is drawn."""
    ax.axhline(0, color=style.FAINT, linewidth=0.8, zorder=0)
    ax.set_xlabel("way of the foot / $L$")
    ax.set_ylabel(title)
    ax.legend(fontsize=style.SMALL, frameon=False, ncols=3)
