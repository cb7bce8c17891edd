"""How slow is quasi-static, and what do MuJoCo's settings cost?

``python -m docs.figures.quasi_static_picture FILE.csv FILE.png`` draws what
`docs.figures.quasi_static` measured.
"""

import sys
from pathlib import Path

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from compare.show.page import write_all
from compare.show.style import FAINT, GREY, PHASE_COLOURS, PHASE_NAMES, SMALL

_PHASES = ("tip", "tangent")
_DAMPED = "speed, damping ratio 0.5"
_CHATTERS = 10  # stations of a hundred; what is left of such a sweep says little
_CURVES = {
    "timestep": r"time step / $T_1$",
    "damping_ratio": "damping ratio",
    "contact_stiffness": "contact stiffness / ($EI/L^3$)",
}
_BARS = (
    "segments",
    "clamp",
    "solver",
    "solref, solimp",
    "integrator, armature 1",
    "cone, friction 0.2",
)


def quasi_static(table: pd.DataFrame) -> Figure:
    """Draw the errors by setting, and how late the vibrissa lets go."""
    figure = Figure(figsize=(11, 7.4), layout="constrained")
    grid = figure.add_gridspec(3, 3, width_ratios=[1, 1, 1.15])
    speed = figure.add_subplot(grid[0, 0])
    for setting, style, words in (("speed", "-", "0.05"), (_DAMPED, "--", "0.5")):
        _errors(speed, table, setting, style, f", damping ratio {words}")
    speed.set_xlabel("speed / ($L/T_1$)")
    late = figure.add_subplot(grid[0, 1])
    for setting, style, words in (("speed", "-", "0.05"), (_DAMPED, "--", "0.5")):
        rows = _numbered(table, setting)
        late.plot(rows["x"], rows["late"], f"o{style}", color=GREY, markersize=4, label=words)
    late.set(xscale="log", yscale="log", xlabel="speed / ($L/T_1$)", ylabel="lets go late by / $L$")
    late.set_yticks([0.01, 0.02, 0.05, 0.1], ["0.01", "0.02", "0.05", "0.1"])
    _label_values(late, table, "speed")
    late.legend(title="damping ratio", fontsize=SMALL, title_fontsize=SMALL, frameon=False)
    places = (grid[1, 0], grid[1, 1], grid[2, 0])
    for place, (setting, words) in zip(places, _CURVES.items(), strict=True):
        ax = figure.add_subplot(place)
        _errors(ax, table, setting, "-", "")
        ax.set_xlabel(words)
    handles, labels = speed.get_legend_handles_labels()
    legend = figure.add_subplot(grid[2, 1])
    legend.axis("off")
    pale = Patch(facecolor="white", edgecolor=GREY, hatch="////")
    words = f"more than {_CHATTERS} of 100 stations\nchatter: of the others"
    legend.legend([*handles, pale], [*labels, words], fontsize=SMALL, frameon=False, loc="center")
    _bars(figure.add_subplot(grid[:, 2]), table)
    return figure


def _numbered(table: pd.DataFrame, setting: str) -> pd.DataFrame:
    rows = table[table["setting"] == setting]
    rows = rows.assign(x=pd.to_numeric(rows["value"]))
    return rows[rows["x"] > 0]  # there is no zero on a logarithmic axis


def _errors(ax: Axes, table: pd.DataFrame, setting: str, style: str, words: str) -> None:
    rows = _numbered(table, setting)
    for phase in _PHASES:
        colour = PHASE_COLOURS[phase]
        label = f"{PHASE_NAMES[phase]}{words}"
        ax.plot(rows["x"], rows[phase], f"o{style}", color=colour, markersize=4, label=label)
    ax.set(xscale="log", yscale="log", ylim=(5e-4, 0.3), ylabel="worst reading's rms")
    ax.grid(axis="y", color=FAINT, linewidth=0.3)
    _label_values(ax, table, setting)


def _label_values(ax: Axes, table: pd.DataFrame, setting: str) -> None:
    values = _numbered(table, setting)["x"].tolist()
    ax.set_xticks(values, [f"{x:g}" for x in values], fontsize=SMALL)
    ax.minorticks_off()


def _bars(ax: Axes, table: pd.DataFrame) -> None:
    position, ticks, names = 0.0, [], []
    for setting in _BARS:
        ax.text(4.2e-4, position, setting, fontsize=SMALL, fontweight="bold", va="center")
        position += 1
        for row in table[table["setting"] == setting].to_dict("records"):
            chatters = not row["chattering"] <= _CHATTERS
            for phase, shift in zip(_PHASES, (-0.2, 0.2), strict=True):
                ax.barh(
                    position + shift, row[phase], 0.36,
                    facecolor="white" if chatters else PHASE_COLOURS[phase],
                    edgecolor=PHASE_COLOURS[phase], hatch="////" if chatters else None,
                )  # fmt: skip
            if pd.isna(row["tip"]):
                words = f"{row['chattering']:.0f} of 100 stations chatter"
                ax.text(4.2e-4, position, words, fontsize=SMALL, va="center", color=GREY)
            ticks.append(position)
            names.append(row["value"])
            position += 1
        position += 0.3
    ax.set_yticks(ticks, names, fontsize=SMALL)
    ax.set(xscale="log", xlim=(4e-4, 0.4), xlabel="worst reading's rms", ylim=(position, -0.8))
    ax.grid(axis="x", color=FAINT, linewidth=0.3)


if __name__ == "__main__":
    out = Path(sys.argv[2])
    write_all(out.parent, {out.name: quasi_static(pd.read_csv(sys.argv[1]))})
