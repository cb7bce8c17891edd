"""The paper's own routes to the tip's angle, and the boundary value problem solved directly.

Slower and less exact than `analytic.solver`, with which they share nothing but the problem: they
are what it is tested and timed against. Dimensionless, one contact at a time.

The names are listed in ``__init__.pyi`` and loaded when first used: what else is in this folder
needs none of SciPy's integrators to load.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
