"""Parameter studies: one case, many runs, on every core or on a cluster, resumable.

``studyfile -> plan -> execute(run) -> store -> report``: a study file says what is varied, the plan
lists the runs lazily, an executor of any kind does them, each becomes one row of a Parquet
dataset, and the report reads nothing but that.
"""

from compare.study.grid.file import load_study
from compare.study.grid.plan import Plan
from compare.study.grid.study import Study
from compare.study.keep.reading import read_rows

__all__ = ["Plan", "Study", "load_study", "read_rows"]
