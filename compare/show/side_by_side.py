"""Any number of sweeps against one reference: a table, a picture, and the differences in pairs."""

from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from analytic import CLAMP_READINGS, Readings
from compare.comparison import Comparison, compare
from compare.show.figures import READING_SYMBOLS, shade_phases

# Okabe and Ito's palette; the line styles tell lines apart where they lie on each other.
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
_STYLES = ("-", "--", ":", "-.")


@dataclass(frozen=True)
class SideBySide:
    """Sweeps compared with a reference and with each other.

    Attributes
    ----------
    against : dict of Comparison
        Each sweep against the reference, by its name.
    between : dict of Comparison
        Each sweep against each one before it, by both names.
    """

    against: dict[str, Comparison]
    between: dict[tuple[str, str], Comparison]

    @property
    def reference(self) -> str:
        """What the sweeps are compared with."""
        return next(iter(self.against.values())).reference.source

    def table(self) -> pd.DataFrame:
        """A row a comparison.

        Columns ``reference``, ``candidate``, the relative rms of each clamp reading, the
        ``snap_off`` of the candidate less that of the reference [length], and the candidate's
        ``seconds_per_station``, NaN where it was not recorded.
        """
        rows = []
        for names, found in self._all().items():
            snap_off = found.snap_off.difference
            rows.append(
                {
                    "reference": names[0],
                    "candidate": names[1],
                    **{name: found.disagreement[name].rms for name in CLAMP_READINGS},
                    "snap_off": np.nan if snap_off is None else snap_off,
                    "seconds_per_station": seconds_per_station(found.candidate),
                }
            )
        return pd.DataFrame(rows)

    def to_dict(self) -> dict[str, Any]:
        """What ``side-by-side.json`` holds: ``comparisons``, each as in ``comparison.json``."""
        return {
            "comparisons": [
                {"names": list(names), **found.to_dict()} for names, found in self._all().items()
            ]
        }

    def _all(self) -> dict[tuple[str, str], Comparison]:
        return {(self.reference, name): c for name, c in self.against.items()} | self.between


def side_by_side(reference: Readings, candidates: dict[str, Readings]) -> SideBySide:
    """Compare every candidate with the reference, and the candidates in pairs.

    Parameters
    ----------
    reference : Readings
        As the closed form.
    candidates : dict of Readings
        By the names under which they are told apart; at least one.

    Raises
    ------
    InputError
        If sweeps are of different beams or have no common stretch.
    """
    return SideBySide(
        {name: compare(reference, readings) for name, readings in candidates.items()},
        {
            (one, other): compare(candidates[one], candidates[other])
            for one, other in combinations(candidates, 2)
        },
    )


def seconds_per_station(readings: Readings) -> float:
    """As recorded by who made the readings; NaN if it was not."""
    seconds = readings.provenance.get("seconds")
    return np.nan if seconds is None else float(seconds) / len(readings.table)


def picture(found: SideBySide) -> Figure:
    """Differences of the clamp readings from the reference over the foot position."""
    figure = Figure(figsize=(12, 4.2), layout="constrained")
    axes = figure.subplots(1, 3, sharex=True)
    first = next(iter(found.against.values()))
    length = first.reference.beam.length
    for ax, name in zip(axes, CLAMP_READINGS, strict=True):
        shade_phases(ax, first.reference.values("foot_x") / length, first.judged["reference"].phase)
        for i, (label, one) in enumerate(found.against.items()):
            table = one.alignment.table
            error = table[f"{name}_candidate"] - table[f"{name}_reference"]
            ax.plot(
                table["foot_x"] / length,
                error / one.disagreement[name].scale,
                color=_COLOURS[i % len(_COLOURS)],
                linestyle=_STYLES[i % len(_STYLES)],
                label=label,
            )
        ax.ticklabel_format(axis="y", scilimits=(-2, 2))
        ax.set_title(READING_SYMBOLS[name][0], fontsize=11)
        ax.set_xlabel("foot $x_0$ / $L$")
    axes[0].set_ylabel(f"difference from {first.reference.source}\nrelative to largest magnitude")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=len(labels), fontsize=9, frameon=False
    )
    return figure
