"""One table out of many parts, a row a run."""

from collections.abc import Callable, Container, Iterable, Iterator

import numpy as np
import pyarrow as pa


class Choice:
    """Which row stands for a run that has several: the latest done, else the latest of all.

    A run has several if it failed first, if two processes did it, or if a process was killed
    between two steps of tidying up.
    """

    def __init__(self) -> None:
        self._best: dict[str, tuple[bool, int, int]] = {}

    def see(self, part: int, table: pa.Table) -> None:
        """Take a part into account; parts come in order of time."""
        for row, (run, outcome) in enumerate(_keys(table)):
            rank = (outcome == "done", part, row)
            self._best[run] = max(rank, self._best.get(run, rank))

    def count(self, wanted: Container[str]) -> int:
        """Count the runs that were seen."""
        return sum(run in wanted for run in self._best)

    def kept(
        self, part: int, table: pa.Table, wanted: Callable[[str], bool] = lambda run: True
    ) -> pa.Table:
        """Keep the rows of a part that stand for their runs."""
        best = self._best
        mask = np.array(
            [best[run][1:] == (part, row) and wanted(run)
             for row, (run, _) in enumerate(_keys(table))],
            dtype=bool,
        )  # fmt: skip
        return table.filter(pa.array(mask))


def merge(tables: Iterable[pa.Table]) -> pa.Table:
    """Merge tables into one."""
    tables = list(tables)
    choice = Choice()
    for part, table in enumerate(tables):
        choice.see(part, table)
    return pa.concat_tables(
        [choice.kept(part, table) for part, table in enumerate(tables)],
        promote_options="permissive",
    )


def _keys(table: pa.Table) -> Iterator[tuple[str, str]]:
    runs, outcomes = table.column("run").to_pylist(), table.column("outcome").to_pylist()
    return zip(runs, outcomes, strict=True)
