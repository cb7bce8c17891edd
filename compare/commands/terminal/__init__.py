"""What the command line prints: tables and lines on standard output, progress beside it.

Lengths are printed in units of the vibrissa's length L, whatever the units of the case.
"""

from compare.commands.terminal.blocks import show as show
from compare.commands.terminal.console import print_line as print_line
from compare.commands.terminal.console import print_written as print_written
from compare.commands.terminal.console import progress as progress
from compare.commands.terminal.results import print_advice as print_advice
from compare.commands.terminal.results import print_at_rest as print_at_rest
from compare.commands.terminal.results import print_budget as print_budget
from compare.commands.terminal.results import print_comparison as print_comparison
from compare.commands.terminal.results import print_engines as print_engines
from compare.commands.terminal.results import print_fastest as print_fastest
from compare.commands.terminal.results import print_float32 as print_float32
from compare.commands.terminal.results import print_side_by_side as print_side_by_side
from compare.commands.terminal.results import print_spatial_comparison as print_spatial_comparison
from compare.commands.terminal.sweeps import note_rows as note_rows
from compare.commands.terminal.sweeps import print_methods as print_methods
from compare.commands.terminal.sweeps import print_passes as print_passes
from compare.commands.terminal.sweeps import print_reconstruction as print_reconstruction
from compare.commands.terminal.sweeps import print_sweep as print_sweep
