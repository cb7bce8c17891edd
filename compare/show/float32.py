"""Single precision over contact stiffness: what was predicted and what was found."""

import matplotlib.ticker
import pandas as pd
from matplotlib.figure import Figure

from compare.show.document import Table
from compare.show.numbers import short
from compare.show.style import BLUE, GREY, LARGE, NORMAL, SERIES, SMALL, label

_WORTH = 0.5  # stations; as many are expected to be lost where a loss is predicted


def sentence(evaluator: str, found: pd.DataFrame) -> str:
    """From which contact stiffness on contacts are lost, predicted and found."""
    lost, expected = found["lost"] > 0, found["predicted_lost"] >= _WORTH
    return (
        f"{evaluator} {_from(found, lost, 'loses contacts', 'loses no contact')}; from "
        f"float32's resolution that is predicted {_from(found, expected, '', 'nowhere')}."
    )


def losses_table(evaluator: str, found: pd.DataFrame, case: str) -> Table:
    """What is lost by contact stiffness, and what was predicted of it."""
    rows = []
    for row in found.to_dict("records"):
        lost = f"{row['lost']} of {row['stations']} ({row['predicted_lost']:.1f})"
        found_and_due = ((row[n], row[f"predicted_{n}"]) for n in ("force_error", "imbalance"))
        off = (f"{short(size)} ({short(due)})" for size, due in found_and_due)
        sizes = short(row["depth"]), short(row["resolution"])
        rows.append((f"{row['contact_stiffness']:g}", *sizes, lost, *off))
    caption = (
        f"{case}: MuJoCo's states at rest by {evaluator}, found (predicted in single precision); "
        "lost: stations; force: over the largest load; L = EI = 1"
    )
    head = ("stiffness", "depth", "resolution", "lost", "force off", "imbalance")
    return Table(caption, head, rows)


def _from(found: pd.DataFrame, where: pd.Series, some: str, none: str) -> str:
    if not where.any():
        return none
    first = found.loc[where, "contact_stiffness"].min()
    return f"{some} from {first:g} EI/L^3 on".strip()


def picture(found: pd.DataFrame, name: str) -> Figure:
    """Draw losses, errors of force and imbalance over the contact stiffness."""
    figure = Figure(figsize=(9.0, 6.4), layout="constrained")
    figure.suptitle(f"{label(name)}: states at rest of MuJoCo, evaluated by others", fontsize=LARGE)
    (depths, lost), (force, balance) = figure.subplots(2, 2, sharex=True)
    groups = list(found.groupby("evaluator", sort=False))
    expected = groups[0][1]
    k = expected["contact_stiffness"]
    depths.plot(k, expected["depth"], "o-", color=GREY, label="depth of a contact, median")
    depths.plot(k, expected["resolution"], "--", color=BLUE, label="resolution, predicted")
    depths.set(xscale="log", yscale="log", ylabel="error of the depth [L]")
    share = 100 / expected["stations"]
    pairs = (
        (lost, "lost", share, "stations lost [%]"),
        (force, "force_error", 1.0, "error of force / largest"),
        (balance, "imbalance", 1.0, "imbalance [EI/L]"),
    )
    for ax, name, scale, words in pairs:
        ax.plot(k, scale * expected[f"predicted_{name}"], "--", color=BLUE, label="predicted")
        ax.set_ylabel(words, fontsize=NORMAL)
    looks = zip(groups, "sx^", SERIES[1:], strict=False)
    for (evaluator, rows), marker, colour in looks:
        look = {"marker": marker, "color": colour, "linestyle": "", "label": evaluator}
        depths.plot(k, (rows["depth_error"] * rows["resolution"]).to_numpy(), **look)
        for ax, name, scale, _ in pairs:
            ax.plot(k, (scale * rows[name].to_numpy()), **look)
    for ax in (force, balance):
        ax.set_yscale("log")
        ax.set_xlabel("contact stiffness [EI/L$^3$]")
    lost.set_ylim(bottom=0)
    for ax in (depths, lost, force, balance):
        ax.xaxis.set_major_locator(matplotlib.ticker.LogLocator(10, numticks=12))
        ax.grid(which="major", alpha=0.25)
        ax.legend(frameon=False, fontsize=SMALL)
    return figure
