"""Agreement as an assertion, for users' own tests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from analytic import InputError, Readings
from compare.comparison import Comparison, compare
from compare.judge.tolerances import Tolerances
from compare.show.verdict import why

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
    __tracebackhide__ = True  # a failing test shows its own lines, and the message
    comparison = compared(reference, candidate, tolerances, offset=offset, noise=noise)
    demand(comparison, budget)
    return comparison


def compared(
    reference: Readings,
    candidate: Readings,
    tolerances: Tolerances | None = None,
    *,
    offset: float | Literal["auto"] = 0.0,
    noise: float | Literal["auto"] = 0.0,
) -> Comparison:
    """Compare two sweeps, if they are sweeps: a test's simulator may return anything.

    Parameters
    ----------
    reference, candidate, tolerances, offset, noise
        As `compare` takes them.

    Returns
    -------
    Comparison
        Whether they agree or not.

    Raises
    ------
    InputError
        If one of the two is no `Readings`; else as `compare`.
    """
    for name, given in (("reference", reference), ("candidate", candidate)):
        if not isinstance(given, Readings):
            raise InputError(
                name,
                "None" if given is None else f"a {type(given).__name__}",
                "analytic.Readings",
                "solve_sweep, simulate_sweep, read_measured or Readings(table, beam) make them",
            )
    return compare(reference, candidate, tolerances, offset=offset, noise=noise)


def demand(comparison: Comparison, budget: Budget | None = None) -> None:
    """Raise AssertionError unless `comparison` agrees.

    Parameters
    ----------
    comparison : Comparison
        What was found.
    budget : Budget, optional
        As `assert_agreement` takes it.

    Raises
    ------
    AssertionError
        If a limit is exceeded; its message is that of `assert_agreement`.
    """
    __tracebackhide__ = True
    if comparison.agrees:
        return
    title = f"{comparison.candidate.source} disagrees with {comparison.reference.source}:"
    remark = [] if comparison.remark is None else [comparison.remark]
    lines = [title, why(comparison, budget), *comparison.failures, *remark]
    raise AssertionError("\n  ".join(lines))
