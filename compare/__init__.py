"""How far two sweeps of one vibrissa disagree, where, and in which phase.

Everything here but the command line works on `Readings` alone, whoever produced them.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from compare.comparison import Comparison, compare
    from compare.gates import assert_agreement
    from compare.measured import read_measured
    from compare.offset import Offset, separate_lag
    from compare.phases import Classification, classify
    from compare.tolerances import Limit, Tolerances

__all__ = [
    "Classification",
    "Comparison",
    "Limit",
    "Offset",
    "Tolerances",
    "assert_agreement",
    "classify",
    "compare",
    "read_measured",
    "separate_lag",
]

# Imported when first used: every run of pytest imports this package, for the plugin in it.
_HOMES = {
    "Classification": "phases",
    "Comparison": "comparison",
    "Limit": "tolerances",
    "Offset": "offset",
    "Tolerances": "tolerances",
    "assert_agreement": "gates",
    "classify": "phases",
    "compare": "comparison",
    "read_measured": "measured",
    "separate_lag": "offset",
}


def __getattr__(name: str) -> Any:  # noqa: ANN401
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"compare.{_HOMES[name]}"), name)
