"""A sweep in motion: both models' vibrissa, its curvature, its contact, and its clamp readings."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, PowerNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from numpy.typing import NDArray
from PIL import Image

from analytic import InputError, Readings, reconstruct
from analytic.problem.arrays import Floats, Integers, Words
from analytic.problem.readings import CLAMP_READINGS
from analytic.solver.shape import curvatures, deflected_shapes
from compare.figures import PHASE_COLOURS, PHASE_NAMES, save_figure, shade_phases
from compare.phases import classify

_INK, _CANDIDATE = "#222222", "#CC79A7"
# Perceptually uniform and the same to every kind of colour vision; its palest end is left out,
# for it would drown in the white around it.
_CURVATURE = ListedColormap(colormaps["viridis"](np.linspace(0.0, 0.9, 256)))
_SYMBOLS = {
    "force_x": "$F_{Ax}$ / ($EI/L^2$)",
    "force_y": "$F_{Ay}$ / ($EI/L^2$)",
    "moment_z": "$M_{Az}$ / ($EI/L$)",
}
_DOTS = 10  # of the candidate's vibrissa, at equal steps of arc length
_MARKS = 50  # of the candidate in a curve
_LONGEST_ARROW = 0.75  # L; the largest contact force
_STILLS = (0.1, 0.4, 0.7, 1.0)  # of the stations in contact; the last is the eve of snap-off
_FRAME, _LAST_FRAME = 80, 1600  # ms
_SIZE, _DPI = (8.0, 6.4), 100  # inches and pixels an inch
_CURVATURE_COLOURS = 80  # of the 256 that a GIF can have


def write_animation(
    reference: Readings,
    candidate: Readings,
    folder: Path,
    frames: int = 60,
    advance: Callable[[], None] = lambda: None,
) -> list[Path]:
    """Draw the sweep in motion, from the sensed readings of both models alone.

    Parameters
    ----------
    reference, candidate : Readings
        Two sweeps of the same beam; a frame shows a station of the first and the nearest one of
        the second.
    folder : Path
        Where ``animation.gif`` and the stills, ``still-1.png`` and so on, are written.
    frames : int
        Number of frames, at least 2; no more than there are stations.
    advance : callable, optional
        Called after every frame, for progress bars.

    Returns
    -------
    list of Path
        The files, each of which appears whole.

    Raises
    ------
    InputError
        If there are too few frames.
    """
    if frames < 2:
        raise InputError("--frames", frames, "2 or more", "60 is usual")
    scene = _Scene(_Motion.of(reference), _Motion.of(candidate))
    touching = np.flatnonzero(scene.reference.phase != "free")
    chosen = np.linspace(0, len(reference.table) - 1, frames).astype(int)
    images = list(scene.images(np.unique(chosen), advance))
    written = [_save_gif(images, folder / "animation.gif")]
    for number, share in enumerate(_STILLS if touching.size else (), start=1):
        station = touching[round(share * (len(touching) - 1))]
        written.append(scene.save_still(int(station), folder / f"still-{number}.png"))
    return written


@dataclass(frozen=True)
class _Motion:
    """One sweep as it is drawn: lengths in L, forces in EI/L^2, moments in EI/L.

    Attributes
    ----------
    readings : Readings
        The sweep.
    foot_x : array, shape (stations,)
        Foot positions.
    x, y, curvature : array, shape (stations, points)
        The centreline from clamp to tip, and the magnitude of its curvature.
    contact : array, shape (stations, 2)
        Where the body is touched; NaN where it is not.
    clamp : dict of array, shape (stations,)
        The clamp readings.
    phase : array of str, shape (stations,)
        As judged from the clamp.
    """

    readings: Readings
    foot_x: Floats
    x: Floats
    y: Floats
    curvature: Floats
    contact: Floats
    clamp: dict[str, Floats]
    phase: Words

    @property
    def force(self) -> Floats:
        """Magnitude of the contact force, shape (stations,)."""
        return np.asarray(np.hypot(self.clamp["force_x"], self.clamp["force_y"]))

    @classmethod
    def of(cls, readings: Readings) -> "_Motion":
        beam = readings.beam
        x, y = deflected_shapes(readings)
        units = (beam.force_unit, beam.force_unit, beam.moment_unit)
        return cls(
            readings,
            readings.values("foot_x") / beam.length,
            x / beam.length,
            y / beam.length,
            np.abs(curvatures(readings, x, y)) * beam.length,
            reconstruct(readings)[["contact_x", "contact_y"]].to_numpy() / beam.length,
            {n: readings.values(n) / u for n, u in zip(CLAMP_READINGS, units, strict=True)},
            classify(readings).phase,
        )

    def beads(self, station: int) -> tuple[Floats, Floats]:
        """Points on the centreline at equal steps of arc length."""
        x, y = self.x[station], self.y[station]
        along = np.append(0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y))))
        at = np.linspace(0, along[-1], _DOTS + 1)[1:]
        return np.interp(at, along, x), np.interp(at, along, y)


class _View:
    """The object, both vibrissae, the contact and its force, in one pair of axes.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    motions : pair of _Motion
        Reference and candidate.
    follows : bool
        Whether the picture moves with the foot, which shows the vibrissa large.
    """

    def __init__(self, ax: Axes, motions: tuple[_Motion, _Motion], follows: bool) -> None:
        self.ax, self._motions, self._follows = ax, motions, follows
        reference = motions[0]
        width, dot = (7.0, 4.5) if follows else (2.0, 0.0)
        self._body = body = Polygon(
            _outline(reference.readings), facecolor="#E4E4E4", edgecolor="#555555", zorder=1
        )
        self._outline = np.array(body.get_xy())
        self.line = LineCollection(
            [], cmap=_CURVATURE, norm=PowerNorm(0.5, 0, float(np.nanmax(reference.curvature))),
            linewidth=width, capstyle="round", zorder=3,
        )  # fmt: skip
        (self._dots,) = ax.plot(
            [], [], "o", color=_CANDIDATE, markersize=dot, markeredgecolor="w",
            markeredgewidth=0.6, zorder=4,
        )  # fmt: skip
        (self._clamp,) = ax.plot([], [], color=_INK, linewidth=0.8 * width, zorder=5)
        (self._contact,) = ax.plot(
            [], [], "o", color=_INK, markersize=4.5 if follows else 2.5, zorder=6
        )
        self.force = ax.quiver(
            [0.0], [0.0], [0.0], [0.0], color=_INK, angles="xy", scale_units="xy", pivot="tip",
            scale=reference.force.max() / _LONGEST_ARROW, zorder=6,
            units="dots", width=2.4 if follows else 1.4, minlength=0,
        )  # fmt: skip
        ax.add_patch(body)
        ax.add_collection(self.line)
        ax.axhline(0, color="#999999", linewidth=0.8, zorder=0)
        ax.set_aspect("equal")
        ax.set_xlabel("$(x - x_0)$ / $L$" if follows else "$x$ / $L$", labelpad=1)
        ax.set_ylabel("$y$ / $L$")
        self.moving: list[Artist] = [
            *([body] if follows else []),
            self.line, self._dots, self._clamp, self._contact, self.force,
        ]  # fmt: skip

    def frame(self) -> None:
        """Choose limits that fill the axes and that nothing will leave."""
        x = np.concatenate(
            [(m.x - m.foot_x[:, None] * self._follows).ravel() for m in self._motions]
        )
        if not self._follows:
            x = np.append(x, self._outline[:, 0])
        left, right = _padded(x, 0.12 if self._follows else 0.02)
        low, high = (-0.2, 1.1) if self._follows else (-0.1, 1.08)
        box = self.ax.get_position(original=True)
        width, height = np.array(_SIZE) * (box.width, box.height)
        wide = max(0.0, (high - low) * width / height - (right - left)) / 2
        tall = max(0.0, (right - left) * height / width - (high - low)) / 2
        self.ax.set_xlim(left - wide, right + wide)
        self.ax.set_ylim(low - tall, high + tall)

    def show(self, station: int, other: int) -> None:
        """Move to a station of the reference and the one of the candidate that is shown with it."""
        reference, candidate = self._motions
        origin = reference.foot_x[station] if self._follows else 0.0
        x, y = reference.x[station] - origin, reference.y[station]
        ends = np.column_stack([x, y])
        self.line.set_segments(list(np.stack([ends[:-1], ends[1:]], axis=1)))
        bent = reference.curvature[station]
        self.line.set_array((bent[1:] + bent[:-1]) / 2)
        beads_x, beads_y = candidate.beads(other)
        # Even where the stations of the two differ, each vibrissa stands on its own foot.
        self._dots.set_data(beads_x - origin, beads_y)
        self._clamp.set_data(x[0] + np.array([-0.06, 0.06]), [0.0, 0.0])
        contact = reference.contact[station] - (origin, 0.0)
        self._contact.set_data(contact[:1], contact[1:])
        self.force.set_offsets(np.nan_to_num(contact))
        self.force.set_UVC(
            [-reference.clamp["force_x"][station]], [-reference.clamp["force_y"][station]]
        )
        if self._follows:
            self._body.set_xy(self._outline - (origin, 0.0))


class _Curve:
    """One clamp reading over the foot position, as far as the sweep has come."""

    def __init__(self, ax: Axes, motions: tuple[_Motion, _Motion], name: str, last: bool) -> None:
        self._curves = [(motion.foot_x, motion.clamp[name]) for motion in motions]
        (self._line,) = ax.plot([], [], color=_INK, linewidth=1.6)
        every = max(1, len(motions[1].foot_x) // _MARKS)
        (self._dots,) = ax.plot([], [], "o", color=_CANDIDATE, markersize=3.6, markevery=every)
        (self._head,) = ax.plot([], [], "o", color=_INK, markersize=5)
        foot_x = np.concatenate([x for x, _ in self._curves])
        values = np.concatenate([v for _, v in self._curves])
        ax.set_xlim(*_padded(foot_x, 0.03))
        ax.set_ylim(*_padded(values, 0.08))
        ax.axhline(0, color="#999999", linewidth=0.8, zorder=0)
        ax.set_ylabel(_SYMBOLS[name])
        ax.tick_params(labelbottom=last)
        if last:
            ax.set_xlabel("foot $x_0$ / $L$")
        shade_phases(ax, motions[0].foot_x, motions[0].phase)
        self.moving: list[Artist] = [self._line, self._dots, self._head]

    def show(self, station: int, other: int) -> None:
        """Grow up to these stations."""
        (x, values), (other_x, other_values) = self._curves
        self._line.set_data(x[: station + 1], values[: station + 1])
        self._dots.set_data(other_x[: other + 1], other_values[: other + 1])
        self._head.set_data(x[station : station + 1], values[station : station + 1])


class _Scene:
    """The picture: what stays is drawn once, what moves is drawn over it frame by frame."""

    def __init__(self, reference: _Motion, candidate: _Motion) -> None:
        self.reference = reference
        motions = reference, candidate
        self._nearest = np.abs(reference.foot_x[:, None] - candidate.foot_x).argmin(axis=1)
        self._figure = Figure(figsize=_SIZE, dpi=_DPI)
        self._canvas: Any = FigureCanvasAgg(self._figure)  # its methods have no types
        grid = self._figure.add_gridspec(
            2, 2, left=0.085, right=0.985, top=0.915, bottom=0.085, hspace=0.24, wspace=0.3,
            height_ratios=[1, 2.1], width_ratios=[1.3, 1],
        )  # fmt: skip
        far = _View(self._figure.add_subplot(grid[0, :]), motions, follows=False)
        near = _View(self._figure.add_subplot(grid[1, 0]), motions, follows=True)
        plots = grid[1, 1].subgridspec(3, 1, hspace=0.12)
        curves = [
            _Curve(self._figure.add_subplot(plots[i]), motions, name, last=i == 2)
            for i, name in enumerate(CLAMP_READINGS)
        ]
        self._parts: tuple[_View | _Curve, ...] = (far, near, *curves)
        self._add_colour_bar(near)
        for view in (far, near):
            view.frame()
        self._add_header(motions)
        self._phase = self._figure.text(0.985, 0.955, "", ha="right", fontsize=12, weight="bold")
        self._moving = [*(a for part in self._parts for a in part.moving), self._phase]

    def images(self, stations: Integers, advance: Callable[[], None]) -> Iterator[Image.Image]:
        """A picture of each station."""
        for artist in self._moving:
            artist.set_animated(True)
        self._canvas.draw()
        still = self._canvas.copy_from_bbox(self._figure.bbox)
        for station in stations:
            self._show(int(station))
            self._canvas.restore_region(still)
            for artist in sorted(self._moving, key=lambda a: a.zorder):
                self._figure.draw_artist(artist)
            yield Image.fromarray(np.asarray(self._canvas.buffer_rgba())).convert("RGB")
            advance()

    def save_still(self, station: int, path: Path) -> Path:
        """Write a PNG of one station."""
        for artist in self._moving:
            artist.set_animated(False)
        self._show(station)
        return save_figure(self._figure, path)

    def _show(self, station: int) -> None:
        for part in self._parts:
            part.show(station, int(self._nearest[station]))
        phase = str(self.reference.phase[station])
        self._phase.set_text(PHASE_NAMES.get(phase, "not to be trusted"))
        self._phase.set_color(PHASE_COLOURS.get(phase, _INK))

    def _add_header(self, motions: tuple[_Motion, _Motion]) -> None:
        case = motions[0].readings.provenance.get("case", "")
        self._figure.text(0.085, 0.955, case, fontsize=12, weight="bold")
        line = Line2D([], [], color=_CURVATURE(0.6), linewidth=5)
        dots = Line2D([], [], color=_CANDIDATE, marker="o", linestyle="")
        self._figure.legend(
            [line, dots],
            [motion.readings.source for motion in motions],
            loc="center",
            bbox_to_anchor=(0.5, 0.967),
            ncols=2,
            frameon=False,
        )

    def _add_colour_bar(self, view: _View) -> None:
        bar = self._figure.colorbar(view.line, ax=view.ax, aspect=32, pad=0.03)
        bar.set_label(r"curvature $|\kappa|$ / ($1/L$)")
        largest = self.reference.force.max()
        steps = np.outer(10.0 ** np.arange(-6, 9), [1, 2, 5]).ravel()
        unit = steps[steps <= max(largest / 2.5, steps[0])][-1]
        view.ax.quiverkey(
            view.force, 0.36, 0.055, unit, f"contact force {unit:g} $EI/L^2$",
            labelpos="E", coordinates="axes", fontproperties={"size": 9},
        )  # fmt: skip


def _outline(readings: Readings) -> Floats:
    """Vertices of the body, shape (n, 2) [L]; none if the source did not tell its contour."""
    if "contour" not in readings.provenance:
        return np.full((1, 2), np.nan)
    xi, eta = (np.asarray(c) / readings.beam.length for c in readings.provenance["contour"])
    top = eta.max()
    return np.column_stack([[xi[0], *xi, xi[-1]], [top, *eta, top]])


def _padded(values: Floats, share: float) -> tuple[float, float]:
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return low - share * (high - low), high + share * (high - low)


def _save_gif(images: list[Image.Image], path: Path) -> Path:
    """Write an animation, whole or not at all.

    All frames share one palette, so that nothing flickers and only what changes is stored.
    """
    palette = Image.new("P", (1, 1))
    palette.putpalette(_palette(images[:: max(1, len(images) // 8)]).tobytes())
    first, *others = (image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images)
    unfinished = path.with_name(f".{path.name}.partial")
    durations = [_FRAME] * len(others) + [_LAST_FRAME]
    first.save(
        unfinished, "GIF", save_all=True, append_images=others, duration=durations, loop=0,
        optimize=False,
    )  # fmt: skip
    return unfinished.replace(path)


def _palette(sample: list[Image.Image]) -> NDArray[np.uint8]:
    """The curvature's colours and the most frequent ones, shape (256, 3).

    Pillow looks colours up in cells of four values a channel, so one colour a cell is enough, and a
    second would be mistaken for it: white for the nearly white.
    """
    pixels = np.stack([np.asarray(image) for image in sample]).reshape(-1, 3)
    colours, counts = np.unique(pixels, axis=0, return_counts=True)
    frequent = colours[np.argsort(-counts)]
    _, first = np.unique(frequent // 4, axis=0, return_index=True)
    scale = np.rint(255 * _CURVATURE(np.linspace(0, 1, _CURVATURE_COLOURS))[:, :3])
    others = frequent[np.sort(first)[: 256 - _CURVATURE_COLOURS]]
    return np.concatenate([others, scale.astype(np.uint8)])
