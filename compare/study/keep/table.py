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
    """The plan's rows, some thousand at a time; the first table is empty."""
    schema = pa.schema(
        [(name, pa.type_for_alias(kind)) for name, kind in columns(plan.study).items()]
    )
    yield schema.empty_table()
    number_of = {run.id: number for number, run in enumerate(plan)}
    wanted = (row for row in rows if row["run"] in number_of)
    while some := list(islice(wanted, _AT_ONCE)):
        # A row that was done for another plan may lack some of this one's axes.
        whole = [{**plan.parameters(number_of[row["run"]]), **row} for row in some]
        yield pa.Table.from_pylist(whole, schema)


def write_table(path: Path, rows: Iterable[Row], plan: Plan) -> None:
    """Write the plan's rows as a Parquet file, whole or not at all."""
    found = tables(rows, plan)
    with (
        whole_file(path) as unfinished,
        pq.ParquetWriter(unfinished, next(found).schema, compression="zstd") as writer,
    ):
        for table in found:
            writer.write_table(table)
