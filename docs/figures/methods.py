"""How well each method finds the contact, on equal readings: of the paper's vibrissa and of others.

``python -m docs.figures.methods CASE|FILE DIR`` prints median errors by noise, and writes
``methods.csv`` and ``methods.png``. FILE are readings whose contacts are known.
"""

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pandas as pd
import typer
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from analytic import CLAMP_READINGS, Case, InputError, Readings, solve_sweep
from analytic.from_clamp.earlier import METHODS, NAMES
from analytic.numerics.arrays import Floats
from analytic.problem.errors import unknown
from analytic.problem.quantities import QUANTITIES
from compare.commands import terminal
from compare.commands.options import option, words
from compare.commands.output import output_folder
from compare.commands.sweeping import sweep_file
from compare.read.case import load_job
from compare.read.job import Job
from compare.sense.noise import with_noise
from compare.show import style
from compare.show.document import Table
from compare.show.numbers import short
from compare.study.work.metrics import contacts_by
from mujoco_models import simulate_sweep

INFORMED = "elastica-informed"
"""The closed form with the true curvature, clamp and friction."""
KNOWN = ", curvature, clamp, friction"
"""What that needs beside what the closed form does."""
_NOISE = "0,0.001,0.01"
_PHASES = ("tip", "tangent")
_DARK = -2.2  # decades; more is so dark that words on it are white
_NEARLY_ALL = 0.985
_DRAWN = 1e-6  # L; what is less is drawn there: no sensor sees the difference


@dataclass(frozen=True)
class Condition:
    """A case as it is in truth, while a method takes it for the paper's vibrissa."""

    what: str  # in a few words, with its size
    true: Callable[[Case], Case]  # the true case, from the one that the method believes in


def _with(name: str, size: float) -> Callable[[Case], Case]:
    """The case with another value of a quantity, in its unit."""
    quantity = QUANTITIES[name]
    return lambda case: quantity.at(case, size * quantity.unit(case))


CONDITIONS: dict[str, Condition] = {
    "exact": Condition("the paper's vibrissa", lambda case: case),
    "curved": Condition("natural curvature -0.2/L", _with("natural_curvature", -0.2)),
    "tapered": Condition(
        "a cone whose tip has 0.8 of the radius",
        lambda case: QUANTITIES["tip_radius"].at(case, 0.8 * case.beam.radius),
    ),
    "soft-clamp": Condition("clamp of stiffness 10 EI/L", _with("clamp_compliance", 0.1)),
    "friction": Condition("friction 0.2", _with("friction", 0.2)),
}
"""By name. Sizes are moderate: each bends or turns a vibrissa by less than a contact does."""

SIMULATED = "mujoco"
"""Name of readings that a simulator made."""


def chosen_conditions(names: Iterable[str]) -> list[str]:
    """Conditions by name, without repetition."""
    every = (*CONDITIONS, SIMULATED)
    found: dict[str, None] = {}
    for name in names:
        if name not in (*every, "all"):
            raise InputError(
                "readings", repr(name), f"all, or of {', '.join(every)}", "correct the name"
            )
        found |= dict.fromkeys(every if name == "all" else [name])
    return list(found)


def as_believed(readings: Readings, case: Case) -> Readings:
    """The readings as a method gets them: of the paper's vibrissa, as far as anybody knows."""
    provenance = {name: x for name, x in readings.provenance.items() if name != "support"}
    return replace(readings, beam=case.beam, provenance=provenance)


def method_errors(
    truth: Readings,
    methods: Iterable[str] = NAMES,
    noise: Iterable[float] = (0.0, 1e-3, 1e-2),
    seed: int = 0,
) -> pd.DataFrame:
    """Contact error of each method, by phase and by noise of the clamp's readings."""
    chosen = list(methods)
    for name in chosen:
        if name not in NAMES:
            raise unknown("method", name, NAMES)
    if not {"contact_x", "contact_y", "phase"} <= set(truth.table):
        raise InputError(
            f"contacts of the readings ({truth.source})",
            "missing",
            "columns contact_x, contact_y and phase",
            "methods are held against contacts that are known: take a model's readings",
        )
    rows = [
        row
        for level in noise
        for sensed in [with_noise(truth, dict.fromkeys(CLAMP_READINGS, level), seed)]
        for name in chosen
        for row in _errors(truth, sensed, name, level)
    ]
    return pd.DataFrame(rows)


