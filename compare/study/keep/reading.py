"""A study's folder as its reports read it; nothing in it is changed."""

from collections.abc import Callable
from pathlib import Path

import pandas as pd

from analytic import InputError
from compare.study.grid.plan import Plan
from compare.study.keep.journal import list_journals, read_journal
from compare.study.keep.locks import lock
from compare.study.keep.merge import merge
from compare.study.keep.parts import Columns, list_parts, sound_parts
from compare.study.keep.store import PLAN_FILE
from compare.study.work.perform import RECORDED


def read_rows(folder: Path, warn: Callable[[str], None]) -> pd.DataFrame:
    """Read all that is stored of a study, also while it is under way.

    Parameters
    ----------
    folder : Path
        Of the study.
    warn : callable
        Takes a line about anything that is wrong with what is stored.

    Returns
    -------
    pandas.DataFrame
        A row a run.

    Raises
    ------
    InputError
        If there is no study in `folder`.
    """
    runs = folder / "runs"
    if not runs.is_dir():
        raise InputError("DIR", folder, "the folder of a study", "`vibrissa study` makes one")
    known = Columns(RECORDED)

    def damaged(path: Path, reason: str) -> None:
        warn(f"{path} is damaged ({reason}): `vibrissa study` does its runs again")

    with lock(runs):
        tables = [table for _, table in sound_parts(list_parts(runs), known, damaged)]
        for path in list_journals(runs):
            table, lost = read_journal(path, RECORDED)
            tables.append(table)
            if lost:
                damaged(path, f"{lost} of {table.num_rows + lost} lines")
    if not tables:
        return pd.DataFrame({"run": [], "outcome": []})
    frame: pd.DataFrame = merge(tables).to_pandas(use_threads=False)
    return frame.sort_values("run", ignore_index=True)


def read_plan(folder: Path) -> Plan:
    """Read what a study is to do."""
    path = folder / PLAN_FILE
    remedy = "start `vibrissa study FILE --out DIR` again: complete runs are kept"
    try:
        return Plan.from_json(path.read_bytes())
    except OSError as error:
        raise InputError("DIR", folder, f"a folder with a readable {PLAN_FILE}", remedy) from error
    except InputError:
        raise
    except ValueError as error:
        raise InputError(str(path), "damaged", "as the study wrote it", remedy) from error
