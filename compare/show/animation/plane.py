"""A sweep in the plane in motion: the object from afar, the vibrissa from near, the readings."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, PowerNorm
from matplotlib.patches import Polygon

from analytic import CLAMP_READINGS, Readings, curvatures, deflected_shapes, reconstruct
from analytic.numerics.arrays import Floats, Words
from compare.sense.phases import classify
from compare.show.animation.film import Part, framed, heading, write_film
from compare.show.figures.over_foot import foot, shade_phases, unit
from compare.show.style import ALONG, BODY, CANDIDATE, FAINT, GREY, INK, REFERENCE, axis_label

# Perceptually uniform and the same to every kind of colour vision; its palest end is left out,
# for it would drown in the white around it.
_CURVATURE_COLOURS = ListedColormap(colormaps["viridis"](np.linspace(0.0, 0.9, 256)))
_DOTS = 10  # of a dotted vibrissa, at equal steps of arc length
_MARKS = 30  # of the candidate in a curve
_RIM = 1.6  # points, on both sides together
_LONGEST_ARROW = 0.45  # L; the largest contact force
_LOWEST, _HIGHEST = -0.1, 1.08  # L; the least that is shown


def write_animation(
    reference: Readings,
    candidate: Readings,
    folder: Path,
    frames: int = 60,
    advance: Callable[[], None] = lambda: None,
) -> list[Path]:
    """Draw the sweep in motion, from the sensed readings of both models alone."""
    one, other = _Motion.of(reference), _Motion.of(candidate)
    touching = np.flatnonzero(np.isin(one.phase, ("tip", "tangent")))
    chosen = framed(reference, touching, frames)
    figure, strip = heading(reference, candidate.source, one.phase)
    grid = figure.add_gridspec(
        2, 2, left=0.085, right=0.985, top=0.915, bottom=0.085, hspace=0.24, wspace=0.3,
        height_ratios=[1, 2.1], width_ratios=[1.3, 1],
    )  # fmt: skip
    far = _view(figure.add_subplot(grid[0, :]), one, other, follows=False)
    near = _view(figure.add_subplot(grid[1, 0]), one, other, follows=True)
    plots: Any = grid[1, 1].subgridspec(3, 1, hspace=0.12).subplots(sharex=True)
    curves = [_curve(ax, one, other, name) for ax, name in zip(plots, CLAMP_READINGS, strict=True)]
    figure.align_ylabels(plots)
    plots[-1].set_xlabel(ALONG[reference.running].axis)
    return write_film(figure, [strip, far, near, *curves], chosen, touching, folder, advance)


@dataclass(frozen=True)
class _Motion:
    """One sweep as it is drawn: lengths in L, forces in EI/L^2, moments in EI/L."""

    readings: Readings
    along: Floats  # shape (stations,); where along the sweep they are
    x: Floats  # shape (stations, points); of the centreline, from clamp to tip
    y: Floats
    curvature: Floats  # its magnitude there
    contact: Floats  # shape (stations, 2); where the body is touched; NaN where it is not
    clamp: dict[str, Floats]  # shape (stations,); the clamp readings
    phase: Words  # shape (stations,); as judged from the clamp

    @classmethod
    def of(cls, readings: Readings) -> "_Motion":
        length = readings.beam.length
        x, y = deflected_shapes(readings)
        return cls(
            readings,
            foot(readings),
            x / length,
            y / length,
            np.abs(curvatures(readings, x, y)) * length,
            reconstruct(readings)[["contact_x", "contact_y"]].to_numpy() / length,
            {name: readings.values(name) / unit(readings, name) for name in CLAMP_READINGS},
            classify(readings).phase,
        )

    def beside(self, along: float) -> int:
        return int(np.abs(self.along - along).argmin())

    def beads(self, station: int) -> tuple[Floats, Floats]:
        """Points on the centreline at equal steps of arc length."""
        x, y = self.x[station], self.y[station]
        along = np.append(0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y))))
        at = np.linspace(0, along[-1], _DOTS + 1)[1:]
        return np.interp(at, along, x), np.interp(at, along, y)


def _view(ax: Axes, one: _Motion, other: _Motion, follows: bool) -> Part:
    """The object, both vibrissae, the contact and its force, in one pair of axes."""
    width, dot = (7.0, 4.5) if follows else (2.0, 0.0)
    outline = _outline(one.readings)
    body = Polygon(outline, facecolor=BODY, edgecolor=GREY, zorder=1)
    ax.add_patch(body)
    line = LineCollection(
        [], cmap=_CURVATURE_COLOURS, norm=PowerNorm(0.5, 0, float(np.nanmax(one.curvature))),
        linewidth=width, capstyle="round", zorder=3,
    )  # fmt: skip
    ax.add_collection(line)
    # Its rim has the reference's colour, as its curves have.
    (rim,) = ax.plot(
        [], [], color=REFERENCE, linewidth=width + _RIM, solid_capstyle="round", zorder=2.9
    )
    (dots,) = ax.plot([], [], "o", color=CANDIDATE, markersize=dot, markeredgecolor="w", zorder=4)
    (clamp,) = ax.plot([], [], color=INK, linewidth=0.8 * width, zorder=5)
    (touched,) = ax.plot([], [], "o", color=INK, markersize=0.5 * width + 1, zorder=6)
    # It ends at the contact of a low object, in whose inside there is room.
    low = np.nanmedian(one.contact[:, 1]) < 0.5
    largest = float(np.nanmax(np.hypot(one.clamp["force_x"], one.clamp["force_y"])))
    force = ax.quiver(
        [0.0], [0.0], [0.0], [0.0], color=INK, angles="xy", scale_units="xy",
        pivot="tip" if low else "tail", scale=largest / _LONGEST_ARROW, zorder=6,
        units="dots", width=2.4 if follows else 1.4, minlength=0,
    )  # fmt: skip
    ax.axhline(0, color=FAINT, linewidth=0.8, zorder=0)
    ax.set_xlabel("$(x - x_0)$ / $L$" if follows else "$x$ / $L$", labelpad=1)
    ax.set_ylabel("$y$ / $L$")
    seen = [m.x - m.x[:, :1] * follows for m in (one, other)]
    ax.set_xlim(*_padded([*seen, [] if follows else outline[:, 0]], 0.05), auto=True)
    ax.set_ylim(min(_LOWEST, float(np.nanmin(one.y)) + _LOWEST), _HIGHEST, auto=True)
    ax.set_aspect("equal", adjustable="datalim")
    if follows:  # the curvature's colours, and an arrow of a round force
        bar = ax.figure.colorbar(line, ax=ax, aspect=32, pad=0.03)
        bar.set_label(r"curvature $|\kappa|$ / ($1/L$)")
        size = float(f"{largest / 4:.1g}")
        ax.quiverkey(
            force, 0.36, 0.055, size, f"contact force {size:g} $EI/L^2$",
            labelpos="E", coordinates="axes", fontproperties={"size": 9},
        )  # fmt: skip

    def show(station: int) -> None:
        origin = one.x[station, 0] if follows else 0.0
        x, y = one.x[station] - origin, one.y[station]
        ends = np.column_stack([x, y])
        line.set_segments(list(np.stack([ends[:-1], ends[1:]], axis=1)))
        rim.set_data(x, y)
        bent = one.curvature[station]
        line.set_array((bent[1:] + bent[:-1]) / 2)
        # Even where the stations of the two differ, each vibrissa stands on its own foot.
        beads_x, beads_y = other.beads(other.beside(one.along[station]))
        dots.set_data(beads_x - origin, beads_y)
        across = np.array([-0.06, 0.06])
        leans = one.readings.clamp_angle[station]
        clamp.set_data(x[0] + across * np.cos(leans), y[0] + across * np.sin(leans))
        contact = one.contact[station] - (origin, 0.0)
        touched.set_data(contact[:1], contact[1:])
        force.set_offsets(np.nan_to_num(contact))
        force_x, force_y = (one.clamp[name][station] for name in ("force_x", "force_y"))
        force.set_UVC([-force_x], [-force_y])
        if follows:
            body.set_xy(outline - (origin, 0.0))

    moving: list[Artist] = [rim, line, dots, clamp, touched, force]
    return Part([body, *moving] if follows else moving, show)


def _curve(ax: Axes, one: _Motion, other: _Motion, name: str) -> Part:
    """One clamp reading over the foot position, as far as the sweep has come."""
    x, values = one.along, one.clamp[name]
    (line,) = ax.plot([], [], color=REFERENCE, linewidth=2.2)
    every = max(1, len(other.along) // _MARKS)
    (dots,) = ax.plot([], [], "o", color=CANDIDATE, markersize=2.6, markevery=every)
    (head,) = ax.plot([], [], "o", color=INK, markersize=5)
    ax.set_xlim(*_padded([x, other.along], 0.03))
    ax.set_ylim(*_padded([values, other.clamp[name]], 0.08))
    ax.axhline(0, color=FAINT, linewidth=0.8, zorder=0)
    ax.set_ylabel(axis_label(name).replace(" / ", "\n"))  # two lines: the axes are low
    shade_phases(ax, x, one.phase)

    def show(station: int) -> None:
        until = other.beside(x[station]) + 1
        line.set_data(x[: station + 1], values[: station + 1])
        dots.set_data(other.along[:until], other.clamp[name][:until])
        head.set_data(x[station : station + 1], values[station : station + 1])

    return Part([line, dots, head], show)


def _outline(readings: Readings) -> Floats:
    """Vertices of the bodies, shape (n, 2) [L], NaN between; none if no contour is recorded."""
    found = []
    for xi, eta in (contour / readings.beam.length for contour in readings.contours):
        top = eta.max()
        body = np.column_stack([[xi[0], *xi, xi[-1]], [top, *eta, top]])
        found += [np.full((1, 2), np.nan), body]
    return np.concatenate(found[1:] or [np.full((1, 2), np.nan)])


def _padded(values: Iterable[Floats | list[float]], share: float) -> tuple[float, float]:
    every = np.concatenate([np.ravel(one) for one in values])
    low, high = float(np.nanmin(every)), float(np.nanmax(every))
    return low - share * (high - low), high + share * (high - low)
