"""Agreement as an assertion, for users' own tests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from analytic import Readings
from compare.comparison import Comparison, compare
from compare.judge.tolerances import Tolerances

if TYPE_CHECKING:
    from compare.explain.budget import Budget


def assert_agreement(
    reference: Readings,
    candidate: Readings,
    tolerances: Tolerances | None = None,
    *,
    offset: float | Literal["auto"] = 0.0,
    noise: float | Literal["auto"] = 0.0,
    budget: Budget | None = None,
) -> Comparison:
    """Raise AssertionError unless the sweeps agree.

    Its message holds every exceeded limit in a line (which reading, which phase, where, how much,
    how much is allowed and why), and what the disagreement is likely made of.

    Parameters
    ----------
    reference, candidate, tolerances, offset, noise
        As `compare` takes them.
    budget : Budget, optional
        Of the candidate's disagreement, measured by controlled changes; the message names its
        largest part in place of the likeness to a known fault.

    Returns
    -------
    Comparison
        If they agree.

    Raises
    ------
    AssertionError
        If they do not.
    InputError
        As `compare`.
    """
    comparison = compare(reference, candidate, tolerances, offset=offset, noise=noise)
    demand(comparison, budget)
    return comparison


def demand(comparison: Comparison, budget: Budget | None = None) -> None:
    """Raise AssertionError unless `comparison` agrees; as `assert_agreement`."""
    if comparison.agrees:
        return
    title = f"{comparison.candidate.source} disagrees with {comparison.reference.source}:"
    raise AssertionError("\n  ".join([title, *comparison.failures, _cause(comparison, budget)]))


def _cause(comparison: Comparison, budget: Budget | None) -> str:
    if budget is not None:
        return f"by its budget the largest part is {budget.blame}"
    if comparison.likely is not None:
        return f"likely: {comparison.likely}"
    return (
        "the readings alone do not tell why; `vibrissa budget` measures the parts of a "
        "MuJoCo model's disagreement"
    )
