"""The same problem in MuJoCo, swept quasi-statically and at rest at every station.

The names are listed in ``__init__.pyi`` and loaded when first used, MuJoCo itself when a sweep
starts.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
