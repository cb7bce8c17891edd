"""The part files of a study's Parquet dataset: each appears whole or not at all."""

import os
import time
import uuid
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TypeAlias

import pyarrow as pa
import pyarrow.parquet as pq

from analytic.problem.files import whole_file

Damaged: TypeAlias = Callable[[Path, str], None]
"""What to do about a part that cannot be read, and why it cannot."""


def list_parts(folder: Path) -> list[Path]:
    """The part files in `folder`, in the order in which they were begun."""
    return sorted(folder.glob("part-*.parquet"))


def new_name() -> str:
    """A name that sorts by time and that no other process has."""
    return f"{time.time_ns():020d}-{uuid.uuid4().hex[:8]}"


def write_part(folder: Path, schema: pa.Schema, tables: Iterable[pa.Table]) -> None:
    """Write `tables` as one new part, which is on the disk itself before it gets its name."""
    part = folder / f"part-{new_name()}.parquet"
    with whole_file(part) as unfinished, unfinished.open("wb") as file:
        # Checksums: a flipped bit must not be read as a result.
        with pq.ParquetWriter(file, schema, compression="zstd", write_page_checksum=True) as writer:
            for table in tables:
                writer.write_table(table.cast(schema))
        file.flush()
        os.fsync(file.fileno())


def read_part(path: Path) -> pa.Table:
    """The rows of a part.

    Raises
    ------
    pyarrow.ArrowException, OSError
        If it is damaged.
    """
    return pq.ParquetFile(path, page_checksum_verification=True).read()


def sound_parts(folder: Path, damaged: Damaged) -> Iterator[tuple[Path, pa.Table]]:
    """Every part that can be read; of the others `damaged` is told."""
    for path in list_parts(folder):
        try:
            table = read_part(path)
        except (pa.ArrowException, OSError) as error:
            damaged(path, " ".join(str(error).split())[:100])
        else:
            yield path, table
