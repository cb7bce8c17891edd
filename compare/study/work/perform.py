"""One run of a study, from its parameters to one flat row; what is known of many at once."""

import os
import platform
import signal
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal, TypeAlias, TypeVar

import numpy as np

from analytic import (
    Beam,
    Contour,
    Events,
    InputError,
    Readings,
    find_many_events,
    solve_sweep,
    solve_sweeps,
)
from analytic.problem.errors import require
from analytic.problem.support import is_plain
from analytic.space import SpatialReadings, solve_space
from compare.comparison import compare
from compare.judge.tolerances import Tolerances
from compare.simulate.dispatch import simulate
from compare.study.grid.plan import PlannedRun
from compare.study.grid.study import PlanarRun, SpatialRun, Study, Value, run_of
from compare.study.work import metrics
from mujoco_models import DivergedError

T = TypeVar("T")


@dataclass(frozen=True)
class Known:
    """What is known of a run; what is None, the run finds itself, with its error if any."""

    run: PlanarRun | None = None
    events: Events | None = None  # of its sweep, of the mirrored one if the foot moves to the right
    reference: Readings | None = None  # the closed form's sweep


NOTHING = Known()


def known_of(study: Study, parameters: Sequence[dict[str, Value]]) -> list[Known]:
    """Read the cases of runs, and find the events of all and solve the sweeps of all at once.

    Of runs in closed form, that is: beside a simulation it takes no time.
    """
    if study.in_space or study.beams or len(parameters) == 1:
        return [NOTHING] * len(parameters)
    given = {i: {**study.base, **one} for i, one in enumerate(parameters)}
    runs = _where_possible(lambda one: require("run", run_of(one), PlanarRun, ""), given)
    events: dict[int, Events] = {}
    swept: dict[int, Readings] = {}
    if "events" in study.record and (plain := _where_possible(_plain, runs)):
        with suppress(Exception):
            profiles, beams = zip(*plain.values(), strict=True)
            events = dict(zip(plain, find_many_events(profiles, beams), strict=True))
    if not study.events_only:
        cases = _where_possible(lambda run: run.case(Path(), "run"), runs)
        solved = zip(cases, solve_sweeps(cases.values()), strict=True)
        swept = {i: found for i, found in solved if isinstance(found, Readings)}
    return [Known(runs.get(i), events.get(i), swept.get(i)) for i in given]


def _where_possible(function: Callable[[Any], T | None], given: Mapping[int, Any]) -> dict[int, T]:
    """What a function makes of each; where it fails, the run will say."""
    made: dict[int, T] = {}
    for i, one in given.items():
        with suppress(Exception):
            if (found := function(one)) is not None:
                made[i] = found
    return made


def _plain(run: PlanarRun) -> tuple[Contour, Beam] | None:
    """Contour and vibrissa of a sweep to the left that many are found of at once."""
    if run.whisk is not None:
        return None
    beam, profile, held = run.physics(Path())
    if not is_plain(beam, held):
        return None
    return (profile.mirrored() if run.sweep.direction == "right" else profile), beam


Outcome: TypeAlias = Literal["done", "diverged", "unsettled", "timeout", "failed", "bad-input"]
Row: TypeAlias = dict[str, Any]

_VERSIONS = ("vibrissa-testbed", "mujoco", "numpy", "scipy")
# Of the stations; in motion the first contact and the last bounce, whatever the settings.
_BOUNCES = 0.1


@dataclass(frozen=True)
class Result:
    row: Row
    readings: dict[str, Readings | SpatialReadings] = field(default_factory=dict)


class _TimeIsUp(Exception):  # noqa: N818  # not an error: an outcome
    pass


def perform_all(study: Study, runs: Sequence[PlannedRun]) -> list[Result]:
    """Do runs, what is known of all of them at once."""
    begin = time.perf_counter()
    known = known_of(study, [run.parameters for run in runs])
    share = (time.perf_counter() - begin) / len(runs)
    return [perform(study, run, one, share) for run, one in zip(runs, known, strict=True)]


