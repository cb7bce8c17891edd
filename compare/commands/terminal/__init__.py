"""What the command line prints: tables and lines on standard output, progress beside it.

Lengths are printed in units of the vibrissa's length L, whatever the units of the case.
"""

import compare.commands.terminal.artists  # noqa: F401  # before what draws is loaded
from compare.commands.terminal.console import print_line, print_written, progress
from compare.commands.terminal.sweeps import (
    note_rows,
    print_methods,
    print_passes,
    print_reconstruction,
    print_sweep,
)
from compare.commands.terminal.verdicts import (
    print_advice,
    print_at_rest,
    print_budget,
    print_comparison,
    print_engines,
    print_fastest,
    print_float32,
    print_motion_budget,
    print_side_by_side,
)

__all__ = [
    "note_rows",
    "print_advice",
    "print_at_rest",
    "print_budget",
    "print_comparison",
    "print_engines",
    "print_fastest",
    "print_float32",
    "print_line",
    "print_methods",
    "print_motion_budget",
    "print_passes",
    "print_reconstruction",
    "print_side_by_side",
    "print_sweep",
    "print_written",
    "progress",
]
