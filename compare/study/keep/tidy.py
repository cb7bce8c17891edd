"""What is stored, put in order: one part with this plan's rows, and other plans' rows elsewhere."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa

from compare.study.grid.plan import Plan
from compare.study.keep.merge import Choice
from compare.study.keep.parts import (
    Columns,
    Damaged,
    list_parts,
    read_part,
    sound_parts,
    write_part,
)


@dataclass(frozen=True)
class Shelves:
    """Where rows are kept."""

    runs: Path  # for the rows of the plan
    # For those of other plans, which are taken up again if the plan becomes theirs again.
    earlier: Path

    def parts(self) -> list[Path]:
        """Find all parts."""
        parts = [*list_parts(self.runs), *list_parts(self.earlier)]
        return sorted(parts, key=lambda path: path.name)


def tidy(
    shelves: Shelves,
    plan: Plan,
    wanted: Mapping[str, int],
    columns: Mapping[str, str],
    damaged: Damaged,
) -> int:
    """Make one part of all rows of a plan, with exactly its columns.

    Any reader of the folder then sees each run of the plan once, and nothing else. One part at a
    time is in memory. The old ones go when the new ones are complete; between the two, `Choice`
    makes sure that nothing counts twice.
    """
    schema = pa.schema([(name, pa.type_for_alias(kind)) for name, kind in columns.items()])
    choice = Choice()
    holding: dict[int, Path] = {}  # parts with rows of the plan, and all in its folder
    in_order, asked = True, 0
    for number, (path, table) in enumerate(sound_parts(shelves.parts(), Columns(columns), damaged)):
        choice.see(number, table)
        here = sum(run in wanted for run in table.column("run").to_pylist())
        asked += here
        if path.parent == shelves.runs:
            in_order &= here == table.num_rows and table.schema == schema
        else:
            in_order &= here == 0
        if here or path.parent == shelves.runs:
            holding[number] = path
    found = choice.count(wanted)
    if in_order and len(holding) < 2 and asked == found:
        return 0

    def rows_of_plan() -> Iterator[pa.Table]:
        for number, path in holding.items():
            kept = choice.kept(number, read_part(path), wanted.__contains__)
            yield _as_planned(kept, plan, wanted, schema)

    if found:
        write_part(shelves.runs, schema, rows_of_plan())
    moved = 0
    for number, path in holding.items():
        rest = choice.kept(number, read_part(path), lambda run: run not in wanted)
        if rest.num_rows:
            shelves.earlier.mkdir(exist_ok=True)
            write_part(shelves.earlier, rest.schema, [rest])
        moved += rest.num_rows if path.parent == shelves.runs else 0
    for path in holding.values():
        path.unlink()
    return moved


def _as_planned(
    table: pa.Table, plan: Plan, wanted: Mapping[str, int], schema: pa.Schema
) -> pa.Table:
    """The rows with the plan's columns; a row done for another plan may lack some of its axes."""
    axes = {key for axis in plan.study.crossed for key in axis.keys}
    runs = table.column("run").to_pylist()
    columns = []
    for name, kind in zip(schema.names, schema.types, strict=True):
        if name in axes and (name not in table.schema.names or table.column(name).null_count):
            values = [plan.parameters(wanted[run])[name] for run in runs]
            columns.append(pa.array(values, kind))
        elif name in table.schema.names:
            columns.append(table.column(name).cast(kind))
        else:
            columns.append(pa.nulls(len(runs), kind))
    return pa.Table.from_arrays(columns, schema=schema)
