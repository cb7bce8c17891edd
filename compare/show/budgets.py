"""What a disagreement is made of: in tables, sentences and pictures."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator

from analytic import CLAMP_READINGS, PHASES
from compare.explain.budget import Budget
from compare.explain.motion import MotionBudget
from compare.explain.parts import UNRESOLVED, Parted, fitted_orders
from compare.show import style
from compare.show.document import Block, Items, Table, Text
from compare.show.numbers import percent, short, words
from compare.show.style import PHASE_LETTERS

_RMS = "relative to each reading's largest magnitude"


def left_over(found: Parted) -> str:
    return f"{short(found.left.rms)} +- {short(found.left.uncertainty)}"


def headline(found: Parted) -> str:
    """What a budget comes to, in one sentence."""
    rest = left_over(found)
    if found.closes:
        remains = f"at most {rest} stays unexplained, and the budget closes"
    elif found.undecided:
        remains = f"the budget is undecided: {rest} stays unexplained"
    else:
        remains = f"{rest} stays unexplained, too much for the budget to close"
    return f"The largest part is {found.blame}; {remains}"


def budget_summary(found: Parted) -> Iterator[Block]:
    """The parts, what they come to, and the suspects."""
    yield _parts_table(found)
    yield Text("", strong=f"{headline(found)}.")
    if isinstance(found, Budget) and found.suspects:
        known = [(f"{words(one.name)}, {one.size}", one.share) for one in found.suspects]
        said = "Suspect: {} in the candidate, accounts for {} of the unexplained."
        yield Items([said.format(name, percent(share)) for name, share in known])
    if isinstance(found, MotionBudget):
        yield Text(f"Observed order in the speed, of three speeds: {found.order:.2f}.")
        if found.left_out:
            yield Text(f"Diverged, and left out: {', '.join(found.left_out)}.")


def _parts_table(found: Parted) -> Table:
    """The parts with their uncertainties, the whole, and what the closed form says of some."""
    rows: list[Sequence[str]] = [
        (name, *(f"{short(one.rms)} ± {short(one.uncertainty)}" for one in parts.values()))
        for name, parts in found.parts.items()
    ]
    rows.append(("disagreement", *map(short, found.disagreement.values())))
    checks = found.checks if isinstance(found, Budget) else {}
    for name, sizes in checks.items():
        rows.append((f"{name}, closed form alone", *map(short, sizes.values())))
    near = " (next to the snap-off, too)" if isinstance(found, Budget) else ""
    alone = "; the closed form's are of each part alone, and need not be within it"
    return Table(
        f"Root mean square over {found.stations} stations{near}, {_RMS}; ± is what unrest and "
        f"extrapolation leave open of that step{alone if checks else ''}",
        ("part", *found.disagreement),
        rows,
        blamed=[i for i, name in enumerate(found.parts) if name == found.blame],
        whole=[len(found.parts)],
    )


def phases_table(found: Budget) -> Table:
    there = {p for sizes in found.by_phase.values() for by in sizes.values() for p in by}
    phases = [phase for phase in PHASES if phase in there]
    return Table(
        "The same in each phase (A: tip contact, B: tangential contact), root mean square",
        ("part", *(f"{r}, {PHASE_LETTERS[p]}" for r in CLAMP_READINGS for p in phases)),
        [
            (name, *(short(sizes[r].get(p)) for r in CLAMP_READINGS for p in phases))
            for name, sizes in found.by_phase.items()
        ],
        blamed=[i for i, name in enumerate(found.by_phase) if name == found.blame],
    )


def convergence_table(found: Mapping[int, Mapping[str, float]]) -> Table:
    return Table(
        f"Root mean square, {_RMS}",
        ("segments", *CLAMP_READINGS),
        [(str(n), *(short(rms[r]) for r in CLAMP_READINGS)) for n, rms in found.items()],
    )


_LEAST = UNRESOLVED / 50  # of the largest magnitude; less has a number, but no bar
_PANEL = (4.3, 3.1)  # inches
_ACROSS = 3  # panels


def picture(found: Parted) -> Figure:
    """Draw all readings, three side by side, under a sentence that says what they show."""
    width, height = _PANEL
    rows = len(found.disagreement) // _ACROSS
    figure = Figure((width * _ACROSS * 0.85, rows * height + 0.4), layout="constrained")
    axes = figure.subplots(rows, _ACROSS, squeeze=False)
    for ax, reading in zip(axes.flat, found.disagreement, strict=True):
        _draw(ax, found, reading)
        ax.tick_params(labelleft=ax in axes[:, 0])
        ax.set_xlabel("")
    said = "with its uncertainty; dashed: all of it; grey: may stay unexplained"
    figure.supxlabel(f"rms / largest magnitude, {said}", fontsize=style.SMALL)
    figure.suptitle(headline(found), fontsize=12)
    return figure


def bars(found: Parted, reading: str) -> Figure:
    figure = Figure(figsize=_PANEL, layout="constrained")
    _draw(figure.subplots(), found, reading)
    return figure


def _draw(ax: Axes, found: Parted, reading: str) -> None:
    names = _order(found)
    rows = np.arange(len(names))[::-1] + 0.0
    rows[:-1] += 0.35  # what is unexplained stands apart
    parts = [found.parts[name][reading] for name in names]
    total = found.disagreement[reading]
    largest = max(total, *(part.rms + part.uncertainty for part in parts), UNRESOLVED)
    ax.set_xscale("log")
    # Decades alone, and written as the numbers beside the bars: the picture takes half the time.
    ax.xaxis.set_major_formatter(lambda x, _: f"1e{round(math.log10(x))}")
    ax.minorticks_off()
    ax.set_xlim(_LEAST, 1.5 * largest)
    ax.axvspan(_LEAST, UNRESOLVED, color=style.BODY, alpha=0.6, linewidth=0, zorder=0)
    colours = {found.blame: style.ORANGE, "unexplained": style.INK}
    for name, row, part in zip(names, rows, parts, strict=True):
        _bar(ax, row, part.rms, part.uncertainty, colours.get(name, style.BLUE))
    ax.axvline(total, color=style.GREY, linestyle="--", linewidth=1.3, zorder=3)
    ax.axhline(0.65, color=style.GREY, linewidth=0.6)
    ax.set_ylim(-0.6, rows[0] + 0.6)
    ax.set_yticks(rows, names)
    ax.tick_params(axis="y", length=0)
    ax.yaxis.get_ticklabels()[names.index(found.blame)].set_fontweight("bold")
    ax.set_title(f"{reading}: {short(total)} in all", fontsize=style.LARGE)
    ax.set_xlabel("rms / largest magnitude")
    for side in ("top", "right", "left"):
        ax.spines[side].set_visible(False)


def _bar(ax: Axes, row: float, rms: float, uncertainty: float, colour: str) -> None:
    """A part, its uncertainty as a whisker, and its size in digits."""
    low, high = max(rms - uncertainty, _LEAST), rms + uncertainty
    if rms > _LEAST:
        ax.barh(row, rms - _LEAST, left=_LEAST, height=0.62, color=colour)
    if high > _LEAST:
        ax.plot([low, high], [row, row], color=style.GREY, linewidth=1.2, marker="|", markersize=6)
    ax.annotate(
        short(rms), (1, row), (34, 0), xycoords=("axes fraction", "data"),
        textcoords="offset points", va="center", ha="right", fontsize=style.SMALL,
    )  # fmt: skip


def _order(found: Parted) -> list[str]:
    explained = [name for name in found.parts if name != "unexplained"]
    explained.sort(key=lambda name: -max(part.rms for part in found.parts[name].values()))
    return [*explained, "unexplained"]


_SECOND = 2  # the order of a beam that first bends half a cell from the clamp


def convergence_picture(found: Mapping[int, Mapping[str, float]]) -> Figure:
    """Draw disagreement against the number of segments, with the fitted and the expected order."""
    figure = Figure(figsize=(5.6, 3.9), layout="constrained")
    ax = figure.subplots()
    n = np.array(list(found), dtype=float)
    for name, order in fitted_orders(found).items():
        errors = np.array([found[segments][name] for segments in found])
        colour, marker = style.READING_COLOURS[name], style.READING_MARKERS[name]
        fit = np.exp(np.log(errors).mean()) * (n / np.exp(np.log(n).mean())) ** -order
        ax.plot(n, fit, color=colour, linewidth=1.2)
        ax.plot(n, errors, marker, color=colour, markersize=6, label=f"{name}: order {order:.2f}")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlim(n.min() / 1.25, n.max() * 1.25)
    ax.set_xticks(n, [f"{segments:g}" for segments in n])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.grid(axis="y", color=style.FAINT, alpha=0.35, linewidth=0.6)
    ax.set_xlabel("segments $N$")
    ax.set_ylabel("rms / largest magnitude")
    lowest = min(errors[name] for errors in found.values() for name in errors)
    second = 0.7 * lowest * (n.max() / n) ** _SECOND
    ax.plot(n, second, color=style.GREY, linestyle="--", linewidth=1, label="second order")
    ax.legend(fontsize=style.SMALL, frameon=False, loc="upper right")
    return figure
