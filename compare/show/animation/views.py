"""The parts of the picture that move: the vibrissae in front of the object, and the curves."""

from typing import Literal

import numpy as np
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, PowerNorm
from matplotlib.patches import Polygon

from analytic import Readings
from analytic.problem.arrays import Floats
from compare.show.animation.motion import Motion, Motions
from compare.show.figures.over_foot import shade_phases
from compare.show.style import BODY, CANDIDATE, FAINT, FOOT, GREY, INK, REFERENCE, axis_label

# Perceptually uniform and the same to every kind of colour vision; its palest end is left out,
# for it would drown in the white around it.
CURVATURE_COLOURS = ListedColormap(colormaps["viridis"](np.linspace(0.0, 0.9, 256)))
_MARKS = 30  # of the candidate in a curve
_RIM = 1.6  # points, on both sides together
_LONGEST_ARROW = 0.75  # L; the largest contact force
_LOWEST, _HIGHEST = -0.1, 1.08  # L; the least that is shown


class View:
    """The object, both vibrissae, the contact and its force, in one pair of axes."""

    def __init__(self, ax: Axes, motions: Motions, follows: bool) -> None:
        self.ax, self._motions, self._follows = ax, motions, follows
        reference = motions.reference
        width, dot = (7.0, 4.5) if follows else (2.0, 0.0)
        self._body = body = Polygon(
            _outline(reference.readings), facecolor=BODY, edgecolor=GREY, zorder=1
        )
        self._outline = np.array(body.get_xy())
        self.line = LineCollection(
            [], cmap=CURVATURE_COLOURS,
            norm=PowerNorm(0.5, 0, float(np.nanmax(reference.curvature))),
            linewidth=width, capstyle="round", zorder=3,
        )  # fmt: skip
        # Its rim has the reference's colour, as its curves have.
        (self._rim,) = ax.plot(
            [], [], color=REFERENCE, linewidth=width + _RIM, solid_capstyle="round", zorder=2.9
        )
        (self._dots,) = ax.plot(
            [], [], "o", color=CANDIDATE, markersize=dot, markeredgecolor="w",
            markeredgewidth=0.6, zorder=4,
        )  # fmt: skip
        (self._clamp,) = ax.plot([], [], color=INK, linewidth=0.8 * width, zorder=5)
        (self._contact,) = ax.plot(
            [], [], "o", color=INK, markersize=4.5 if follows else 2.5, zorder=6
        )
        longest, pivot = _arrow(reference)
        self.force = ax.quiver(
            [0.0], [0.0], [0.0], [0.0], color=INK, angles="xy", scale_units="xy", pivot=pivot,
            scale=reference.force.max() / longest, zorder=6,
            units="dots", width=2.4 if follows else 1.4, minlength=0,
        )  # fmt: skip
        ax.add_patch(body)
        ax.add_collection(self.line)
        ax.axhline(0, color=FAINT, linewidth=0.8, zorder=0)
        ax.set_aspect("equal")
        ax.set_xlabel("$(x - x_0)$ / $L$" if follows else "$x$ / $L$", labelpad=1)
        ax.set_ylabel("$y$ / $L$")
        self.moving: list[Artist] = [
            *([body] if follows else []),
            self._rim, self.line, self._dots, self._clamp, self._contact, self.force,
        ]  # fmt: skip

    def frame(self, size: tuple[float, float]) -> None:
        """Choose limits that fill the axes and that nothing will leave."""
        x = np.concatenate(
            [
                (m.x - m.foot_x[:, None] * self._follows).ravel()
                for m in (self._motions.reference, self._motions.candidate)
            ]
        )
        if not self._follows:
            x = np.append(x, self._outline[:, 0])
        left, right = _padded(x, 0.12 if self._follows else 0.02)
        low, high = (_LOWEST - 0.1 * self._follows, _HIGHEST)
        box = self.ax.get_position(original=True)
        width, height = np.array(size) * (box.width, box.height)
        wide = max(0.0, (high - low) * width / height - (right - left)) / 2
        tall = max(0.0, (right - left) * height / width - (high - low)) / 2
        self.ax.set_xlim(left - wide, right + wide)
        self.ax.set_ylim(low - tall, high + tall)

    def show(self, station: int) -> None:
        """Move to a station."""
        reference, candidate = self._motions.reference, self._motions.candidate
        origin = reference.foot_x[station] if self._follows else 0.0
        x, y = reference.x[station] - origin, reference.y[station]
        ends = np.column_stack([x, y])
        self.line.set_segments(list(np.stack([ends[:-1], ends[1:]], axis=1)))
        self._rim.set_data(x, y)
        bent = reference.curvature[station]
        self.line.set_array((bent[1:] + bent[:-1]) / 2)
        beads_x, beads_y = candidate.beads(int(self._motions.nearest[station]))
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


class Curve:
    """One clamp reading over the foot position, as far as the sweep has come."""

    def __init__(self, ax: Axes, motions: Motions, name: str, last: bool) -> None:
        both = motions.reference, motions.candidate
        self._nearest = motions.nearest
        self._curves = [(motion.foot_x, motion.clamp[name]) for motion in both]
        (self._line,) = ax.plot([], [], color=REFERENCE, linewidth=2.2)
        every = max(1, len(motions.candidate.foot_x) // _MARKS)
        (self._dots,) = ax.plot([], [], "o", color=CANDIDATE, markersize=2.6, markevery=every)
        (self._head,) = ax.plot([], [], "o", color=INK, markersize=5)
        foot_x = np.concatenate([x for x, _ in self._curves])
        values = np.concatenate([v for _, v in self._curves])
        ax.set_xlim(*_padded(foot_x, 0.03))
        ax.set_ylim(*_padded(values, 0.08))
        ax.axhline(0, color=FAINT, linewidth=0.8, zorder=0)
        ax.set_ylabel(axis_label(name))
        ax.tick_params(labelbottom=last)
        if last:
            ax.set_xlabel(FOOT)
        shade_phases(ax, motions.reference.foot_x, motions.reference.phase)
        self.moving: list[Artist] = [self._line, self._dots, self._head]

    def show(self, station: int) -> None:
        """Grow up to a station."""
        other = int(self._nearest[station])
        (x, values), (other_x, other_values) = self._curves
        self._line.set_data(x[: station + 1], values[: station + 1])
        self._dots.set_data(other_x[: other + 1], other_values[: other + 1])
        self._head.set_data(x[station : station + 1], values[station : station + 1])


def _arrow(motion: Motion) -> tuple[float, Literal["tip", "tail"]]:
    """How long the largest contact force may be drawn [L], and by which end it is held.

    It ends at the contact if there is more room above, inside a low object, and starts there if
    there is more below a high one.
    """
    eta = motion.contact[:, 1]
    with np.errstate(divide="ignore", invalid="ignore"):
        stretch = motion.force.max() / motion.clamp["force_y"]
        above = float(np.nanmin((_HIGHEST - eta) * stretch))
        below = float(np.nanmin((eta - _LOWEST) * stretch))
    return min(_LONGEST_ARROW, max(above, below)), "tip" if above > below else "tail"


def _outline(readings: Readings) -> Floats:
    """Vertices of the body, shape (n, 2) [L]; none if the source did not record its contour."""
    if "contour" not in readings.provenance:
        return np.full((1, 2), np.nan)
    xi, eta = (np.asarray(c) / readings.beam.length for c in readings.provenance["contour"])
    top = eta.max()
    return np.column_stack([[xi[0], *xi, xi[-1]], [top, *eta, top]])


def _padded(values: Floats, share: float) -> tuple[float, float]:
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return low - share * (high - low), high + share * (high - low)
