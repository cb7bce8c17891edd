"""The command ``reconstruct``: the object from the clamp, and how well methods find it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from compare.commands.kinds import A_RIG, For, no_rigs, pass_files, require_use
from compare.commands.options import (
    AGREES,
    DISAGREES,
    BeamFile,
    Columns,
    InFrame,
    Way,
    flag,
    option,
    out_folder,
    shares,
    words,
)
from compare.commands.output import distinct_name, distinct_names, waiting
from compare.read.case import load_job, load_space_job
from compare.read.kinds import SPACE, TABLES
from compare.read.toml import TomlFile

if TYPE_CHECKING:
    from compare.read.job import SpaceJob

SWEEP, ERRORS = "readings in the plane", "contacts that are known"
_CASE, _STORED = "a case", "a file"
_LEVELS = "0,0.001,0.01"  # of noise


def reconstruct(
    context: typer.Context,
    files: Annotated[
        list[str],
        typer.Argument(
            metavar="FILE...",
            help="Readings, or a folder that `rig` wrote; or a case, for how well methods do.",
        ),
    ],
    out: Annotated[Path | None, out_folder("results/FILE-reconstructed, or CASE-methods")] = None,
    beam: Annotated[BeamFile, For((SWEEP, SPACE))] = None,
    column: Annotated[Columns, For((SWEEP, SPACE))] = None,
    direction: Annotated[Way, For((SWEEP,), (A_RIG,))] = None,
    noise: Annotated[
        str | None,
        option(
            "Of the clamp readings over their largest magnitude, as 0.01; beside contacts that "
            "are known up to three, as 0,0.001,0.01.",
            "NUMBER",
        ),
    ] = None,
    offset: Annotated[
        float,
        option(
            "By how much foot_x is too large, as `compare --offset auto` finds it; in the "
            "vibrissa's unit of length, metres beside units.",
            "NUMBER",
        ),
        For((SWEEP,)),
    ] = 0.0,
    friction: Annotated[
        str | None,
        option(
            "Friction coefficient of the sweep; auto: estimate it from Phase B.",
            "NUMBER|auto",
            "the file's, or that of --beam",
        ),
        For((SWEEP,)),
    ] = None,
    method: Annotated[
        str | None,
        option(
            "Which methods; `vibrissa list methods` has all.",
            "A,B,...",
            "elastica; all beside contacts that are known",
        ),
        For((SWEEP, ERRORS)),
    ] = None,
    fit: Annotated[
        str | None,
        option(
            "The whole object: circle, ellipse, superellipse, convex; auto: the likeliest of them. "
            "Exit code 1 if it does not explain the readings.",
            "FAMILY",
        ),
        For((SWEEP,)),
    ] = None,
    errors: Annotated[
        bool,
        flag("--errors", "How well methods find the contacts that a model's file holds."),
        For((ERRORS,), (_STORED,)),
    ] = False,
    on: Annotated[
        str,
        option(
            "Readings of what, while methods take it for a straight vibrissa in a rigid clamp "
            "without friction: exact, curved, tapered, soft-clamp, friction, mujoco; or all.",
            "A,B,...",
        ),
        For((ERRORS,), (_CASE,)),
    ] = "exact",
    frame: Annotated[InFrame, For((SPACE,), (A_RIG,))] = "world",
) -> int:
    """Find the object from the clamp readings alone.

    Of a case, and with --errors, how well every method finds contacts that are known. In space
    --beam takes a case file, too: its vibrissa, its clamp, and the true body to compare with.
    Passes in the plane, several files or a folder that `rig` wrote, are of one object.
    """
    known = None if beam is None else _in_space(beam)
    given = [Path(file) for file in files]
    stored = [path for path in given if path.suffix.lower() in TABLES or path.is_dir()]
    found = pass_files(stored)
    swept = [] if errors else [one for one in found if _kind(one, known) == SWEEP]
    code = AGREES
    cases = [path for path in given if path not in stored]
    rest = [path for path in (*found, *cases) if path not in swept]
    if swept:
        rigs = [] if no_rigs(swept) and not column else [A_RIG]
        require_use(context, SWEEP, _STORED, *rigs)
        share = None if noise is None else shares("--noise", noise, 1)[0]
        with waiting("loading"):
            from compare.commands import reconstructing
        rig = reconstructing.RigFiles(column or (), beam, direction, frame)
        passes = [reconstructing.without_faults(rig.read(path), offset) for path in swept]
        place = out / "passes" if out and rest else out
        place = place or Path("results") / f"{distinct_name(given[0])}-reconstructed"
        methods = words(method or "elastica")
        if not reconstructing.in_the_plane(passes, place, share, friction, methods, fit):
            code = DISAGREES
    several = distinct_names(rest) if rest else {}
    for name, path in several.items():
        is_file = path.suffix.lower() in TABLES
        job = None if is_file else load_job(str(path))
        kind = ERRORS if errors or not is_file else _kind(path, known)
        raw = is_file and (bool(column) or not no_rigs([path]))
        require_use(context, kind, _STORED if is_file else _CASE, *([A_RIG] if raw else []))
        place = out if out is None or len(several) + bool(swept) == 1 else out / name
        levels = shares("--noise", noise or _LEVELS, 3) if kind == ERRORS else []
        share = shares("--noise", noise or "0", 1)[0] if kind != ERRORS else 0.0
        with waiting("loading"):
            from compare.commands import reconstructing
        if kind == ERRORS:
            chosen = None if method is None else words(method)
            reconstructing.compare_methods(job or path, place, chosen, levels, words(on))
            continue
        rig = reconstructing.RigFiles(column or (), beam, direction, frame)
        folder = place or Path("results") / f"{distinct_name(path)}-reconstructed"
        if not reconstructing.in_space(path, known, rig, folder, share):
            code = DISAGREES
    return code


def _in_space(beam: Path) -> "SpaceJob | None":
    """The case in space that the vibrissa's file is, if it is one."""
    return load_space_job(beam) if "body" in TomlFile.read(beam, "beam file").tables else None


def _kind(file: Path, known: "SpaceJob | None") -> str:
    from compare.read.space_readings import is_spatial

    return SPACE if known is not None or is_spatial(file) else SWEEP
