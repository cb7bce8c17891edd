"""What decides the phase, over the foot position."""

from matplotlib.figure import Figure

from compare.comparison import Comparison
from compare.show.figures.keys import key_below
from compare.show.figures.over_foot import (
    LINE,
    dots,
    draw,
    foot,
    foot_label,
    on_vibrissa,
    shade_reference,
)
from compare.show.style import CANDIDATE, GREY, PAGE_WIDTH, REFERENCE, label

_AXES = {"left": 0.107, "right": 0.99, "top": 0.98, "bottom": 0.15, "hspace": 0.08}


def phase_criterion(comparison: Comparison) -> Figure:
    """Draw criterion (26) of the paper, zero in Phase B, and the contact, at the tip in Phase A."""
    figure = Figure(figsize=(PAGE_WIDTH, 5.4))
    axes = figure.subplots(2, 1, sharex=True, gridspec_kw=_AXES)
    for readings, which, style in (
        (comparison.reference, "reference", LINE),
        (comparison.candidate, "candidate", dots(comparison)),
    ):
        judged, x = comparison.judged[which], foot(readings)
        draw(axes[0], x, judged.criterion, label=label(readings.source), **style)
        draw(axes[1], x, on_vibrissa(1 - judged.shortfall), **style)
    for ax, expected in zip(axes, (0, 1), strict=True):
        shade_reference(ax, comparison)
        ax.axhline(expected, color=GREY, linewidth=0.8, linestyle="--")
    axes[0].set_ylabel(r"$(2F_{Ay} - M_{Az}^2)\,/\,2f$" + "\nzero in Phase B")
    axes[1].set_ylabel("contact $s_1$ / $L$\none in Phase A")
    axes[1].set_xlabel(
        f"{foot_label(comparison.reference)}   (dotted: transitions found from the clamp)"
    )
    length = comparison.reference.beam.length
    for place in comparison.transitions.values():
        for where, colour in ((place.reference, REFERENCE), (place.candidate, CANDIDATE)):
            if where is not None:
                for ax in axes:
                    ax.axvline(where / length, color=colour, linestyle=":", linewidth=1)
    key_below(figure, axes[0], 2)
    return figure
