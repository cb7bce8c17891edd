"""The sweep in space, past any convex body: the problem, its closed form, and the way back.

The names are listed in ``__init__.pyi`` and loaded when first used.
"""

from analytic.problem.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
