"""How far two sweeps of one vibrissa disagree, where, and in which phase.

Everything here but the command line works on `Readings` alone, whoever produced them.

The names are listed in ``__init__.pyi`` and loaded when first used: every run of pytest imports
this package, for the plugin in it.
"""

from analytic.problem.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
