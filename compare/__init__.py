"""How far two sweeps of one vibrissa disagree, where, and in which phase.

Everything here but the command line works on `Readings` alone, whoever produced them.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from compare.align.offset import Offset, separate_lag
    from compare.comparison import Comparison, compare
    from compare.judge.tolerances import Limit, Tolerances
    from compare.read.rig import read_measured
    from compare.sense.phases import Classification, classify
    from compare.testing.gates import assert_agreement

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
    "Classification": "sense.phases",
    "Comparison": "comparison",
    "Limit": "judge.tolerances",
    "Offset": "align.offset",
    "Tolerances": "judge.tolerances",
    "assert_agreement": "testing.gates",
    "classify": "sense.phases",
    "compare": "comparison",
    "read_measured": "read.rig",
    "separate_lag": "align.offset",
}


def __getattr__(name: str) -> Any:  # noqa: ANN401
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"compare.{_HOMES[name]}"), name)
