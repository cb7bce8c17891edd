"""How far two sweeps of one vibrissa disagree, where, and in which phase.

Everything here but the command line works on `Readings` alone, whoever produced them.
"""

from compare.comparison import Comparison, compare
from compare.gates import assert_agreement
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
    "separate_lag",
]
