"""The part files of a study's Parquet dataset: each appears whole or not at all."""

import hashlib
import os
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TypeAlias

import pyarrow as pa
import pyarrow.parquet as pq

from analytic.problem.files import whole_file

Damaged: TypeAlias = Callable[[Path, str], None]
"""What to do about a part that cannot be read, and why it cannot."""
_DIGITS = 32  # of a digest in a part's name; names of eight are older and have none


def list_parts(folder: Path) -> list[Path]:
    """Find the part files in a folder."""
    return sorted(folder.glob("part-*.parquet"))


def new_name() -> str:
    """Make a name that sorts by time and that no other process has."""
    return f"{time.time_ns():020d}-{uuid.uuid4().hex[:8]}"


def write_part(folder: Path, schema: pa.Schema, tables: Iterable[pa.Table]) -> None:
    """Write tables as one new part, which is on the disk itself before it gets its name."""
    name = new_name()
    whole = folder / f".part-{name}.parquet"
    with whole_file(whole) as unfinished, unfinished.open("wb") as file:
        with pq.ParquetWriter(file, schema, compression="zstd") as writer:
            for table in tables:
                writer.write_table(table.cast(schema))
        file.flush()
        os.fsync(file.fileno())
    # The name holds a digest: not one flipped bit is read as a result.
    whole.rename(folder / f"part-{name}-{_digest(whole.read_bytes())}.parquet")


def read_part(path: Path) -> pa.Table:
    """Read the rows of a part."""
    content = path.read_bytes()
    *_, digest = path.stem.split("-")
    if len(digest) == _DIGITS and digest != _digest(content):
        raise ValueError("its content is not what its name says")
    part = pq.ParquetFile(pa.BufferReader(content), page_checksum_verification=True)
    # Not in Arrow's threads: one that still ends while Python does aborts the whole process.
    return part.read(use_threads=False)


class Columns:
    """The columns that parts have, which must fit together."""

    def __init__(self, known: Mapping[str, str]) -> None:
        self._known = {name: pa.type_for_alias(kind) for name, kind in known.items()}
        self._all = pa.schema(list(self._known.items()))

    def take(self, table: pa.Table) -> None:
        """Take the columns of a table into account."""
        for name in ("run", "outcome"):
            if name not in table.schema.names or table.column(name).null_count:
                raise pa.ArrowInvalid(f"a column {name} with a text in every row is missing")
        together = pa.unify_schemas([self._all, table.schema], promote_options="permissive")
        for name, kind in self._known.items():
            found = together.field(name).type
            # pandas writes its texts as large ones.
            if found != kind and not (pa.types.is_string(kind) and pa.types.is_large_string(found)):
                raise pa.ArrowTypeError(f"its column {name} is no {kind}")
        self._all = together


def sound_parts(
    paths: Iterable[Path], columns: Columns, damaged: Damaged
) -> Iterator[tuple[Path, pa.Table]]:
    """Read parts."""
    for path in paths:
        try:
            table = read_part(path)
            columns.take(table)
        except (pa.ArrowException, OSError, ValueError, KeyError) as error:
            damaged(path, " ".join(str(error).split())[:100])
        else:
            yield path, table


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:_DIGITS]
