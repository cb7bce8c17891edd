"""What is computed of many runs in closed form at once, before each of them is done."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from analytic import Beam, Contour, Events, Readings, find_many_events, solve_sweeps
from analytic.problem.support import is_plain
from compare.study.grid.axes import Value
from compare.study.grid.study import PlanarRun, Study, run_of

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
    runs = _where_possible(_read, given)
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


def _read(parameters: Mapping[str, Value]) -> PlanarRun | None:
    run = run_of(parameters)
    return run if isinstance(run, PlanarRun) else None


def _plain(run: PlanarRun) -> tuple[Contour, Beam] | None:
    """Contour and vibrissa of a sweep to the left that many are found of at once."""
    if run.whisk is not None:
        return None
    beam, profile, held = run.physics(Path())
    if not is_plain(beam, held):
        return None
    return (profile.mirrored() if run.sweep.direction == "right" else profile), beam
