"""How far two sweeps of one vibrissa disagree, where, and in which phase.

Everything here but the command line works on `Readings` alone, whoever produced them.
"""

from compare.comparison import Comparison, assert_agreement, compare
from compare.phases import Classification, classify
from compare.tolerances import Tolerances

__all__ = ["Classification", "Comparison", "Tolerances", "assert_agreement", "classify", "compare"]
