"""The command ``rig``: a rig's files become sweeps, and what is wrong with them is said."""

from itertools import combinations
from pathlib import Path
from typing import Annotated

import typer

from compare.commands.options import AGREES, option, out_folder
from compare.commands.output import distinct_name, output_folder


def rig(
    files: Annotated[
        list[Path],
        typer.Argument(metavar="FILE...", help="A rig's files, or folders with its files."),
    ],
    rig: Annotated[
        Path, option("TOML file with [beam], [columns] and [passes] of the rig.", "FILE")
    ],
    out: Annotated[Path | None, out_folder("results/FILE-passes")] = None,
) -> int:
    """Make readings of a rig's files, without their defects.

    They are calibrated, zero and drift are taken off, and what is left out is counted. Each pass
    becomes a file for `compare` and `reconstruct`.
    """
    from compare.commands import terminal
    from compare.commands.sweep_lines import print_passes
    from compare.measure.repeats import repeat
    from compare.read.passes import read_passes, without_gaps
    from compare.read.rig_file import read_rig
    from compare.show.figures.readings import passes_picture
    from compare.show.passes import passes_document

    passes = read_passes(files, read_rig(rig))
    repeats = {}
    for one, other in combinations(passes, 2):
        if (
            one.direction == other.direction
            and one.readings.bends_left == other.readings.bends_left
        ):
            repeats[one.name, other.name] = repeat(without_gaps(one), without_gaps(other))
    with output_folder(out or Path("results") / f"{distinct_name(files[0])}-passes") as folder:
        print_passes(passes, repeats)
        for one in passes:
            terminal.print_written(one.readings.write(folder / f"{one.name}.parquet"))
        terminal.keep(folder / "passes.json", passes_document(passes, repeats))
        terminal.keep(folder / "passes.png", passes_picture(passes))
    return AGREES
