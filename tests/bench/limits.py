"""How far figures are from what they cannot go below, which is timed beside them."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import NamedTuple
from unittest.mock import patch

import numpy as np
from rich.console import Console
from rich.table import Table

from analytic import (
    Beam,
    Case,
    Sweep,
    catenary,
    named_case,
    solve_contact,
    solve_sweep,
    solve_sweeps,
)
from analytic.solver.elastica import elliptic_integrals
from compare.explain.budget import controlled_changes
from compare.simulate.budgets import measure_budget
from mujoco_models import Settings, simulate_sweep
from mujoco_models.sweep.sweep import set_out
from tests.bench.ratios import command, process
from tests.bench.timing import cpu_seconds
from tests.in_turn import InTurn

_RUNS = 3
_EVALUATIONS = 200
_EVALUATION = "MuJoCo looks at each state once"
_INTEGRALS = "F and E, once a contact"
_LIBRARIES = "import mujoco, pandas, matplotlib.pyplot, PIL.Image, jinja2, rich.table, typer"


class Figure(NamedTuple):
    """What is timed, and what it cannot go below."""

    name: str
    ours: Callable[[], object]
    limit: Callable[[], object]
    meaning: str
    share: int = 1
    """Of how many things `ours` is the time."""
    limit_share: int = 1


def figures(quick: bool) -> list[Figure]:
    """Those of MuJoCo, of the closed form and of the commands.

    Parameters
    ----------
    quick : bool
        Whether they are only tried, at a small size.

    Returns
    -------
    list of Figure
        In that order.
    """
    stations, contacts, cases = (12, 1000, 10) if quick else (200, 100_000, 1000)
    refined = ((40, 50_000), *((n, 3200) for n in (80, 160, 320, 640)))
    sizes = [(10, 400)] if quick else [(40, 3200), *refined]
    short = ("--stations", "12", "--segments", "10") if quick else ()
    case = replace(named_case("catenary"), sweep=Sweep(stations))
    profile, thin = catenary(0.5, -0.8), Beam(radius=0.0)
    slopes = {"A": (-31, -15), "B": (-14, 30)}
    of_many, of_one = _integrals(contacts), _integrals(stations)

    def batch() -> None:
        family = (replace(case, profile=catenary(0.4 + i / 1e4, -0.8)) for i in range(cases))
        for _ in solve_sweeps(family):
            pass

    return [
        *(_station(case, Settings(segments=n, contour_points=points)) for n, points in sizes),
        *(
            Figure(
                f"a contact in Phase {phase}, of {contacts:,}",
                partial(solve_contact, profile, np.deg2rad(np.linspace(*ends, contacts)), thin),
                *(of_many, _INTEGRALS, contacts, contacts),
            )
            for phase, ends in slopes.items()
        ),
        Figure(
            f"a sweep of {stations} stations in closed form, with its events",
            *(lambda: solve_sweep(replace(case)), of_one, _INTEGRALS),
        ),
        Figure(f"one of {cases:,} such sweeps", batch, of_one, _INTEGRALS, cases),
        Figure(
            "`vibrissa list cases`",
            partial(process, command("list", "cases")),
            partial(process, "import typer"),
            "Python, and the import of Typer",
        ),
        Figure(
            "`vibrissa run catenary`",
            partial(process, command("run", "catenary", *short)),
            partial(process, _LIBRARIES),
            "Python, and the imports of MuJoCo, pandas, Matplotlib, ...",
        ),
        Figure(
            f"a budget, N = {sizes[0][0]}, its sweeps one after the other",
            partial(_budget, case, Settings(segments=sizes[0][0], contour_points=sizes[0][1])),
            _all_evaluations(case, Settings(segments=sizes[0][0], contour_points=sizes[0][1])),
            f"{_EVALUATION}, of all its sweeps",
        ),
    ]


def main(quick: bool) -> None:
    """Print each figure beside its limit."""
    table = Table(
        "figure", "CPU time", "limit", "times", "what the limit is",
        title=f"The least of {_RUNS} runs, on one core",
    )  # fmt: skip
    for one in figures(quick):
        ours, limit = (
            min(cpu_seconds(call) for _ in range(1 if quick else _RUNS)) / share
            for call, share in ((one.ours, one.share), (one.limit, one.limit_share))
        )
        table.add_row(one.name, _time(ours), _time(limit), f"{ours / limit:.1f}", one.meaning)
    Console(width=160).print(table)


def _station(case: Case, settings: Settings) -> Figure:
    stations = case.sweep.stations
    mesh = f"{settings.contour_points:,} points"
    return Figure(
        f"a station of MuJoCo's chain, N = {settings.segments}, {mesh}",
        partial(simulate_sweep, case, settings),
        _evaluations(case, settings, _EVALUATIONS),
        _EVALUATION,
        stations,
        _EVALUATIONS,
    )


def _budget(case: Case, settings: Settings) -> None:
    with patch("compare.simulate.workers.Workers", InTurn):  # whose time is not lost sight of
        measure_budget(case, settings)


def _evaluations(case: Case, settings: Settings, count: int) -> Callable[[], None]:
    """MuJoCo's evaluations of one state, amid the sweep."""
    walk = set_out(case, settings)
    for foot_x in case.foot_x[: len(case.foot_x) // 2]:
        walk.go_to(float(foot_x))

    def evaluations() -> None:
        for _ in range(count):
            walk.model.evaluate()

    return evaluations


def _all_evaluations(case: Case, settings: Settings) -> Callable[[], None]:
    """As many evaluations as the sweeps of a budget have stations, of one state amid each sweep."""
    stations = len(case.foot_x)
    few = replace(case, sweep=Sweep(12))
    every = [_evaluations(few, one, stations) for one in controlled_changes(settings).values()]

    def all_of_them() -> None:
        for evaluations in every:
            evaluations()

    return all_of_them


def _integrals(count: int) -> Callable[[], object]:
    opposite, adjacent = np.sin(x := np.linspace(0.1, 1.5, count)), np.cos(x)
    k = np.linspace(0.1, 0.7, count)
    return lambda: elliptic_integrals(opposite, adjacent, k, np.sqrt(1 - k * k))


def _time(seconds: float) -> str:
    """Three digits, in s, ms, µs or ns."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"