def needs_of(method: str) -> str:
    """What a method has to know beside the foot's position."""
    if method in METHODS:
        return ", ".join(METHODS[method].needs)
    return "moment, force, rigidity, length"


def _errors(
    truth: Readings, sensed: Readings, method: str, level: float
) -> Iterator[dict[str, Any]]:
    begun = time.process_time()
    found = contacts_by(sensed, method, level)
    seconds = time.process_time() - begun
    off = [found[name].to_numpy() - truth.values(name) for name in ("contact_x", "contact_y")]
    error = np.hypot(*off) / truth.beam.length
    phase = truth.table["phase"].to_numpy()
    touching = int(np.isin(phase, _PHASES).sum())
    for name in _PHASES:
        here: Floats = error[(phase == name) & truth.trusted]
        answered = here[np.isfinite(here)]
        yield {
            "method": method,
            "needs": needs_of(method),
            "noise": level,
            "phase": name,
            "contacts": len(here),
            "answered": len(answered) / len(here) if len(here) else np.nan,
            "median": float(np.median(answered)) if answered.size else np.nan,
            "rms": float(np.sqrt(np.mean(answered**2))) if answered.size else np.nan,
            "worst": float(answered.max()) if answered.size else np.nan,
            "seconds": seconds / max(touching, 1),
        }


def picture(found: pd.DataFrame, title: str) -> Figure:
    """Draw each method's median error over noise, or over kinds of readings without noise."""
    over, said = "noise", "noise over each reading's largest magnitude"
    if len(set(found["readings"])) > 1:
        over, said = "readings", "the readings' vibrissa"
        found = found[found["noise"] == found["noise"].min()]
    methods, columns = (list(dict.fromkeys(found[name])) for name in ("method", over))
    phases = [name for name, of in found.groupby("phase", sort=False) if of["contacts"].any()]
    figure = Figure(
        figsize=(1.0 * len(columns) * len(phases) + 3.6, 0.42 * len(methods) + 2.2),
        layout="constrained",
    )
    axes = figure.subplots(1, max(len(phases), 1), squeeze=False, sharey=True)[0]
    colours = colormaps["viridis_r"].with_extremes(bad=style.BODY)
    decades = Normalize(np.log10(_DRAWN), 0)
    for ax, phase in zip(axes, phases, strict=False):
        rows = found[found["phase"] == phase]
        medians, shares = (
            rows.pivot_table(index="method", columns=over, values=name, dropna=False)
            .reindex(index=methods, columns=columns)
            .to_numpy(dtype=float)
            for name in ("median", "answered")
        )
        sizes = np.log10(np.maximum(medians, _DRAWN))
        ax.imshow(np.ma.masked_invalid(sizes), colours, decades, aspect="auto")
        for (i, j), size in np.ndenumerate(sizes):
            share = shares[i, j]
            if np.isnan(share):  # not asked
                continue
            text = "none" if np.isnan(size) else short(10**size) if size > -6 else "<1e-6"
            text += "" if share > _NEARLY_ALL or np.isnan(size) else f"\n{share:.0%}"
            ax.text(
                j, i, text, ha="center", va="center", fontsize=style.SMALL, linespacing=0.9,
                color=style.PAPER if size > _DARK else style.INK,
            )  # fmt: skip
        ax.set_xticks(range(len(columns)), columns, rotation=35, ha="right", fontsize=style.SMALL)
        ax.set_title(style.PHASE_NAMES[str(phase)], fontsize=style.SMALL + 1)
    scale = ScalarMappable(decades, colours)
    figure.colorbar(scale, ax=axes, label="median error / $L$, powers of ten", shrink=0.8)
    axes[0].set_yticks(range(len(methods)), methods, fontsize=style.SMALL)
    figure.supxlabel(f"{said}; below a number: share answered", fontsize=style.SMALL)
    figure.suptitle(f"Contact found from the clamp: {title}", fontsize=12)
    return figure