def perform_alone(study: Study, runs: Sequence[PlannedRun]) -> list[Result]:
    """Do runs in a process that does nothing else: one that hangs ends the process.

    `perform` asks the time between stations, which ends a slow run but not a stuck one. An alarm
    that nobody handles kills; no Python code has to run for it. Windows has no such alarm.
    """
    if not hasattr(signal, "setitimer"):
        return perform_all(study, runs)
    signal.setitimer(signal.ITIMER_REAL, 1.1 * study.timeout + 1)
    try:
        return perform_all(study, runs)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def perform(study: Study, run: PlannedRun, known: Known = NOTHING, spent: float = 0.0) -> Result:
    """Do one run. Whatever goes wrong becomes its outcome; nothing is raised."""
    begin = time.perf_counter() - spent
    row: Row = {"run": run.id, "outcome": "done", "reason": "", **run.parameters}
    readings: dict[str, Readings | SpatialReadings] = {}
    try:
        row |= _measure(study, run.parameters, readings, known)
    except _TimeIsUp:
        row |= {"outcome": "timeout", "reason": f"not finished after {study.timeout:g} s"}
    except InputError as error:
        row |= {"outcome": "bad-input", "reason": str(error)}
    except DivergedError as error:
        row |= {"outcome": "diverged", "reason": str(error)}
    except Exception as error:
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        row |= {"outcome": "failed", "reason": reason}
    row |= {"seconds": time.perf_counter() - begin, **_system()}
    return Result(row, readings if study.keep_readings else {})


def lost(run: PlannedRun, outcome: Outcome, reason: str) -> Result:
    return Result({"run": run.id, "outcome": outcome, "reason": reason, **run.parameters})


def _measure(
    study: Study,
    parameters: dict[str, Value],
    readings: dict[str, Readings | SpatialReadings],
    known: Known,
) -> Row:
    run = known.run or run_of({**study.base, **parameters})
    row: Row = {"seed": run.noise.seed}
    method = run.reconstruction.method
    if study.in_space and "reconstruction" in study.record and method != "elastica":
        raise InputError("reconstruction.method", method, "elastica in space", "leave it out")
    along_line = isinstance(run, PlanarRun) and run.whisk is None
    if isinstance(run, PlanarRun) and along_line and "events" in study.record:
        physics, direction = run.physics(Path()), run.sweep.direction
        events = known.events or metrics.find(physics, direction)
        row |= metrics.events(events, physics.beam.length, direction)
    if along_line and study.events_only:
        return row
    solver: Any = solve_space if isinstance(run, SpatialRun) else solve_sweep
    reference = known.reference or solver(run.case(Path(), "run"))
    if "events" in study.record and isinstance(reference, SpatialReadings):
        row |= metrics.events_in_space(reference)
    elif "events" in study.record and not along_line:
        row |= metrics.events_on_way(require("readings", reference, Readings, "in the plane"))
    simulated = reference
    if study.beams:
        begin = time.perf_counter()

        def ask_the_time() -> None:
            if time.perf_counter() > begin + study.timeout:
                raise _TimeIsUp

        simulated = _simulated(run, ask_the_time)
        row["seconds_candidate"] = time.perf_counter() - begin
        row |= _trust(simulated)
    candidate = run.noise.add_to(simulated)
    readings["analytic"] = reference
    if candidate is not reference:
        readings["candidate"] = candidate
    if row.get("outcome") == "diverged":
        return row
    if "disagreement" in study.record:
        row |= compare(reference, candidate).metrics()
    if "reconstruction" in study.record:
        row |= metrics.reconstruction(candidate, method, run.noise.relative)
    return row


def _simulated(
    run: PlanarRun | SpatialRun, advance: Callable[[], None]
) -> Readings | SpatialReadings:
    if isinstance(run, SpatialRun):
        return simulate(run.case(Path(), "run"), run.mujoco, advance=advance)
    case = run.case(Path(), "run")
    motion = None if run.motion is None else run.motion.build(case.beam)
    return simulate(case, run.mujoco, motion, None, run.engine.name, advance)


def _trust(simulated: Readings | SpatialReadings) -> Row:
    """The outcome, if the simulation itself speaks against too many of its stations."""
    status = simulated.table["status"].to_numpy()
    for outcome in ("diverged", "unsettled"):
        count = int((status == outcome).sum())
        if count > Tolerances().untrusted * len(status):
            return {"outcome": outcome, "reason": f"{count} of {len(status)} stations {outcome}"}
    bouncing = int(np.isin(status, ("chattering", "lost")).sum())
    if bouncing > _BOUNCES * len(status):
        reason = f"{bouncing} of {len(status)} stations chattering or without contact"
        return {"outcome": "unsettled", "reason": reason}
    return {}


@cache
def _system() -> Row:
    return {
        **{f"version_{name.replace('-', '_')}": version(name) for name in _VERSIONS},
        "version_python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "host": platform.node(),
    }
