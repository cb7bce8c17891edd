"""One table out of many parts, a row a run."""

from collections.abc import Iterable, Iterator
from pathlib import Path

import pyarrow as pa

from compare.study.keep.parts import Damaged, list_parts, sound_parts, write_part


class Choice:
    """Which row stands for a run that has several: the latest done, else the latest of all.

    A run has several if it failed first, if two processes did it, or if a process was killed
    between two steps of tidying up.
    """

    def __init__(self) -> None:
        self._best: dict[str, tuple[bool, int, int]] = {}

    def see(self, part: int, table: pa.Table) -> None:
        """Take the rows of part number `part` into account; parts come in order of time."""
        for row, (run, outcome) in enumerate(_keys(table)):
            rank = (outcome == "done", part, row)
            self._best[run] = max(rank, self._best.get(run, rank))

    def kept(self, part: int, table: pa.Table) -> pa.Table:
        """The rows of part number `part` that stand for their runs."""
        best = self._best
        mask = [best[run][1:] == (part, row) for row, (run, _) in enumerate(_keys(table))]
        return table.filter(pa.array(mask, pa.bool_()))


def merge(tables: Iterable[pa.Table]) -> pa.Table:
    """The rows of all `tables`, in order of time, each run once, with the columns of all."""
    tables = list(tables)
    choice = Choice()
    for part, table in enumerate(tables):
        choice.see(part, table)
    return pa.concat_tables(
        [choice.kept(part, table) for part, table in enumerate(tables)],
        promote_options="permissive",
    )


def compact(folder: Path, damaged: Damaged) -> None:
    """Make one part of all sound ones, so that any reader of the folder sees each run once.

    One part at a time is in memory. The old ones go when the new one is complete; between the two,
    `Choice` sees to it that nothing counts double.
    """
    if len(list_parts(folder)) < 2:
        return
    choice, schemas, old = Choice(), [], []
    for part, (path, table) in enumerate(sound_parts(folder, damaged)):
        choice.see(part, table)
        schemas.append(table.schema)
        old.append(path)
    schema = pa.unify_schemas(schemas, promote_options="permissive")

    def tables() -> Iterator[pa.Table]:
        for part, (_, table) in enumerate(sound_parts(folder, damaged)):
            yield pa.concat_tables(
                [schema.empty_table(), choice.kept(part, table)], promote_options="permissive"
            )

    write_part(folder, schema, tables())
    for path in old:
        path.unlink()


def _keys(table: pa.Table) -> Iterator[tuple[str, str]]:
    runs, outcomes = table.column("run").to_pylist(), table.column("outcome").to_pylist()
    return zip(runs, outcomes, strict=True)
