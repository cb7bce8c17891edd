"""Engines that sweep the same case: MuJoCo, and others that say what of a disagreement is its own.

The names are listed in ``__init__.pyi`` and loaded when first used, an engine's own library when it
sweeps.
"""

from analytic.problem.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
