"""Sweeps to the right, as mirror images of sweeps to the left."""

from collections.abc import Callable
from dataclasses import replace

from analytic.problem.case import Case
from analytic.problem.errors import require
from analytic.problem.readings import Readings


def leftward(case: Case) -> Case:
    """A case whose clamp goes to the left: itself, or its mirror image."""
    require("case", case, Case, "named_case('catenary') makes one")
    return case if case.direction == "left" else case.mirrored()


def keep_facing(case: Case, keep: Callable[[Readings], None]) -> Callable[[Readings], None]:
    """What takes readings of the sweep to the left, and keeps them as those of a case."""
    return lambda found: keep(facing(case, found))


def facing(case: Case, found: Readings) -> Readings:
    """The readings of the sweep to the left that was solved for `case`, as readings of `case`."""
    if case.direction == "left":
        return found
    mirrored = found.mirrored()
    return replace(mirrored, provenance={**mirrored.provenance, **case.provenance()})
