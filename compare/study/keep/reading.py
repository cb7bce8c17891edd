"""A study's folder as its reports read it; nothing in it is changed."""

from pathlib import Path

import pandas as pd

from analytic import InputError
from compare.study.grid.plan import Plan
from compare.study.keep.database import NAME, Warn, read
from compare.study.keep.store import PLAN_FILE, joined, numbers, tables


def read_rows(folder: Path, warn: Warn) -> pd.DataFrame:
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
    if not (folder / NAME).is_file():
        raise InputError("DIR", folder, "the folder of a study", "`vibrissa study` makes one")
    plan = read_plan(folder)
    found = joined(tables(read(folder, warn), plan, numbers(plan)))
    # Not in Arrow's threads: one that still ends while Python does aborts the whole process.
    frame: pd.DataFrame = found.to_pandas(use_threads=False)
    return frame.sort_values("run", ignore_index=True)


def read_plan(folder: Path) -> Plan:
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
