"""What the command line prints: tables and lines on standard output, progress beside it.

Lengths are printed in units of the vibrissa's length L, whatever the units of the case.
"""

from compare.commands.terminal.blocks import show
from compare.commands.terminal.console import print_line, print_written, progress
from compare.commands.terminal.results import (
    print_advice,
    print_at_rest,
    print_budget,
    print_comparison,
    print_engines,
    print_fastest,
    print_float32,
    print_motion_budget,
    print_side_by_side,
    print_spatial_comparison,
)
from compare.commands.terminal.sweeps import (
    note_rows,
    print_methods,
    print_passes,
    print_reconstruction,
    print_sweep,
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
    "print_spatial_comparison",
    "print_sweep",
    "print_written",
    "progress",
    "show",
]
