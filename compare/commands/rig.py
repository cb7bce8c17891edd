"""The command ``rig``: a rig's files become sweeps, and what is wrong with them is said."""

import gc
from pathlib import Path
from typing import Annotated

import typer

from compare.commands.options import option, out_folder
from compare.commands.output import distinct_name, output_folder, waiting


def rig(
    files: Annotated[
        list[Path],
        typer.Argument(metavar="FILE...", help="A rig's files, or folders with its files."),
    ],
    rig: Annotated[
        Path, option("TOML file with [beam], [columns] and [passes] of the rig.", "FILE")
    ],
    out: Annotated[Path | None, out_folder("results/FILE-passes")] = None,
) -> bool:
    """Make readings of a rig's files, without their defects.

    They are calibrated, zero and drift are taken off, and what is left out is counted; a picture of
    each pass is written first. What cannot be, as a contact called free, is refused. Each pass
    becomes a file; `calibrate`, `compare` and `reconstruct` take their folder.
    """
    from analytic.from_clamp.object.lag import lag_between
    from compare.commands import terminal
    from compare.measure.repeats import repeats
    from compare.read.passes import look_at_passes, swept_alike, usable
    from compare.read.rig_file import read_rig
    from compare.show.figures.readings import pass_picture, passes_picture
    from compare.show.passes import lag_summary, passes_document, passes_summary, with_lag

    described = read_rig(rig)
    passes = look_at_passes(files, described)
    with output_folder(out or Path("results") / f"{distinct_name(files[0])}-passes") as folder:
        gc.freeze()  # what there is stays: a collection looks at the picture alone
        for one in passes:
            terminal.keep(folder / f"{one.name}.png", pass_picture(one))
            gc.collect()  # a picture is a cycle, and those of ten passes hold 60 MB
        found = [repeats([one.readings for one in some]) for some in swept_alike(usable(passes))]
        with waiting("looking for a lag"):
            lag = lag_between([one.readings for one in passes])
        terminal.show(
            *passes_summary(passes, found), *lag_summary(passes, lag, described.passes.lag)
        )
        for one in passes:
            readings = one.readings if lag is None else with_lag(one.readings, lag)
            terminal.print_written(readings.write(folder / f"{one.name}.parquet"))
        terminal.keep(folder / "passes.json", passes_document(passes, found, lag))
        terminal.keep(folder / "passes.png", passes_picture(passes))
    return True
