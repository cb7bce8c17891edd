"""What is printed of a report that was written, and how its command ends."""

from typing import TYPE_CHECKING

from compare.commands.options import AGREES, DISAGREES

if TYPE_CHECKING:
    from compare.report import Report


def print_report(found: "Report") -> int:
    """Print the verdict of a run, and where the page is."""
    from compare.commands import terminal
    from compare.comparison import Comparison

    if isinstance(found.comparison, Comparison):
        terminal.print_comparison(found.comparison)
    elif found.comparison is not None:
        terminal.print_spatial_comparison(found.comparison, found.parts)
    terminal.print_written(found.path)
    return AGREES if found.comparison is None or found.comparison.agrees else DISAGREES
