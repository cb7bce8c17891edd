"""Advice put to the test: the advised sweep, and what came of it."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from analytic import Case, Readings, solve_sweep
from compare.explain.advice import Advice, advise, seconds_a_station
from compare.explain.budget import Budget, largest_rms
from compare.explain.changes import coarser_mesh
from mujoco_models import simulate_sweep
from mujoco_models.settings import Settings


@dataclass(frozen=True)
class Followed:
    """Advice, and what came of it."""

    target: float  # the wanted error
    predicted: Advice  # the settings, and what was expected
    error: float  # what was measured with them
    seconds_a_station: float  # what was measured with them

    @property
    def reached(self) -> bool:
        """Whether the measured error is at most the target."""
        return self.error <= self.target

    def to_dict(self) -> dict[str, Any]:
        """What ``budget.json`` holds."""
        return {**asdict(self), "reached": self.reached}


def follow_advice(
    case: Case, found: Budget, runs: Mapping[str, Readings], target: float
) -> Followed:
    """Ask for advice, sweep with the advised settings, and measure."""
    base = Settings(**runs["base"].provenance["settings"])
    coarser = simulate_sweep(case, coarser_mesh(base))
    predicted = advise(found, runs, coarser, target)
    made = simulate_sweep(case, predicted.settings)
    return Followed(
        target, predicted, largest_rms(solve_sweep(case), made), seconds_a_station(made)
    )
