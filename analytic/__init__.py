"""The vibrissa and its contact with a convex contour, in closed form.

`analytic.problem` states the problem (beam, profile, case, readings); `analytic.solver` solves it.

The names are listed in ``__init__.pyi`` and loaded when first used: who states a problem need not
wait for what solves it.
"""

from analytic.problem.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