def compare_methods(
    source: Job | Path, out: Path, names: list[str], levels: list[float], on: list[str]
) -> None:
    """Write the errors of methods under noise, on readings whose contacts are known."""
    called = source.stem if isinstance(source, Path) else source.case.name
    with output_folder(out) as folder:
        tables = []
        for which, truth, believed in _truths(source, on, folder):
            found = method_errors(believed, names, levels)
            unlike = believed.beam != truth.beam or believed.provenance != truth.provenance
            if unlike:
                knowing = method_errors(truth, ["elastica"], levels)
                knowing = knowing.assign(method=INFORMED, needs=knowing["needs"] + KNOWN)
                found = pd.concat([found, knowing], ignore_index=True)
            found.insert(0, "readings", which)
            found.insert(0, "case", called)
            tables.append(found)
            print_methods(found, f"{called} ({which if len(on) > 1 else truth.source})")
        every = pd.concat(tables, ignore_index=True)
        terminal.keep(folder / "methods.csv", every)
        title = f"{called} ({truth.source})" if len(tables) == 1 else called
        terminal.keep(folder / "methods.png", picture(every, title))


def _truths(
    source: Job | Path, on: list[str], folder: Path
) -> Iterator[tuple[str, Readings, Readings]]:
    """Readings with their true contacts, what of, and as the methods get them."""
    if isinstance(source, Path):
        truth = Readings.read(source)
        yield "exact", truth, truth
        return
    conditions = chosen_conditions(on)
    source.case.require_plain("the table of methods")
    for name in conditions:
        if name == SIMULATED:
            with terminal.progress("MuJoCo", source.stations) as advance:
                truth = simulate_sweep(source.case, source.settings, advance)
            truth.write(folder / sweep_file(source))
        else:
            truth = solve_sweep(CONDITIONS[name].true(source.case))
        yield name, truth, as_believed(truth, source.case)


def print_methods(found: pd.DataFrame, title: str) -> None:
    """Print each method's median error by noise, and how many contacts it has an answer for."""
    levels = sorted(found["noise"].unique())
    heads = (f"noise {level:g}" if level else "no noise" for level in levels)
    rows = []
    for method, of_method in found.groupby("method", sort=False):
        name = str(method)
        for phase, by_noise in of_method.groupby("phase", sort=False):
            by = by_noise.set_index("noise")
            if not by["contacts"][levels[0]]:
                continue
            rate = f"{1 / by['seconds'].median():.0f}" if name and by["seconds"].min() > 0 else ""
            share = f"{by['answered'][levels[0]]:.0%}"
            medians = (short(by["median"][level]) for level in levels)
            rows.append((name, style.PHASE_LETTERS[str(phase)], share, *medians, rate))
            name = ""
    head = ("method", "phase", "answers", *heads, "contacts per s")
    terminal.show(Table(f"Median error of the contact, over L: {title}", head, rows, words=(0, 1)))


def _levels(text: str) -> list[float]:
    found = [float(word) for word in words(text)]
    if not all(0 <= level < 1 for level in found):
        raise InputError("--noise", text, "numbers from 0 up to 1", "as 0,0.01")
    return found


def main(
    source: Annotated[str, typer.Argument(help="A case, or a file of readings.")],
    out: Annotated[Path, typer.Argument(help="Folder for what is written.")],
    method: Annotated[str, option("Which methods.", "A,B,...")] = ",".join(NAMES),
    noise: Annotated[str, option("Over each reading's largest magnitude.", "A,B,...")] = _NOISE,
    on: Annotated[
        str, option(f"Readings of what: {', '.join(CONDITIONS)}, {SIMULATED}; or all.", "A,B,...")
    ] = "exact",
) -> None:
    """Find how well methods do that take readings for those of the paper's vibrissa."""
    given = Path(source)
    what: Job | Path = given if given.suffix == ".parquet" else load_job(source)
    compare_methods(what, out, words(method), _levels(noise), words(on))


if __name__ == "__main__":
    typer.run(main)
