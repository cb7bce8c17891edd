"""What may stand in the table of one sweep."""

import difflib
import re
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.columns import CONTACT, ODD, SENSED, WORDS
from analytic.problem.errors import InputError, Place, row_number, unknown

_TEXT_FIX = "fix the cell, or leave it empty where nothing was measured"
_THOUSANDS = re.compile(r"[+-]?\d{1,3}([.,' \u202f]\d{3})+([.,]\d*)?")


def as_numbers(
    column: "pd.Series[Any]", name: str, place: Place = row_number, remedy: str = _TEXT_FIX
) -> Floats:
    """A column of readings as numbers, NaN where a cell is empty."""
    types = pd.api.types
    kind = column.dtype
    if types.is_bool_dtype(kind) or isinstance(kind, pd.CategoricalDtype):
        raise _wrong_type(name, kind)
    if types.is_float_dtype(kind) or types.is_integer_dtype(kind):
        numbers = column.to_numpy(dtype=float, na_value=np.nan)
    elif types.is_object_dtype(kind) or types.is_string_dtype(kind):
        numbers = _parsed(column, name, place, remedy)
    else:
        raise _wrong_type(name, kind)
    infinite = np.isinf(numbers)
    if infinite.any():
        row = int(np.argmax(infinite))
        raise InputError(f"column {name}, {place(row)},", numbers[row], "finite", remedy)
    return np.asarray(numbers, dtype=float)


def checked_table(table: pd.DataFrame, source: str, place: Place = row_number) -> pd.DataFrame:
    """A table whose columns are those of readings: numbers as floats, rows counted from 0."""
    check_columns(table, SENSED, source)
    changed: dict[str, Floats] = {}
    for name in (*SENSED, *CONTACT):
        if name in table:
            column = table[name]
            numbers = as_numbers(column, name, place)
            if column.dtype != float:
                changed[name] = numbers
    for name, allowed in WORDS.items():
        if name in table:
            check_words(table[name], name, allowed, place)
    if not isinstance(table.index, pd.RangeIndex):
        table = table.reset_index(drop=True)
    return table.assign(**changed) if changed else table


def check_columns(table: pd.DataFrame, sensed: tuple[str, ...], source: str) -> None:
    """Refuse a table without what a clamp senses, or with two columns of one name."""
    missing = [name for name in sensed if name not in table]
    if missing:
        names = [*map(str, table.columns)]
        there, allowed = ", ".join(names)[:120] or "none", f"at least {', '.join(sensed)}"
        others = [name for name in names if name not in sensed]
        alike = {name: difflib.get_close_matches(name, others, n=1) for name in missing}
        named = [f"{name} (is it {found[0]}?)" if found else name for name, found in alike.items()]
        raise InputError(
            f"columns of the readings ({source})", there, allowed, f"add {', '.join(named)}"
        )
    twice = table.columns[table.columns.duplicated()]
    if len(twice):
        raise InputError(f"column {twice[0]}", "there more than once", "one column", "drop one")


def as_table(columns: Mapping[str, Floats | Integers]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            name: _words(name).take(values.astype(np.intp)) if name in WORDS else values
            for name, values in columns.items()
        }
    )


def says(column: "pd.Series[Any]", word: str) -> Booleans:
    if not isinstance(column.array, pd.arrays.ArrowStringArray):
        return (column == word).to_numpy(dtype=bool)
    cells = pa.array(column.array)
    same = pc.equal(cells, pa.scalar(word, cells.type)).fill_null(False)
    return np.asarray(same.to_numpy(zero_copy_only=False))


@cache
def _words(name: str) -> "pd.api.extensions.ExtensionArray":
    """The words that may stand in a column, as pandas holds texts."""
    return pd.Series(WORDS[name]).array


def mirrored_table(table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(**_turned_over(table))


def mirrored_columns(columns: Mapping[str, Floats | Integers]) -> dict[str, Floats | Integers]:
    """What `as_table` takes, in a mirror, x to -x."""
    return {**columns, **_turned_over(columns)}


def _turned_over(columns: Any) -> dict[str, Any]:  # noqa: ANN401  # a table or a mapping of arrays
    changed = {name: 0.0 - columns[name] for name in ODD if name in columns}  # 0 never is -0
    if "tip_angle" in columns:
        changed["tip_angle"] = np.pi - columns["tip_angle"]
    return changed


def _parsed(column: "pd.Series[Any]", name: str, place: Place, remedy: str) -> Floats:
    numbers = np.array([_number(cell) for cell in column], dtype=float)
    wrong = np.isnan(numbers) & column.notna().to_numpy()
    if wrong.any():
        row = int(np.argmax(wrong))
        cell = column.iloc[row]
        if isinstance(cell, str) and _THOUSANDS.fullmatch(cell.strip()):
            remedy = "export numbers without a separator of thousands"
        raise InputError(f"column {name}, {place(row)},", f"{cell!r}"[:40], "a number", remedy)
    return numbers


def _number(cell: object) -> float:
    """The number in a cell of text, NaN where there is none."""
    if isinstance(cell, str | int | float | np.number) and not isinstance(cell, bool):
        try:
            return np.nan if "_" in str(cell) else float(cell)
        except (ValueError, OverflowError):
            pass
    return np.nan


def check_words(
    column: "pd.Series[Any]", name: str, allowed: tuple[str, ...], place: Place
) -> None:
    if isinstance(column.dtype, pd.StringDtype) and set(column.unique()) <= set(allowed):
        return
    odd = ~column.astype(str).isin(allowed).to_numpy()
    if odd.any():
        row = int(np.argmax(odd))
        where, word = f"column {name}, {place(row)},", str(column.iloc[row])
        raise unknown(where, word, allowed, remedy="fix the column or drop it")


def _wrong_type(name: str, kind: object) -> InputError:
    remedy = "booleans, categories, times are no readings"
    return InputError(f"column {name}", f"of type {kind}", "numbers", remedy)
