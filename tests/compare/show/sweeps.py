"""Sweeps to draw: exact ones, and candidates that are a little off. No simulator is needed."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from analytic import CLAMP_READINGS, Readings, named_case, solve_sweep
from compare import compare
from compare.show.budgets import picture
from compare.show.page import write_all
from tests.compare.planted import planted

STATIONS = 60


@cache
def exact(name: str) -> Readings:
    case = named_case(name)
    return solve_sweep(replace(case, sweep=replace(case.sweep, stations=STATIONS)))


@cache
def candidate(name: str) -> Readings:
    """As a simulator would leave it: all clamp readings wave about the exact ones."""
    sweep = exact(name)
    wave = 1 + 1e-3 * np.sin(np.arange(STATIONS))
    table = sweep.table.assign(**{n: wave * sweep.values(n) for n in CLAMP_READINGS})
    said = {"settings": {"beam": "chain", "segments": 40}, "engine": "MuJoCo 4.0.0", "seconds": 1.0}
    provenance = {**sweep.provenance, **said}
    return replace(sweep, table=table, source="mujoco chain", provenance=provenance)


def without_contact(name: str) -> Readings:
    """A simulator that never touches."""
    sweep = candidate(name)
    nothing = dict.fromkeys(CLAMP_READINGS, 0.0)
    nothing |= {column: np.nan for column in sweep.table if column.startswith(("contact", "tip_"))}
    provenance = {**sweep.provenance, "events": {}}
    return replace(sweep, table=sweep.table.assign(phase="free", **nothing), provenance=provenance)


def two_runs(folder: Path) -> Path:
    """As `write_report` leaves them, one with a budget and one with its readings."""
    for case, budget in (("parabola", planted()), ("catenary", None)):
        simulated = candidate(case)
        run = folder / f"{case}-chain"
        run.mkdir()
        contents = {"comparison.json": compare(exact(case), simulated).to_dict()}
        if budget is None:
            simulated.write(run / "mujoco-chain.parquet")
        else:
            contents |= {"budget.json": budget.to_dict(), "budget.png": picture(budget)}
        write_all(run, contents)
    return folder
