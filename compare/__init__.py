"""How far two sweeps of one vibrissa disagree, where, and in which phase.

Everything here but the command line works on `Readings` alone, whoever produced them.

The names are listed in ``__init__.pyi`` and loaded when first used: every run of pytest imports
this package, for the plugin in it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
