"""Parameter studies: one case, many runs, on every core or on a cluster, resumable.

``studyfile -> plan -> execute(run) -> store -> report``: a study file says what is varied, the plan
lists the runs lazily, an executor of any kind does them, each becomes one row of a Parquet
dataset, and the report reads nothing but that.

The names are listed in ``__init__.pyi`` and loaded when first used: a study file is checked before
what does the runs is loaded.
"""

from analytic.problem.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
