"""The paper's own routes to one contact, and integration: what `analytic.solver` is checked by."""

from analytic.problem.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
