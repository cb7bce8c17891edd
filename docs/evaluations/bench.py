"""Sweep cases with an engine that steps in time, as it is and as well as it gets: a row a sweep.

Each script beside this one has an engine's links as a `Trial` (of `engines.Stepper` what steps and
looks), and names its variants. Every station is treated alike: the foot moves in one swing, the
engine steps for some swings more, the clamp is read, and `engines.agreement` is asked whether
springs, contacts and clamp agree. Closed form and MuJoCo come in when all is read.
"""

import sys
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Protocol

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, Case, Sweep, circle, solve_sweep
from engines.agreement import Agreement, State
from mujoco_models import Settings, simulate_sweep
from mujoco_models.beams.layout import Layout

STATIONS = 30
FOUND_ON = Case(name="low", profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(stations=STATIONS))
SHOWN_ON = [
    replace(FOUND_ON, name=name, profile=profile)
    for name, profile in {
        "small": circle(0.5, (0.0, 0.5)),
        "high": circle(1.0, (0.0, 0.75)),
        "large": circle(2.0, (0.1, 0.4)),
    }.items()
]
_BEFORE = 0.07  # L before snap-off: nearer to it any error is one of where it lets go


class Trial(Protocol):
    """An engine's vibrissa and its circle; see `engines.Stepper`."""

    layout: Layout
    period: int

    def step(self, foot_x: float) -> None: ...

    def look(self) -> State: ...


def circle_of(case: Case) -> tuple[np.ndarray, float]:
    """Centre and radius of a case's object."""
    at = case.profile.at(case.profile.parameter(np.zeros(1)))
    radius = float((at.stretch / at.turning)[0])
    return np.array([float(at.xi[0]), float(at.eta[0]) + radius]), radius


def measure(
    out: Path,
    engine: str,
    variants: Mapping[str, Callable[[Case, int], Trial]],
    counts: Mapping[str, tuple[int, ...]],
    swings: int = 16,
) -> None:
    """Sweep with every variant: "defaults" and "tuned" on all cases, what is between on one."""
    rows = []
    for name, make in variants.items():
        whole = name.split(":")[0] in ("defaults", "tuned")
        for case in [FOUND_ON, *SHOWN_ON] if whole else [FOUND_ON]:
            for count in counts.get(name, (10,)):
                rows.append({"engine": engine, "settings": name, **_row(case, count, make, swings)})
                print(
                    *(f"{x:.3g}" if isinstance(x, float) else x for x in rows[-1].values()),
                    flush=True,
                )
                pd.DataFrame(rows).to_csv(out, index=False, float_format="%.4g")


def _row(
    case: Case, count: int, make: Callable[[Case, int], Trial], swings: int
) -> dict[str, object]:
    """How far the clamp's readings are from the closed form's, and what the test says of them."""
    begun = time.process_time()
    trial = make(case, count)
    agreement, at, doubts, moving = (
        Agreement(case, trial.layout),
        float(case.foot_x[0]),
        Counter(),
        0,
    )
    read = np.full((STATIONS, 3), np.nan)
    for i, foot_x in enumerate(case.foot_x.tolist()):
        for place in np.linspace(at, foot_x, 1 + trial.period)[1:].tolist():
            trial.step(place)
        for _ in range(swings * trial.period):
            trial.step(foot_x)
        state, at = trial.look(), foot_x
        doubt = agreement.doubt(state, foot_x)
        doubts.update([doubt] if doubt else [])
        if doubt == "a number is missing":
            doubts[doubt] += STATIONS - 1 - i
            break
        read[i] = state.clamp
        for _ in range(max(1, trial.period // 16)):
            trial.step(foot_x)
        moving += bool(np.abs(trial.look().clamp - state.clamp).max() > 1e-3)
    seconds = time.process_time() - begun
    ours = _seconds_of_mujoco(case, count)
    exact = solve_sweep(case)
    true = exact.table[list(CLAMP_READINGS)].to_numpy()
    kept = case.foot_x > exact.snap_off + _BEFORE
    with np.errstate(over="ignore"):
        rms = np.sqrt((((read - true)[kept] / np.abs(true).max(axis=0)) ** 2).mean(axis=0))
    cause = doubts.most_common(1)[0][0] if doubts else ""
    return {
        "case": case.name, "segments": count,
        **dict(zip(CLAMP_READINGS, rms.tolist(), strict=True)),
        "stations": STATIONS, "doubted": sum(doubts.values()), "doubt": cause, "moving": moving,
        "times_mujoco": seconds / ours,
    }  # fmt: skip


def _seconds_of_mujoco(case: Case, count: int) -> float:
    """The second time, when all is loaded."""
    for _ in range(2):
        begun = time.process_time()
        simulate_sweep(case, Settings(segments=count, obstacle="primitive"))
    return time.process_time() - begun


def out() -> Path:
    """Where the table goes."""
    return Path(sys.argv[1])
