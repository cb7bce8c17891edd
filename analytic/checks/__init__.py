"""The paper's own routes to the tip's angle, slower than `analytic.solver`, which they check."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
