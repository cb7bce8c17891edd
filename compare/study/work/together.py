"""What is computed of many runs in closed form at once, before each of them is done."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from analytic import Beam, Contour, Events, Readings, find_many_events, solve_sweeps
from analytic.problem.support import is_plain
from compare.study.grid.axes import Value
from compare.study.grid.study import PlanarRun, Study, run_of


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
    known = [_read(study, one) for one in parameters]
    if "events" in study.record:
        known = _with_events(known)
    if not study.events_only:
        known = _with_sweeps(known)
    return known


def _read(study: Study, parameters: dict[str, Value]) -> Known:
    try:
        run = run_of({**study.base, **parameters})
        return Known(run if isinstance(run, PlanarRun) else None)
    except Exception:  # the run will say
        return NOTHING


def _with_events(known: list[Known]) -> list[Known]:
    which: list[int] = []
    profiles: list[Contour] = []
    beams: list[Beam] = []
    for i, one in enumerate(known):
        if one.run is None or one.run.whisk is not None:
            continue
        try:
            beam, profile, held = one.run.physics(Path())
            if is_plain(beam, held):
                mirrored = one.run.sweep.direction == "right"
                profiles.append(profile.mirrored() if mirrored else profile)
                beams.append(beam)
                which.append(i)
        except Exception:  # the run will say
            continue
    try:
        found_of = dict(zip(which, find_many_events(profiles, beams), strict=True))
    except Exception:  # the run that has none will say
        return known
    return [replace(one, events=found_of.get(i)) for i, one in enumerate(known)]


def _with_sweeps(known: list[Known]) -> list[Known]:
    cases = {}
    for i, one in enumerate(known):
        if one.run is not None:
            try:
                cases[i] = one.run.case(Path(), "run")
            except Exception:  # the run will say
                continue
    solved = dict(zip(cases, solve_sweeps(cases.values()), strict=True))
    return [
        replace(one, reference=found) if isinstance(found := solved.get(i), Readings) else one
        for i, one in enumerate(known)
    ]
