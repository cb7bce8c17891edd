"""The command ``reconstruct``: the object from the clamp."""

from pathlib import Path
from typing import Annotated

import typer

from analytic.problem.errors import InputError, because
from compare.commands import options as opt
from compare.commands.output import distinct_name, distinct_names, output_folder, waiting
from compare.read.case import load_space_job
from compare.read.kinds import SPACE
from compare.read.toml import TomlFile

SWEEP = "readings in the plane"


def reconstruct(
    context: typer.Context,
    files: Annotated[
        list[Path],
        typer.Argument(metavar="FILE...", help="Readings, or a folder that `rig` wrote."),
    ],
    out: Annotated[Path | None, opt.out_folder("results/FILE-reconstructed")] = None,
    beam: Annotated[opt.BeamFile, opt.For((SWEEP, SPACE))] = None,
    column: Annotated[opt.Columns, opt.For((SWEEP, SPACE))] = None,
    direction: Annotated[opt.Way, opt.For((SWEEP,), (opt.A_RIG,))] = None,
    noise: Annotated[
        float | None,
        opt.option("Of the clamp readings over their largest magnitude, as 0.01.", "NUMBER"),
    ] = None,
    offset: Annotated[
        float,
        opt.option(
            "By how much foot_x is too large, as `compare --offset auto` finds it; in the "
            "vibrissa's unit of length, metres beside units.",
            "NUMBER",
        ),
        opt.For((SWEEP,)),
    ] = 0.0,
    friction: Annotated[
        str | None,
        opt.option(
            "Friction coefficient of the sweep; auto: estimate it from Phase B.",
            "NUMBER|auto",
            "the file's, or that of --beam",
        ),
        opt.For((SWEEP,)),
    ] = None,
    method: Annotated[
        str,
        opt.option("Which methods; `vibrissa list methods` has all.", "A,B,..."),
        opt.For((SWEEP,)),
    ] = "elastica",
    fit: Annotated[
        str | None,
        opt.option(
            "The whole object: circle, ellipse, superellipse, convex, in space sphere, ellipsoid, "
            "cylinder, convex; auto: the likeliest of them, in space but for convex. Exit code 1 "
            "if it does not explain the readings.",
            "FAMILY",
        ),
    ] = None,
    frame: Annotated[opt.InFrame, opt.For((SPACE,), (opt.A_RIG,))] = "world",
) -> bool:
    """Find the object from the clamp readings alone.

    In space --beam takes a case file, too: its vibrissa, its clamp, and the true body to compare
    with. Passes, several files or a folder that `rig` wrote, are of one object.
    """
    if noise is not None and not 0 <= noise < 1:
        raise InputError("--noise", noise, "a number from 0 up to 1", "as 0.01")
    known = None  # the case in space that the vibrissa's file is, if it is one
    if beam is not None and "body" in TomlFile.read(beam, "beam file").tables:
        known = load_space_job(beam)
    found = opt.pass_files(files)
    from compare.read.space_readings import is_spatial, read_space

    in_space = [one for one in found if known is not None or is_spatial(one)]
    swept = [one for one in found if one not in in_space]
    if swept:
        opt.require_use(context, SWEEP, *([opt.A_RIG] if column or opt.from_rigs(swept) else []))
    if in_space:
        opt.require_use(
            context, SPACE, *([opt.A_RIG] if column or not opt.no_rigs(in_space) else [])
        )
    with waiting("loading"):
        from compare.commands import reconstructing
    if in_space and fit is not None:
        reconstructing.check_body(fit)
    rig, level = reconstructing.RigFiles(column or (), beam, direction, frame), noise or 0.0
    good = True

    def place(file: Path, *inner: str) -> Path:
        return out.joinpath(*inner) if out else Path(f"results/{distinct_name(file)}-reconstructed")

    if swept:
        passes = [reconstructing.without_faults(one, offset) for one in rig.read_all(swept)]
        where = place(files[0], *["passes"] * bool(in_space))
        good = reconstructing.in_the_plane(passes, where, noise, friction, opt.words(method), fit)
    sweeps, body = [], None if known is None else known.body
    vibrissa, tangent = (known.case.beam, known.case.path.tangent) if known else (None, None)
    for name, path in distinct_names(in_space).items() if in_space else ():
        sweeps.append(read_space(path, vibrissa, tangent, rig.columns, rig.frame))
        with output_folder(place(path, *[name] * (len(found) > 1))) as folder:
            good &= reconstructing.find_body(sweeps[-1], body, folder, level, True)
    if sweeps and fit is not None:
        try:
            good &= reconstructing.body_of(sweeps, place(in_space[0]), level, fit)
        except InputError as error:
            if good:
                raise
            raise because(error, "what is said of the readings above comes first") from error
    return good
