"""The same problem in MuJoCo, swept quasi-statically and at rest at every station.

The names are listed in ``__init__.pyi`` and loaded when first used, MuJoCo itself when a sweep
starts.
"""

from analytic.problem.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
