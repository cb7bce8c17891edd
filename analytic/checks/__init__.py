"""The paper's own routes to the tip's angle, slower than `analytic.solver`, which they check."""

from analytic.problem.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
