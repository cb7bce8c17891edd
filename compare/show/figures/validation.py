"""Disagreement and its uncertainty over the foot position, reading by reading."""

from matplotlib.figure import Figure

from compare.comparison import Comparison
from compare.show.figures.keys import key_below
from compare.show.figures.over_foot import draw, shade_reference, stacked
from compare.show.style import BLUE, GREY, INK, SKY, SMALL, SYMBOLS
from compare.validate.validation import Validation

_EXPANDED = 2  # standard uncertainties, at one station of one reading


def validation_picture(comparison: Comparison, found: Validation) -> Figure:
    """Draw E = S - D of each reading within its expanded uncertainty."""
    figure, axes = stacked(comparison.reference)
    length = comparison.reference.beam.length
    for name, ax in axes.items():
        rows = found.table[found.table["reading"] == name].sort_values("foot_x")
        x = rows["foot_x"].to_numpy() / length
        shade_reference(ax, comparison)
        for part, colour, label in (
            ("u_val", SKY, r"$\pm 2\,u_\mathrm{val}$"),
            ("u_data", GREY, r"$\pm 2\,u_D$, noise alone"),
        ):
            wide = _EXPANDED * rows[part].to_numpy()
            ax.fill_between(x, -wide, wide, color=colour, alpha=0.45, linewidth=0, label=label)
        style = {"color": INK, "marker": "o", "markersize": 2.5, "linestyle": ""}
        draw(ax, x, rows["error"].to_numpy(), label="$E = S - D$", **style)
        ax.axhline(0, color=BLUE, linewidth=0.8)
        one = found.by_reading[name]
        said = "resolved" if one.resolved else "not resolved"
        ax.set_title(
            f"{SYMBOLS[name]}: rms {one.error:.1e}, {said} "
            f"(limit {one.limit:.1e} = {one.coverage:.2f} $u_\\mathrm{{val}}$)",
            fontsize=SMALL + 1,
        )
        ax.set_ylabel("of the largest magnitude", fontsize=SMALL)
    key_below(figure, axes["force_x"], 4)
    return figure
