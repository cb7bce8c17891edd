"""Many sweeps, one after the other, in the memory of a few."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from analytic.problem.case import Case
from analytic.problem.errors import require
from analytic.problem.readings import Readings
from analytic.solver.plain import solve_plain
from analytic.solver.sweep import solve_sweep

_AT_ONCE = 16_384  # stations: their intermediate results stay in the processor's cache


@dataclass(frozen=True)
class Unsolved:
    """What `solve_sweeps` has for a case that it could not solve.

    Attributes
    ----------
    case : object
        As it was given.
    error : Exception
        Why; `solve_sweep` of the case raises the same.
    """

    case: object
    error: Exception

    @property
    def reason(self) -> str:
        """Why, in a line."""
        return " ".join(str(self.error).split()) or type(self.error).__name__


def solve_sweeps(cases: Iterable[Case]) -> Iterator[Readings | Unsolved]:
    """The readings of many cases in closed form, as `solve_sweep` has them one by one.

    Contours and vibrissae of any kind may be mixed. Those of the paper's vibrissa are solved some
    hundred at a time, with every formula over the stations of all: several times faster than one by
    one. Cases are taken from the iterable as they are needed, and forgotten when their readings are
    handed out: a generator of a million cases takes the memory of a few hundred.

    Parameters
    ----------
    cases : iterable of Case
        The problems.

    Returns
    -------
    iterator of Readings or Unsolved
        One a case, in their order. A case that fails is an `Unsolved` that says why; the others are
        solved all the same.

    Raises
    ------
    InputError
        If `cases` is no iterable.

    Examples
    --------
    >>> from analytic import Case, Sweep, circle, solve_sweeps
    >>> cases = (Case(profile=circle(r, (0, 0.4)), sweep=Sweep(50)) for r in (0.5, 1.0, 2.0))
    >>> [f"{found.snap_off:.4f}" for found in solve_sweeps(cases)]
    ['-1.0268', '-1.2705', '-1.6674']
    """
    require("cases", cases, Iterable, "as [named_case('catenary'), named_case('parabola')]")
    return _solved(cases)


def _solved(cases: Iterable[Case]) -> Iterator[Readings | Unsolved]:
    batch: list[Case] = []
    stations = 0
    for case in cases:
        batch.append(case)
        stations += case.sweep.stations if isinstance(case, Case) else 0
        if stations >= _AT_ONCE:
            yield from _batch(batch)
            batch, stations = [], 0
    yield from _batch(batch)


def _batch(cases: list[Case]) -> Iterator[Readings | Unsolved]:
    plain = [i for i, case in enumerate(cases) if isinstance(case, Case) and case.is_plain]
    found: dict[int, Readings | Unsolved] = {}
    try:
        solved = solve_plain([cases[i] for i in plain]) if plain else []
        found |= zip(plain, solved, strict=True)
    except Exception:  # a contour's functions may raise anything; one by one, to see whose do
        found |= {i: _alone(cases[i]) for i in plain}
        if not any(isinstance(one, Unsolved) for one in found.values()):
            raise  # no case's: the batch's own
    for i, case in enumerate(cases):
        yield found[i] if i in found else _alone(case)


def _alone(case: Case) -> Readings | Unsolved:
    try:
        return solve_sweep(case)
    except Exception as error:
        return Unsolved(case, error)
