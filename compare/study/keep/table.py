"""The table of a study's runs: the rows of its plan, in the plan's columns."""

from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from analytic.problem.files import whole_file
from compare.study.grid.plan import Plan
from compare.study.keep.database import Row
from compare.study.work.perform import columns

_AT_ONCE = 5000  # rows in memory


def tables(rows: Iterable[Row], plan: Plan) -> Iterator[pa.Table]:
    """The plan's rows, some thousand at a time; at least one table, maybe empty."""
    schema = pa.schema(
        [(name, pa.type_for_alias(kind)) for name, kind in columns(plan.study).items()]
    )
    number_of = {run.id: number for number, run in enumerate(plan)}
    axes = [key for axis in plan.study.crossed for key in axis.keys]
    wanted = (row for row in rows if row["run"] in number_of)
    some = list(islice(wanted, _AT_ONCE))
    while True:
        # A row that was done for another plan may lack some of this one's axes.
        complete = [
            row
            if all(axis in row for axis in axes)
            else {**row, **plan.parameters(number_of[row["run"]])}
            for row in some
        ]
        arrays = [pa.array([row.get(name) for row in complete], kind)
                  for name, kind in zip(schema.names, schema.types, strict=True)]  # fmt: skip
        yield pa.Table.from_arrays(arrays, schema=schema)
        some = list(islice(wanted, _AT_ONCE))
        if not some:
            return


def write_table(path: Path, rows: Iterable[Row], plan: Plan) -> None:
    """Write the plan's rows as a Parquet file, whole or not at all."""
    found = tables(rows, plan)
    first = next(found)
    with (
        whole_file(path) as unfinished,
        pq.ParquetWriter(unfinished, first.schema, compression="zstd") as writer,
    ):
        writer.write_table(first)
        for table in found:
            writer.write_table(table)
