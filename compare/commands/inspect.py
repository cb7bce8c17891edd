"""The command ``inspect``: what beam a user's own MuJoCo model is."""

import json
import sys
from pathlib import Path
from typing import Annotated

import typer

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file
from compare.commands.options import AGREES, DISAGREES
from compare.commands.output import output_folder


def inspect(
    model: Annotated[
        str, typer.Argument(metavar="MODEL", help="An MJCF or URDF file, or a shipped model.")
    ],
    foot: Annotated[
        str | None, typer.Option(metavar="BODY", help="The body that holds the vibrissa.")
    ] = None,
    force: Annotated[
        str | None, typer.Option(metavar="NAME", help="The force sensor at its clamp.")
    ] = None,
    torque: Annotated[
        str | None, typer.Option(metavar="NAME", help="The torque sensor at its clamp.")
    ] = None,
    geoms: Annotated[
        str | None, typer.Option(metavar="NAMES", help="The vibrissa's geoms, as 'whisker*,tip'.")
    ] = None,
    site: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="A site at its clamp, where sensors are added."),
    ] = None,
    beam: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="TOML file whose [beam] table is what the model should be."
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder for inspection.json; none without."),
    ] = None,
) -> int:
    """Measure what beam a MuJoCo model is, and say what a user should know of it."""
    from compare.read.case_file import read_beam
    from mujoco_models import shipped_models

    stated = None if beam is None else read_beam(beam)[0]
    shipped = shipped_models()
    if model not in shipped and not Path(model).suffix:
        raise InputError(
            "MODEL", repr(model), f"a file, or one of {', '.join(shipped)}", "name one of them"
        )
    path = regular_file(shipped.get(model, Path(model)), "model", sys.maxsize)
    from compare.commands import terminal
    from compare.simulate.inspection import Inspection
    from mujoco_models import inspect_model

    found = inspect_model(path, foot=foot, force=force, torque=torque, geoms=geoms, site=site)
    inspection = Inspection(found, stated)
    for line in inspection.lines():
        terminal.print_line(line)
    if out is not None:
        from analytic.problem.files import write_whole

        with output_folder(out) as folder:
            content = json.dumps(inspection.to_dict(), indent=2)
            terminal.print_written(write_whole(folder / "inspection.json", content))
    return AGREES if inspection.sound else DISAGREES
